// Linear solvers on the systems of tests/support/box_problem.h: bars of 2n x n x n cubes, small strain, kappa / mu =
// 25, beta = 100, tolerance 1e-8; docs/solvers.md quotes these numbers.
//
//   rhexis_bench --benchmark_filter=Linalg

#include <benchmark/benchmark.h>

#include <string>

#include "base/parallel.h"
#include "linalg/saddle_solver.h"
#include "tests/support/box_problem.h"

namespace {

using namespace rhexis;          // NOLINT
using namespace rhexis::linalg;  // NOLINT

test::BoxProblem bar(std::int64_t n, double kappa = 25.0) {
  const auto cells = static_cast<int>(n);
  return test::make_box_problem(test::make_box({2 * cells, cells, cells}, 1.0 / cells), {1.0, kappa, 100.0});
}

/// One Newton iteration's worth: factor (analysis kept) and solve.
void iterate(benchmark::State& state, const SaddleMatrix& K, const test::BoxProblem& problem, const std::string& name) {
  const auto solver = make_saddle_solver(name, &problem.blocks);
  VectorX bu = VectorX::Zero(K.displacement_unknowns());
  for (Eigen::Index i = 2; i < bu.size(); i += 3) bu[i] = 1.0;
  const VectorX bp = VectorX::Constant(K.pressure_unknowns(), 1e-3 / std::max(1, K.pressure_unknowns()));
  VectorX u;
  VectorX p;
  LinearReport report = solver->factor(K, problem.free);
  for (auto _ : state) {
    report = solver->factor(K, problem.free);
    if (report.ok()) report = solver->solve(bu, bp, 1e-8, u, p);
    if (!report.ok()) {
      state.SkipWithError(report.message.c_str());
      return;
    }
  }
  state.counters["unknowns"] = problem.free.count() + K.pressure_unknowns();
  state.counters["iterations"] = report.iterations;
  state.counters["megabytes"] = 1e-6 * static_cast<double>(solver->memory_bytes());
}

void LinalgDisplacement(benchmark::State& state, const char* name) {
  const test::BoxProblem problem = bar(state.range(0), 5.0);
  SaddleMatrix K;
  K.A = problem.displacement_only;
  iterate(state, K, problem, name);
}

void LinalgMixed(benchmark::State& state, const char* name) {
  const test::BoxProblem problem = bar(state.range(0));
  iterate(state, problem.K, problem, name);
}

void LinalgAnalyse(benchmark::State& state, const char* name) {
  const test::BoxProblem problem = bar(state.range(0));
  for (auto _ : state) {
    const auto solver = make_saddle_solver(name, &problem.blocks);
    benchmark::DoNotOptimize(solver->factor(problem.K, problem.free));
  }
}

void LinalgPattern(benchmark::State& state) {
  const auto cells = static_cast<int>(state.range(0));
  const mesh::TetMesh mesh = test::make_box({2 * cells, cells, cells}, 1.0);
  std::vector<std::int32_t> connectivity;
  for (const mesh::Tet& tet : mesh.tets) {
    for (const NodeId node : tet) connectivity.push_back(node.value());
  }
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  for (auto _ : state) benchmark::DoNotOptimize(make_block_pattern(nodes, connectivity, 4));
  state.counters["tets"] = static_cast<double>(mesh.tet_count());
}

void LinalgMultiply(benchmark::State& state) {
  const test::BoxProblem problem = bar(state.range(0));
  const VectorX x = VectorX::Ones(problem.K.displacement_unknowns());
  VectorX y(x.size());
  set_thread_count(static_cast<int>(state.range(1)));
  for (auto _ : state) problem.K.A.multiply(x, y);
  set_thread_count(0);
}

BENCHMARK_CAPTURE(LinalgDisplacement, direct, "direct")
    ->Arg(4)
    ->Arg(8)
    ->Arg(12)
    ->Arg(16)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(LinalgDisplacement, cg, "cg")->Arg(4)->Arg(8)->Arg(12)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(LinalgMixed, direct, "direct")->Arg(4)->Arg(8)->Arg(12)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(LinalgMixed, cg, "cg")->Arg(4)->Arg(8)->Arg(12)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(LinalgMixed, minres, "minres")->Arg(4)->Arg(8)->Arg(12)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(LinalgAnalyse, direct, "direct")->Arg(12)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(LinalgAnalyse, cg, "cg")->Arg(12)->Unit(benchmark::kMillisecond);
BENCHMARK(LinalgPattern)->Arg(12)->Arg(34)->Unit(benchmark::kMillisecond);
BENCHMARK(LinalgMultiply)->ArgsProduct({{16, 24}, {1, 2}})->Unit(benchmark::kMillisecond);

}  // namespace
