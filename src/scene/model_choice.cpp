#include "scene/model_choice.h"

#include "mesh/quality.h"
#include "model/stabilisation.h"

namespace rhexis::scene {
namespace {

/// The stabilisation smooths lambda over a length; above this fraction of the body's thickness it smooths what is real.
constexpr double kMostSmoothing = 0.25;

}  // namespace

model::ModelSettings choose_model(const Scene& scene, const mesh::TetMesh& mesh, std::vector<std::string>& notes,
                                  std::vector<std::string>& warnings) {
  model::ModelSettings settings{.kind = scene.model.kind,
                                .elastic = scene.material.elastic,
                                .law = scene.material.law,
                                .beta = 0.0,
                                .initial_lambda = scene.model.initial_lambda,
                                .corotated_tangent = scene.model.corotated_tangent};
  if (settings.kind != model::ModelKind::hyperelastic) return settings;
  settings.beta = scene.model.beta ? *scene.model.beta : model::auto_beta(settings.law);
  if (!scene.model.beta) notes.push_back(fmt::format("beta = {:.4g}, chosen from the material", settings.beta));
  if (settings.beta > 0.0) {
    const double reach = model::smoothing_length(mesh, settings.law, settings.beta);
    const double thickness = mesh::thickness(mesh);
    if (reach > kMostSmoothing * thickness)
      warnings.push_back(fmt::format(
          "{}: beta = {:.4g} smooths lambda over {:.3g} m, more than a quarter of the body's thickness of {:.3g} m "
          "({} would resolve more)",
          scene.file, settings.beta, reach, thickness,
          scene.model.beta ? "a smaller beta or a finer mesh" : "a finer mesh"));  // below auto the body locks
  }
  return settings;
}

}  // namespace rhexis::scene
