#include "apps/command.h"
#include "apps/tear_output.h"
#include "result/summary.h"

namespace rhexis::apps {
namespace {

using nlohmann::ordered_json;

ordered_json points_json(const std::vector<Vec3>& points) {
  ordered_json list = ordered_json::array();
  for (const Vec3& point : points) list.push_back(vector_json(point));
  return list;
}

/// null: the response has no record.
ordered_json record_json(const std::optional<response::RecordUse>& use) {
  if (!use) return nullptr;
  return {{"topology", use->topology},
          {"outside", use->outside},
          {"past_last", use->past_last},
          {"torn_off", use->torn_off},
          {"not_made", use->not_made}};
}

ordered_json advance_json(const session::AdvanceRecord& advance) {
  return {{"topology", advance.topology},
          {"time", 1e-3 * advance.tick},
          {"started", advance.started},
          {"length", advance.length},
          {"angle", advance.angle},
          {"turn", advance.turn},
          {"value", advance.value},
          {"edges_cut", advance.edges_cut},
          {"tets_removed", advance.tets_removed},
          {"tets_frozen", advance.tets_frozen},
          {"nodes_moved", advance.nodes_moved},
          {"nodes_copied", advance.nodes_copied},
          {"volume_lost", advance.volume_lost},
          {"pieces", advance.pieces},
          {"finished", advance.finished},
          {"crack_area", advance.crack_area},
          {"record", record_json(advance.record)},
          {"force_before", vector_json(advance.force_before)},
          {"force_after", vector_json(advance.force_after)},
          {"milliseconds",
           {{"remesh", 1e3 * advance.remesh_seconds},
            {"local", 1e3 * advance.local_seconds},
            {"update", 1e3 * advance.update_seconds},
            {"wait", 1e3 * advance.wait_seconds}}},
          {"front_before", points_json(advance.front_before)},
          {"front_after", points_json(advance.front_after)}};
}

}  // namespace

ordered_json make_tear_summary(const scene::TearProblem& problem, const std::vector<std::string>& warnings,
                               const std::string& scene, session::TearSession& tear, const TearOutput& output,
                               const std::string& why, const TearTimes& times) {
  ordered_json advances = ordered_json::array();
  double lost = 0.0;
  for (const session::AdvanceRecord& advance : tear.advances()) {
    advances.push_back(advance_json(advance));
    lost += advance.volume_lost;
  }
  const double intact = mesh::total_volume(problem.mesh);
  ordered_json summary;
  summary["title"] = problem.title;
  summary["scene"] = scene;
  summary["model"] = tear.model_name();
  summary["criterion"] = tear.settings().criterion;
  summary["incision"] = problem.fracture.incision;
  summary["response"] = tear.is_linear() ? problem.interaction.response : "live";
  summary["converged"] = why.empty();
  summary["why"] = why;
  summary["nodes"] = tear.body().mesh().node_count();
  summary["tets"] = tear.body().mesh().tet_count();
  summary["unknowns"] = 3 * problem.mesh.node_count() - problem.body.supports.size();
  summary["pieces"] = tear.pieces();
  summary["crack_area"] = tear.crack_area();
  summary["volume_lost"] = lost;
  summary["volume_ratio"] = 1.0 - lost / intact;
  summary["hand_work"] = tear.hand().work();
  summary["stored_energy"] = tear.stored_energy();
  summary["largest_force"] = output.largest_force();
  summary["max_force"] = problem.interaction.max_force;
  summary["max_displacement"] = output.largest_displacement();
  summary["advances"] = advances;
  summary["time"] = {{"read", times.read},
                     {"build", times.build},
                     {"solve", times.total - times.read - times.build},
                     {"total", times.total}};
  summary["memory"] = {{"response", tear.memory_bytes()}, {"peak", result::peak_memory_bytes()}};
  summary["notes"] = problem.notes;
  summary["warnings"] = problem.warnings;
  for (const std::string& warning : warnings) summary["warnings"].push_back(warning);
  summary["versions"] = result::versions();
  return summary;
}

void print_tear_outcome(const ordered_json& summary, const std::filesystem::path& out) {
  double milliseconds = 0.0;
  int removed = 0;
  int pulled = 0;
  for (const ordered_json& advance : summary["advances"]) {
    removed += advance["tets_removed"].get<int>();
    if (advance["started"].get<bool>()) continue;
    ++pulled;
    for (const char* part : {"remesh", "local", "update"}) milliseconds += advance["milliseconds"][part].get<double>();
  }
  fmt::print(
      "torn            {} advances, {:.4g} m^2 of crack, {} tets removed, {:.3g} of the volume lost, {} pieces\n",
      pulled, summary["crack_area"].get<double>(), removed, 1.0 - summary["volume_ratio"].get<double>(),
      summary["pieces"].get<int>());
  fmt::print("force           {:.4g} N at most{}\n", summary["largest_force"].get<double>(),
             summary["largest_force"].get<double>() > summary["max_force"].get<double>()
                 ? fmt::format(", more than the device's {:.4g} N", summary["max_force"].get<double>())
                 : "");
  fmt::print("energy          {:.4g} J by the hand, {:.4g} J stored at the end\n", summary["hand_work"].get<double>(),
             summary["stored_energy"].get<double>());
  const auto& time = summary["time"];
  fmt::print(
      "time            {:.2f} s: {:.2f} read, {:.2f} build, {:.2f} ticks; {:.2f} ms an advance; {:.0f} MB at most\n",
      time["total"].get<double>(), time["read"].get<double>(), time["build"].get<double>(), time["solve"].get<double>(),
      pulled > 0 ? milliseconds / pulled : 0.0, summary["memory"]["peak"].get<double>() * 1e-6);
  fmt::print("results         {}, steps.pvd, force.csv, force.svg\n", (out / "result.vtkhdf").string());
}

}  // namespace rhexis::apps
