#pragma once

/// What a user can cause (a wrong file, scene, option) is returned as an `Error` and printed as one line
///     rhexis: FILE:LINE: what is wrong (what would be right)
/// Broken invariants are RHEXIS_CHECK (base/check.h); trouble inside a computation is a status of its report.

#include <string>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

namespace rhexis {

struct Error {
  std::string what;    ///< what is wrong, one line, no full stop
  std::string remedy;  ///< what would be right, empty when the first part says it
  std::string file;    ///< as the user named it; empty when no file is at fault
  int line = 0;        ///< 1-based; 0 when unknown or the file is binary

  /// `FILE:LINE: what (remedy)`, without the parts that are empty.
  [[nodiscard]] std::string message() const;

  /// The same error, placed in a file (and line) unless it has a place already.
  [[nodiscard]] Error at(const std::string& in_file, int in_line = 0) const;
};

template <class T>
using Expected = tl::expected<T, Error>;

/// return fail("set 'top' holds no node", "enlarge its box");
[[nodiscard]] inline tl::unexpected<Error> fail(std::string what, std::string remedy = {}, std::string file = {},
                                                int line = 0) {
  return tl::unexpected<Error>(Error{std::move(what), std::move(remedy), std::move(file), line});
}
[[nodiscard]] inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

}  // namespace rhexis
