// What a look-up in a record takes at the haptic rate, by the advances that the crack has made; one in each dimension
// lies between two recorded values, with three lengths, so that all 2^(2n+1) terms of (4.27) have a weight:
//     rhexis_bench --benchmark_filter=record
// reaction: (4.27) to the letter, from the recorded reactions. stiffness: the 3 x 3 of all pulls, which a session takes
// once per topology; a tick then multiplies. nearest: (4.8), (4.9).

#include <benchmark/benchmark.h>

#include <array>
#include <random>

#include "record/store/reaction.h"

namespace rhexis {
namespace {

using record::store::Advanced;

/// Of the grasp points of the plate of the thesis, with made-up stiffnesses.
const record::store::Record& some_record() {
  static const record::store::Record record = [] {
    record::store::Record out;
    out.head.parameters.advances = 3;
    out.head.parameters.directions = 13;
    out.head.parameters.lengths = {0.02, 0.04, 0.06};
    for (std::int32_t point = 0; point < 428; ++point) out.head.points.push_back(point);
    const auto topologies = static_cast<std::size_t>(record::store::Numbering(out.head.parameters).count());
    std::mt19937_64 bits(7);
    out.in_solve.assign(topologies * out.head.points.size(), 1);
    out.stiffness.resize(6 * out.in_solve.size());
    for (double& one : out.stiffness) one = static_cast<double>(bits() >> 11U) * 0x1p-53;
    return out;
  }();
  return record;
}

constexpr std::array<Advanced, 3> kAdvances{Advanced{83.0, 0.031}, Advanced{101.0, 0.044}, Advanced{70.0, 0.05}};

std::span<const Advanced> advances_of(const benchmark::State& state) {
  return std::span(kAdvances).first(static_cast<std::size_t>(state.range(0)));
}

void reaction(benchmark::State& state) {
  const record::store::Lookup lookup(some_record());
  Vec3 pull(0.01, 0.02, 0.0);
  int point = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(lookup.reaction(advances_of(state), point, pull).force);
    point = (point + 37) % 428;
  }
}
BENCHMARK(reaction)->Name("record/reaction")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);

void stiffness(benchmark::State& state) {
  const record::store::Lookup lookup(some_record());
  int point = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(lookup.stiffness(advances_of(state), point).value);
    point = (point + 37) % 428;
  }
}
BENCHMARK(stiffness)->Name("record/stiffness")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);

void nearest(benchmark::State& state) {
  const record::store::Lookup lookup(some_record());
  for (auto _ : state) benchmark::DoNotOptimize(lookup.nearest(advances_of(state)).topology);
}
BENCHMARK(nearest)->Name("record/nearest")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rhexis
