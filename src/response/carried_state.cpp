#include "response/carried_state.h"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/LU>

#include "element/cofactor.h"
#include "element/linear_tet.h"

namespace rhexis::response {
namespace {

constexpr int kMostOpenings = 400;

/// u at the new reference positions of the nodes that moved, in the tet of before that each lies in, or nearest to.
void carry_moved(const model::DisplacementSpace& before, const std::vector<std::uint8_t>& left_out,
                 const VectorX& u_before, const mesh::MeshEdit& edit, VectorX& u) {
  std::vector<std::int32_t> place(before.node_count(), -1);
  std::vector<double> inside(edit.moved.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < edit.moved.size(); ++k) place[edit.moved[k].node.index()] = static_cast<std::int32_t>(k);
  for (std::size_t t = 0; 4 * t < before.connectivity.size(); ++t) {
    if (left_out[t] != 0) continue;
    const std::int32_t* const node = &before.connectivity[4 * t];
    for (std::size_t a = 0; a < 4; ++a) {
      const std::int32_t k = place[static_cast<std::size_t>(node[a])];
      if (k < 0) continue;
      const mesh::MovedNode& moved = edit.moved[static_cast<std::size_t>(k)];
      std::array<Vec3, 4> x;
      std::array<Vec3, 4> w;
      for (std::size_t b = 0; b < 4; ++b) {
        x[b] = before.nodes[static_cast<std::size_t>(node[b])];
        w[b] = u_before.segment<3>(3 * Eigen::Index{node[b]});
      }
      const element::LinearTet shape = element::make_linear_tet(x);
      const Vec3 way = moved.to - moved.from;
      double least = std::numeric_limits<double>::infinity();  // barycentric coordinate of the new position
      for (std::size_t b = 0; b < 4; ++b) least = std::min(least, (b == a ? 1.0 : 0.0) + shape.gradient[b].dot(way));
      if (least <= inside[static_cast<std::size_t>(k)]) continue;
      inside[static_cast<std::size_t>(k)] = least;
      u.segment<3>(3 * Eigen::Index{node[a]}) = w[a] + element::displacement_gradient(shape, w) * way;
    }
  }
}

/// J of a tet is linear in the place of each of its nodes.
struct Volume {
  double J = 1.0;
  std::array<Vec3, 4> slope;  ///< dJ/dx, 1/m
};
Volume volume_of(const mesh::TetMesh& mesh, TetId tet, const VectorX& u) {
  const element::LinearTet shape = element::make_linear_tet(mesh::corners(mesh, tet));
  std::array<Vec3, 4> w;
  for (std::size_t a = 0; a < 4; ++a) w[a] = u.segment<3>(3 * Eigen::Index{mesh.tet(tet)[a].value()});
  const Mat3 F = Mat3::Identity() + element::displacement_gradient(shape, w);
  const Mat3 cofactor = element::cofactor(F);
  Volume out;
  out.J = F.row(0).dot(cofactor.row(0));
  for (std::size_t a = 0; a < 4; ++a) out.slope[a] = cofactor * shape.gradient[a];
  return out;
}

/// Tets around nodes that moved are opened one after the other where their volume is too small, by the nodes that moved
/// (Agmon and Motzkin's relaxation of linear inequalities). Returns the least J of those tets.
double open_flat_tets(const mesh::TornMesh& mesh, const std::vector<NodeId>& movable, VectorX& u) {
  std::vector<TetId> tets;
  for (const NodeId node : movable) {
    for (const TetId tet : mesh.tets_around(node)) {
      if (mesh.is_solved(tet)) tets.push_back(tet);
    }
  }
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  std::vector<double> J;
  for (const TetId tet : tets) J.push_back(volume_of(mesh.mesh(), tet, u).J);
  for (int opening = 0; opening < kMostOpenings && !tets.empty(); ++opening) {
    const auto worst = static_cast<std::size_t>(std::min_element(J.begin(), J.end()) - J.begin());
    if (J[worst] >= kLeastVolumeLeft) break;
    const Volume volume = volume_of(mesh.mesh(), tets[worst], u);
    std::size_t best = 4;
    for (std::size_t a = 0; a < 4; ++a) {
      if (!std::binary_search(movable.begin(), movable.end(), mesh.mesh().tet(tets[worst])[a])) continue;
      if (best == 4 || volume.slope[a].squaredNorm() > volume.slope[best].squaredNorm()) best = a;
    }
    const Vec3 slope = volume.slope[best];
    if (!(slope.squaredNorm() > 0.0)) break;
    const NodeId node = mesh.mesh().tet(tets[worst])[best];
    u.segment<3>(3 * Eigen::Index{node.value()}) += (1.5 * kLeastVolumeLeft - volume.J) / slope.squaredNorm() * slope;
    for (std::size_t i = 0; i < tets.size(); ++i) {
      const mesh::Tet& of = mesh.mesh().tet(tets[i]);
      if (std::find(of.begin(), of.end(), node) != of.end()) J[i] = volume_of(mesh.mesh(), tets[i], u).J;
    }
  }
  return J.empty() ? 1.0 : *std::min_element(J.begin(), J.end());
}

}  // namespace

std::optional<model::State> carried_state(const model::DisplacementSpace& before,
                                          const std::vector<std::uint8_t>& left_out_before, const model::State& state,
                                          const mesh::TornMesh& mesh, const mesh::MeshEdit& edit, bool may_invert) {
  model::State out = state;
  carry_moved(before, left_out_before, state.u, edit, out.u);
  const Eigen::Index nodes = out.u.size() / 3;
  out.u.conservativeResize(out.u.size() + 3 * static_cast<Eigen::Index>(edit.copied.size()));
  for (std::size_t i = 0; i < edit.copied.size(); ++i)
    out.u.segment<3>(3 * (nodes + static_cast<Eigen::Index>(i))) =
        out.u.segment<3>(3 * Eigen::Index{edit.copied[i].value()});
  for (Eigen::Index t = 0; t < out.lambda.size(); ++t) {
    if (!mesh.is_solved(TetId(static_cast<std::size_t>(t)))) out.lambda[t] = 0.0;
  }

  std::vector<NodeId> movable;
  for (const mesh::MovedNode& moved : edit.moved) movable.push_back(moved.node);
  const std::size_t without_copies = movable.size();
  for (std::size_t i = 0; i < edit.copied.size(); ++i) {
    const auto end = movable.begin() + static_cast<std::ptrdiff_t>(without_copies);
    if (std::find(movable.begin(), end, edit.copied[i]) != end)
      movable.emplace_back(static_cast<std::size_t>(nodes) + i);
  }
  const double least = open_flat_tets(mesh, movable, out.u);
  if (least <= 0.0 && !may_invert) return std::nullopt;
  return out;
}

}  // namespace rhexis::response
