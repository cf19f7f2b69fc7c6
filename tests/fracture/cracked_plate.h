#pragma once

/// Plates with an edge crack whose flanks are faces of the mesh: nodes on the crack are doubled, except on the front.

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "fracture/crack.h"
#include "fracture/front_surroundings.h"
#include "fracture/local_object.h"
#include "mesh/generate.h"
#include "mesh/tet_mesh.h"
#include "tests/fracture/whole_body.h"

namespace rhexis::fracture::test {

/// Doubles the nodes of the mesh plane y = `height` up to x < `length`: a crack from x = 0.
inline void open_seam(mesh::TetMesh& mesh, double height, double length, double tolerance) {
  std::vector<NodeId> twin(mesh.node_count());
  for (std::size_t i = 0, count = mesh.node_count(); i < count; ++i) {
    const Vec3 x = mesh.nodes[i];
    if (std::abs(x[1] - height) > tolerance || x[0] > length - tolerance) continue;
    twin[i] = NodeId(mesh.node_count());
    mesh.nodes.push_back(x);
  }
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    double y = 0.0;
    for (const NodeId node : mesh.tets[t]) y += 0.25 * mesh.node(node)[1];
    if (y < height) continue;
    for (NodeId& node : mesh.tets[t])
      if (node.index() < twin.size() && twin[node.index()].valid()) node = twin[node.index()];
  }
}

/// A structured plate of `size` (m) with a crack of `length` cells from x = 0 at half height. `jitter`: inner nodes are
/// moved in the x-y plane by up to this part of a cell, those on the crack's plane along it, never the front.
inline mesh::TetMesh cracked_plate(const Vec3& size, const std::array<int, 3>& cells, int length, double jitter = 0.0,
                                   std::uint64_t seed = 1) {
  mesh::TetMesh mesh = mesh::make_structured_box(size, cells);
  const double h = size[0] / cells[0];
  const double small = 1e-6 * h;
  std::mt19937_64 random(seed);
  const auto amount = [&] { return jitter * h * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0); };
  std::map<std::pair<long, long>, Vec3> moves;  // one for a column of nodes through the thickness
  for (Vec3& x : mesh.nodes) {
    const bool rim = x[0] < small || x[0] > size[0] - small || x[1] < small || x[1] > size[1] - small;
    const bool on_plane = std::abs(x[1] - 0.5 * size[1]) < small;
    const bool front = on_plane && std::abs(x[0] - length * h) < small;
    if (rim || front) continue;
    const auto [at, is_new] = moves.try_emplace({std::lround(x[0] / h), std::lround(x[1] * cells[1] / size[1])});
    if (is_new) at->second = Vec3(amount(), amount(), 0.0);
    x[0] += at->second[0];
    if (!on_plane) x[1] += at->second[1];
  }
  open_seam(mesh, 0.5 * size[1], length * h, small);
  return mesh;
}

/// The front of such a plate, towards +x.
inline Crack front_at(double x, double y, double thickness) {
  Crack crack;
  crack.uniform = true;
  for (const double z : {0.0, thickness}) crack.front.push_back({Vec3(x, y, z), Vec3::UnitX(), Vec3::UnitZ()});
  return crack;
}

/// The local object about a front, solved with the displacement of the whole body on its boundary.
inline LocalObject local_fields(const mesh::TornMesh& body, const Surroundings& surroundings, const Crack& crack,
                                const WholeProblem& problem, const VectorX& u, double edges = 4.0) {
  std::vector<std::uint8_t> supported(body.mesh().node_count(), 0);
  for (const auto& [dof, value] : problem.given) supported[static_cast<std::size_t>(dof / 3)] = 1;
  LocalObject local(body, problem.elastic, surroundings.tets_near(body, crack, edges * surroundings.mean_edge()),
                    supported, {}, {.body_force = problem.body_force, .node_force = {}});
  VectorX given(3 * static_cast<Eigen::Index>(local.boundary().size()));
  for (std::size_t i = 0; i < local.boundary().size(); ++i)
    given.segment<3>(3 * static_cast<Eigen::Index>(i)) = u.segment<3>(3 * local.boundary()[i].value());
  EXPECT_TRUE(local.solve(given));
  return local;
}

enum class Mode { opening, shear };
/// The plate of 6_fracture_modeI: `top` and `bottom` moved apart by 2 mm, or along each other.
inline WholeProblem pulled_plate(const mesh::TetMesh& mesh, Mode mode, const std::string& top = "+y",
                                 const std::string& bottom = "-y") {
  WholeProblem problem;
  problem.elastic = {.young = 1.0e6, .poisson = 0.4};
  const auto along = mode == Mode::opening ? 1 : 0;
  problem.hold(mesh, top, along, 0.001);
  problem.hold(mesh, bottom, along, -0.001);
  if (mode == Mode::shear) {
    for (const std::string& set : {top, bottom})
      for (const int component : {1, 2}) problem.hold(mesh, set, component, 0.0);
    return problem;
  }
  // Rigid motions: x, and turning about y and z, at the node of the bottom nearest to the origin's edge; z there too.
  const std::vector<NodeId>& nodes = mesh.find_node_set(bottom)->nodes;
  const NodeId first = nodes.front();
  NodeId furthest = first;
  for (const NodeId node : nodes)
    if ((mesh.node(node) - mesh.node(first)).norm() > (mesh.node(furthest) - mesh.node(first)).norm()) furthest = node;
  problem.given[3 * first.value()] = 0.0;
  problem.given[3 * first.value() + 2] = 0.0;
  problem.given[3 * furthest.value() + 2] = 0.0;
  for (const NodeId node : mesh.find_node_set(top)->nodes) {
    problem.given[3 * node.value() + 2] = 0.0;
    break;
  }
  return problem;
}

}  // namespace rhexis::fracture::test
