#include "result/result_folder.h"

#include <functional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/atomic_file.h"

namespace rhexis::result {

namespace fs = std::filesystem;
namespace {

/// Removes the files of `folder` whose name, as it is or as it would be once complete, is of the kind asked for.
void remove_files(const fs::path& folder, const std::function<bool(std::string_view)>& is_of_a_run) {
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code))
    if (is_of_a_run(finished_name(entry.path().filename().string()))) fs::remove(entry.path(), code);
}

}  // namespace

Expected<ResultFolder> ResultFolder::open(const fs::path& path) {
  std::error_code code;
  fs::create_directories(path / "steps", code);
  if (code)
    return fail("cannot make the folder: " + code.message(), "choose a folder that can be written to", path.string());
  remove_files(path, [](std::string_view name) {
    return name == "result.vtkhdf" || name == "summary.json" || name == "steps.pvd" || name == "released.pvd" ||
           name == "force.csv" || name == "force.svg";
  });
  remove_files(path / "steps", [](std::string_view name) {
    return name.starts_with("step_") || name.starts_with("topology_") || name.starts_with("released_");
  });
  // An empty series: a run whose first step fails leaves one too, and a folder that cannot be written to is known now.
  if (const Expected<void> written = mesh::write_series(path / "steps.pvd", {}); !written) return fail(written.error());
  return ResultFolder(path);
}

Expected<void> ResultFolder::write_step(double load, const mesh::TetMesh& mesh,
                                        const std::vector<mesh::Field>& fields) {
  const std::string name = fmt::format("steps/step_{:04}.vtu", series_.size() + 1);
  if (Expected<void> written = mesh::write_mesh_file(path_ / name, mesh, fields); !written) return written;
  series_.push_back({load, name});
  return mesh::write_series(path_ / "steps.pvd", series_);
}

Expected<void> ResultFolder::write_topology(std::size_t topology, const mesh::TetMesh& mesh,
                                            const std::vector<mesh::Field>& fields) {
  const std::string name = fmt::format("steps/topology_{:04}", topology);
  for (const char* ending : {".vtkhdf", ".vtu"})
    if (Expected<void> written = mesh::write_mesh_file(path_ / (name + ending), mesh, fields); !written) return written;
  series_.push_back({static_cast<double>(topology), name + ".vtu"});
  return mesh::write_series(path_ / "steps.pvd", series_);
}

Expected<void> ResultFolder::write_released(double time, const mesh::TetMesh& mesh,
                                            const std::vector<mesh::Field>& fields) {
  const std::string name = fmt::format("steps/released_{:04}.vtu", released_.size() + 1);
  if (Expected<void> written = mesh::write_mesh_file(path_ / name, mesh, fields); !written) return written;
  released_.push_back({time, name});
  return mesh::write_series(path_ / "released.pvd", released_);
}

Expected<void> ResultFolder::write_result(const mesh::TetMesh& mesh, const std::vector<mesh::Field>& fields) {
  return mesh::write_mesh_file(path_ / "result.vtkhdf", mesh, fields);
}

Expected<void> ResultFolder::write_summary(const nlohmann::ordered_json& summary) {
  return write_atomically(path_ / "summary.json",
                          summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
}

}  // namespace rhexis::result
