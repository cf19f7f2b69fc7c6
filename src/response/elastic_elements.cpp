#include "response/elastic_elements.h"

#include <utility>

#include "base/check.h"
#include "element/linear_tet.h"

namespace rhexis::response {
namespace {

using linalg::ElementMatrix;
using linalg::ElementVector;

void tet_stiffness(const mesh::TornMesh& mesh, const ElasticModel& model, TetId tet, ElementMatrix& out) {
  const element::LinearTet shape = element::make_linear_tet(mesh::corners(mesh.mesh(), tet));
  element::small_strain_stiffness(model.body.elastic, shape, out);
}

/// rho g V / 4 at each corner.
ElementVector tet_weight(const mesh::TornMesh& mesh, const ElasticModel& model, TetId tet) {
  const Vec3 share = model.body.density / 4.0 * mesh::signed_volume(mesh.mesh(), tet) * model.body.gravity;
  return share.replicate<4, 1>();
}

/// The prescribed displacements of its corners, zero where free. False: all are zero.
bool prescribed(const mesh::TornMesh& mesh, const ElasticModel& model, TetId tet, ElementVector& out) {
  if (!model.moves_supports) return false;
  for (int a = 0; a < 4; ++a) {
    const NodeId node = mesh.original(mesh.mesh().tet(tet)[static_cast<std::size_t>(a)]);
    out.segment<3>(3 * a) = model.value.segment<3>(3 * Eigen::Index{node.value()});
  }
  return !out.isZero(0.0);
}

}  // namespace

ElasticModel::ElasticModel(ElasticBody of, std::size_t intact_nodes)
    : body(std::move(of)),
      held(3 * intact_nodes, 0),
      value(VectorX::Zero(static_cast<Eigen::Index>(3 * intact_nodes))) {
  RHEXIS_CHECK(body.dead_force.size() == 0 || body.dead_force.size() == value.size(), "{} dead forces for {} dofs",
               body.dead_force.size(), value.size());
  for (const model::PrescribedDof& support : body.supports) {
    held[static_cast<std::size_t>(support.dof)] = 1;
    value[support.dof] = support.value;
    moves_supports = moves_supports || support.value != 0.0;
  }
}

ElasticElements::ElasticElements(const mesh::TornMesh& mesh, const ElasticModel& model) : mesh_(mesh), model_(model) {}

std::int32_t ElasticElements::node_count() const { return static_cast<std::int32_t>(mesh_.mesh().node_count()); }
std::int32_t ElasticElements::element_count() const { return static_cast<std::int32_t>(mesh_.mesh().tet_count()); }

bool ElasticElements::is_active(std::int32_t element) const { return mesh_.is_solved(TetId(element)); }

std::array<std::int32_t, 4> ElasticElements::nodes(std::int32_t element) const {
  const mesh::Tet& tet = mesh_.mesh().tet(TetId(element));
  return {tet[0].value(), tet[1].value(), tet[2].value(), tet[3].value()};
}

void ElasticElements::stiffness(std::int32_t element, ElementMatrix& out) const {
  tet_stiffness(mesh_, model_, TetId(element), out);
}

void ElasticElements::load(std::int32_t element, ElementVector& out) const {
  const TetId tet(element);
  out = tet_weight(mesh_, model_, tet);
  ElementVector u;
  if (!prescribed(mesh_, model_, tet, u)) return;
  ElementMatrix K;
  tet_stiffness(mesh_, model_, tet, K);
  out -= K * u;
}

Vec3 ElasticElements::node_load(std::int32_t node) const {
  const NodeId id(node);
  if (model_.body.dead_force.size() == 0 || id.index() >= mesh_.intact_node_count()) return Vec3::Zero();
  return model_.body.dead_force.segment<3>(3 * Eigen::Index{node});
}

unsigned ElasticElements::free_components(std::int32_t node) const {
  const std::uint8_t* const held = model_.held.data() + 3 * mesh_.original(NodeId(node)).index();
  return (held[0] == 0 ? 1U : 0U) | (held[1] == 0 ? 2U : 0U) | (held[2] == 0 ? 4U : 0U);
}

double support_energy(const mesh::TornMesh& mesh, const ElasticModel& model) {
  if (!model.moves_supports) return 0.0;
  double sum = 0.0;
  ElementVector u;
  ElementMatrix K;
  for (std::size_t t = 0; t < mesh.mesh().tet_count(); ++t) {
    const TetId tet(t);
    if (!mesh.is_solved(tet) || !prescribed(mesh, model, tet, u)) continue;
    tet_stiffness(mesh, model, tet, K);
    sum += 0.5 * u.dot(K * u) - tet_weight(mesh, model, tet).dot(u);
  }
  return sum;
}

double potential_energy(const mesh::TornMesh& mesh, const ElasticModel& model, const VectorX& u) {
  double sum = 0.0;
  ElementMatrix K;
  ElementVector of_tet;
  for (std::size_t t = 0; t < mesh.mesh().tet_count(); ++t) {
    const TetId tet(t);
    if (!mesh.is_solved(tet)) continue;
    for (int a = 0; a < 4; ++a)
      of_tet.segment<3>(3 * a) =
          u.segment<3>(3 * Eigen::Index{mesh.mesh().tet(tet)[static_cast<std::size_t>(a)].value()});
    tet_stiffness(mesh, model, tet, K);
    sum += 0.5 * of_tet.dot(K * of_tet) - tet_weight(mesh, model, tet).dot(of_tet);
  }
  // Out of the solve the displacement is zero.
  return model.body.dead_force.size() == 0 ? sum
                                           : sum - model.body.dead_force.dot(u.head(model.body.dead_force.size()));
}

}  // namespace rhexis::response
