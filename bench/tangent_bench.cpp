// Time and memory per tet of building residuals and tangents, on tubes of some 400, 3,000 and 30,000 nodes:
//     rhexis_bench --benchmark_filter=tangent/30000
// x_warped is the time over that of the paper's corotated R K_e R^T on the same mesh and threads (Table 6 of the paper:
// linear 0.09, geometrically nonlinear 1.3, hyperelastic 10.1); x_triplets how many times faster than Eigen's
// setFromTriplets.

#include <benchmark/benchmark.h>

#include <limits>
#include <map>

#include "base/clock.h"
#include "base/parallel.h"
#include "mesh/generate.h"
#include "model/make_model.h"
#include "tests/support/slow_tets.h"

namespace rhexis {
namespace {

const mesh::TetMesh& tube(int nodes) {
  static std::map<int, mesh::TetMesh> made;
  const auto found = made.find(nodes);
  if (found != made.end()) return found->second;
  mesh::TubeShape shape;
  auto mesh = mesh::make_tube(shape, nodes);
  return made.emplace(nodes, mesh ? std::move(*mesh) : mesh::TetMesh{}).first->second;
}

/// Bent and stretched, so that no path is taken that rest alone would take.
model::State bent_state(const mesh::TetMesh& mesh, const model::Model& model) {
  model::State state = model.initial_state();
  const mesh::BoundingBox box = mesh::bounding_box(mesh);
  const double length = box.size().maxCoeff();
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const Vec3 x = (mesh.nodes[n] - box.from) / length;
    state.u.segment<3>(static_cast<Eigen::Index>(3 * n)) =
        length * Vec3(0.3 * x.z() * x.z(), 0.05 * x.x(), 0.1 * x.z() + 0.05 * x.y() * x.x());
  }
  return state;
}

struct Subject {
  const char* label;
  model::ModelSettings settings;
};

std::vector<Subject> subjects() {
  model::ModelSettings base;
  base.elastic = {0.981e6, 0.46};
  base.law = {8.395e4, 8.395e4, 4.167e6};
  base.beta = 100.0;
  const auto with = [&](model::ModelKind kind, model::CorotatedTangent tangent, double c2) {
    model::ModelSettings s = base;
    s.kind = kind;
    s.corotated_tangent = tangent;
    s.law.c2 = c2;
    return s;
  };
  using model::CorotatedTangent, model::ModelKind;
  const double c2 = base.law.c2;
  return {{"corotated_warped", with(ModelKind::corotated, CorotatedTangent::warped, c2)},
          {"corotated", with(ModelKind::corotated, CorotatedTangent::exact, c2)},
          {"linear", with(ModelKind::linear, CorotatedTangent::exact, c2)},
          {"geometrically_nonlinear", with(ModelKind::geometrically_nonlinear, CorotatedTangent::exact, c2)},
          {"neo_hookean", with(ModelKind::hyperelastic, CorotatedTangent::exact, 0.0)},
          {"mooney_rivlin", with(ModelKind::hyperelastic, CorotatedTangent::exact, c2)},
          {"mass_spring", with(ModelKind::mass_spring, CorotatedTangent::exact, c2)}};
}

/// Best time of one call, s, by mesh, threads and subject: what ratios are formed of.
std::map<std::string, double>& best() {
  static std::map<std::string, double> times;
  return times;
}

template <class Work>
double time_best(benchmark::State& run, const Work& work) {
  double fastest = std::numeric_limits<double>::max();
  work();
  for (auto _ : run) {
    const Stopwatch watch;
    work();
    const double seconds = watch.seconds();
    run.SetIterationTime(seconds);
    fastest = std::min(fastest, seconds);
  }
  return fastest;
}

void triplets(benchmark::State& run, int nodes, const Subject& subject) {
  const mesh::TetMesh& mesh = tube(nodes);
  const model::State state = bent_state(mesh, *model::make_model(mesh, subject.settings));
  const double seconds =
      time_best(run, [&] { benchmark::DoNotOptimize(test::slow_evaluate(mesh, subject.settings, state)); });
  best()[std::to_string(nodes) + subject.label] = seconds;
  run.counters["ns_per_tet"] = 1e9 * seconds / static_cast<double>(mesh.tet_count());
}

void build(benchmark::State& run, int nodes, int threads, bool tangent, const Subject& subject) {
  const mesh::TetMesh& mesh = tube(nodes);
  set_thread_count(threads);
  const auto model = model::make_model(mesh, subject.settings);
  const model::State state = bent_state(mesh, *model);
  const auto scratch = model->make_scratch();
  linalg::SaddleMatrix K = model->make_tangent();
  model::Residual residual{VectorX(state.u.size()), VectorX(state.lambda.size())};
  const double seconds = time_best(run, [&] {
    if (tangent) {
      model->tangent(state, *scratch, K);
    } else {
      model->residual(state, *scratch, residual);
    }
  });
  set_thread_count(0);
  const double tets = static_cast<double>(mesh.tet_count());
  run.counters["ns_per_tet"] = 1e9 * seconds / tets;
  run.counters["bytes_per_tet"] = static_cast<double>(model->memory_bytes()) / tets;
  const std::string key =
      std::to_string(nodes) + "/" + std::to_string(threads) + (tangent ? "t/" : "r/") + subject.label;
  best()[key] = seconds;
  const auto ratio = [&](const std::string& other, const char* name, bool inverse) {
    const auto found = best().find(other);
    if (found != best().end()) run.counters[name] = inverse ? found->second / seconds : seconds / found->second;
  };
  ratio(std::to_string(nodes) + "/" + std::to_string(threads) + (tangent ? "t/" : "r/") + "corotated_warped",
        "x_warped", false);
  ratio(std::to_string(nodes) + "/1" + (tangent ? "t/" : "r/") + subject.label, "speed_up", true);
  if (tangent) ratio(std::to_string(nodes) + subject.label, "x_triplets", true);
}

const bool registered = [] {
  for (const int nodes : {401, 3000, 30000}) {
    for (const Subject& subject : subjects()) {
      if (subject.settings.kind == model::ModelKind::mass_spring || subject.settings.law.c2 == 0.0) continue;
      benchmark::RegisterBenchmark(("triplets/" + std::to_string(nodes) + "/" + subject.label).c_str(),
                                   [=](benchmark::State& run) { triplets(run, nodes, subject); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
    for (const bool tangent : {true, false}) {
      for (const int threads : {1, 2}) {
        for (const Subject& subject : subjects()) {
          const std::string name = std::string(tangent ? "tangent/" : "residual/") + std::to_string(nodes) + "/" +
                                   std::to_string(threads) + "_threads/" + subject.label;
          benchmark::RegisterBenchmark(name.c_str(),
                                       [=](benchmark::State& run) { build(run, nodes, threads, tangent, subject); })
              ->UseManualTime()
              ->Unit(benchmark::kMillisecond);
        }
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace rhexis
