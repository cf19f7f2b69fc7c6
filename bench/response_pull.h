#pragma once

/// The plate 240 x 240 x 10 mm, torn straight on from a crack of 60 mm: what every way of following it is given.

#include <map>
#include <memory>
#include <vector>

#include "fracture/incision.h"
#include "mesh/generate.h"
#include "mesh/quality.h"
#include "response/elastic_elements.h"
#include "response/response.h"

namespace rhexis::response::bench {

inline constexpr double kEdgesPerAdvance = 1.5;
inline constexpr double kLocalEdges = 4.0;
inline constexpr int kAdvances = 18;

/// The plate at its start, and the edits of its advances, made once.
struct Pull {
  mesh::TornMesh start;
  ElasticBody elastic;
  std::vector<mesh::MeshEdit> edits;
  std::vector<Focus> focus;  ///< before the first edit and after each
  NodeId hand;
};

inline const Pull& pull_of(int nodes) {
  static std::map<int, std::unique_ptr<Pull>> made;
  std::unique_ptr<Pull>& pull = made[nodes];
  if (pull) return *pull;
  const mesh::TetMesh mesh = mesh::make_plate({{0.24, 0.24, 0.01}}, nodes).value();
  const mesh::Quality quality = mesh::measure_quality(mesh);
  const double h = quality.edge.mean;
  pull = std::make_unique<Pull>(Pull{mesh::TornMesh(mesh), {}, {}, {}, {}});
  pull->elastic.elastic = {.young = 1.0e6, .poisson = 0.4};
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.node_count()); ++i) {
    if (mesh.nodes[static_cast<std::size_t>(i)][1] < 0.24 - 1e-9) continue;
    for (std::int32_t c = 0; c < 3; ++c) pull->elastic.supports.push_back({3 * i + c, 0.0});
  }
  for (const NodeId node : mesh.find_node_set("-y")->nodes) {
    const auto distance = [&](NodeId id) { return (mesh.node(id) - Vec3(0.1, 0.0, 0.005)).norm(); };
    if (!pull->hand.valid() || distance(node) < distance(pull->hand)) pull->hand = node;
  }
  fracture::IncisionSettings settings{fracture::IncisionMethod::keep_nodes, h, quality.radius_ratio.min,
                                      std::vector<std::uint8_t>(mesh.node_count(), 0)};
  settings.immovable[pull->hand.index()] = 1;
  fracture::Surroundings surroundings(mesh);
  const auto cut = [&](mesh::TornMesh& body, double from, double to) {
    const Vec3 a(0.1203, from, -0.01), b(0.1203, from, 0.02), c(0.1203, to, 0.02), d(0.1203, to, -0.01);
    mesh::MeshEdit edit = fracture::incise(body, surroundings, {{{a, b, c}, {a, c, d}}}, settings).edit;
    body.apply(edit);
    surroundings.follow(edit, body);
    return edit;
  };
  double front = 0.06;
  cut(pull->start, -0.01, front);
  mesh::TornMesh body = pull->start;
  const auto here = [&] { return Focus{{0.1203, front, 0.005}, Vec3::UnitY(), 0.005, kLocalEdges * h, Vec3::UnitZ()}; };
  pull->focus.push_back(here());
  while (pull->edits.size() < kAdvances && front + kEdgesPerAdvance * h < 0.23) {
    pull->edits.push_back(cut(body, front, front + kEdgesPerAdvance * h));
    front += kEdgesPerAdvance * h;
    pull->focus.push_back(here());
  }
  return *pull;
}

}  // namespace rhexis::response::bench
