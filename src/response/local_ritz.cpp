#include "response/local_ritz.h"

#include <algorithm>

#include <Eigen/LU>

#include "base/check.h"
#include "element/linear_tet.h"

namespace rhexis::response {
namespace {

/// Added to the diagonal of the reduced energy, relative to its largest entry: recorded bodies that are alike leave
/// directions without energy. The energy is least at the solution, so that this counts there by its square.
constexpr double kRidge = 1e-11;

}  // namespace

TornShape shape_of(const mesh::TornMesh& body) {
  TornShape out{body.mesh().nodes, {}};
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) out.solved.push_back(body.is_solved(TetId(t)) ? 1 : 0);
  return out;
}

std::vector<TetId> differing_tets(const mesh::TetMesh& intact, std::span<const TornShape* const> shapes) {
  std::vector<std::uint8_t> moved(intact.node_count(), 0);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    for (const TornShape* shape : shapes) moved[i] |= shape->nodes[i] != shapes.front()->nodes[i] ? 1 : 0;
  }
  std::vector<TetId> out;
  for (std::size_t t = 0; t < intact.tet_count(); ++t) {
    bool some = false;
    bool all = true;
    for (const TornShape* shape : shapes) {
      some = some || shape->solved[t] != 0;
      all = all && shape->solved[t] != 0;
    }
    const mesh::Tet& tet = intact.tets[t];
    const bool bent =
        some && std::any_of(tet.begin(), tet.end(), [&](NodeId node) { return moved[node.index()] != 0; });
    if (some != all || bent) out.emplace_back(t);
  }
  return out;
}

LocalRegion::LocalRegion(const mesh::TetMesh& mesh, const ElasticModel& model, std::span<const TetId> differing)
    : mesh_(mesh), model_(model), place_(3 * mesh.node_count(), -1) {
  enum : std::uint8_t { away, boundary, within };
  std::vector<std::uint8_t> part(mesh.node_count(), away);
  for (const TetId tet : differing) {
    for (const NodeId node : mesh.tet(tet)) part[node.index()] = within;
  }
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const mesh::Tet& tet = mesh.tets[t];
    if (std::none_of(tet.begin(), tet.end(), [&](NodeId node) { return part[node.index()] == within; })) continue;
    tets_.emplace_back(t);
    for (const NodeId node : tet) part[node.index()] = std::max<std::uint8_t>(part[node.index()], boundary);
  }
  for (const std::uint8_t which : {within, boundary}) {
    for (std::size_t dof = 0; dof < place_.size(); ++dof) {
      if (part[dof / 3] != which || model.held[dof] != 0) continue;
      place_[dof] = static_cast<std::int32_t>(dofs_.size());
      dofs_.push_back(static_cast<std::int32_t>(dof));
    }
    if (which == within) inner_ = static_cast<Eigen::Index>(dofs_.size());
  }
}

Eigen::Index LocalRegion::place_of(NodeId node) const {
  const std::int32_t* const place = place_.data() + 3 * node.index();
  return place[1] == place[0] + 1 && place[2] == place[0] + 2 ? place[0] : -1;
}

Eigen::SparseMatrix<double> LocalRegion::stiffness(const TornShape& shape) const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(144 * tets_.size());
  Eigen::Matrix<double, 12, 12> K;
  for (const TetId tet : tets_) {
    if (shape.solved[tet.index()] == 0) continue;
    const mesh::Tet& node = mesh_.tet(tet);
    element::small_strain_stiffness(
        model_.body.elastic,
        element::make_linear_tet({shape.nodes[node[0].index()], shape.nodes[node[1].index()],
                                  shape.nodes[node[2].index()], shape.nodes[node[3].index()]}),
        K);
    std::array<std::int32_t, 12> at{};
    for (std::size_t i = 0; i < 12; ++i) at[i] = place_[3 * node[i / 3].index() + i % 3];
    for (std::size_t i = 0; i < 12; ++i) {
      for (std::size_t j = 0; j < 12; ++j) {
        if (at[i] >= 0 && at[j] >= 0)
          entries.emplace_back(at[i], at[j], K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(dofs_.size());
  Eigen::SparseMatrix<double> out(size, size);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

RecordedBodies::RecordedBodies(const LocalRegion& region, std::span<const TornShape* const> shapes) : region_(region) {
  for (const TornShape* shape : shapes) stiffness_.push_back(region.stiffness(*shape));
}

/// u_l^T K_k u_k = S_k over the whole of body k, whose forces are at the point alone, where all u_l are the identity;
/// outside of the region all bodies are the same.
PointFields RecordedBodies::fields(NodeId point, std::span<const Eigen::MatrixXd> compliance,
                                   std::span<const Mat3> stiffness) const {
  const auto count = static_cast<Eigen::Index>(stiffness_.size());
  PointFields out;
  out.place = region_.place_of(point);
  out.local.resize(static_cast<Eigen::Index>(region_.dofs().size()), 3 * count);
  for (Eigen::Index k = 0; k < count; ++k)
    out.local.middleCols<3>(3 * k) = compliance[static_cast<std::size_t>(k)] * stiffness[static_cast<std::size_t>(k)];
  out.far_energy.resize(3 * count, 3 * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::MatrixXd force = stiffness_[static_cast<std::size_t>(k)] * out.local.middleCols<3>(3 * k);
    out.far_energy.middleCols<3>(3 * k) = -out.local.transpose() * force;
    for (Eigen::Index l = 0; l < count; ++l)
      out.far_energy.block<3, 3>(3 * l, 3 * k) += stiffness[static_cast<std::size_t>(k)];
  }
  out.far_energy = 0.5 * (out.far_energy + out.far_energy.transpose()).eval();
  return out;
}

LocalRitz::LocalRitz(const LocalRegion& region, const TornShape& shape) : region_(region) {
  const Eigen::Index inner = region.inner();
  const Eigen::MatrixXd K = region.stiffness(shape);
  const Eigen::Index boundary = K.rows() - inner;
  Eigen::MatrixXd K_oo = K.topLeftCorner(inner, inner);
  for (Eigen::Index i = 0; i < inner; ++i) {
    if (K_oo(i, i) == 0.0) K_oo(i, i) = 1.0;  // a node out of the solve
  }
  inner_factor_.compute(K_oo);
  if (singular()) return;
  follow_ = -inner_factor_.solve(K.topRightCorner(inner, boundary));
  condensed_ = K.bottomRightCorner(boundary, boundary);
  condensed_.noalias() += K.bottomLeftCorner(boundary, inner) * follow_;
}

Mat3 LocalRitz::stiffness(const PointFields& point) const {
  const Eigen::Index inner = region_.inner();
  const Eigen::Index columns = point.local.cols();
  const auto boundary = point.local.bottomRows(point.local.rows() - inner);
  Eigen::MatrixXd energy = point.far_energy;
  energy.noalias() += boundary.transpose() * (condensed_ * boundary);
  const bool is_inner = point.place >= 0 && point.place < inner;
  energy.diagonal().array() += kRidge * energy.diagonal().maxCoeff();
  if (!is_inner) {
    // u(point) = sum c_k = d: S = (E^T H^-1 E)^-1.
    const Eigen::MatrixXd ones = Mat3::Identity().replicate(columns / 3, 1);
    const Mat3 compliance = ones.transpose() * energy.ldlt().solve(ones);
    const Mat3 stiffness = compliance.inverse();
    return 0.5 * (stiffness + stiffness.transpose());
  }
  // The point is one of the inner dofs: it is moved from where it would follow the boundary, G c, to d, against the
  // compliance W of the inner dofs; c is free.
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(inner, 3);
  unit.middleRows<3>(point.place) = Mat3::Identity();
  const Mat3 W = inner_factor_.solve(unit).middleRows<3>(point.place);
  const Mat3 inverse = W.inverse();
  const Eigen::MatrixXd G = follow_.middleRows<3>(point.place) * boundary;
  energy.noalias() += G.transpose() * inverse * G;
  const Eigen::MatrixXd back = inverse * G;
  const Mat3 stiffness = inverse - back * energy.ldlt().solve(back.transpose());
  return 0.5 * (stiffness + stiffness.transpose());
}

}  // namespace rhexis::response
