#include "apps/tear_output.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "base/atomic_file.h"
#include "result/chart.h"
#include "result/torn_fields.h"

namespace rhexis::apps {
namespace {

std::vector<mesh::Field> fields_of(session::TearSession& tear, const VectorX& u) {
  std::vector<TetId> local;
  for (const fracture::LocalObject& object : tear.local_objects())
    local.insert(local.end(), object.tets().begin(), object.tets().end());
  result::TornState state{.body = &tear.settings().body, .u = &u, .local = local};
  if (!tear.is_linear()) state.stress = [&](TetId tet) { return tear.stress(tet, u); };
  return result::make_torn_fields(tear.body(), state);
}

}  // namespace

Expected<TearOutput> TearOutput::open(const std::filesystem::path& path) {
  Expected<result::ResultFolder> folder = result::ResultFolder::open(path);
  if (!folder) return fail(std::move(folder.error()));
  TearOutput out(std::move(*folder));
  out.trace_.open(path / "force.csv");
  out.trace_ << "time_s,pull_x_m,pull_y_m,pull_z_m,force_x_N,force_y_N,force_z_N,advances,hand_work_J,"
                "stored_energy_J,crack_area_m2\n";
  if (!out.trace_.flush()) return fail("cannot be written", "choose a folder that can", (path / "force.csv").string());
  return out;
}

Expected<void> TearOutput::write_topology(session::TearSession& tear, double time) {
  VectorX u;
  tear.displacement(u);
  note_displacement(u);
  if (time > 0.0) advance_time_.push_back(time);
  return folder_.write_topology(tear.body().topology(), tear.body().mesh(), fields_of(tear, u));
}

Expected<void> TearOutput::write_released(session::TearSession& tear, double time) {
  VectorX u;
  tear.displacement(u);
  note_displacement(u);
  return folder_.write_released(time, tear.body().mesh(), fields_of(tear, u));
}

Expected<void> TearOutput::write_tick(session::TearSession& tear, double time, const Vec3& hand,
                                      const session::TickReport& report) {
  const Vec3& f = report.force;
  fmt::print(trace_, "{:.3f},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{:.9g},{:.9g},{:.9g}\n", time, hand.x(),
             hand.y(), hand.z(), f.x(), f.y(), f.z(), tear.advances().size(), tear.hand().work(), tear.stored_energy(),
             tear.crack_area());
  if (!trace_.flush()) return fail("cannot be written", "room on the disk", (folder_.path() / "force.csv").string());
  time_.push_back(time);
  force_.push_back(f);
  largest_force_ = std::max(largest_force_, f.norm());
  return {};
}

void TearOutput::note_displacement(const VectorX& u) {
  for (Eigen::Index node = 0; node < u.size() / 3; ++node)
    largest_move_ = std::max(largest_move_, u.segment<3>(3 * node).norm());
}

Expected<void> TearOutput::write_result(session::TearSession& tear, const std::string& title) {
  VectorX u;
  tear.displacement(u);
  note_displacement(u);
  if (Expected<void> written = folder_.write_result(tear.body().mesh(), fields_of(tear, u)); !written) return written;
  const auto series = [&](const std::string& name, const auto& component) {
    result::ChartSeries line;
    line.name = name;
    line.x = time_;
    for (const Vec3& force : force_) line.y.push_back(component(force));
    return line;
  };
  result::Chart chart;
  chart.title = "Force on the hand";
  chart.subtitle = title;
  chart.x.label = "time / s";
  chart.y.label = "force / N";
  chart.series.push_back(series("magnitude", [](const Vec3& f) { return f.norm(); }));
  for (Eigen::Index c = 0; c < 3; ++c)
    chart.series.push_back(series(std::string(1, "xyz"[c]), [c](const Vec3& f) { return f[c]; }));
  chart.marks.push_back({"advance of the crack", advance_time_});
  if (time_.empty()) return {};
  return result::write_chart(folder_.path() / "force.svg", chart);
}

}  // namespace rhexis::apps
