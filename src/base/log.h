#pragma once

/// What the program says while it works goes to stderr through spdlog: stdout is for results. Errors that end a
/// command are printed by the command itself, in the form of base/error.h.

#include <spdlog/spdlog.h>

namespace rhexis {

enum class Verbosity { quiet, normal, verbose };

/// Plain lines without a time stamp; warnings are prefixed `rhexis: warning:`.
void set_up_log(Verbosity verbosity);

}  // namespace rhexis
