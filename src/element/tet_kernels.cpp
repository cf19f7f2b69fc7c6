#include "element/tet_kernels.h"

#include "base/instruction_set.h"

namespace rhexis::element {

const TetKernels* find_tet_kernels(std::string_view name) {
  if (!runs_instruction_set(name)) return nullptr;
#if defined(__x86_64__)
  if (name == "avx2") {
    static const TetKernels kernels = avx2::make_tet_kernels();
    return &kernels;
  }
  if (name == "avx512") {
    static const TetKernels kernels = avx512::make_tet_kernels();
    return &kernels;
  }
#endif
  static const TetKernels kernels = portable::make_tet_kernels();
  return &kernels;
}

const TetKernels& tet_kernels() {
  static const TetKernels& chosen = *find_tet_kernels(instruction_set());
  return chosen;
}

}  // namespace rhexis::element
