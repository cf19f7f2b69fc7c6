#pragma once

/// How the readers refuse a file. A reader has a hundred places that can meet nonsense; inside this room they throw, so
/// that the code reads as the format does, and `guarded` is the one door through which the failure leaves, as an
/// `Error`.

#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"

namespace rhexis::mesh::io {

struct ReadFailure {
  Error error;  ///< without the file's name
};

/// Throws ReadFailure. `line` is 1-based, 0 when there is none to name.
[[noreturn]] void refuse(std::string what, std::string remedy = {}, int line = 0);

/// Text from a file as UTF-8 that can be printed: control characters, and what is no UTF-8, become '?'.
[[nodiscard]] std::string printable(std::string_view text);
/// The same in quotes, cut to 40 characters.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Returns read(), or the error that it threw, placed in `file`.
template <class Read>
auto guarded(const std::string& file, Read&& read) -> Expected<decltype(read())> {
  try {
    return read();
  } catch (ReadFailure& failure) {
    failure.error.file = file;
    return fail(std::move(failure.error));
  } catch (const std::bad_alloc&) {
    return fail("not enough memory to read it", "", file);
  }
}

}  // namespace rhexis::mesh::io
