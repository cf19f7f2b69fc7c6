#pragma once

/// The body: nodes, linear tetrahedra and named sets, in the order of the file they came from.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/ids.h"
#include "base/vec.h"

namespace rhexis::mesh {

using Tet = std::array<NodeId, 4>;

/// Vertices of the face opposite to vertex k of a tet, seen counter-clockwise from outside a positively oriented tet.
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
/// Vertex pairs of the six edges of a tet.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// A face of a tet: the one opposite to its vertex `vertex`. Names a surface triangle without ambiguity.
struct TetFace {
  TetId tet;
  std::int8_t vertex = 0;
  friend auto operator<=>(const TetFace&, const TetFace&) = default;
};

/// Nodes under a name; ascending, no duplicates.
struct NodeSet {
  std::string name;
  std::vector<NodeId> nodes;
};

/// Boundary faces under a name; ascending, no duplicates. The node set of the same name holds their nodes.
struct FaceSet {
  std::string name;
  std::vector<TetFace> faces;
};

struct TetMesh {
  std::vector<Vec3> nodes;         ///< reference position X, metres
  std::vector<Tet> tets;           ///< positively oriented: det[X1-X0, X2-X0, X3-X0] > 0
  std::vector<NodeSet> node_sets;  ///< names are unique among node sets
  std::vector<FaceSet> face_sets;  ///< names are unique among face sets

  [[nodiscard]] std::size_t node_count() const { return nodes.size(); }
  [[nodiscard]] std::size_t tet_count() const { return tets.size(); }
  [[nodiscard]] const Vec3& node(NodeId id) const { return nodes[id.index()]; }
  [[nodiscard]] const Tet& tet(TetId id) const { return tets[id.index()]; }

  /// nullptr when there is no set of that name.
  [[nodiscard]] const NodeSet* find_node_set(std::string_view name) const;
  [[nodiscard]] const FaceSet* find_face_set(std::string_view name) const;
};

/// Corner positions X0..X3 of a tet, m.
[[nodiscard]] std::array<Vec3, 4> corners(const TetMesh& mesh, TetId tet);

/// det[X1-X0, X2-X0, X3-X0] / 6, m^3; negative when the tet is turned inside out.
[[nodiscard]] double signed_volume(const TetMesh& mesh, TetId tet);

/// Sum over all tets, m^3.
[[nodiscard]] double total_volume(const TetMesh& mesh);

/// h_e of the pressure stabilisation: the longest edge of the tet in the reference configuration, m.
[[nodiscard]] double longest_edge(const TetMesh& mesh, TetId tet);

/// The three nodes of a face, counter-clockwise seen from outside its tet.
[[nodiscard]] std::array<NodeId, 3> face_nodes(const TetMesh& mesh, TetFace face);

struct BoundingBox {
  Vec3 from = Vec3::Zero();  ///< smallest coordinates, m
  Vec3 to = Vec3::Zero();    ///< largest coordinates, m
  [[nodiscard]] Vec3 size() const { return to - from; }
};
/// Of all nodes; a box of size zero for a mesh without nodes.
[[nodiscard]] BoundingBox bounding_box(const TetMesh& mesh);

}  // namespace rhexis::mesh
