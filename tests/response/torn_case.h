#pragma once

/// Loaded bodies with a crack that is cut on, step by step, and the response that follows beside its slow oracle.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "fracture/pieces.h"
#include "mesh/generate.h"
#include "response/exact_response.h"
#include "tests/fracture/cut_support.h"
#include "tests/support/torn_body_oracle.h"

namespace rhexis::response::test {

using fracture::test::CutBody;
using rhexis::test::TornBodyOracle;

/// A crack plane through a body: where the front starts, where it runs, along what it lies.
struct CutPath {
  Vec3 from = Vec3::Zero();
  Vec3 direction = Vec3::UnitY();
  Vec3 tangent = Vec3::UnitZ();
  double half_width = 0.0;  ///< m; the cut reaches this far to both sides
};

inline fracture::CutSurface cut_surface(const CutPath& path, double from, double to) {
  const Vec3 side = path.half_width * path.tangent;
  const Vec3 near = path.from + from * path.direction;
  const Vec3 far = path.from + to * path.direction;
  return fracture::test::strip({near - side, near + side}, {far - side, far + side});
}

struct TornCase {
  std::string name;
  CutBody cut;
  ElasticBody elastic;
  CutPath path;
  double at = 0.0;              ///< m, how far the front has gone
  std::vector<double> reached;  ///< before each step

  [[nodiscard]] double edge() const { return cut.settings.mean_edge; }
  [[nodiscard]] Focus focus(double radius_in_edges) const {
    return {path.from + at * path.direction, path.direction, std::min(path.half_width, 2.0 * edge()),
            radius_in_edges * edge(), path.tangent};
  }
  /// Cuts on by `length` edges, with what loses its support frozen; the body takes it.
  mesh::MeshEdit step(double length) {
    reached.push_back(at);
    mesh::MeshEdit edit = cut.incise(cut_surface(path, at, at + length * edge())).edit;
    at += length * edge();
    take(edit);
    return cut.body.history().back();
  }
  mesh::MeshEdit undo() {
    at = reached.back();
    reached.pop_back();
    return cut.undo();
  }
  /// Applies an edit, with what loses its support frozen.
  void take(mesh::MeshEdit edit) {
    cut.apply(edit);
    edit.frozen = fracture::unsupported_tets(cut.body, fracture::find_pieces(cut.body, cut.held));
    cut.undo();
    cut.apply(edit);
  }
  [[nodiscard]] NodeId nearest(const Vec3& x) const {
    NodeId best;
    for (std::size_t i = 0; i < cut.body.mesh().node_count(); ++i) {
      const NodeId node(i);
      if (!in_solve(node)) continue;
      if (!best.valid() || (cut.body.mesh().node(node) - x).norm() < (cut.body.mesh().node(best) - x).norm())
        best = node;
    }
    return best;
  }
  [[nodiscard]] bool in_solve(NodeId node) const {
    const auto around = cut.body.tets_around(node);
    return std::any_of(around.begin(), around.end(), [&](TetId tet) { return cut.body.is_solved(tet); });
  }
  /// In the solve, within a distance of a point.
  [[nodiscard]] std::vector<NodeId> nodes_near(const Vec3& x, double distance) const {
    std::vector<NodeId> out;
    for (std::size_t i = 0; i < cut.body.mesh().node_count(); ++i) {
      if (in_solve(NodeId(i)) && (cut.body.mesh().nodes[i] - x).norm() < distance) out.emplace_back(i);
    }
    return out;
  }
  [[nodiscard]] std::vector<NodeId> all_nodes() const {
    std::vector<NodeId> out;
    for (std::size_t i = 0; i < cut.body.mesh().node_count(); ++i) out.emplace_back(i);
    return out;
  }
};

/// Held where `where` says, by a prescribed displacement that is not zero; under gravity and forces at every node.
template <class Where>
TornCase make_case(std::string name, const mesh::TetMesh& mesh, const CutPath& path, const Where& where) {
  TornCase out{std::move(name), CutBody(mesh), {}, path, 0.0, {}};
  out.cut.hold(where);
  out.elastic.elastic = {.young = 1.0e6, .poisson = 0.4};
  out.elastic.density = 1000.0;
  out.elastic.gravity = {1.0, -2.0, -9.81};
  const double size = mesh::bounding_box(mesh).size().maxCoeff();
  const std::size_t n = mesh.node_count();
  out.elastic.dead_force.resize(static_cast<Eigen::Index>(3 * n));
  for (std::size_t i = 0; i < 3 * n; ++i) {
    const auto dof = static_cast<Eigen::Index>(i);
    out.elastic.dead_force[dof] = 1e-4 * std::sin(static_cast<double>(i));
    if (out.cut.held[i] == 0) continue;
    const Vec3& x = mesh.nodes[i / 3];
    out.elastic.supports.push_back({static_cast<std::int32_t>(i), 1e-3 * (x[0] - 0.5 * x[1] + 0.3 * size)});
  }
  return out;
}

inline TornCase plate_case(int nodes) {
  const mesh::TetMesh mesh = mesh::make_plate({{0.24, 0.24, 0.01}}, nodes).value();
  return make_case("plate", mesh, {{0.117, -0.001, 0.005}, Vec3::UnitY(), Vec3::UnitZ(), 0.01},
                   [](const Vec3& x) { return x[1] > 0.2399; });
}
inline TornCase bar_case(int nodes) {
  const mesh::TetMesh mesh = mesh::make_bar({{0.10, 0.04, 0.04}}, nodes).value();
  return make_case("bar", mesh, {{0.043, -0.001, 0.02}, Vec3(0.1, 1.0, 0.0).normalized(), Vec3::UnitZ(), 0.03},
                   [](const Vec3& x) { return x[0] < 1e-9; });
}
inline TornCase tube_case(int nodes) {
  const mesh::TetMesh mesh =
      mesh::make_tube({.radius = 0.005, .length = 0.04, .wall = 0.002, .bend = 30.0}, nodes).value();
  const mesh::BoundingBox box = mesh::bounding_box(mesh);
  CutPath path{{0.0, -0.0055, 0.018}, Vec3(0.0, 1.0, 0.2).normalized(), Vec3::UnitX(), 0.012};
  path.from[0] = 0.5 * (box.from[0] + box.to[0]);
  return make_case("tube", mesh, path, [](const Vec3& x) { return x[2] < 1e-9; });
}

/// How far the answers are from those of the oracle, as parts of what the intact body has.
struct Scale {
  double compliance = 0.0;
  double displacement = 0.0;
  double energy = 0.0;
};
struct Difference {
  double compliance = 0.0;
  double rest = 0.0;
  double local = 0.0;  ///< displacement of the nodes of the local object
  double whole = 0.0;
  double energy = 0.0;
  [[nodiscard]] double largest() const { return std::max({compliance, rest, local, whole, energy}); }
};

inline VectorX some_force(Eigen::Index dofs) {
  VectorX out(dofs);
  for (Eigen::Index i = 0; i < dofs; ++i) out[i] = 0.01 * std::cos(1.0 + static_cast<double>(i));
  return out;
}

inline Scale scale_of(const TornCase& body, const std::vector<NodeId>& held) {
  TornBodyOracle oracle(body.cut.body, body.elastic);
  const VectorX force = some_force(static_cast<Eigen::Index>(3 * held.size()));
  return {oracle.compliance(held).norm(), oracle.displacement(held, force).cwiseAbs().maxCoeff(),
          std::abs(oracle.energy_at_rest())};
}

inline Difference difference(const TornCase& body, ExactResponse& response, const std::vector<NodeId>& held,
                             const Focus& focus, const Scale& scale, double energy_at_first) {
  TornBodyOracle oracle(body.cut.body, body.elastic);
  EXPECT_TRUE(oracle.is_stable());
  const VectorX force = some_force(static_cast<Eigen::Index>(3 * held.size()));
  const VectorX u = oracle.displacement(held, force);
  const std::vector<NodeId> near = body.nodes_near(focus.centre, focus.radius);
  VectorX local;
  response.displacement(near, force, 1.0, local);
  VectorX whole;
  response.whole_displacement(force, 1.0, whole);
  const Eigen::MatrixXd compliance = oracle.compliance(held);
  const double energy = oracle.energy_at_rest() - energy_at_first + 0.5 * force.dot(compliance * force);
  const auto largest = [](const VectorX& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0; };
  return {(response.compliance() - compliance).norm() / scale.compliance,
          largest(response.rest() - oracle.rest(held)) / scale.displacement,
          largest(local - TornBodyOracle::at(near, u)) / scale.displacement, largest(whole - u) / scale.displacement,
          std::abs(response.stored_energy(force) - energy) / scale.energy};
}

}  // namespace rhexis::response::test
