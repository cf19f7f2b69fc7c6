#include "studies/live_models.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/nearest_name.h"
#include "mesh/generate.h"
#include "model/make_model.h"
#include "model/stabilisation.h"
#include "solver/equilibrium.h"
#include "solver/live_equilibrium.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

/// m, of the circle on which the hand moves, outwards and aside.
constexpr double kRadius = 0.006;
/// Relative, of the converged force: a tenth of the smallest error that is told.
constexpr double kOracleTolerance = 1e-6;

/// A soft rod, 20 mm thick and 60 mm long, held below and at a node of its side near the top.
struct Rod {
  mesh::TetMesh mesh;
  std::shared_ptr<const model::Model> model;
  model::Loading loading;
  std::int32_t node = 0;

  static Expected<Rod> make(int nodes, const std::string& name);
};

Expected<Rod> Rod::make(int nodes, const std::string& name) {
  Expected<mesh::TetMesh> mesh = mesh::make_tube({.radius = 0.01, .length = 0.06}, nodes);
  if (!mesh) return fail(std::move(mesh.error()));
  Rod rod;
  rod.mesh = std::move(*mesh);
  model::ModelSettings settings;
  settings.kind = model::kind_named(name);
  settings.elastic = {.young = 1e5, .poisson = 0.49};
  settings.law = material::to_mooney_rivlin(settings.elastic);
  settings.beta = model::auto_beta(settings.law);
  rod.model = model::make_model(rod.mesh, settings);
  rod.loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(rod.model->space().dof_count()));
  for (const NodeId node : rod.mesh.find_node_set("bottom")->nodes)
    for (std::int32_t c = 0; c < 3; ++c) rod.loading.supports.push_back({3 * node.value() + c, 0.0});
  const Vec3 at(0.01, 0.0, 0.05);
  for (std::size_t i = 0; i < rod.mesh.node_count(); ++i) {
    const auto nearest = static_cast<std::size_t>(rod.node);
    if ((rod.mesh.nodes[i] - at).norm() < (rod.mesh.nodes[nearest] - at).norm())
      rod.node = static_cast<std::int32_t>(i);
  }
  return rod;
}

/// Displacement of the hand, m, that moves at `speed`.
Vec3 hand_at(double seconds, double speed) {
  const double angle = speed * seconds / kRadius;
  return {kRadius * (1.0 - std::cos(angle)), kRadius * std::sin(angle), 0.0};
}

/// The force that holds the point at `hand` in equilibrium, N, from a state near it; empty: none was found.
std::optional<Vec3> converged_force(const Rod& rod, model::State near, const Vec3& hand) {
  model::Loading held = rod.loading;
  for (std::int32_t c = 0; c < 3; ++c) held.supports.push_back({3 * rod.node + c, hand[c]});
  std::sort(held.supports.begin(), held.supports.end(), [](const auto& a, const auto& b) { return a.dof < b.dof; });
  const solver::Options options{.linear = rod.model->pressure_unknowns() > 0 ? "cg" : "direct",
                                .tolerance = kOracleTolerance};
  solver::Options one_step = options;
  one_step.steps = 1;
  const solver::Report report = solver::solve_equilibrium(*rod.model, held, one_step, near);
  if (!report.converged()) return std::nullopt;
  return Vec3(report.reaction.segment<3>(3 * Eigen::Index{rod.node}));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

ordered_json one_row(const Rod& rod, double speed, const LiveModelsOptions& options) {
  solver::LiveEquilibrium live(rod.model, rod.loading, rod.model->initial_state(),
                               {.corrections = options.corrections});
  live.hold({.node = {rod.node, 0, 0}, .weight = Vec3::UnitX(), .count = 1});
  std::vector<double> frame_ms;
  std::vector<double> residual;
  std::vector<double> error;
  double largest = 0.0;
  int late = 0;
  int failed = 0;
  int iterations = 0;
  double now = 0.0;
  double next_sample = options.seconds / options.samples;
  while (now < options.seconds) {
    const Stopwatch watch;
    const solver::LiveFrame frame = live.step(hand_at(now, speed));
    const double seconds = watch.seconds();
    frame_ms.push_back(1e3 * seconds);
    residual.push_back(frame.residual);
    iterations += frame.linear_iterations;
    late += frame.reached ? 0 : 1;
    now += options.frame > 0.0 ? options.frame : std::max(seconds, kFramePeriod);
    if (now < next_sample) continue;
    // The frame is over, and the hand has moved on: what the haptic loop says to that.
    next_sample += options.seconds / options.samples;
    const Vec3 hand = hand_at(now, speed);
    const Vec3 felt = live.force() + live.stiffness() * (hand - live.point());
    const std::optional<Vec3> exact = converged_force(rod, live.state(), hand);
    failed += exact ? 0 : 1;
    if (!exact) continue;
    error.push_back((felt - *exact).norm());
    largest = std::max(largest, exact->norm());
  }
  const auto frames = static_cast<double>(frame_ms.size());
  const auto of_largest = [&](double value) { return error.empty() ? ordered_json() : ordered_json(value / largest); };
  return {{"nodes", rod.mesh.node_count()},
          {"tets", rod.mesh.tet_count()},
          {"model", std::string(rod.model->name())},
          {"speed_mm_s", 1e3 * speed},
          {"frames_per_s", frames / now},
          {"frame_ms", median(frame_ms)},
          {"frame_ms_most", *std::max_element(frame_ms.begin(), frame_ms.end())},
          {"late", late / frames},
          {"iterations", iterations / frames},
          {"residual", median(residual)},
          {"error_mean", of_largest(std::accumulate(error.begin(), error.end(), 0.0) /
                                    std::max<double>(1.0, static_cast<double>(error.size())))},
          {"error_most", of_largest(error.empty() ? 0.0 : *std::max_element(error.begin(), error.end()))},
          {"force_N", largest},
          {"oracle_failed", failed}};
}

Expected<void> check(const LiveModelsOptions& options) {
  const std::vector<std::string> known = LiveModelsOptions{}.models;
  for (const std::string& name : options.models) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearest_name(name, known);
    return fail(fmt::format("the model '{}' is not one that follows a hand", name),
                near.empty() ? fmt::format("one of {}", fmt::join(known, ", ")) : "did you mean '" + near + "'?");
  }
  for (const double speed : options.speeds) {
    if (!(speed > 0.0) || !std::isfinite(speed)) return fail(fmt::format("a speed of {} m/s", speed), "more than 0");
  }
  if (!(options.frame >= 0.0) || !std::isfinite(options.frame))
    return fail(fmt::format("a frame of {} s", options.frame), "0 or more");
  if (!(options.seconds > 0.0) || !std::isfinite(options.seconds) || options.samples < 1 || options.corrections < 1)
    return fail("a motion of no time, without a sample or without a correction", "more than 0 of each");
  if (options.nodes.empty() || options.models.empty() || options.speeds.empty()) return fail("nothing to do", "");
  return {};
}

}  // namespace

Expected<ordered_json> run_live_models(const LiveModelsOptions& options, const StudyFolder& folder,
                                       const Progress& progress) {
  if (Expected<void> fine = check(options); !fine) return fail(fine.error());
  folder.note(
      "A soft rod, held below, is led by a hand on a circle; every frame corrects the last state by Newton corrections "
      "that are not solved to the end. Errors are those of the force that the haptic loop gives between frames, "
      "against "
      "the converged one of the same instant, relative to the largest of the motion.");
  ordered_json rows = ordered_json::array();
  double all = 0.0;
  for (const int nodes : options.nodes) all += nodes;
  double done = 0.0;
  bool goes_on = true;
  for (const int nodes : options.nodes) {
    for (const std::string& name : options.models) {
      const Expected<Rod> rod = Rod::make(nodes, name);
      if (!rod) return fail(rod.error());
      for (const double speed : options.speeds) {
        if (!goes_on) break;
        rows.push_back(one_row(*rod, speed, options));
        if (Expected<void> written = folder.write_table("live-models", rows); !written) return fail(written.error());
        if (Expected<void> written = folder.write_figure("live-models", live_models_chart(rows)); !written)
          return fail(written.error());
        done += nodes / static_cast<double>(options.models.size() * options.speeds.size());
        goes_on = progress(std::min(1.0, done / all),
                           fmt::format("{} tets, {}, {:.0f} mm/s", rod->mesh.tet_count(), name, 1e3 * speed));
      }
    }
  }
  return rows;
}

result::Chart live_models_chart(const ordered_json& rows) {
  using result::ChartSeries;
  using result::Symbol;
  constexpr std::array<Symbol, 3> kSymbols{Symbol::circle, Symbol::square, Symbol::diamond};
  result::Chart chart;
  chart.title = "A frame of a body that follows a hand";
  chart.subtitle = "Median and longest, over all speeds of the hand";
  chart.x = {.label = "tets", .scale = result::Scale::log};
  chart.y = {.label = "time per frame / ms", .scale = result::Scale::log};
  const std::vector<std::string> models = LiveModelsOptions{}.models;
  for (std::size_t k = 0; k < models.size(); ++k) {
    ChartSeries series;
    series.name = models[k];
    series.symbol = kSymbols[k];
    for (const ordered_json& row : rows) {
      if (row.at("model") != models[k]) continue;
      const double tets = row.at("tets");
      const double ms = row.at("frame_ms");
      const double most = row.at("frame_ms_most");
      if (!series.x.empty() && series.x.back() == tets) {
        series.y.back() = std::max(series.y.back(), ms);
        series.high.back() = std::max(series.high.back(), most);
        continue;
      }
      series.x.push_back(tets);
      series.y.push_back(ms);
      series.low.push_back(ms);
      series.high.push_back(most);
    }
    for (std::size_t i = 0; i < series.y.size(); ++i) series.low[i] = series.y[i];
    if (!series.x.empty()) chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace rhexis::studies
