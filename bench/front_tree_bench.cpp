// The multifrontal factor that follows a tear, on the plate 240 x 240 x 10 mm: a crack runs from the middle of y = 0 to
// +y. Beside it what it replaces: a sparse factorisation of the whole (docs/exact-response.md quotes these numbers).
//
//   rhexis_bench --benchmark_filter=FrontTree

#include <benchmark/benchmark.h>

#include <cmath>

#include "base/clock.h"
#include "mesh/generate.h"
#include "tests/support/front_body.h"

namespace {

using namespace rhexis;          // NOLINT
using namespace rhexis::linalg;  // NOLINT

test::FrontBody plate(const benchmark::State& state) {
  return {mesh::make_plate({{0.24, 0.24, 0.01}}, static_cast<int>(state.range(0))).value(), 0.0};
}

/// The middle of the front, and the line of the crack behind it.
struct Crack {
  explicit Crack(const test::FrontBody& body) {
    for (const Vec3& x : body.position) size = size.cwiseMax(x);
  }
  [[nodiscard]] Vec3 tip() const { return {0.5 * size[0], length, 0.5 * size[2]}; }
  Vec3 size = Vec3::Zero();
  double length = 3.0;  // mean edges
};

/// Nodes of a column through the thickness around the tip, some `count` of them.
std::vector<std::int32_t> window(const test::FrontBody& body, const Vec3& tip, std::size_t count) {
  std::vector<std::pair<double, std::int32_t>> near;
  for (std::int32_t i = 0; i < body.node_count(); ++i) {
    near.emplace_back((body.position[static_cast<std::size_t>(i)] - tip).norm(), i);
  }
  std::sort(near.begin(), near.end());
  std::vector<std::int32_t> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(near[i].second);
  std::sort(out.begin(), out.end());
  return out;
}

/// Removes the elements that the crack's line crosses between two lengths.
std::vector<std::int32_t> tear(test::FrontBody& body, const Vec3& from, const Vec3& to) {
  std::vector<std::int32_t> out;
  for (std::int32_t e = 0; e < body.element_count(); ++e) {
    if (!body.is_active(e)) continue;
    const Vec3 at = body.centroid(e);
    if (std::abs(at[0] - to[0]) > 0.5 || at[1] < from[1] || at[1] > to[1]) continue;
    body.active[static_cast<std::size_t>(e)] = false;
    out.push_back(e);
  }
  return out;
}

void FrontTreeMake(benchmark::State& state) {
  const test::FrontBody body = plate(state);
  std::shared_ptr<const FrontTree> tree;
  for (auto _ : state) tree = FrontTree::make(body, {});
  state.counters["fronts"] = static_cast<double>(tree->front_count());
  state.counters["gflop"] = 1e-9 * tree->flops_made();
  state.counters["megabytes"] = 1e-6 * static_cast<double>(tree->memory_bytes());
}

/// The tear advances by two edges, and the window with it, every time; `part` says what is timed.
void follow(benchmark::State& state, bool move) {
  test::FrontBody body = plate(state);
  Crack crack(body);
  const auto count = static_cast<std::size_t>(state.range(1));
  std::shared_ptr<const FrontTree> tree = FrontTree::make(body, {});
  ElementChange change;
  change.kept = window(body, crack.tip(), count);
  tree = tree->updated(body, change);
  double made = 0.0;
  double gflop = 0.0;
  double steps = 0.0;
  double worst = 0.0;
  for (auto _ : state) {
    const Vec3 from = crack.tip();
    crack.length += 2.0;
    if (crack.length > 0.9 * crack.size[1]) {
      crack.length = 3.0;
      std::fill(body.active.begin(), body.active.end(), true);
      tree = FrontTree::make(body, {});
      change.kept = window(body, crack.tip(), count);
      tree = tree->updated(body, change);
      continue;
    }
    change.touched = tear(body, from, crack.tip());
    Stopwatch watch;
    tree = tree->updated(body, change);
    const double within = watch.seconds();
    change.touched.clear();
    change.kept = window(body, crack.tip(), count);
    watch.restart();
    std::shared_ptr<const FrontTree> next = tree->updated(body, change);
    const double moved = watch.seconds();
    if (move) {
      made += static_cast<double>(next->fronts_made());
      gflop += 1e-9 * next->flops_made();
    } else {
      made += static_cast<double>(tree->fronts_made());
      gflop += 1e-9 * tree->flops_made();
    }
    worst = std::max(worst, 1e3 * (move ? moved : within));
    tree = next;
    steps += 1.0;
    state.SetIterationTime(move ? moved : within);
    if (tree->outcome() != FrontOutcome::ok) state.SkipWithError("not positive definite");
  }
  state.counters["fronts"] = made / steps;
  state.counters["gflop"] = gflop / steps;
  state.counters["worst_ms"] = worst;
}

/// Elements among the kept nodes go: nothing but the condensed matrix is made again.
void FrontTreeTear(benchmark::State& state) { follow(state, false); }
/// The kept nodes move on.
void FrontTreeMove(benchmark::State& state) { follow(state, true); }

void FrontTreeBackward(benchmark::State& state) {
  const test::FrontBody body = plate(state);
  const auto tree = FrontTree::make(body, {});
  VectorX x;
  for (auto _ : state) tree->backward(VectorX(), nullptr, VectorX(), 1.0, x);
}

/// The whole by CHOLMOD: with the analysis, or with a new factorisation alone.
void FrontTreeBeside(benchmark::State& state, bool analyse) {
  const test::FrontBody body = plate(state);
  std::vector<std::int32_t> connectivity;
  for (const auto& tet : body.tets) connectivity.insert(connectivity.end(), tet.begin(), tet.end());
  const auto pattern = std::make_shared<BlockPattern>(make_block_pattern(body.node_count(), connectivity, 4));
  SymmetricBlockMatrix A(pattern);
  ElementMatrix K;
  for (std::int32_t e = 0; e < body.element_count(); ++e) {
    body.stiffness(e, K);
    const auto nodes = body.nodes(e);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const std::int32_t row = nodes[static_cast<std::size_t>(a)];
        const std::int32_t col = nodes[static_cast<std::size_t>(b)];
        if (col > row) continue;
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(A.values.data() +
                                                                       9 * std::ptrdiff_t{pattern->find(row, col)});
        block += K.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  std::vector<bool> held(body.free.size());
  for (std::size_t i = 0; i < held.size(); ++i) held[i] = !body.free[i];
  const FreeDofs free = make_free_dofs(held);
  CholeskyFactor factor;
  factor.analyse(*pattern, free);
  for (auto _ : state) {
    if (analyse) factor.analyse(*pattern, free);
    if (factor.factor(A.values) != CholeskyOutcome::ok) state.SkipWithError("not positive definite");
  }
  state.counters["gflop"] = 1e-9 * factor.flops();
  state.counters["megabytes"] = 1e-6 * static_cast<double>(factor.memory_bytes());
}

BENCHMARK(FrontTreeMake)->Arg(500)->Arg(5000)->Arg(20000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(FrontTreeTear)
    ->ArgsProduct({{500, 5000, 20000, 100000}, {100, 200, 300}})
    ->Iterations(25)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(FrontTreeMove)
    ->ArgsProduct({{500, 5000, 20000, 100000}, {100, 200, 300}})
    ->Iterations(25)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(FrontTreeBackward)->Arg(500)->Arg(5000)->Arg(20000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(FrontTreeBeside, analyse_and_factor, true)
    ->Arg(500)
    ->Arg(5000)
    ->Arg(20000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(FrontTreeBeside, factor, false)
    ->Arg(500)
    ->Arg(5000)
    ->Arg(20000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
