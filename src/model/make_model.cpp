#include "model/make_model.h"

#include <algorithm>

#include "base/check.h"
#include "element/tet_kernels.h"
#include "model/mass_spring.h"
#include "model/p1_displacement.h"
#include "model/p1_hyperelastic.h"
#include "model/taylor_hood.h"

namespace rhexis::model {

ModelKind kind_named(std::string_view name) {
  const auto* const found = std::find(kModelNames.begin(), kModelNames.end(), name);
  RHEXIS_CHECK(found != kModelNames.end(), "model '{}'", name);
  return static_cast<ModelKind>(found - kModelNames.begin());
}

std::unique_ptr<Model> make_model(const mesh::TetMesh& mesh, const ModelSettings& settings, LeftOut left_out) {
  const element::TetKernels& kernels = element::tet_kernels();
  RHEXIS_CHECK(left_out.empty() || is_live(settings.kind), "{} takes whole meshes",
               kModelNames[static_cast<std::size_t>(settings.kind)]);
  switch (settings.kind) {
    case ModelKind::mass_spring: return make_mass_spring(mesh, settings);
    case ModelKind::linear: return make_linear(mesh, settings, kernels, left_out);
    case ModelKind::corotated: return make_corotated(mesh, settings, kernels, left_out);
    case ModelKind::geometrically_nonlinear: return make_geometrically_nonlinear(mesh, settings, kernels, left_out);
    case ModelKind::hyperelastic: return make_hyperelastic(mesh, settings, kernels, left_out);
    case ModelKind::taylor_hood: return make_taylor_hood(mesh, settings);
  }
  RHEXIS_CHECK(false, "model kind {}", static_cast<int>(settings.kind));
  return nullptr;
}

}  // namespace rhexis::model
