#include "scene/dynamics_choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhexis::scene {
namespace {

/// Of a swing: a step that is a longer part of it shows none, and one of this part shows it well.
constexpr double kLongestPart = 0.25;
constexpr double kGoodPart = 0.05;
/// Damping that is so many times critical lets nothing swing, and creep for long.
constexpr double kMostDamping = 10.0;
constexpr double kShortestStep = 0.001;  // s, of the declaration

/// s, of the slowest swing, roughly: the first bending mode of a bar as long and thick as the body's box, held at one
/// end, T = 2 pi / 3.516 L^2 sqrt(12 rho / E) / d. Wrong by a small factor for most bodies.
double slowest_swing(const mesh::TetMesh& mesh, const MaterialSettings& material) {
  const Vec3 size = mesh::bounding_box(mesh).size();
  const double length = size.maxCoeff();
  return 2.0 * std::numbers::pi / 3.516 * length * length / size.minCoeff() *
         std::sqrt(12.0 * material.density / material.elastic.young);
}

void warn_of_numbers(const solver::Dynamics& dynamics, double swing, const Place& place,
                     std::vector<std::string>& warnings) {
  const auto warn = [&](const std::string& what, const std::string& remedy) {
    warnings.push_back(place.fail(what, remedy).value().message());
  };
  if (dynamics.step > kLongestPart * swing)
    warn(fmt::format("a time step of {:.3g} s is long beside the slowest swing of this body, about {:.2g} s: it comes "
                     "to rest without one",
                     dynamics.step, swing),
         kLongestPart * swing > kShortestStep
             ? fmt::format("step = {:.1g} shows it", std::max(kShortestStep, kGoodPart * swing))
             : "it is at rest sooner than can be seen: leave [dynamics] out");
  const double w = 2.0 * std::numbers::pi / swing;  // 1/s
  if (0.5 * dynamics.stiffness_damping * w > kMostDamping)
    warn(fmt::format("with stiffness_damping = {:.3g} s this body creeps back for several times that, and does not "
                     "swing",
                     dynamics.stiffness_damping),
         fmt::format("less than {:.1g} s for a swing of about {:.2g} s", 2.0 / w, swing));
  if (0.5 * dynamics.mass_damping / w > kMostDamping)
    warn(fmt::format("with mass_damping = {:.3g} 1/s this body creeps back in about {:.2g} s, and does not swing",
                     dynamics.mass_damping, dynamics.mass_damping / (w * w)),
         fmt::format("less than {:.1g} 1/s for a swing of about {:.2g} s", 2.0 * w, swing));
}

}  // namespace

Expected<std::optional<solver::Dynamics>> choose_dynamics(const Scene& scene, const mesh::TetMesh& mesh,
                                                          std::vector<std::string>& warnings) {
  if (!scene.dynamics) return std::nullopt;
  const Place& place = scene.dynamics->place;
  if (scene.model.kind == model::ModelKind::linear || !model::is_live(scene.model.kind)) {
    const std::string name(model::kModelNames[static_cast<std::size_t>(scene.model.kind)]);
    warnings.push_back(place
                           .fail(fmt::format("'dynamics' is not read by model {}, which has no mass", in_quotes(name)),
                                 R"(kind = "corotated", "geometrically-nonlinear" or "hyperelastic")")
                           .value()
                           .message());
    return std::nullopt;
  }
  if (!(scene.material.density > 0.0))
    return place.fail("dynamics need a mass, and 'material.density' is 0", "a density in kg/m3, more than 0");
  const solver::Dynamics dynamics{.density = scene.material.density,
                                  .mass_damping = scene.dynamics->mass_damping,
                                  .stiffness_damping = scene.dynamics->stiffness_damping,
                                  .step = scene.dynamics->step};
  warn_of_numbers(dynamics, slowest_swing(mesh, scene.material), place, warnings);
  return dynamics;
}

}  // namespace rhexis::scene
