#if defined(__x86_64__)
#define RHEXIS_SIMD_NAMESPACE avx2
#define RHEXIS_SIMD_NAME "avx2"
#define RHEXIS_SIMD_WIDTH 4
#include "element/simd/tet_kernels.inc.h"
#endif
