#include "result/torn_fields.h"

#include <algorithm>
#include <array>

#include <Eigen/LU>

#include "element/cofactor.h"
#include "element/linear_tet.h"
#include "model/evaluation.h"
#include "result/fields.h"

namespace rhexis::result {
namespace {

using mesh::Centering;
using mesh::Field;

/// A field of numbers that `value` gives for each of `count` entities.
template <class Value>
Field numbers(std::string name, Centering centering, std::size_t count, const Value& value) {
  Field field{std::move(name), centering, 1, std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) field.values[i] = static_cast<double>(value(i));
  return field;
}

std::array<Vec3, 4> at_corners(const VectorX& u, const mesh::Tet& tet) {
  std::array<Vec3, 4> out;
  for (std::size_t a = 0; a < 4; ++a) out[a] = u.segment<3>(3 * tet[a].value());
  return out;
}

struct Solved {
  model::TetFields tets;
  std::vector<double> force;  ///< N, 3 per node: internal force minus weight
};

Solved evaluate(const mesh::TornMesh& body, const TornState& state) {
  const mesh::TetMesh& mesh = body.mesh();
  const Vec3 weight = state.body->density * state.body->gravity;  // N/m^3
  Solved out;
  out.tets = model::make_tet_fields(mesh.tet_count());
  std::fill(out.tets.J.begin(), out.tets.J.end(), 1.0);
  out.force.assign(3 * mesh.node_count(), 0.0);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const TetId id(t);
    if (!body.is_solved(id)) continue;
    const element::LinearTet tet = element::make_linear_tet(mesh::corners(mesh, id));
    const Mat3 gradient = element::displacement_gradient(tet, at_corners(*state.u, mesh.tet(id)));
    const Mat3 F = Mat3::Identity() + gradient;
    const Mat3 stress = state.stress ? state.stress(id) : element::small_strain_stress(state.body->elastic, gradient);
    model::set_tet(out.tets, t, F.determinant(), stress.trace() / 3.0, stress);
    const Mat3 nominal = state.stress ? Mat3(stress * element::cofactor(F)) : stress;  // first Piola-Kirchhoff
    for (std::size_t a = 0; a < 4; ++a) {
      const Vec3 force = tet.volume * (nominal * tet.gradient[a] - 0.25 * weight);
      for (std::size_t c = 0; c < 3; ++c)
        out.force[3 * mesh.tet(id)[a].index() + c] += force[static_cast<Eigen::Index>(c)];
    }
  }
  return out;
}

/// N, of the support on the body: what its held components need beside the loads; zero elsewhere. Copies are held as
/// their originals are.
Field reaction(const mesh::TornMesh& body, const TornState& state, const std::vector<double>& force) {
  Field field{"reaction", Centering::point, 3, std::vector<double>(force.size(), 0.0)};
  std::vector<bool> held(3 * body.intact_node_count());
  for (const model::PrescribedDof& support : state.body->supports) held[static_cast<std::size_t>(support.dof)] = true;
  for (std::size_t node = 0; node < body.mesh().node_count(); ++node) {
    const std::size_t original = body.original(NodeId(node)).index();
    for (std::size_t c = 0; c < 3; ++c) {
      if (!held[3 * original + c] || !body.is_alive(NodeId(node))) continue;
      const double dead = node == original && state.body->dead_force.size() > 0
                              ? state.body->dead_force[static_cast<Eigen::Index>(3 * node + c)]
                              : 0.0;
      field.values[3 * node + c] = force[3 * node + c] - dead;
    }
  }
  return field;
}

}  // namespace

std::vector<Field> make_torn_fields(const mesh::TornMesh& body, const TornState& state) {
  const std::size_t nodes = body.mesh().node_count();
  const std::size_t tets = body.mesh().tet_count();
  const Solved solved = evaluate(body, state);
  std::vector<Field> fields;
  fields.push_back({"displacement", Centering::point, 3, std::vector<double>(state.u->begin(), state.u->end())});
  fields.push_back(reaction(body, state, solved.force));
  fields.push_back(
      numbers("node_alive", Centering::point, nodes, [&](std::size_t n) { return body.is_alive(NodeId(n)); }));
  fields.push_back(numbers("original_node", Centering::point, nodes,
                           [&](std::size_t n) { return body.original(NodeId(n)).value(); }));
  for (Field& field : fields_of_tets(solved.tets)) fields.push_back(std::move(field));
  fields.push_back(numbers("alive", Centering::cell, tets, [&](std::size_t t) { return body.is_alive(TetId(t)); }));
  fields.push_back(numbers("frozen", Centering::cell, tets, [&](std::size_t t) { return body.is_frozen(TetId(t)); }));
  fields.push_back(numbers("original_tet", Centering::cell, tets, [](std::size_t t) { return t; }));
  Field local = numbers("local", Centering::cell, tets, [](std::size_t) { return 0; });
  for (const TetId tet : state.local) local.values[tet.index()] = 1.0;
  fields.push_back(std::move(local));
  return fields;
}

}  // namespace rhexis::result
