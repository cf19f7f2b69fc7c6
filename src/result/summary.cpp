#include "result/summary.h"

#include <algorithm>

#include <cholmod.h>
#include <dmumps_c.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <tbb/version.h>
#include <Eigen/Core>

namespace rhexis::result {
namespace {

using nlohmann::ordered_json;

ordered_json step_json(const solver::StepReport& step) {
  ordered_json json{{"load", step.load},
                    {"iterations", step.iterations},
                    {"linear_iterations", step.linear_iterations},
                    {"residual_u", step.residual_u},
                    {"residual_lambda", step.residual_lambda}};
  if (!step.message.empty()) json["message"] = step.message;
  return json;
}

ordered_json steps_json(const std::vector<solver::StepReport>& steps) {
  ordered_json list = ordered_json::array();
  for (const solver::StepReport& step : steps) list.push_back(step_json(step));
  return list;
}

}  // namespace

ordered_json make_summary(const RunDescription& run, const mesh::TetMesh& mesh, const model::Model& model,
                          const model::Loading& loading, const Measures& measures, const solver::Report& report,
                          const RunTimes& times) {
  ordered_json iterations = ordered_json::array();
  for (const solver::StepReport& step : report.steps) iterations.push_back(step.iterations);

  ordered_json summary;
  summary["title"] = run.title;
  summary["scene"] = run.scene;
  summary["model"] = run.model;
  summary["linear"] = run.linear;
  if (run.model == "hyperelastic") summary["beta"] = run.beta;
  summary["converged"] = report.converged();
  summary["outcome"] = solver::name_of(report.outcome);
  summary["why"] = report.why;
  summary["load"] = report.load;
  summary["iterations"] = iterations;
  summary["residual"] = std::max(report.residual_u, report.residual_lambda);
  summary["nodes"] = mesh.node_count();
  summary["tets"] = mesh.tet_count();
  summary["unknowns"] = unknown_count(model, loading);
  summary["negative_pivots"] = report.negative_pivots ? ordered_json(*report.negative_pivots) : ordered_json(nullptr);
  summary["volume_ratio"] = measures.volume_ratio;
  summary["inverted_tets"] = measures.inverted_tets;
  summary["pressure_jump"] = measures.pressure_jump;
  summary["max_displacement"] = measures.max_displacement;
  summary["time"] = {
      {"read", times.read}, {"build", report.build_seconds}, {"solve", report.solve_seconds}, {"total", times.total}};
  summary["memory"] = {
      {"model", model.memory_bytes()}, {"linear", report.linear_memory_bytes}, {"peak", peak_memory_bytes()}};
  summary["steps"] = steps_json(report.steps);
  summary["cuts"] = steps_json(report.cuts);
  summary["notes"] = run.notes;
  summary["warnings"] = run.warnings;
  summary["versions"] = versions();
  return summary;
}

std::size_t unknown_count(const model::Model& model, const model::Loading& loading) {
  return model.space().dof_count() - loading.supports.size() + static_cast<std::size_t>(model.pressure_unknowns());
}

ordered_json versions() {
  return {{"rhexis", RHEXIS_VERSION},
          {"compiler", __VERSION__},
          {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"cholmod", fmt::format("{}.{}.{}", CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION)},
          {"mumps", MUMPS_VERSION},
          {"hdf5", fmt::format("{}.{}.{}", H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE)},
          {"tbb", TBB_VERSION_STRING}};
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace rhexis::result
