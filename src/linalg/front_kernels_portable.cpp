#define RHEXIS_SIMD_NAMESPACE portable
#include "linalg/front_kernels.inc.h"
