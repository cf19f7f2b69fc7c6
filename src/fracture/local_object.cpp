#include "fracture/local_object.h"

#include <algorithm>
#include <optional>

#include "base/check.h"
#include "element/linear_tet.h"
#include "linalg/cholesky_factor.h"

namespace rhexis::fracture {
namespace {

/// A pivot below this part of its diagonal entry is rounding: the part hangs by nothing firm.
constexpr double kSmallestPivot = 1e-12;

std::array<Vec3, 4> corner_displacements(const std::array<std::int32_t, 4>& nodes, const VectorX& u) {
  std::array<Vec3, 4> out;
  for (std::size_t k = 0; k < 4; ++k) out[k] = u.segment<3>(3 * nodes[k]);
  return out;
}

}  // namespace

TetStress stress_of(const mesh::TornMesh& body, const material::Elastic& elastic, TetId tet, const VectorX& u) {
  const std::array<Vec3, 4> x = mesh::corners(body.mesh(), tet);
  const element::LinearTet shape = element::make_linear_tet(x);
  std::array<std::int32_t, 4> nodes{};
  for (std::size_t k = 0; k < 4; ++k) nodes[k] = body.mesh().tet(tet)[k].value();
  TetStress out;
  out.tet = tet;
  out.centroid = 0.25 * (x[0] + x[1] + x[2] + x[3]);
  out.volume = shape.volume;
  out.stress =
      element::small_strain_stress(elastic, element::displacement_gradient(shape, corner_displacements(nodes, u)));
  return out;
}

struct LocalObject::Core {
  material::Elastic elastic;
  std::vector<TetId> tets;
  std::vector<NodeId> nodes;  ///< ascending; local numbers are places in here
  std::vector<NodeId> boundary;
  std::vector<NodeId> interior;
  std::vector<std::int32_t> boundary_place;  ///< local number of each boundary node
  std::vector<std::int32_t> interior_place;
  std::vector<std::array<std::int32_t, 4>> local;  ///< local numbers of the nodes of each tet
  std::vector<element::LinearTet> shape;
  VectorX load;  ///< f_o, 3 per local node, zero on the boundary
  linalg::CholeskyFactor factor{linalg::Ordering::amd};
  std::optional<bool> stable;  ///< whether it was factored
  VectorX u;                   ///< 3 per local node
  VectorX force;               ///< work space of solve
  std::vector<TetStress> stresses;
  std::vector<Mat3> gradients;

  void number(const mesh::TornMesh& body, std::span<const std::uint8_t> supported, std::span<const NodeId> hand);
  void add_loads(const LocalLoads& loads);
  [[nodiscard]] bool factor_interior();
  void find_stresses();
};

void LocalObject::Core::number(const mesh::TornMesh& body, std::span<const std::uint8_t> supported,
                               std::span<const NodeId> hand) {
  // Per node of the body: first the tets of the local object around it, then its local number.
  std::vector<std::int32_t> of_body(body.mesh().node_count(), 0);
  for (const TetId tet : tets)
    for (const NodeId node : body.mesh().tet(tet)) ++of_body[node.index()];
  std::vector<std::int32_t> inside;  // of the local nodes
  for (std::size_t i = 0; i < of_body.size(); ++i) {
    if (of_body[i] == 0) continue;
    inside.push_back(of_body[i]);
    of_body[i] = static_cast<std::int32_t>(nodes.size());
    nodes.emplace_back(i);
  }
  local.reserve(tets.size());
  shape.reserve(tets.size());
  stresses.reserve(tets.size());
  for (const TetId tet : tets) {
    auto& of_tet = local.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      of_tet[k] = of_body[body.mesh().tet(tet)[k].index()];
    }
    const std::array<Vec3, 4> x = mesh::corners(body.mesh(), tet);
    shape.push_back(element::make_linear_tet(x));
    TetStress& stress = stresses.emplace_back();
    stress.tet = tet;
    stress.centroid = 0.25 * (x[0] + x[1] + x[2] + x[3]);
    stress.volume = shape.back().volume;
    stress.at_hand = std::any_of(hand.begin(), hand.end(), [&](NodeId held) {
      const mesh::Tet& corners = body.mesh().tet(tet);
      return std::find(corners.begin(), corners.end(), held) != corners.end();
    });
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const NodeId node = nodes[i];
    const auto around = body.tets_around(node);
    const auto solved = std::count_if(around.begin(), around.end(), [&](TetId tet) { return body.is_solved(tet); });
    const bool given =
        solved != inside[i] || supported[node.index()] != 0 || std::find(hand.begin(), hand.end(), node) != hand.end();
    (given ? boundary : interior).push_back(node);
    (given ? boundary_place : interior_place).push_back(static_cast<std::int32_t>(i));
  }
}

void LocalObject::Core::add_loads(const LocalLoads& loads) {
  load = VectorX::Zero(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t tet = 0; tet < tets.size(); ++tet)
    for (const std::int32_t node : local[tet]) load.segment<3>(3 * node) += 0.25 * shape[tet].volume * loads.body_force;
  if (loads.node_force.empty()) return;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    load.segment<3>(3 * static_cast<Eigen::Index>(i)) += loads.node_force[nodes[i].index()];
}

bool LocalObject::Core::factor_interior() {
  if (interior.empty()) return true;
  std::vector<bool> held(3 * nodes.size(), false);
  for (const std::int32_t node : boundary_place)
    for (std::int32_t i = 0; i < 3; ++i) held[static_cast<std::size_t>(3 * node + i)] = true;
  std::vector<std::int32_t> connectivity;
  for (const auto& of_tet : local) connectivity.insert(connectivity.end(), of_tet.begin(), of_tet.end());
  linalg::SymmetricBlockMatrix K(std::make_shared<const linalg::BlockPattern>(
      linalg::make_block_pattern(static_cast<std::int32_t>(nodes.size()), connectivity, 4)));
  Eigen::Matrix<double, 12, 12> element;
  for (std::size_t tet = 0; tet < tets.size(); ++tet) {
    element::small_strain_stiffness(elastic, shape[tet], element);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const std::int32_t row = local[tet][static_cast<std::size_t>(a)];
        const std::int32_t column = local[tet][static_cast<std::size_t>(b)];
        if (row < column || held[3 * static_cast<std::size_t>(row)] || held[3 * static_cast<std::size_t>(column)])
          continue;
        const auto at = 9 * static_cast<std::size_t>(K.pattern->find(row, column));
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(K.values.data() + at) +=
            element.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  return factor.analyse(*K.pattern, linalg::make_free_dofs(held)) == linalg::CholeskyOutcome::ok &&
         factor.factor(K.values) == linalg::CholeskyOutcome::ok && factor.smallest_pivot() > kSmallestPivot;
}

void LocalObject::Core::find_stresses() {
  for (std::size_t tet = 0; tet < tets.size(); ++tet) {
    gradients[tet] = element::displacement_gradient(shape[tet], corner_displacements(local[tet], u));
    stresses[tet].stress = element::small_strain_stress(elastic, gradients[tet]);
  }
}

LocalObject::LocalObject(const mesh::TornMesh& body, const material::Elastic& elastic, std::vector<TetId> tets,
                         std::span<const std::uint8_t> supported, std::span<const NodeId> hand, const LocalLoads& loads)
    : core_(std::make_unique<Core>()) {
  RHEXIS_CHECK(supported.size() == body.mesh().node_count(), "{} nodes, {} marks of support", body.mesh().node_count(),
               supported.size());
  core_->elastic = elastic;
  core_->tets = std::move(tets);
  core_->number(body, supported, hand);
  core_->add_loads(loads);
  const auto dofs = 3 * static_cast<Eigen::Index>(core_->nodes.size());
  core_->u = VectorX::Zero(dofs);
  core_->force = VectorX::Zero(dofs);
  core_->gradients.assign(core_->tets.size(), Mat3::Zero());
}

LocalObject::~LocalObject() = default;
LocalObject::LocalObject(LocalObject&&) noexcept = default;
LocalObject& LocalObject::operator=(LocalObject&&) noexcept = default;

const std::vector<TetId>& LocalObject::tets() const { return core_->tets; }
const std::vector<NodeId>& LocalObject::nodes() const { return core_->nodes; }
const std::vector<NodeId>& LocalObject::boundary() const { return core_->boundary; }
const std::vector<NodeId>& LocalObject::interior() const { return core_->interior; }
const VectorX& LocalObject::displacement() const { return core_->u; }
const std::vector<TetStress>& LocalObject::stresses() const { return core_->stresses; }
const std::vector<Mat3>& LocalObject::gradients() const { return core_->gradients; }

bool LocalObject::factor() {
  if (!core_->stable) core_->stable = core_->factor_interior();
  return *core_->stable;
}

bool LocalObject::solve(const VectorX& u_boundary) {
  Core& core = *core_;
  RHEXIS_CHECK(u_boundary.size() == 3 * static_cast<Eigen::Index>(core.boundary.size()),
               "{} boundary nodes are given {} displacements", core.boundary.size(), u_boundary.size());
  if (!factor()) return false;
  core.u.setZero();
  for (std::size_t i = 0; i < core.boundary.size(); ++i)
    core.u.segment<3>(3 * core.boundary_place[i]) = u_boundary.segment<3>(3 * static_cast<Eigen::Index>(i));

  if (!core.interior.empty()) {
    core.force = core.load;  // f_o - K_ob u_b, tet by tet; rows of the boundary are not read
    for (std::size_t tet = 0; tet < core.tets.size(); ++tet) {
      const element::LinearTet& shape = core.shape[tet];
      const Mat3 gradient = element::displacement_gradient(shape, corner_displacements(core.local[tet], core.u));
      const Mat3 stress = shape.volume * element::small_strain_stress(core.elastic, gradient);
      for (std::size_t k = 0; k < 4; ++k) core.force.segment<3>(3 * core.local[tet][k]) -= stress * shape.gradient[k];
    }
    core.factor.solve(core.force, core.force);
    for (const std::int32_t place : core.interior_place)
      core.u.segment<3>(3 * place) = core.force.segment<3>(3 * place);
  }
  core.find_stresses();
  return true;
}

void LocalObject::take(const VectorX& u) {
  RHEXIS_CHECK(u.size() == core_->u.size(), "{} nodes are given {} displacements", core_->nodes.size(), u.size());
  core_->u = u;
  core_->find_stresses();
}

void LocalObject::take(const VectorX& u, const std::function<void(TetStress&)>& set_stress) {
  take(u);
  for (TetStress& tet : core_->stresses) set_stress(tet);
}

}  // namespace rhexis::fracture
