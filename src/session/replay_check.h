#pragma once

/// `rhexis replay --check`: computes a recorded interaction again, tick by tick and step by step, and holds every bit
/// that is recorded against what comes out.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "base/error.h"

namespace rhexis::session {

struct CheckReport {
  std::string difference;   ///< empty: the same bits; else the first that is another, in words
  std::uint64_t ticks = 0;  ///< of the haptic loop, computed again and found the same
  std::uint64_t steps = 0;  ///< of the physics
  std::uint64_t advances = 0;
  std::uint64_t bodies = 0;  ///< opened or made anew
  std::string version;       ///< of the program that recorded
};

/// `progress`: called now and then with the part that is done. Errors: of the file.
[[nodiscard]] Expected<CheckReport> check_recording(const std::filesystem::path& path,
                                                    const std::function<void(double)>& progress = {});

}  // namespace rhexis::session
