#include "linalg/front_kernels.h"

#include "base/instruction_set.h"

namespace rhexis::linalg {

const FrontKernels* find_front_kernels(std::string_view name) {
  if (!runs_instruction_set(name)) return nullptr;
#if defined(__x86_64__)
  if (name == "avx2") {
    static const FrontKernels kernels = avx2::make_front_kernels();
    return &kernels;
  }
  if (name == "avx512") {
    static const FrontKernels kernels = avx512::make_front_kernels();
    return &kernels;
  }
#endif
  static const FrontKernels kernels = portable::make_front_kernels();
  return &kernels;
}

const FrontKernels& front_kernels() {
  static const FrontKernels& chosen = *find_front_kernels(instruction_set());
  return chosen;
}

}  // namespace rhexis::linalg
