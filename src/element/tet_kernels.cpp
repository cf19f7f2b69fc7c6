#include "element/tet_kernels.h"

#include <cstdlib>

#include "base/log.h"

namespace rhexis::element {

const TetKernels* find_tet_kernels(std::string_view name) {
  if (name == "portable") {
    static const TetKernels kernels = portable::make_tet_kernels();
    return &kernels;
  }
#if defined(__x86_64__)
  if (name == "avx2" && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    static const TetKernels kernels = avx2::make_tet_kernels();
    return &kernels;
  }
  if (name == "avx512" && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    static const TetKernels kernels = avx512::make_tet_kernels();
    return &kernels;
  }
#endif
  return nullptr;
}

namespace {

const TetKernels& choose() {
  if (const char* wanted = std::getenv("RHEXIS_SIMD"); wanted != nullptr && *wanted != '\0') {
    if (const TetKernels* kernels = find_tet_kernels(wanted)) return *kernels;
    spdlog::warn("RHEXIS_SIMD={}: not on this processor (portable, avx2 or avx512)", wanted);
  }
  for (const char* name : {"avx512", "avx2"}) {
    if (const TetKernels* kernels = find_tet_kernels(name)) return *kernels;
  }
  return *find_tet_kernels("portable");
}

}  // namespace

const TetKernels& tet_kernels() {
  static const TetKernels& chosen = choose();
  return chosen;
}

}  // namespace rhexis::element
