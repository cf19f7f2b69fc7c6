#if defined(__x86_64__)
#define RHEXIS_SIMD_NAMESPACE avx512
#define RHEXIS_SIMD_NAME "avx512"
#define RHEXIS_SIMD_WIDTH 8
#include "element/simd/tet_kernels.inc.h"
#endif
