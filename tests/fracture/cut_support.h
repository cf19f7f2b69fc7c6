#pragma once

/// Bodies to cut, surfaces to cut them with, and what has to hold of a body afterwards, checked the slow way.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "base/hash.h"
#include "fracture/front_surroundings.h"
#include "fracture/incision.h"
#include "fracture/pieces.h"
#include "mesh/quality.h"
#include "mesh/torn_mesh.h"

namespace rhexis::fracture::test {

/// A body that is cut, with all that follows it.
struct CutBody {
  explicit CutBody(const mesh::TetMesh& intact, IncisionMethod method = IncisionMethod::keep_nodes)
      : body(intact), surroundings(intact), held(3 * intact.node_count(), 0) {
    const mesh::Quality quality = mesh::measure_quality(intact);
    settings = {method, quality.edge.mean, quality.radius_ratio.min, std::vector<std::uint8_t>(intact.node_count(), 0)};
  }

  /// All three components of the nodes that `where` is true of.
  template <class Where>
  void hold(const Where& where) {
    for (std::size_t node = 0; node < body.intact_node_count(); ++node) {
      if (!where(body.mesh().nodes[node])) continue;
      settings.immovable[node] = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) held[3 * node + axis] = 1;
    }
  }
  void apply(const mesh::MeshEdit& edit) {
    body.apply(edit);
    surroundings.follow(edit, body);
    for (const NodeId parent : edit.copied) {
      settings.immovable.push_back(settings.immovable[parent.index()]);
      for (std::size_t axis = 0; axis < 3; ++axis) held.push_back(held[3 * parent.index() + axis]);
    }
  }
  mesh::MeshEdit undo() {
    mesh::MeshEdit edit = body.undo();
    held.resize(3 * body.mesh().node_count());
    settings.immovable.resize(body.mesh().node_count());
    return edit;
  }
  Incision incise(const CutSurface& surface) const { return fracture::incise(body, surroundings, surface, settings); }
  Incision cut(const CutSurface& surface) {
    Incision incision = incise(surface);
    apply(incision.edit);
    return incision;
  }
  double flattest_allowed() const { return kFlattestTet * settings.smallest_radius_ratio; }

  mesh::TornMesh body;
  Surroundings surroundings;
  IncisionSettings settings;
  std::vector<std::uint8_t> held;
};

/// The strip between two polylines of as many points; above is where (b - a) x (to - from) points.
inline CutSurface strip(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  CutSurface surface;
  for (std::size_t k = 0; k + 1 < from.size(); ++k) {
    surface.triangles.push_back({from[k], from[k + 1], to[k + 1]});
    surface.triangles.push_back({from[k], to[k + 1], to[k]});
  }
  return surface;
}

/// A parallelogram in the plane x = `x`, from y0 to y1, z0 to z1; above is +x.
inline CutSurface across_x(double x, double y0, double y1, double z0, double z1) {
  return strip({{x, y0, z1}, {x, y0, z0}}, {{x, y1, z1}, {x, y1, z0}});
}

/// Everything that can change: positions, vertices, flags, and the tets around each node.
inline std::uint64_t fingerprint(const mesh::TornMesh& body) {
  Hash hash;
  for (std::size_t node = 0; node < body.mesh().node_count(); ++node) {
    const Vec3& x = body.mesh().nodes[node];
    const NodeId original = body.original(NodeId(node));
    hash.add(std::span<const double>(x.data(), 3)).add(std::span<const NodeId>(&original, 1));
    hash.add(body.tets_around(NodeId(node)));
  }
  for (std::size_t tet = 0; tet < body.mesh().tet_count(); ++tet) {
    const std::array<std::uint8_t, 2> flags{body.is_alive(TetId(tet)), body.is_frozen(TetId(tet))};
    hash.add(std::span<const NodeId>(body.mesh().tets[tet])).add(std::span<const std::uint8_t>(flags));
  }
  return hash.value();
}

/// No alive tet is inside out or flatter than allowed.
inline void expect_round(const CutBody& cut) {
  for (std::size_t t = 0; t < cut.body.mesh().tet_count(); ++t) {
    if (!cut.body.is_alive(TetId(t))) continue;
    ASSERT_GT(mesh::signed_volume(cut.body.mesh(), TetId(t)), 0.0) << "tet " << t;
    ASSERT_GE(mesh::radius_ratio(mesh::corners(cut.body.mesh(), TetId(t))), cut.flattest_allowed()) << "tet " << t;
  }
}

/// Every face of an alive tet has one alive tet or two, which see it from opposite sides; the surface is closed: as
/// many of its triangles pass an edge one way as the other.
inline void expect_manifold_faces(const mesh::TornMesh& body) {
  std::map<std::array<NodeId, 3>, std::pair<int, int>> faces;  // sorted nodes -> seen in even and in odd order
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    if (!body.is_alive(TetId(t))) continue;
    for (std::int8_t k = 0; k < 4; ++k) {
      std::array<NodeId, 3> n = mesh::face_nodes(body.mesh(), {TetId(t), k});
      int swaps = 0;
      for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 1}})
        if (n[static_cast<std::size_t>(j)] < n[static_cast<std::size_t>(i)]) {
          std::swap(n[static_cast<std::size_t>(i)], n[static_cast<std::size_t>(j)]);
          ++swaps;
        }
      ASSERT_TRUE(n[0] != n[1] && n[1] != n[2]);
      ++(swaps % 2 == 0 ? faces[n].first : faces[n].second);
    }
  }
  std::map<std::pair<NodeId, NodeId>, int> passes;
  for (const auto& [n, seen] : faces) {
    ASSERT_LE(seen.first, 1) << n[0].value() << ' ' << n[1].value() << ' ' << n[2].value();
    ASSERT_LE(seen.second, 1) << n[0].value() << ' ' << n[1].value() << ' ' << n[2].value();
    const int way = seen.first - seen.second;
    for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
      const NodeId a = n[static_cast<std::size_t>(i)];
      const NodeId b = n[static_cast<std::size_t>(j)];
      passes[std::minmax(a, b)] += a < b ? way : -way;
    }
  }
  for (const auto& [edge, balance] : passes) ASSERT_EQ(balance, 0) << edge.first.value() << ' ' << edge.second.value();
}

inline std::size_t alive_count(const mesh::TornMesh& body) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) count += body.is_alive(TetId(t)) ? 1 : 0;
  return count;
}

/// Uniform numbers whose bits are the same everywhere.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double between(double from, double to) { return from + (to - from) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  Vec3 inside(const mesh::BoundingBox& box) {
    Vec3 at;
    for (int k = 0; k < 3; ++k) at[k] = between(box.from[k], box.to[k]);
    return at;
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 v(between(-1, 1), between(-1, 1), between(-1, 1));
      if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace rhexis::fracture::test
