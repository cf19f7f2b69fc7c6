#include "base/instruction_set.h"

#include <algorithm>
#include <cstdlib>

#include "base/log.h"

namespace rhexis {
namespace {

std::string_view choose() {
  if (const char* wanted = std::getenv("RHEXIS_SIMD"); wanted != nullptr && *wanted != '\0') {
    const auto* const known = std::find(kInstructionSets.begin(), kInstructionSets.end(), wanted);
    if (known != kInstructionSets.end() && runs_instruction_set(*known)) return *known;
    spdlog::warn("RHEXIS_SIMD={}: not on this processor (portable, avx2 or avx512)", wanted);
  }
  return *std::find_if(kInstructionSets.rbegin(), kInstructionSets.rend(), runs_instruction_set);
}

}  // namespace

bool runs_instruction_set(std::string_view name) {
  if (name == "portable") return true;
#if defined(__x86_64__)
  if (name == "avx2") return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (name == "avx512")
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#endif
  return false;
}

std::string_view instruction_set() {
  static const std::string_view chosen = choose();
  return chosen;
}

}  // namespace rhexis
