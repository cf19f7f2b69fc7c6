// A model with tets left out is that of the others alone, in their numbers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "tests/model/p1_support.h"

namespace rhexis::test {
namespace {

class LeftOutTets : public testing::TestWithParam<P1Case> {};

TEST_P(LeftOutTets, TheModelIsThatOfTheOthers) {
  const mesh::TetMesh mesh = distorted_box({3, 2, 2});
  std::vector<std::uint8_t> out(mesh.tet_count(), 0);
  mesh::TetMesh rest;
  rest.nodes = mesh.nodes;
  std::vector<std::size_t> tet;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    out[t] = t % 5 == 2 ? 1 : 0;
    if (out[t] != 0) continue;
    rest.tets.push_back(mesh.tets[t]);
    tet.push_back(t);
  }
  ASSERT_LT(tet.size(), mesh.tet_count());
  const auto whole = model::make_model(mesh, GetParam().settings, out);
  const auto alone = model::make_model(rest, GetParam().settings);
  model::State state = random_state(mesh, whole->pressure_unknowns());
  model::State part{state.u, VectorX(alone->pressure_unknowns())};
  for (std::size_t t = 0; t < mesh.tet_count() && state.lambda.size() > 0; ++t) {
    if (out[t] != 0) state.lambda[static_cast<Eigen::Index>(t)] = 0.0;
  }
  for (Eigen::Index t = 0; t < part.lambda.size(); ++t)
    part.lambda[t] = state.lambda[static_cast<Eigen::Index>(tet[static_cast<std::size_t>(t)])];

  const auto scratch = whole->make_scratch();
  const auto other = alone->make_scratch();
  model::Residual a;
  model::Residual b;
  EXPECT_TRUE(whole->residual(state, *scratch, a).finite);
  alone->residual(part, *other, b);
  EXPECT_GT(b.u.norm(), 0.0);
  EXPECT_LE((a.u - b.u).norm(), 1e-13 * b.u.norm());
  for (Eigen::Index t = 0; t < b.lambda.size(); ++t)
    EXPECT_NEAR(a.lambda[static_cast<Eigen::Index>(tet[static_cast<std::size_t>(t)])], b.lambda[t],
                1e-13 * b.lambda.norm());
  EXPECT_NEAR(whole->energy(state), alone->energy(part), 1e-12 * std::abs(alone->energy(part)));
  EXPECT_NEAR(whole->volume_change_norm(state), alone->volume_change_norm(part),
              1e-12 * alone->volume_change_norm(part));

  // What the tangent does to a displacement, and the lambdas left out for themselves.
  linalg::SaddleMatrix K = whole->make_tangent();
  linalg::SaddleMatrix L = alone->make_tangent();
  whole->tangent(state, *scratch, K);
  alone->tangent(part, *other, L);
  VectorX y(state.u.size());
  VectorX z(state.u.size());
  K.A.multiply(state.u, y);
  L.A.multiply(state.u, z);
  EXPECT_LE((y - z).norm(), 1e-13 * z.norm());
  for (std::size_t t = 0; t < mesh.tet_count() && K.C.rows() > 0; ++t) {
    if (out[t] == 0) continue;
    EXPECT_EQ(K.C.pattern->row_start[t + 1] - K.C.pattern->row_start[t], 1) << t;
    EXPECT_GT(K.C.values[static_cast<std::size_t>(K.C.pattern->row_start[t])], 0.0) << t;
  }
}

TEST_P(LeftOutTets, TheStressOfATetIsThatOfTheFields) {
  const mesh::TetMesh mesh = distorted_box({2, 2, 2});
  const auto body = model::make_model(mesh, GetParam().settings);
  const model::State state = random_state(mesh, body->pressure_unknowns());
  const model::TetFields fields = body->fields(state);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    Mat3 reference;
    Mat3 deformed;
    const NodeId origin = mesh.tets[t][0];
    for (int a = 0; a < 3; ++a) {
      const NodeId node = mesh.tets[t][static_cast<std::size_t>(a) + 1];
      reference.col(a) = mesh.node(node) - mesh.node(origin);
      deformed.col(a) = reference.col(a) + state.u.segment<3>(3 * Eigen::Index{node.value()}) -
                        state.u.segment<3>(3 * Eigen::Index{origin.value()});
    }
    const Mat3 stress = body->tet_state(state, TetId(t), deformed * reference.inverse()).stress;
    const double* of = &fields.stress[6 * t];
    Mat3 expected;
    expected << of[0], of[3], of[5], of[3], of[1], of[4], of[5], of[4], of[2];
    EXPECT_LE((stress - expected).norm(), 1e-10 * (1.0 + expected.norm())) << t;
  }
}

INSTANTIATE_TEST_SUITE_P(All, LeftOutTets, testing::ValuesIn(p1_cases()), p1_case_name);

}  // namespace
}  // namespace rhexis::test
