#include "result/fields.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "mesh/surface.h"

namespace rhexis::result {
namespace {

using mesh::Centering;
using mesh::Field;

/// From xx yy zz xy yz xz.
Mat3 tensor(const double* s) {
  Mat3 m;
  m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return m;
}

/// The first `count` nodes of a node-major vector field; the mesh's nodes come first in every displacement space.
Field node_field(std::string name, const VectorX& values, std::size_t count) {
  return {std::move(name), Centering::point, 3, std::vector<double>(values.data(), values.data() + 3 * count)};
}

/// Forces at the vertices alone: a node in the middle of an edge hands half of its force to each end, which keeps the
/// total force and moment.
VectorX on_vertices(const model::DisplacementSpace& space, VectorX force) {
  const std::size_t vertices = space.node_count() - space.edges.size();
  for (std::size_t e = 0; e < space.edges.size(); ++e)
    for (const NodeId end : space.edges[e])
      force.segment<3>(3 * end.value()) += 0.5 * force.segment<3>(static_cast<Eigen::Index>(3 * (vertices + e)));
  return force;
}

}  // namespace

std::vector<Field> fields_of_tets(const model::TetFields& tets) {
  const std::size_t count = tets.J.size();
  Field pressure{"pressure", Centering::cell, 1, std::vector<double>(count)};
  Field principal{"principal_max", Centering::cell, 1, std::vector<double>(count)};
  Field mises{"von_mises", Centering::cell, 1, std::vector<double>(count)};
  for (std::size_t t = 0; t < count; ++t) {
    const double* s = tets.stress.data() + 6 * t;
    pressure.values[t] = -tets.lambda[t];
    principal.values[t] = Eigen::SelfAdjointEigenSolver<Mat3>(tensor(s), Eigen::EigenvaluesOnly).eigenvalues()[2];
    const double normal = std::pow(s[0] - s[1], 2) + std::pow(s[1] - s[2], 2) + std::pow(s[2] - s[0], 2);
    const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    mises.values[t] = std::sqrt(0.5 * normal + 3.0 * shear);
  }
  std::vector<Field> fields;
  fields.push_back({"lambda", Centering::cell, 1, tets.lambda});
  fields.push_back(std::move(pressure));
  fields.push_back({"stress", Centering::cell, 6, tets.stress});
  fields.push_back(std::move(principal));
  fields.push_back(std::move(mises));
  fields.push_back({"J", Centering::cell, 1, tets.J});
  return fields;
}

std::vector<Field> make_fields(const mesh::TetMesh& mesh, const model::Model& model, const model::State& state,
                               const model::TetFields& tets, const VectorX& reaction) {
  std::vector<Field> fields;
  fields.push_back(node_field("displacement", state.u, mesh.node_count()));
  if (reaction.size() > 0)
    fields.push_back(node_field("reaction", on_vertices(model.space(), reaction), mesh.node_count()));
  if (model.pressure_at_vertices())
    fields.push_back({"lambda", Centering::point, 1, std::vector<double>(state.lambda.begin(), state.lambda.end())});
  for (Field& field : fields_of_tets(tets)) fields.push_back(std::move(field));
  return fields;
}

Measures measure(const mesh::TetMesh& mesh, const model::State& state, const model::TetFields& tets) {
  Measures measures;
  double reference = 0.0;
  double deformed = 0.0;
  double lambda_size = 0.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const double volume = mesh::signed_volume(mesh, TetId(t));
    reference += volume;
    deformed += volume * tets.J[t];
    lambda_size += volume * std::abs(tets.lambda[t]);
    if (tets.J[t] <= 0.0) ++measures.inverted_tets;
  }
  measures.volume_ratio = deformed / reference;

  double jump_square = 0.0;
  double area = 0.0;
  for (const mesh::InteriorFace& face : mesh::find_faces(mesh).interior) {
    const double face_size = mesh::face_area(mesh, face.first);
    const double jump = tets.lambda[face.first.tet.index()] - tets.lambda[face.second.tet.index()];
    jump_square += face_size * jump * jump;
    area += face_size;
  }
  const double mean_lambda = lambda_size / reference;
  if (area > 0.0 && mean_lambda > 0.0) measures.pressure_jump = std::sqrt(jump_square / area) / mean_lambda;

  for (std::size_t n = 0; n < mesh.node_count(); ++n)
    measures.max_displacement =
        std::max(measures.max_displacement, state.u.segment<3>(static_cast<Eigen::Index>(3 * n)).norm());
  return measures;
}

}  // namespace rhexis::result
