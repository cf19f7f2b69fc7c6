#pragma once

/// Wider vector instructions of the processor. A room with kernels for each compiles them in units of their own
/// (*_avx2.cpp, *_avx512.cpp) and asks here which to take.

#include <array>
#include <string_view>

namespace rhexis {

/// Narrowest first.
inline constexpr std::array<std::string_view, 3> kInstructionSets{"portable", "avx2", "avx512"};

/// Whether units of that name were built and this processor runs them. False for a name that is none of the above.
[[nodiscard]] bool runs_instruction_set(std::string_view name);

/// The widest that this processor runs, or what the environment variable RHEXIS_SIMD names; chosen once. A name that it
/// does not run is warned of.
[[nodiscard]] std::string_view instruction_set();

}  // namespace rhexis
