#pragma once

/// Numbers that the docs quote are printed by the tests that check them: `[ measured ] what: value`.

#include <fmt/format.h>

namespace rhexis::test {

template <class... Args>
void measured(fmt::format_string<Args...> format, Args&&... args) {
  fmt::print("[ measured ] {}\n", fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace rhexis::test
