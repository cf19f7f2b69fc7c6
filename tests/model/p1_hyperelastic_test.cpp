// What is particular to PSH: the condensed form, the jump matrix, fields, inversion; and auto_beta.

#include <gtest/gtest.h>

#include <limits>

#include "mesh/surface.h"
#include "model/pressure_matrix.h"
#include "model/stabilisation.h"
#include "tests/model/p1_support.h"

namespace rhexis::test {
namespace {

model::ModelSettings hyperelastic(double beta, double c2 = kLaw.c2) {
  model::ModelSettings settings;
  settings.kind = model::ModelKind::hyperelastic;
  settings.law = {kLaw.c1, c2, kLaw.kappa};
  settings.beta = beta;
  settings.initial_lambda = 300.0;
  return settings;
}

/// P = dW/dF of W = c1 (I1bar - 3) + c2 (I2bar - 3) + kappa/2 (J - 1)^2, from dI1/dF = 2 F, dI2/dF = 2 (I1 F - F C),
/// dJ/dF = cof F: written without C^-1 or the law's code.
Mat3 displacement_form_stress(const Mat3& F) {
  const double J = F.determinant(), a = std::pow(J, -2.0 / 3.0);
  const Mat3 C = F.transpose() * F, inverse = F.inverse().transpose();
  const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - (C * C).trace());
  return 2.0 * kLaw.c1 * a * (F - I1 / 3.0 * inverse) +
         2.0 * kLaw.c2 * a * a * (I1 * F - F * C - 2.0 / 3.0 * I2 * inverse) + kLaw.kappa * (J - 1.0) * J * inverse;
}

/// Section 1.2: with beta = 0 and lambda = kappa (J - 1), force and condensed tangent are those of the displacement
/// form.
TEST(P1Hyperelastic, WithoutStabilisationItIsTheDisplacementForm) {
  const mesh::TetMesh mesh = distorted_box({3, 2, 2});
  const auto model = model::make_model(mesh, hyperelastic(0.0));
  model::State state = random_state(mesh, model->pressure_unknowns());
  const auto with_pressure = [&](model::State at) {
    const model::TetFields fields = model->fields(at);
    for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
      at.lambda[static_cast<Eigen::Index>(t)] = kLaw.kappa * (fields.J[t] - 1.0);
    }
    return at;
  };
  const auto force = [&](const VectorX& u) {
    VectorX out = VectorX::Zero(u.size());
    for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
      const mesh::Tet& tet = mesh.tets[t];
      const std::array<Vec3, 4> X = mesh::corners(mesh, TetId(t));
      Mat3 edges, moved;
      for (int a = 0; a < 3; ++a) {
        const auto n = static_cast<std::size_t>(a + 1);
        edges.col(a) = X[n] - X[0];
        moved.col(a) = edges.col(a) + u.segment<3>(3 * tet[n].value()) - u.segment<3>(3 * tet[0].value());
      }
      const Mat3 nodal =
          edges.determinant() / 6.0 * displacement_form_stress(moved * edges.inverse()) * edges.inverse().transpose();
      for (int a = 0; a < 3; ++a) {
        out.segment<3>(3 * tet[static_cast<std::size_t>(a + 1)].value()) += nodal.col(a);
        out.segment<3>(3 * tet[0].value()) -= nodal.col(a);
      }
    }
    return out;
  };
  state = with_pressure(state);
  const Evaluated at = evaluate(*model, state);
  const Eigen::Index dofs = state.u.size(), tets = state.lambda.size();
  const VectorX expected = force(state.u);
  EXPECT_LT((at.residual.head(dofs) - expected).norm(), 1e-13 * expected.norm());
  EXPECT_LT(at.residual.tail(tets).norm(), 1e-13 * model->volume_change_norm(state));

  // A + B C^-1 B^T, C = diag(V) / kappa, against differences of the displacement form's force.
  const Eigen::MatrixXd B = at.tangent.topRightCorner(dofs, tets);
  const Eigen::MatrixXd condensed =
      at.tangent.topLeftCorner(dofs, dofs) -
      B * at.tangent.bottomRightCorner(tets, tets).diagonal().cwiseInverse().asDiagonal() * B.transpose();
  VectorX direction(dofs);
  std::mt19937 random(4);
  for (double& value : direction) value = std::uniform_real_distribution<double>(-0.01, 0.01)(random);
  const double h = 1e-3;
  const auto difference = [&](double s) {
    return VectorX(force(state.u + s * direction) - force(state.u - s * direction));
  };
  const VectorX measured = (45.0 * difference(h) - 9.0 * difference(2 * h) + difference(3 * h)) / (60.0 * h);
  EXPECT_LT((condensed * direction - measured).norm(), 1e-10 * measured.norm());
}

TEST(PressureMatrix, IsTheJumpTermOfEquationFive) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 2});
  const double beta = 7.0, kappa = 2e5;
  const linalg::SymmetricCsr C = model::make_pressure_matrix(mesh, kappa, beta);
  VectorX lambda(static_cast<Eigen::Index>(mesh.tet_count())), product(lambda.size());
  for (Eigen::Index t = 0; t < lambda.size(); ++t) lambda[t] = std::sin(3.0 * static_cast<double>(t));
  C.multiply(lambda, product);
  double expected = 0.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    expected += mesh::signed_volume(mesh, TetId(t)) * lambda[static_cast<Eigen::Index>(t)] *
                lambda[static_cast<Eigen::Index>(t)] / kappa;
  }
  for (const mesh::InteriorFace& face : mesh::find_faces(mesh).interior) {
    const double jump = lambda[face.first.tet.value()] - lambda[face.second.tet.value()];
    for (const TetId tet : {face.first.tet, face.second.tet}) {
      expected += beta * mesh::longest_edge(mesh, tet) / kappa * mesh::face_area(mesh, face.first) * jump * jump;
    }
  }
  EXPECT_NEAR(lambda.dot(product), expected, 1e-13 * expected);
  // A constant lambda has no jumps.
  lambda.setOnes();
  C.multiply(lambda, product);
  EXPECT_NEAR(product.sum(), mesh::total_volume(mesh) / kappa, 1e-13 * beta);
  EXPECT_EQ(model::make_pressure_matrix(mesh, kappa, 0.0).values.size(), mesh.tet_count());
}

TEST(P1Hyperelastic, LambdaIsTheMeanCauchyStress) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 2});
  const auto model = model::make_model(mesh, hyperelastic(10.0));
  const model::State state = random_state(mesh, model->pressure_unknowns());
  const model::TetFields fields = model->fields(state);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    EXPECT_EQ(fields.lambda[t], state.lambda[static_cast<Eigen::Index>(t)]);
    const double mean = (fields.stress[6 * t] + fields.stress[6 * t + 1] + fields.stress[6 * t + 2]) / 3.0;
    EXPECT_NEAR(mean, fields.lambda[t], 1e-9 * kLaw.kappa * 1e-3);
  }
}

TEST(P1Hyperelastic, InversionIsCountedAndNamed) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 2});
  const auto model = model::make_model(mesh, hyperelastic(1.0));
  EXPECT_FALSE(model->allows_inversion());
  model::State state = model->initial_state();
  const mesh::Tet& victim = mesh.tets[5];
  // One corner through the opposite face: that tet turns inside out.
  const Vec3 face = (mesh.node(victim[1]) + mesh.node(victim[2]) + mesh.node(victim[3])) / 3.0;
  state.u.segment<3>(3 * victim[0].value()) = 1.5 * (face - mesh.node(victim[0]));
  const Evaluated at = evaluate(*model, state);
  EXPECT_GE(at.of_residual.inverted_tets, 1);
  EXPECT_LT(at.of_residual.min_J, 0.0);
  EXPECT_EQ(at.of_residual.worst_tet, at.of_tangent.worst_tet);
  EXPECT_EQ(at.of_residual.inverted_tets, at.of_tangent.inverted_tets);
}

TEST(P1Hyperelastic, NanNamesItsTet) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 2});
  const auto model = model::make_model(mesh, hyperelastic(1.0));
  model::State state = model->initial_state();
  state.lambda[11] = std::numeric_limits<double>::quiet_NaN();
  const Evaluated at = evaluate(*model, state);
  EXPECT_FALSE(at.of_residual.finite);
  EXPECT_EQ(at.of_residual.worst_tet, TetId(11));
  EXPECT_FALSE(at.of_tangent.finite);
  EXPECT_EQ(at.of_tangent.worst_tet, TetId(11));
}

TEST(P1Hyperelastic, PreconditionerBlocksAreDefinite) {
  mesh::TetMesh mesh = distorted_box({2, 2, 2});
  mesh.nodes.emplace_back(5.0, 5.0, 5.0);  // without a tet
  for (const P1Case& c : p1_cases()) {
    const auto model = model::make_model(mesh, c.settings);
    const linalg::BlockPreconditioner blocks = model->preconditioner();
    linalg::SaddleMatrix as_saddle;
    as_saddle.A = blocks.A0;
    const Eigen::VectorXd spectrum = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(as_saddle)).eigenvalues();
    // Six rigid motions and the loose node's three dofs; nothing negative beyond rounding.
    EXPECT_GT(spectrum[0], -1e-12 * spectrum.tail<1>()[0]) << c.name;
    EXPECT_LT(spectrum[8], 1e-12 * spectrum.tail<1>()[0]) << c.name;
    EXPECT_GT(spectrum[9], 1e-6 * spectrum.tail<1>()[0]) << c.name;
    EXPECT_EQ(blocks.S0.rows(), model->pressure_unknowns());
    for (std::int32_t t = 0; t < blocks.S0.rows(); ++t) {
      const auto last = static_cast<std::size_t>(blocks.S0.pattern->row_start[static_cast<std::size_t>(t) + 1]) - 1;
      EXPECT_GT(blocks.S0.values[last], mesh::signed_volume(mesh, TetId(t)) / c.settings.law.shear_modulus()) << t;
    }
    EXPECT_GT(model->memory_bytes(), 100 * mesh.tet_count());
  }
}

TEST(P1Corotated, InvertedFlatAndCollapsedTetsStayFinite) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 2});
  model::ModelSettings settings;
  settings.kind = model::ModelKind::corotated;
  settings.elastic = kElastic;
  for (const auto tangent : {model::CorotatedTangent::exact, model::CorotatedTangent::warped}) {
    settings.corotated_tangent = tangent;
    const auto model = model::make_model(mesh, settings);
    EXPECT_TRUE(model->allows_inversion());
    model::State state = model->initial_state();
    const std::vector<Mat3> maps{Mat3::Zero(),
                                 -Mat3::Identity(),
                                 Vec3(1.0, 1.0, 0.0).asDiagonal().toDenseMatrix(),
                                 Vec3(1.0, 1.0, -1.0).asDiagonal().toDenseMatrix(),
                                 Vec3(1.0, 0.0, 0.0).asDiagonal().toDenseMatrix(),
                                 Vec3(1e8, 1.0, -1.0).asDiagonal().toDenseMatrix(),
                                 1e-160 * Mat3::Identity()};
    for (std::size_t m = 0; m < maps.size(); ++m) {
      for (std::size_t n = 0; n < mesh.node_count(); ++n) {
        state.u.segment<3>(static_cast<Eigen::Index>(3 * n)) = maps[m] * mesh.nodes[n] - mesh.nodes[n];
      }
      const Evaluated at = evaluate(*model, state);
      EXPECT_TRUE(at.of_residual.finite) << m;
      EXPECT_TRUE(at.of_tangent.finite) << m;
      EXPECT_TRUE(at.residual.allFinite()) << m;
      EXPECT_TRUE(at.tangent.allFinite()) << m;
      EXPECT_TRUE(std::isfinite(at.energy)) << m;
    }
  }
}

TEST(AutoBeta, MakesTheLeastDampedSpuriousPressureAsStiffAsAPhysicalOne) {
  const auto at_poisson = [&](double nu) { return model::auto_beta(material::to_mooney_rivlin({1e5, nu})); };
  EXPECT_EQ(at_poisson(0.1), 0.0);
  EXPECT_NEAR(at_poisson(0.2), 0.0, 1e-14);
  EXPECT_NEAR(at_poisson(0.45), 1.5625, 1e-12);
  EXPECT_NEAR(at_poisson(0.49), 9.0625, 1e-11);
  EXPECT_NEAR(at_poisson(0.4999), 937.1875, 1e-8);
  // (1 + 4 beta) / kappa = 3 / (4 mu), and the split of c1 + c2 does not matter.
  const double beta = model::auto_beta(kLaw);
  EXPECT_NEAR((1.0 + 4.0 * beta) / kLaw.kappa, 0.75 / kLaw.shear_modulus(), 1e-18);
  EXPECT_EQ(beta, model::auto_beta({kLaw.c1 + kLaw.c2, 0.0, kLaw.kappa}));
}

TEST(SmoothingLength, GrowsWithTheRootOfBetaAndTheMesh) {
  const mesh::TetMesh mesh = mesh::make_structured_box(Vec3(1.0, 1.0, 1.0), {2, 2, 2});
  const mesh::TetMesh half = mesh::make_structured_box(Vec3(1.0, 1.0, 1.0), {4, 4, 4});
  EXPECT_EQ(model::smoothing_length(mesh, kLaw, 0.0), 0.0);
  const double length = model::smoothing_length(mesh, kLaw, 4.0);
  // h = sqrt(1/2), D = h^2 / 2, the elastic compliance beside that of the volume.
  EXPECT_NEAR(length, std::sqrt(0.25 * 4.0 / (1.0 + 0.75 * kLaw.kappa / kLaw.shear_modulus())), 1e-14);
  EXPECT_NEAR(model::smoothing_length(mesh, kLaw, 16.0), 2.0 * length, 1e-14);
  EXPECT_NEAR(model::smoothing_length(half, kLaw, 4.0), 0.5 * length, 1e-14);
  EXPECT_EQ(model::smoothing_length({}, kLaw, 4.0), 0.0);
}

}  // namespace
}  // namespace rhexis::test
