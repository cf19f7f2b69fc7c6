#include "response/torn_model.h"

#include <algorithm>

namespace rhexis::response {
namespace {

/// Per node: some tet of it is in the solve.
std::vector<std::uint8_t> solved_nodes(const mesh::TornMesh& mesh) {
  std::vector<std::uint8_t> solved(mesh.mesh().node_count(), 0);
  for (std::size_t t = 0; t < mesh.mesh().tet_count(); ++t) {
    if (!mesh.is_solved(TetId(t))) continue;
    for (const NodeId node : mesh.mesh().tets[t]) solved[node.index()] = 1;
  }
  return solved;
}

}  // namespace

std::vector<std::uint8_t> tets_left_out(const mesh::TornMesh& mesh) {
  std::vector<std::uint8_t> out(mesh.mesh().tet_count(), 0);
  for (std::size_t t = 0; t < out.size(); ++t) out[t] = mesh.is_solved(TetId(t)) ? 0 : 1;
  return out;
}

model::Loading make_torn_loading(const mesh::TornMesh& mesh, const LiveBody& body,
                                 const model::DisplacementSpace& space, const VectorX& u) {
  const std::size_t nodes = mesh.mesh().node_count();
  const std::vector<std::uint8_t> solved = solved_nodes(mesh);
  model::Loading out;

  std::vector<std::int32_t> support_of(3 * mesh.intact_node_count(), -1);
  for (std::size_t i = 0; i < body.body.supports.size(); ++i)
    support_of[static_cast<std::size_t>(body.body.supports[i].dof)] = static_cast<std::int32_t>(i);
  for (std::size_t node = 0; node < nodes; ++node) {
    const std::size_t original = mesh.original(NodeId(node)).index();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto dof = static_cast<std::int32_t>(3 * node + c);
      const std::int32_t support = support_of[3 * original + c];
      if (solved[node] == 0) {
        out.supports.push_back({dof, u[dof]});
      } else if (support >= 0) {
        out.supports.push_back({dof, body.body.supports[static_cast<std::size_t>(support)].value});
      }
    }
  }

  out.dead_force = VectorX::Zero(static_cast<Eigen::Index>(3 * nodes));
  const Vec3 weight = body.body.density * body.body.gravity;
  for (std::size_t t = 0; t < mesh.mesh().tet_count() && !weight.isZero(0.0); ++t) {
    if (!mesh.is_solved(TetId(t))) continue;
    const Vec3 quarter = 0.25 * mesh::signed_volume(mesh.mesh(), TetId(t)) * weight;
    for (const NodeId node : mesh.mesh().tets[t]) out.dead_force.segment<3>(3 * Eigen::Index{node.value()}) += quarter;
  }
  for (Eigen::Index node = 0; node < body.body.dead_force.size() / 3; ++node) {
    if (solved[static_cast<std::size_t>(node)] != 0)
      out.dead_force.segment<3>(3 * node) += body.body.dead_force.segment<3>(3 * node);
  }

  for (const SurfacePressure& pressure : body.pressures) {
    std::vector<mesh::TetFace> faces;
    for (const mesh::TetFace& face : pressure.faces) {
      if (mesh.is_solved(face.tet)) faces.push_back(face);
    }
    out.pressures.push_back(model::make_follower_pressure(mesh.mesh(), space, faces, pressure.value, out.supports));
  }
  return out;
}

}  // namespace rhexis::response
