#if defined(__x86_64__)
#define RHEXIS_SIMD_NAMESPACE avx512
#include "linalg/front_kernels.inc.h"
#endif
