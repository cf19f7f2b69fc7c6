#include "mesh/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Dense>

#include "mesh/surface.h"

namespace rhexis::mesh {
namespace {

Defect tet_defect(DefectKind kind, std::size_t tet, std::string what) {
  return {kind, TetId(tet), NodeId(), std::move(what)};
}
Defect node_defect(DefectKind kind, std::size_t node, std::string what) {
  return {kind, TetId(), NodeId(node), std::move(what)};
}

Tet sorted(Tet tet) {
  std::sort(tet.begin(), tet.end());
  return tet;
}

bool indices_are_good(const TetMesh& mesh, const Tet& tet) {
  return std::all_of(tet.begin(), tet.end(), [&](NodeId n) { return n.valid() && n.index() < mesh.node_count(); });
}

void find_node_defects(const TetMesh& mesh, std::vector<Defect>& defects) {
  std::vector<char> used(mesh.node_count(), 0);
  for (const Tet& tet : mesh.tets)
    for (const NodeId n : tet)
      if (n.valid() && n.index() < mesh.node_count()) used[n.index()] = 1;
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    const Vec3& x = mesh.nodes[i];
    if (!used[i])
      defects.push_back(node_defect(DefectKind::unused_node, i, fmt::format("node {} belongs to no tet", i)));
    if (!x.allFinite())
      defects.push_back(
          node_defect(DefectKind::not_finite, i, fmt::format("node {} lies at ({}, {}, {})", i, x[0], x[1], x[2])));
  }
}

/// Inverted or flat. All lengths are taken relative to the longest edge, so neither tiny nor huge bodies under- or
/// overflow; the comparisons are written such that a NaN counts as flat.
void find_shape_defect(const TetMesh& mesh, std::size_t t, std::vector<Defect>& defects) {
  const std::array<Vec3, 4> x = corners(mesh, TetId(t));
  const double longest = longest_edge(mesh, TetId(t));
  const Vec3 a = (x[1] - x[0]) / longest;
  const Vec3 b = (x[2] - x[0]) / longest;
  const Vec3 c = (x[3] - x[0]) / longest;
  const double six_volumes = a.cross(b).dot(c);
  const double twice_largest_area = std::sqrt(std::max({a.cross(b).squaredNorm(), b.cross(c).squaredNorm(),
                                                        c.cross(a).squaredNorm(), (b - a).cross(c - a).squaredNorm()}));
  const double height = std::abs(six_volumes) / twice_largest_area;
  if (!(height >= kFlatTet))
    defects.push_back(tet_defect(DefectKind::flat_tet, t,
                                 fmt::format("tet {} is flat (volume {:.3g} m^3, height over longest edge {:.1e})", t,
                                             signed_volume(mesh, TetId(t)), height)));
  else if (six_volumes < 0.0)
    defects.push_back(
        tet_defect(DefectKind::inverted_tet, t,
                   fmt::format("tet {} is inverted (volume {:.3g} m^3)", t, signed_volume(mesh, TetId(t)))));
}

/// Looks at each tet by itself. Returns the tets that name four different existing nodes: only those have faces.
std::vector<std::size_t> find_tet_defects(const TetMesh& mesh, std::vector<Defect>& defects) {
  std::vector<std::size_t> sound;
  sound.reserve(mesh.tet_count());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const Tet& tet = mesh.tets[t];
    if (!indices_are_good(mesh, tet)) {
      defects.push_back(
          tet_defect(DefectKind::bad_index, t,
                     fmt::format("tet {} names nodes {}, {}, {}, {} where there are {}", t, tet[0].value(),
                                 tet[1].value(), tet[2].value(), tet[3].value(), mesh.node_count())));
      continue;
    }
    const Tet s = sorted(tet);
    if (const auto twice = std::adjacent_find(s.begin(), s.end()); twice != s.end()) {
      defects.push_back(
          tet_defect(DefectKind::repeated_node, t, fmt::format("tet {} names node {} twice", t, twice->value())));
      continue;
    }
    sound.push_back(t);
    if (std::all_of(tet.begin(), tet.end(), [&](NodeId n) { return mesh.node(n).allFinite(); }))
      find_shape_defect(mesh, t, defects);
  }
  return sound;
}

/// Removes later copies of a tet from `sound`, so that one copy does not show up as four non-manifold faces too.
void find_duplicates(const TetMesh& mesh, std::vector<std::size_t>& sound, std::vector<Defect>& defects) {
  std::vector<std::pair<Tet, std::size_t>> keyed;
  keyed.reserve(sound.size());
  for (const std::size_t t : sound) keyed.emplace_back(sorted(mesh.tets[t]), t);
  std::sort(keyed.begin(), keyed.end());
  std::vector<char> copy(mesh.tet_count(), 0);
  for (std::size_t i = 0, first = 0; i < keyed.size(); ++i) {
    if (keyed[i].first != keyed[first].first) first = i;
    if (i == first) continue;
    copy[keyed[i].second] = 1;
    defects.push_back(
        tet_defect(DefectKind::duplicate_tet, keyed[i].second,
                   fmt::format("tet {} has the same nodes as tet {}", keyed[i].second, keyed[first].second)));
  }
  std::erase_if(sound, [&](std::size_t t) { return copy[t] != 0; });
}

/// Disjoint sets of tets; the root of a set is its first tet.
class Pieces {
 public:
  explicit Pieces(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// `part` holds the tets `original[i]` of the whole mesh.
void find_pieces(const std::vector<std::size_t>& original, Pieces& pieces, std::vector<Defect>& defects) {
  std::vector<std::size_t> size(original.size(), 0);
  for (std::size_t i = 0; i < original.size(); ++i) ++size[pieces.root(i)];
  const auto largest = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  for (std::size_t i = 0; i < original.size(); ++i)
    if (size[i] > 0 && i != largest)
      defects.push_back(tet_defect(
          DefectKind::unconnected_tet, original[i],
          fmt::format("tet {} and the piece it begins ({} of {} tets) share no face with the largest piece ({} tets)",
                      original[i], size[i], original.size(), size[largest])));
}

/// Faces that three or more tets claim, and pieces that no face connects.
void find_face_defects(const TetMesh& mesh, const std::vector<std::size_t>& sound, std::vector<Defect>& defects) {
  TetMesh part;
  part.nodes = mesh.nodes;
  part.tets.reserve(sound.size());
  for (const std::size_t t : sound) part.tets.push_back(mesh.tets[t]);
  const FaceTable faces = find_faces(part);
  Pieces pieces(sound.size());
  for (const auto& [first, second] : faces.interior) pieces.join(first.tet.index(), second.tet.index());

  std::vector<std::pair<std::array<NodeId, 3>, std::size_t>> claims;
  for (const TetFace face : faces.non_manifold) {
    auto nodes = face_nodes(part, face);
    std::sort(nodes.begin(), nodes.end());
    claims.emplace_back(nodes, face.tet.index());
  }
  std::sort(claims.begin(), claims.end());
  for (std::size_t begin = 0, end = 0; begin < claims.size(); begin = end) {
    std::vector<std::size_t> tets;
    for (end = begin; end < claims.size() && claims[end].first == claims[begin].first; ++end) {
      pieces.join(claims[begin].second, claims[end].second);
      tets.push_back(sound[claims[end].second]);
    }
    const auto& n = claims[begin].first;
    defects.push_back(tet_defect(DefectKind::non_manifold_face, tets.front(),
                                 fmt::format("the face of nodes {}, {}, {} belongs to {} tets: {}", n[0].value(),
                                             n[1].value(), n[2].value(), tets.size(), fmt::join(tets, ", "))));
  }
  find_pieces(sound, pieces, defects);
}

}  // namespace

std::vector<Defect> find_defects(const TetMesh& mesh) {
  std::vector<Defect> defects;
  find_node_defects(mesh, defects);
  std::vector<std::size_t> sound = find_tet_defects(mesh, defects);
  find_duplicates(mesh, sound, defects);
  find_face_defects(mesh, sound, defects);
  std::stable_sort(defects.begin(), defects.end(), [](const Defect& a, const Defect& b) {
    return std::tie(a.kind, a.tet, a.node) < std::tie(b.kind, b.tet, b.node);
  });
  return defects;
}

std::size_t orient_tets(TetMesh& mesh) {
  std::vector<char> turned(mesh.tet_count(), 0);
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t)
    if (signed_volume(mesh, TetId(t)) < 0.0) {
      std::swap(mesh.tets[t][2], mesh.tets[t][3]);
      turned[t] = 1;
      ++count;
    }
  // A face is named by the vertex opposite to it, so the faces of a turned tet change their names with the swap.
  for (FaceSet& set : mesh.face_sets) {
    for (TetFace& face : set.faces)
      if (turned[face.tet.index()] && face.vertex >= 2) face.vertex = static_cast<std::int8_t>(5 - face.vertex);
    std::sort(set.faces.begin(), set.faces.end());
  }
  return count;
}

}  // namespace rhexis::mesh
