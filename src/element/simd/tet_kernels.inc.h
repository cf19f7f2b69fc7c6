/// The whole of one instruction set's kernels: RHEXIS_SIMD_NAMESPACE and RHEXIS_SIMD_WIDTH are set by the source file
/// that includes this. Only headers without code, or whose code is inlined away, may be included here.

#include <cstddef>
#include <cstdint>

#include "element/polar.h"
#include "element/tet_kernels.h"
#include "material/tensor.h"

namespace rhexis::element::RHEXIS_SIMD_NAMESPACE {
namespace {

using material::Deformation;
using material::Sym;
using material::Sym66;

inline constexpr int kWidth = RHEXIS_SIMD_WIDTH;

// In this order: each builds on those before it.
// clang-format off
#include "element/simd/pack.h"
#include "element/simd/cofactor.h"
#include "element/simd/tet_math.h"
#include "element/simd/polar.h"
#include "element/simd/responses.h"
#include "element/simd/kernel_table.h"
// clang-format on

}  // namespace

TetKernels make_tet_kernels() {
  TetKernels table;
  table.instruction_set = RHEXIS_SIMD_NAME;
  table.linear = DisplacementLoops<SmallStrain>::table();
  table.corotated = DisplacementLoops<Corotated>::table();
  table.warped_corotated = DisplacementLoops<WarpedCorotated>::table();
  table.st_venant_kirchhoff = DisplacementLoops<material::StVenantKirchhoffLaw>::table();
  table.mooney_rivlin = MixedLoops<material::MooneyRivlinLaw>::table();
  table.neo_hookean = MixedLoops<material::NeoHookeanLaw>::table();
  table.polar = &polar_batch;
  return table;
}

}  // namespace rhexis::element::RHEXIS_SIMD_NAMESPACE
