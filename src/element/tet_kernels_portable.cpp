#define RHEXIS_SIMD_NAMESPACE portable
#define RHEXIS_SIMD_NAME "portable"
#define RHEXIS_SIMD_WIDTH 2
#include "element/simd/tet_kernels.inc.h"
