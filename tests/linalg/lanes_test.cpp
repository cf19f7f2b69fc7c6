#include "linalg/lanes.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <limits>

#include "linalg/chebyshev_inverse.h"
#include "linalg/pressure_patches.h"
#include "linalg/saddle_residual.h"
#include "linalg/side_by_side_cg.h"
#include "linalg/whole_rows.h"
#include "tests/linalg/random_systems.h"
#include "tests/support/box_problem.h"

namespace rhexis::linalg {
namespace {

constexpr double kRounding = 1e-15;
/// Single precision, rows of a few dozen terms.
constexpr double kSingle = 1e-6;
/// The same of a map that divides by what is left of sums that cancel, on pressures without any order.
constexpr double kSingleMap = 1e-5;

/// The oracle of every product here: one lane, which is that of a vector.
class LanesTest : public testing::Test {
 protected:
  LanesTest() {
    std::mt19937 random(7);
    K = test::random_saddle(90, 70, 60.0, 0.1, random);
    K.skew.emplace();
    K.skew->values.resize(K.A.values.size());
    for (double& value : K.skew->values) value = test::uniform(random);
  }
  template <int k>
  static Lanes<k> random_lanes(Eigen::Index rows, unsigned seed) {
    std::mt19937 random(seed);
    return Lanes<k>::NullaryExpr(rows, k, [&] { return test::uniform(random); });
  }
  SaddleMatrix K;
};

template <int k>
void expect_columns(const SaddleMatrix& K, const Lanes<k>& u, const Lanes<k>& p) {
  Lanes<k> yu(u.rows(), k);
  Lanes<k> yp(p.rows(), k);
  K.multiply(u, p, yu, yp);
  Lanes<k> of_p = u;
  K.B.add_transposed(p, -0.3, of_p);
  Lanes<k> of_u(p.rows(), k);
  K.B.multiply(u, of_u);
  WholeRows whole;
  whole.take(K.A);
  Lanes<k> single;
  whole.multiply(u, single);
  for (int lane = 0; lane < k; ++lane) {
    const VectorX u1 = u.col(lane);
    const VectorX p1 = p.col(lane);
    VectorX a(u.rows());
    VectorX b(p.rows());
    K.multiply(u1, p1, a, b);
    EXPECT_LT((a - yu.col(lane)).norm(), kRounding * a.norm());  // the skew part is summed in another order
    EXPECT_TRUE(b == yp.col(lane)) << "the same bits, lane " << lane;
    a = u1;
    K.B.add_transposed(p1, -0.3, a);
    K.B.multiply(u1, b);
    EXPECT_TRUE(a == of_p.col(lane) && b == of_u.col(lane));
    K.A.multiply(u1, a);
    EXPECT_LT((a - single.col(lane)).norm(), kSingle * a.norm());
  }
}

TEST_F(LanesTest, multiply_as_their_columns_do) {
  expect_columns<2>(K, random_lanes<2>(270, 1), random_lanes<2>(70, 2));
  expect_columns<4>(K, random_lanes<4>(270, 3), random_lanes<4>(70, 4));
}

TEST_F(LanesTest, dots_are_those_of_the_columns) {
  const FourLanes a = random_lanes<4>(300, 5);
  const FourLanes b = random_lanes<4>(300, 6);
  const PerLane<4> found = dots<4>(a, b);
  for (int lane = 0; lane < 4; ++lane) EXPECT_NEAR(found[lane], a.col(lane).dot(b.col(lane)), 1e-13);
}

template <int k>
void expect_inverse_of_columns(const ChebyshevInverse& inverse, const Lanes<k>& b) {
  ChebyshevInverse::Work work;
  Lanes<k> x;
  inverse.apply(b, x, work);
  for (int lane = 0; lane < k; ++lane) {
    VectorX one;
    inverse.apply(VectorX(b.col(lane)), one, work);
    EXPECT_LT((one - x.col(lane)).norm(), kSingleMap * one.norm());
  }
}

TEST_F(LanesTest, the_map_for_the_pressures_is_that_of_each) {
  const SymmetricCsr C =
      test::make_box_problem(test::make_box({6, 5, 4}, 0.1), {.mu = 1.0, .kappa = 25.0, .beta = 9.0}).K.C;
  const ChebyshevInverse inverse(C, 0.1);
  expect_inverse_of_columns<2>(inverse, random_lanes<2>(C.rows(), 8));
  expect_inverse_of_columns<4>(inverse, random_lanes<4>(C.rows(), 9));
}

/// Systems of one matrix that end at different times: one at once, one by its tolerance, one by its count.
TEST_F(LanesTest, conjugate_gradients_end_lane_by_lane) {
  const Eigen::Index size = K.A.rows() * 3;
  FourLanes b = random_lanes<4>(size, 10);
  b.col(0).setZero();
  const std::array<LaneTarget, 4> target{{{0.0, 50}, {1e-3, 200}, {1e-10, 3}, {1e-9, 0}}};
  FourLanes x = FourLanes::Zero(size, 4);
  FourLanes r = b;
  FourLanes followed = FourLanes::Zero(size, 4);
  CgLanes<4> work;
  work.resize(size);
  FourLanes direction;
  const auto results = conjugate_gradients<4>(
      [&](const FourLanes& v, FourLanes& y) {
        direction = v;
        K.A.multiply(v, y);
      },
      [](const FourLanes& v, FourLanes& z) { z = 0.01 * v; },
      [&](const PerLane<4>& step) {
        for (Eigen::Index i = 0; i < size; ++i) followed.row(i).array() += step * direction.row(i).array();
      },
      target, work, r, x);
  EXPECT_TRUE(followed == x) << "what is taken along";
  for (std::size_t l = 0; l < 4; ++l) {
    const auto lane = static_cast<Eigen::Index>(l);
    CgWorkspace one;
    one.resize(size);
    VectorX x1 = VectorX::Zero(size);
    VectorX r1 = b.col(lane);
    const CgResult expected = conjugate_gradients([&](const VectorX& v, VectorX& y) { K.A.multiply(v, y); },
                                                  [](const VectorX& v, VectorX& z) { z = 0.01 * v; }, target[l].norm,
                                                  target[l].most, one, r1, x1);
    EXPECT_EQ(results[l].iterations, expected.iterations) << lane;
    if (target[l].most > 0) {
      EXPECT_EQ(results[l].end, expected.end) << lane;
    }
    EXPECT_LT((x1 - x.col(lane)).norm(), 1e-12 * (1.0 + x1.norm())) << lane;
  }
}

/// A lane whose curvature is negative stops there, with what a step along it needs; the others go on.
TEST_F(LanesTest, negative_curvature_ends_a_lane_alone) {
  const VectorX diagonal = VectorX::LinSpaced(40, -1.0, 3.0);
  TwoLanes b = TwoLanes::Zero(40, 2);
  b(0, 0) = 1.0;  // of the negative entry
  b.col(1).tail(20).setOnes();
  TwoLanes r = b;
  TwoLanes x = TwoLanes::Zero(40, 2);
  CgLanes<2> work;
  work.resize(40);
  const auto results = conjugate_gradients<2>([&](const TwoLanes& v, TwoLanes& y) { y = diagonal.asDiagonal() * v; },
                                              [](const TwoLanes& v, TwoLanes& z) { z = v; }, [](const PerLane<2>&) {},
                                              {{{1e-12, 100}, {1e-12, 100}}}, work, r, x);
  EXPECT_EQ(results[0].end, CgEnd::negative_curvature);
  EXPECT_EQ(results[0].iterations, 1);
  EXPECT_DOUBLE_EQ(results[0].slope, 1.0);
  EXPECT_DOUBLE_EQ(results[0].curvature, -1.0);
  EXPECT_TRUE(work.p.col(0) == b.col(0));
  EXPECT_TRUE(x.col(0).isZero(0.0));
  EXPECT_EQ(results[1].end, CgEnd::converged);
  EXPECT_LT((x.col(1).tail(20) - diagonal.tail(20).cwiseInverse()).norm(), 1e-11);
}

}  // namespace
}  // namespace rhexis::linalg
