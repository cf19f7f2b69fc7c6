#include "bench/rivals/bar.h"

#include <algorithm>

#include "base/check.h"
#include "mesh/generate.h"
#include "model/stabilisation.h"
#include "solver/equilibrium.h"

namespace rhexis::rivals {
namespace {

constexpr double kLength = 0.1;  // m
constexpr double kThickness = 0.02;
/// Of the converged answers: far below every error that is told.
constexpr double kTolerance = 1e-9;

}  // namespace

Expected<Bar> Bar::make(int nodes, const material::Elastic& elastic) {
  Expected<mesh::TetMesh> mesh = mesh::make_bar({{kLength, kThickness, kThickness}}, nodes);
  if (!mesh) return fail(std::move(mesh.error()));
  Bar bar;
  bar.mesh = std::move(*mesh);
  bar.elastic = elastic;
  bar.held = bar.mesh.find_node_set("-x")->nodes;
  const Vec3 tip(kLength, 0.5 * kThickness, 0.5 * kThickness);
  for (std::size_t i = 0; i < bar.mesh.node_count(); ++i) {
    if (!bar.hand.valid() || (bar.mesh.nodes[i] - tip).norm() < (bar.mesh.node(bar.hand) - tip).norm())
      bar.hand = NodeId(i);
  }
  return bar;
}

model::Loading Bar::supported() const {
  model::Loading loading;
  loading.dead_force = VectorX::Zero(dofs());
  for (const NodeId node : held)
    for (std::int32_t c = 0; c < 3; ++c) loading.supports.push_back({3 * node.value() + c, 0.0});
  return loading;
}

model::Loading Bar::led(const Vec3& at) const {
  model::Loading loading = supported();
  for (std::int32_t c = 0; c < 3; ++c) loading.supports.push_back({3 * hand.value() + c, at[c]});
  std::sort(loading.supports.begin(), loading.supports.end(),
            [](const auto& a, const auto& b) { return a.dof < b.dof; });
  return loading;
}

std::shared_ptr<const model::Model> Bar::model(model::ModelKind kind, bool stabilised) const {
  model::ModelSettings settings;
  settings.kind = kind;
  settings.elastic = elastic;
  settings.law = material::to_mooney_rivlin(elastic, true);
  settings.beta = stabilised ? model::auto_beta(settings.law) : 0.0;
  return model::make_model(mesh, settings);
}

model::State converged(const Bar& bar, const model::Model& model, const Vec3& hand, model::State near) {
  const bool is_mixed = model.pressure_unknowns() > 0;
  const solver::Options options{.linear = is_mixed ? "cg" : "direct", .tolerance = kTolerance, .steps = 1};
  const solver::Report report = solver::solve_equilibrium(model, bar.led(hand), options, near);
  RHEXIS_CHECK(report.converged(), "no converged answer of {}: {}", model.name(), report.why);
  return near;
}

double error_of(const VectorX& u, const VectorX& of) { return (u - of).norm() / of.norm(); }

}  // namespace rhexis::rivals
