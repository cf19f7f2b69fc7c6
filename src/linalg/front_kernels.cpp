#include "linalg/front_kernels.h"

#include <cstdlib>

namespace rhexis::linalg {

const FrontKernels* find_front_kernels(std::string_view name) {
  if (name == "portable") {
    static const FrontKernels kernels = portable::make_front_kernels();
    return &kernels;
  }
#if defined(__x86_64__)
  if (name == "avx2" && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    static const FrontKernels kernels = avx2::make_front_kernels();
    return &kernels;
  }
  if (name == "avx512" && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    static const FrontKernels kernels = avx512::make_front_kernels();
    return &kernels;
  }
#endif
  return nullptr;
}

const FrontKernels& front_kernels() {
  static const FrontKernels& chosen = [] {
    const char* const wanted = std::getenv("RHEXIS_SIMD");
    for (const char* name : {wanted != nullptr ? wanted : "", "avx512", "avx2"}) {
      if (const FrontKernels* const kernels = find_front_kernels(name)) return *kernels;
    }
    return *find_front_kernels("portable");
  }();
  return chosen;
}

}  // namespace rhexis::linalg
