// The multifrontal factor that follows a tear, on the plate 240 x 240 x 10 mm: a crack runs from the middle of y = 0 to
// +y. Beside it what it replaces: a sparse factorisation of the whole (docs/exact-response.md quotes these numbers).
//
//   rhexis_bench --benchmark_filter=FrontTree

#include <benchmark/benchmark.h>

#include <algorithm>
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

/// A crack from the middle of y = 0 to +y, one mean edge at a time.
class Crack {
 public:
  explicit Crack(test::FrontBody& body) : body_(body) {
    for (const Vec3& x : body.position) size_ = size_.cwiseMax(x);
  }
  [[nodiscard]] bool has_arrived() const { return length_ > 0.85 * size_[1]; }
  [[nodiscard]] Vec3 tip() const { return {0.5 * size_[0], length_, 0.5 * size_[2]}; }

  /// The elements along the next edge go.
  [[nodiscard]] std::vector<std::int32_t> advance() {
    length_ += 1.0;
    std::vector<std::int32_t> out;
    for (std::int32_t e = 0; e < body_.element_count(); ++e) {
      const Vec3 at = body_.centroid(e);
      if (!body_.is_active(e) || std::abs(at[0] - tip()[0]) > 0.4) continue;
      if (at[1] < length_ - 1.0 || at[1] >= length_) continue;
      body_.active[static_cast<std::size_t>(e)] = false;
      out.push_back(e);
    }
    return out;
  }
  void start_again() {
    length_ = 2.0;
    std::fill(body_.active.begin(), body_.active.end(), true);
  }

 private:
  test::FrontBody& body_;
  Vec3 size_ = Vec3::Zero();  // mean edges
  double length_ = 2.0;       // mean edges
};

void FrontTreeMake(benchmark::State& state) {
  const test::FrontBody body = plate(state);
  std::shared_ptr<const FrontTree> tree;
  for (auto _ : state) tree = FrontTree::make(body, {});
  state.counters["fronts"] = static_cast<double>(tree->front_count());
  state.counters["gflop"] = 1e-9 * tree->flops_made();
  state.counters["megabytes"] = 1e-6 * static_cast<double>(tree->memory_bytes());
}

/// The mean of a whole crack: most advances take a thousandth of a factorisation, those that cross a separator near the
/// top of the tree a quarter. Nodes
/// within some mean edges of the tip are kept, and move with it; the one that is held is, always.
void FrontTreeAdvance(benchmark::State& state) {
  test::FrontBody body = plate(state);
  Crack crack(body);
  const std::int32_t hand = body.node_count() - 1;
  const auto radius = static_cast<double>(state.range(1));
  const auto intact = FrontTree::make(body, {hand});
  std::shared_ptr<const FrontTree> tree = intact;
  std::vector<double> seconds;
  double gflop = 0.0;
  double fronts = 0.0;
  double kept = 0.0;
  for (auto _ : state) {
    if (crack.has_arrived()) {
      crack.start_again();
      tree = intact;
    }
    ElementChange change;
    change.touched = crack.advance();
    change.kept = body.nodes_within(crack.tip(), radius);
    if (!std::binary_search(change.kept.begin(), change.kept.end(), hand)) change.kept.push_back(hand);
    const Stopwatch watch;
    tree = tree->updated(body, change);
    seconds.push_back(watch.seconds());
    state.SetIterationTime(seconds.back());
    gflop += 1e-9 * tree->flops_made();
    fronts += static_cast<double>(tree->fronts_made());
    kept += static_cast<double>(tree->kept_dofs().size());
    if (tree->outcome() != FrontOutcome::ok) state.SkipWithError("not positive definite");
  }
  std::sort(seconds.begin(), seconds.end());
  const auto steps = static_cast<double>(seconds.size());
  state.counters["gflop"] = gflop / steps;
  state.counters["fronts"] = fronts / steps;
  state.counters["kept"] = kept / steps;
  state.counters["median_ms"] = 1e3 * seconds[seconds.size() / 2];
  state.counters["worst_ms"] = 1e3 * seconds.back();
}

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
BENCHMARK(FrontTreeAdvance)  // nodes; radius of the kept nodes in mean edges, 0: none
    ->ArgsProduct({{500, 5000, 20000}, {0, 3}})
    ->Iterations(50)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(FrontTreeAdvance)->Args({100000, 0})->Iterations(65)->UseManualTime()->Unit(benchmark::kMillisecond);
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
