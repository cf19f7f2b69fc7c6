#include "studies/reference_solution.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rhexis::studies {
namespace {

namespace fs = std::filesystem;

/// Rows of numbers under a header; every row as long as `columns`.
Expected<std::vector<double>> read_numbers(const fs::path& path, std::size_t columns) {
  std::ifstream file(path);
  std::vector<double> out;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number == 1) continue;
    std::stringstream cells(line);
    std::string cell;
    std::size_t found = 0;
    for (; std::getline(cells, cell, ','); ++found) {
      double value = 0.0;
      if (std::from_chars(cell.data(), cell.data() + cell.size(), value).ec != std::errc())
        return fail(fmt::format("'{}' is no number", cell), {}, path.string(), number);
      out.push_back(value);
    }
    if (found != columns)
      return fail(fmt::format("{} numbers", found), fmt::format("{}", columns), path.string(), number);
  }
  return out;
}

}  // namespace

Expected<std::optional<LoadedBody>> read_reference_vessel(const fs::path& shared) {
  const fs::path folder = shared / "reference" / "4_vessel_small";
  if (!fs::exists(folder / "mesh_nodes.csv")) return std::optional<LoadedBody>();
  const Expected<std::vector<double>> nodes = read_numbers(folder / "mesh_nodes.csv", 3);
  if (!nodes) return fail(nodes.error());
  const Expected<std::vector<double>> tets = read_numbers(folder / "mesh_tets.csv", 4);
  if (!tets) return fail(tets.error());
  LoadedBody body{.name = "reference vessel", .mesh = {}, .supports = {}};
  for (std::size_t i = 0; i < nodes->size(); i += 3)
    body.mesh.nodes.emplace_back((*nodes)[i], (*nodes)[i + 1], (*nodes)[i + 2]);
  for (std::size_t i = 0; i < tets->size(); i += 4) {
    mesh::Tet tet;
    for (std::size_t k = 0; k < 4; ++k) tet[k] = NodeId(static_cast<std::int32_t>((*tets)[i + k]));
    body.mesh.tets.push_back(tet);
  }
  std::ifstream file(folder / "mesh_sets.json");
  const nlohmann::json sets = nlohmann::json::parse(file, nullptr, false);
  if (!sets.is_object() || !sets.contains("nodesets"))
    return fail("no node sets in it", {}, (folder / "mesh_sets.json").string());
  for (const auto& [name, ids] : sets["nodesets"].items()) {
    mesh::NodeSet set{name, {}};
    for (const auto& id : ids) set.nodes.emplace_back(id.get<std::int32_t>());
    std::sort(set.nodes.begin(), set.nodes.end());
    body.mesh.node_sets.push_back(std::move(set));
  }
  body.supports = {{"top", {0.0, 0.0, 0.0}}, {"midpatch", {0.005, kFree, kFree}}, {"bottom", {kFree, kFree, -0.012}}};
  return body;
}

Expected<std::optional<VectorX>> read_displacement(const fs::path& file, std::size_t nodes) {
  if (!fs::exists(file)) return std::optional<VectorX>();
  const Expected<std::vector<double>> numbers = read_numbers(file, 3);
  if (!numbers) return fail(numbers.error());
  if (numbers->size() != 3 * nodes)
    return fail(fmt::format("{} rows for {} nodes", numbers->size() / 3, nodes), {}, file.string());
  return VectorX(Eigen::Map<const VectorX>(numbers->data(), static_cast<Eigen::Index>(numbers->size())));
}

}  // namespace rhexis::studies
