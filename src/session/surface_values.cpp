#include "session/surface_values.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace rhexis::session {
namespace {

double von_mises(const Mat3& s) {
  const double normal =
      std::pow(s(0, 0) - s(1, 1), 2) + std::pow(s(1, 1) - s(2, 2), 2) + std::pow(s(2, 2) - s(0, 0), 2);
  const double shear = s(0, 1) * s(0, 1) + s(1, 2) * s(1, 2) + s(0, 2) * s(0, 2);
  return std::sqrt(0.5 * normal + 3.0 * shear);
}

double value_of(wire::Field field, const Mat3& stress) {
  switch (field) {
    case wire::Field::von_mises: return von_mises(stress);
    case wire::Field::mean_stress: return stress.trace() / 3.0;
    case wire::Field::principal_max: {
      Eigen::SelfAdjointEigenSolver<Mat3> solver;
      solver.computeDirect(stress, Eigen::EigenvaluesOnly);  // in closed form: for eyes, and there are many
      return solver.eigenvalues()[2];
    }
    default: return 0.0;
  }
}

std::vector<TetId> tets_at_surface(const mesh::TornMesh& body, const SurfaceTracker& surface) {
  std::vector<TetId> out;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    const mesh::Tet& nodes = body.mesh().tets[t];
    const bool touches =
        std::any_of(nodes.begin(), nodes.end(), [&](NodeId node) { return surface.vertex_of(node).has_value(); });
    if (touches && body.is_alive(TetId(t))) out.emplace_back(t);
  }
  return out;
}

}  // namespace

void surface_displacement(const SurfaceTracker& surface, const VectorX& u, std::vector<float>& out) {
  const std::vector<NodeId>& nodes = surface.nodes();
  out.assign(3 * nodes.size(), 0.0F);
  for (std::size_t vertex = 0; vertex < nodes.size(); ++vertex) {
    for (std::size_t c = 0; c < 3; ++c)
      out[3 * vertex + c] = static_cast<float>(u[static_cast<Eigen::Index>(3 * nodes[vertex].index() + c)]);
  }
}

void SurfaceValues::find(wire::Field field, const mesh::TornMesh& body, const std::function<Mat3(TetId)>& stress,
                         const SurfaceTracker& surface, const VectorX& u, std::vector<float>& out) {
  const std::vector<NodeId>& nodes = surface.nodes();
  out.clear();
  if (field == wire::Field::none) return;
  out.resize(nodes.size(), 0.0F);
  const auto moved = [&](NodeId node) { return Vec3(u.segment<3>(static_cast<Eigen::Index>(3 * node.index()))); };
  if (field == wire::Field::displacement) {
    for (std::size_t vertex = 0; vertex < nodes.size(); ++vertex)
      out[vertex] = static_cast<float>(moved(nodes[vertex]).norm());
    return;
  }
  if (tets_.empty()) tets_ = tets_at_surface(body, surface);
  sum_.assign(body.mesh().node_count(), 0.0);
  volume_.assign(body.mesh().node_count(), 0.0);
  for (const TetId tet : tets_) {
    const mesh::Tet& corner = body.mesh().tet(tet);
    const double volume = mesh::signed_volume(body.mesh(), tet);
    const double value = body.is_solved(tet) ? value_of(field, stress(tet)) : 0.0;
    for (const NodeId node : corner) {
      sum_[node.index()] += value * volume;
      volume_[node.index()] += volume;
    }
  }
  for (std::size_t vertex = 0; vertex < nodes.size(); ++vertex) {
    if (volume_[nodes[vertex].index()] <= 0.0) continue;
    out[vertex] = static_cast<float>(sum_[nodes[vertex].index()] / volume_[nodes[vertex].index()]);
  }
}

}  // namespace rhexis::session
