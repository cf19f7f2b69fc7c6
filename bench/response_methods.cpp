// Ways to the exact compliance at the hand while a body tears, side by side on the plate 240 x 240 x 10 mm whose crack
// runs from y = 60 mm on in steps of one and a half edges. Each way gives the 3 x 3 compliance of the held node after
// each advance; the time of an advance is the mean, with all that a way has to do now and then. It is the processor's
// time on one thread, so that what else runs on the machine counts little. docs/exact-response.md quotes these numbers.
//
//   rhexis_bench --benchmark_filter=ResponseMethods

#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "bench/processor_watch.h"
#include "bench/response_pull.h"
#include "bench/response_rivals.h"
#include "response/contact.h"
#include "response/exact_response.h"
#include "response/force_basis.h"
#include "response/publish.h"
#include "tests/support/torn_body_oracle.h"

namespace {

using namespace rhexis;                   // NOLINT
using namespace rhexis::response;         // NOLINT
using namespace rhexis::response::bench;  // NOLINT

/// One way: what it has to set up, and what it does after each edit that `body` has taken.
struct Way {
  std::function<Mat3(const mesh::MeshEdit&, const Focus&)> advance;
  /// Where there is one: what the nodes of the local object do under a force.
  std::function<void(std::span<const NodeId>, const VectorX&, double, VectorX&)> displace;
};

std::vector<NodeId> nodes_around(const mesh::TornMesh& body, const Focus& focus) {
  std::vector<NodeId> out;
  for (std::size_t i = 0; i < body.mesh().node_count(); ++i) {
    const double distance = (body.mesh().nodes[i] - focus.centre).norm();
    if (body.is_alive(NodeId(i)) && distance < focus.radius) out.emplace_back(i);
  }
  return out;
}
using MakeWay = std::function<Way(const Pull&, mesh::TornMesh&)>;

/// `most` advances; every answer is held against the full refactorisation where that is quick.
void run(benchmark::State& state, const MakeWay& make, int most) {
  const Pull& pull = pull_of(static_cast<int>(state.range(0)));
  set_thread_count(1);
  mesh::TornMesh body = pull.start;
  const ProcessorWatch setup;
  const Way way = make(pull, body);
  state.counters["setup_ms"] = 1e3 * setup.seconds();
  const std::size_t advances = std::min(pull.edits.size(), static_cast<std::size_t>(most));
  double worst = 0.0;
  double tets = 0.0;
  double first = 0.0;  // s, of the displacement of the local object after an advance, and of another force on
  double again = 0.0;
  for (auto _ : state) {
    double seconds = 0.0;
    for (std::size_t i = 0; i < advances; ++i) {
      body.apply(pull.edits[i]);
      tets += static_cast<double>(pull.edits[i].removed.size());
      const ProcessorWatch watch;
      const Mat3 compliance = way.advance(pull.edits[i], pull.focus[i + 1]);
      seconds += watch.seconds();
      if (way.displace) {
        const std::vector<NodeId> local = nodes_around(body, pull.focus[i + 1]);
        VectorX u;
        ForceBasis basis;
        const auto solve = [&](const VectorX& forces, double loads, VectorX& out) {
          way.displace(local, forces, loads, out);
        };
        for (int tick = 0; tick < 8; ++tick) {
          const VectorX force = Vec3(std::sin(tick), std::cos(tick), 1.0);
          const ProcessorWatch one;
          basis.displacement(force, solve, u);
          (tick < 3 ? first : again) += one.seconds() / static_cast<double>(advances);
        }
      }
      if (state.range(0) > 20000 && i + 1 < advances) continue;
      rhexis::test::TornBodyOracle oracle(body, pull.elastic);
      const Eigen::MatrixXd expected = oracle.compliance({pull.hand});
      worst = std::max(worst, (compliance - expected).norm() / expected.norm());
    }
    state.SetIterationTime(seconds / static_cast<double>(advances));
  }
  set_thread_count(0);
  if (!(worst < 1e-7)) state.SkipWithError("not exact");
  state.counters["error"] = worst;
  state.counters["advances"] = static_cast<double>(advances);
  if (way.displace) {
    state.counters["local_ms"] = 1e3 * first;  // three forces, which make a basis
    state.counters["tick_ms"] = 1e3 * again / 5.0;
  }
  state.counters["tets"] = tets / static_cast<double>(advances);
}

/// Assembly, order of elimination and factor, all anew.
void full(benchmark::State& state) {
  run(
      state,
      [](const Pull& pull, mesh::TornMesh& body) {
        Way way;
        way.advance = [&](const mesh::MeshEdit&, const Focus&) {
          return Mat3(rhexis::test::TornBodyOracle(body, pull.elastic).compliance({pull.hand}));
        };
        return way;
      },
      state.range(0) > 20000 ? 1 : 3);
}

/// `is_known`: the dissection knows where the crack will run.
Way follow_tree(const Pull& pull, mesh::TornMesh& body, bool is_known) {
  ExactSettings settings;
  settings.body = pull.elastic;
  const std::span<const Focus> first(&pull.focus[0], is_known ? 1 : 0);
  const std::shared_ptr<ExactResponse> response = ExactResponse::make(body, settings, first);
  response->grasp(std::span(&pull.hand, 1));
  Way way;
  way.advance = [response](const mesh::MeshEdit& edit, const Focus& focus) {
    RHEXIS_CHECK(response->follow(edit, std::span(&focus, 1)).ok, "not stable");
    return Mat3(response->compliance());
  };
  way.displace = [response](std::span<const NodeId> nodes, const VectorX& force, double loads, VectorX& out) {
    response->displacement(nodes, force, loads, out);
  };
  return way;
}

/// Partial refactorisation in a tree that knows the way of the crack.
void ours(benchmark::State& state) {
  run(
      state, [](const Pull& pull, mesh::TornMesh& body) { return follow_tree(pull, body, true); }, kAdvances);
}

/// The same in a tree as METIS makes it (Herholz and Sorkine-Hornung).
void partial(benchmark::State& state) {
  run(
      state, [](const Pull& pull, mesh::TornMesh& body) { return follow_tree(pull, body, false); },
      state.range(0) > 20000 ? 6 : kAdvances);
}

void condense(benchmark::State& state, double edges_ahead) {
  run(
      state,
      [=](const Pull& pull, mesh::TornMesh& body) {
        const double h = pull.focus[0].radius / kLocalEdges;
        const auto own = std::make_shared<Condensed>(pull, body, edges_ahead * h);
        Way way;
        way.advance = [own](const mesh::MeshEdit& edit, const Focus& focus) { return own->advance(edit, focus); };
        return way;
      },
      kAdvances);
}
void one_window(benchmark::State& state) { condense(state, kEdgesPerAdvance * kAdvances); }
void moving_window(benchmark::State& state) { condense(state, 10.0); }

void low_rank(benchmark::State& state) {
  run(
      state,
      [](const Pull& pull, mesh::TornMesh& body) {
        const auto own = std::make_shared<LowRank>(pull, body);
        Way way;
        way.advance = [own](const mesh::MeshEdit& edit, const Focus&) { return own->advance(edit); };
        return way;
      },
      kAdvances);
}

void HeldPointTick(benchmark::State& state) {
  const Pull& pull = pull_of(static_cast<int>(state.range(0)));
  ExactSettings settings;
  settings.body = pull.elastic;
  const auto response = ExactResponse::make(pull.start, settings, {});
  const SurfacePoint point = *nearest_surface_point(pull.start, Vec3(0.1, 0.0, 0.0043));
  response->grasp({point.node.data(), static_cast<std::size_t>(point.count)});
  const ContactLaw law =
      make_contact_law(point, ContactRule::consistent, ContactMode::hold, response->compliance(), response->rest());
  double at = 0.0;
  for (auto _ : state) {
    // What a tick does: take the newest snapshot as bytes, and evaluate it.
    const ForceSnapshot snapshot = make_snapshot(law, {.force_limit = 10.0});
    benchmark::DoNotOptimize(force_at(snapshot, Vec3(at, -at, 1e-3)));
    benchmark::DoNotOptimize(law.nodal_forces(Vec3(at, -at, 1e-3)));
    at += 1e-9;
  }
}

void NearestSurfacePoint(benchmark::State& state) {
  const Pull& pull = pull_of(static_cast<int>(state.range(0)));
  double at = 0.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(nearest_surface_point(pull.start, Vec3(0.1 + at, 0.02, 0.012)));
    at += 1e-6;
  }
}

void all_sizes(benchmark::internal::Benchmark* of) {
  for (const int nodes : {506, 1270, 5000, 20000, 100000}) of->Arg(nodes);
  of->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(full)->Name("ResponseMethods/full")->Apply(all_sizes);
BENCHMARK(one_window)->Name("ResponseMethods/one_window")->Apply(all_sizes);
BENCHMARK(low_rank)->Name("ResponseMethods/low_rank")->Apply(all_sizes);
BENCHMARK(partial)->Name("ResponseMethods/partial")->Apply(all_sizes);
BENCHMARK(HeldPointTick)->Arg(506)->Arg(100000)->Unit(benchmark::kNanosecond);
BENCHMARK(NearestSurfacePoint)->Arg(506)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(moving_window)->Name("ResponseMethods/moving_window")->Apply(all_sizes);
BENCHMARK(ours)->Name("ResponseMethods/ours")->Apply(all_sizes);

}  // namespace
