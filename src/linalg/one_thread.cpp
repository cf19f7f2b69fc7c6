#include "linalg/one_thread.h"

extern "C" {
void openblas_set_num_threads(int threads);
// Of the OpenMP runtime that CHOLMOD was built with; absent when it was built without.
__attribute__((weak)) void omp_set_max_active_levels(int levels);
}

namespace rhexis::linalg {

void stay_on_one_thread() {
  static const bool blas_is_set = [] {
    openblas_set_num_threads(1);
    return true;
  }();
  static_cast<void>(blas_is_set);
  if (omp_set_max_active_levels != nullptr) omp_set_max_active_levels(0);
}

}  // namespace rhexis::linalg
