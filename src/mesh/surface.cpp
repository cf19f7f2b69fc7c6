#include "mesh/surface.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include <Eigen/Dense>

#include "base/check.h"

namespace rhexis::mesh {
namespace {

/// One tet's claim to a face: its two larger node numbers as the key, the smallest being the bucket it lies in.
struct Claim {
  std::uint64_t key = 0;
  TetFace face;
  friend auto operator<=>(const Claim&, const Claim&) = default;
};

std::array<std::int32_t, 3> sorted_nodes(const TetMesh& mesh, TetFace face) {
  const std::array<NodeId, 3> nodes = face_nodes(mesh, face);
  std::array<std::int32_t, 3> n{nodes[0].value(), nodes[1].value(), nodes[2].value()};
  if (n[0] > n[1]) std::swap(n[0], n[1]);
  if (n[1] > n[2]) std::swap(n[1], n[2]);
  if (n[0] > n[1]) std::swap(n[0], n[1]);
  return n;
}

/// All claims, bucketed by the smallest node of the face (a counting sort) and sorted inside each bucket, so that
/// claims to one face are neighbours. Buckets hold some 25 claims, which is what makes this faster than one big sort.
std::vector<Claim> sorted_claims(const TetMesh& mesh, std::vector<std::size_t>& bucket_end) {
  bucket_end.assign(mesh.node_count() + 1, 0);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t)
    for (std::int8_t k = 0; k < 4; ++k) {
      const auto n = sorted_nodes(mesh, {TetId(t), k});
      RHEXIS_CHECK(n[0] >= 0 && static_cast<std::size_t>(n[2]) < mesh.node_count(), "tet {} names node {} or {} of {}",
                   t, n[0], n[2], mesh.node_count());
      ++bucket_end[static_cast<std::size_t>(n[0]) + 1];
    }
  for (std::size_t i = 1; i < bucket_end.size(); ++i) bucket_end[i] += bucket_end[i - 1];

  // bucket_end[n] starts as the begin of bucket n and has moved to its end when all claims are in place.
  std::vector<Claim> claims(4 * mesh.tet_count());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t)
    for (std::int8_t k = 0; k < 4; ++k) {
      const auto n = sorted_nodes(mesh, {TetId(t), k});
      const std::uint64_t key = (static_cast<std::uint64_t>(n[1]) << 32) | static_cast<std::uint64_t>(n[2]);
      claims[bucket_end[static_cast<std::size_t>(n[0])]++] = {key, {TetId(t), k}};
    }
  bucket_end.pop_back();
  std::size_t begin = 0;
  for (const std::size_t end : bucket_end) {
    std::sort(claims.begin() + static_cast<std::ptrdiff_t>(begin), claims.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end;
  }
  return claims;
}

}  // namespace

FaceTable find_faces(const TetMesh& mesh) {
  std::vector<std::size_t> bucket_end;
  const std::vector<Claim> claims = sorted_claims(mesh, bucket_end);

  // What each face of each tet meets: nothing (an invalid tet), another tet's face, or, where three or more meet,
  // itself.
  std::vector<TetFace> mate(claims.size());
  const auto mate_of = [&](TetFace face) -> TetFace& {
    return mate[4 * face.tet.index() + static_cast<std::size_t>(face.vertex)];
  };
  std::size_t begin = 0;
  std::size_t interior = 0;
  std::size_t boundary = 0;
  for (const std::size_t bucket : bucket_end)
    while (begin < bucket) {
      std::size_t end = begin + 1;
      while (end < bucket && claims[end].key == claims[begin].key) ++end;
      if (end - begin == 1) ++boundary;
      if (end - begin == 2) {
        ++interior;
        mate_of(claims[begin].face) = claims[begin + 1].face;
        mate_of(claims[begin + 1].face) = claims[begin].face;
      }
      if (end - begin > 2)
        for (std::size_t i = begin; i < end; ++i) mate_of(claims[i].face) = claims[i].face;
      begin = end;
    }

  FaceTable table;
  table.interior.reserve(interior);
  table.boundary.reserve(boundary);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t)
    for (std::int8_t k = 0; k < 4; ++k) {
      const TetFace face{TetId(t), k};
      const TetFace other = mate_of(face);
      if (!other.tet.valid())
        table.boundary.push_back(face);
      else if (other == face)
        table.non_manifold.push_back(face);
      else if (face < other)
        table.interior.push_back({face, other});
    }
  return table;
}

double face_area(const TetMesh& mesh, TetFace face) {
  const auto [a, b, c] = face_nodes(mesh, face);
  return 0.5 * (mesh.node(b) - mesh.node(a)).cross(mesh.node(c) - mesh.node(a)).norm();
}

}  // namespace rhexis::mesh
