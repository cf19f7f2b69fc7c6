#pragma once

/// Reads the solutions of other programs (csv, json) that lie beside the checkout.

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace rhexis::test {

inline nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

/// All numbers of a csv file in reading order; a first line that does not start with a number is a header.
inline std::vector<double> read_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<double> values;
  std::string line;
  while (std::getline(file, line)) {
    if (values.empty() && line.find_first_of("0123456789+-.") != 0) continue;
    std::stringstream cells(line);
    std::string cell;
    while (std::getline(cells, cell, ',')) values.push_back(std::stod(cell));
  }
  return values;
}

/// `<stem>_nodes.csv` and `<stem>_tets.csv`, which keep the digits that the .msh beside them may have lost.
inline mesh::TetMesh read_reference_mesh(const std::filesystem::path& stem) {
  mesh::TetMesh mesh;
  const std::vector<double> nodes = read_csv(stem.string() + "_nodes.csv");
  for (std::size_t i = 0; i + 2 < nodes.size(); i += 3) mesh.nodes.emplace_back(nodes[i], nodes[i + 1], nodes[i + 2]);
  const std::vector<double> tets = read_csv(stem.string() + "_tets.csv");
  for (std::size_t i = 0; i + 3 < tets.size(); i += 4) {
    mesh::Tet tet;
    for (std::size_t k = 0; k < 4; ++k) tet[k] = NodeId(static_cast<std::int32_t>(tets[i + k]));
    mesh.tets.push_back(tet);
  }
  const nlohmann::json sets = read_json(stem.string() + "_sets.json");
  for (const auto& [name, ids] : sets["nodesets"].items()) {
    mesh::NodeSet set{name, {}};
    for (const auto& id : ids) set.nodes.emplace_back(id.get<std::int32_t>());
    mesh.node_sets.push_back(set);
  }
  return mesh;
}

}  // namespace rhexis::test
