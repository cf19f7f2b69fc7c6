// A whole Newton iteration (tangent, factorisation, solve, line search) of PSH against a corotated one: the same
// vessel, pushed aside and pulled, solved to 1e-8 by both in turn, so that the ratio survives a machine whose speed
// drifts. The paper's Table 6 has 5.75 for 401 nodes.
//
//   rhexis_bench --benchmark_filter=Newton

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

#include "base/clock.h"
#include "mesh/generate.h"
#include "model/make_model.h"
#include "model/stabilisation.h"
#include "solver/equilibrium.h"

namespace {

using namespace rhexis;  // NOLINT

constexpr double kAuto = -1.0;

model::ModelSettings settings_of(model::ModelKind kind, double beta) {
  model::ModelSettings settings;
  settings.kind = kind;
  settings.elastic = {1e6, 0.49};
  settings.law = material::to_mooney_rivlin(settings.elastic);
  settings.beta = beta == kAuto ? model::auto_beta(settings.law) : beta;
  return settings;
}

/// Top held, bottom pulled by a tenth of the length, 5% of the width aside.
model::Loading loading_of(const mesh::TetMesh& mesh, const model::Model& body) {
  model::Loading loading;
  loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(body.space().dof_count()));
  for (const NodeId node : mesh.find_node_set("top")->nodes)
    for (int i = 0; i < 3; ++i) loading.supports.push_back({3 * node.value() + i, 0.0});
  for (const NodeId node : mesh.find_node_set("bottom")->nodes) {
    loading.supports.push_back({3 * node.value(), 0.0005});
    loading.supports.push_back({3 * node.value() + 2, -0.004});
  }
  std::sort(loading.supports.begin(), loading.supports.end(),
            [](const auto& a, const auto& b) { return a.dof < b.dof; });
  return loading;
}

struct Cost {
  double seconds = 0.0;
  double build_seconds = 0.0;
  int iterations = 0;
  int linear_iterations = 0;
  void add(const solver::Report& report, double taken) {
    seconds += taken;
    build_seconds += report.build_seconds;
    for (const solver::StepReport& step : report.steps) {
      iterations += step.iterations;
      linear_iterations += step.linear_iterations;
    }
  }
  [[nodiscard]] double per_iteration() const { return seconds / std::max(1, iterations); }
};

bool run(const mesh::TetMesh& mesh, const model::Model& body, const std::string& linear, Cost& cost) {
  const model::Loading loading = loading_of(mesh, body);
  model::State state = body.initial_state();
  const Stopwatch watch;
  const solver::Report report = solver::solve_equilibrium(body, loading, {.linear = linear, .steps = 2}, state);
  cost.add(report, watch.seconds());
  return report.converged();
}

void NewtonPshAgainstCorotated(benchmark::State& state, const char* linear, double beta) {
  const mesh::TetMesh mesh = mesh::make_tube({}, static_cast<int>(state.range(0))).value();
  const auto corotated = model::make_model(mesh, settings_of(model::ModelKind::corotated, 0.0));
  const auto psh = model::make_model(mesh, settings_of(model::ModelKind::hyperelastic, beta));
  Cost base;
  Cost ours;
  for (auto _ : state) {
    if (!run(mesh, *corotated, "direct", base) || !run(mesh, *psh, linear, ours)) {
      state.SkipWithError("not converged");
      return;
    }
  }
  const auto per_tet = [&](const Cost& cost) {
    return 1e9 * cost.per_iteration() / static_cast<double>(mesh.tet_count());
  };
  state.counters["corotated_ns_per_tet"] = per_tet(base);
  state.counters["psh_ns_per_tet"] = per_tet(ours);
  state.counters["psh_build_share"] = ours.build_seconds / ours.seconds;
  state.counters["cg_a_step"] = static_cast<double>(ours.linear_iterations) / std::max(1, ours.iterations);
  state.counters["iteration_ratio"] = ours.per_iteration() / base.per_iteration();
  state.counters["solve_ratio"] = ours.seconds / base.seconds;
}

#define SIZES Arg(401)->Arg(3000)->Arg(30000)->Unit(benchmark::kMillisecond)->UseRealTime()
BENCHMARK_CAPTURE(NewtonPshAgainstCorotated, cg_beta_100, "cg", 100.0)->SIZES;
BENCHMARK_CAPTURE(NewtonPshAgainstCorotated, cg_beta_auto, "cg", kAuto)->SIZES;
BENCHMARK_CAPTURE(NewtonPshAgainstCorotated, direct_beta_100, "direct", 100.0)->SIZES;

}  // namespace
