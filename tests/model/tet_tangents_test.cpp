// What a tangent adds up, tet by tet, adds up to it.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/model/p1_support.h"

namespace rhexis::test {
namespace {

class TetTangents : public testing::TestWithParam<P1Case> {};

TEST_P(TetTangents, AddUpToTheTangent) {
  const mesh::TetMesh mesh = distorted_box({3, 2, 2});
  const auto body = model::make_model(mesh, GetParam().settings);
  const auto scratch = body->make_scratch();
  const model::State state = random_state(mesh, body->pressure_unknowns());
  linalg::SaddleMatrix K = body->make_tangent();
  body->tangent(state, *scratch, K);
  std::vector<double> blocks;
  std::vector<double> coupling;
  ASSERT_TRUE(body->tet_tangents(state, *scratch, blocks, coupling).finite);
  ASSERT_EQ(blocks.size(), 90 * mesh.tet_count());

  linalg::SymmetricBlockMatrix sum(K.A.pattern);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    mesh::Tet nodes = mesh.tets[t];
    std::sort(nodes.begin(), nodes.end());
    const double* block = blocks.data() + 90 * t;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b <= a; ++b, block += 9) {
        double* const to =
            sum.values.data() + 9 * std::ptrdiff_t{K.A.pattern->find(nodes[a].value(), nodes[b].value())};
        for (int i = 0; i < 9; ++i) to[i] += block[i];
      }
    }
  }
  double largest = 0.0;
  for (const double value : K.A.values) largest = std::max(largest, std::abs(value));
  for (std::size_t i = 0; i < sum.values.size(); ++i) ASSERT_NEAR(sum.values[i], K.A.values[i], 1e-14 * largest);
  EXPECT_TRUE(coupling == K.B.values);  // one row a tet in either
}

INSTANTIATE_TEST_SUITE_P(All, TetTangents, testing::ValuesIn(p1_cases()), p1_case_name);

}  // namespace
}  // namespace rhexis::test
