#pragma once

/// Broken invariants: a mistake of ours, never of the user. The process stops with the condition, the place and a
/// message, because nothing computed after it could be trusted. What a user can cause is an `Error` (base/error.h).

#include <fmt/format.h>

#include <string>

namespace rhexis {

[[noreturn]] void check_failed(const char* condition, const char* file, int line, const std::string& message);

}  // namespace rhexis

/// RHEXIS_CHECK(condition, format, arguments...): on in every build, so keep it out of inner loops.
#define RHEXIS_CHECK(condition, ...)                                                      \
  do {                                                                                    \
    if (!(condition)) [[unlikely]]                                                        \
      ::rhexis::check_failed(#condition, __FILE__, __LINE__, ::fmt::format(__VA_ARGS__)); \
  } while (false)
