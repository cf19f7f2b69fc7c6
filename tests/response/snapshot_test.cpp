#include "response/snapshot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "response/publish.h"
#include "tests/support/counted_allocations.h"

namespace rhexis::response::test {
namespace {

using rhexis::test::allocations;

ContactLaw some_law(ContactMode mode) {
  SurfacePoint point;
  point.count = 3;
  point.weight = Vec3(0.2, 0.5, 0.3);
  point.normal = Vec3(1.0, 2.0, -2.0) / 3.0;
  Eigen::MatrixXd compliance(9, 9);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) compliance(i, j) = (i == j ? 0.02 : 0.0) + 0.001 * std::cos(i + j);
  }
  return make_contact_law(point, ContactRule::consistent, mode, compliance, VectorX::LinSpaced(9, -1e-3, 2e-3));
}

TEST(ForceSnapshot, FeelsWhatTheLawSays) {
  for (const ContactMode mode : {ContactMode::hold, ContactMode::push}) {
    const ContactLaw law = some_law(mode);
    const ForceSnapshot snapshot = make_snapshot(
        law, {.number = 9, .topology = 7, .grasp = 3, .force_limit = 4.0e3, .start = Vec3(1e-3, -2e-3, 5e-4)});
    EXPECT_EQ(snapshot.topology, 7u);
    EXPECT_EQ(snapshot.number, 9u);
    EXPECT_EQ(snapshot.grasp, 3u);
    EXPECT_EQ(snapshot.force_limit, 4.0e3);
    EXPECT_EQ(snapshot.start, (std::array<double, 3>{1e-3, -2e-3, 5e-4}));
    int pressed = 0;
    for (int k = 0; k < 50; ++k) {
      const Vec3 hand(0.01 * std::sin(k), 0.02 * std::cos(2 * k), 0.015 * std::sin(3 * k));
      // The same sums of three products in another order.
      EXPECT_LT((force_at(snapshot, hand).force - law.force(hand)).norm(), 1e-15 * (1.0 + law.force(hand).norm()));
      pressed += law.force(hand).norm() > 0.0 ? 1 : 0;
    }
    EXPECT_GT(pressed, 10);
  }
}

TEST(ForceSnapshot, IsLimitedInLengthAndNotInDirection) {
  const ContactLaw law = some_law(ContactMode::hold);
  const Vec3 hand(0.05, -0.02, 0.01);
  const double full = law.force(hand).norm();
  const Felt felt = force_at(make_snapshot(law, {.force_limit = 0.25 * full}), hand);
  EXPECT_TRUE(felt.limited);
  EXPECT_NEAR(felt.force.norm(), 0.25 * full, 1e-15 * full);
  EXPECT_NEAR(felt.force.normalized().dot(law.force(hand).normalized()), 1.0, 1e-15);
  EXPECT_FALSE(force_at(make_snapshot(law, {.force_limit = 2.0 * full}), hand).limited);
}

TEST(ForceSnapshot, IsZeroWithoutAHoldAndForWhatIsNotANumber) {
  ForceSnapshot snapshot = make_snapshot(some_law(ContactMode::hold), {});
  const Vec3 hand(0.05, -0.02, 0.01);
  EXPECT_GT(force_at(snapshot, hand).force.norm(), 0.0);
  EXPECT_TRUE(force_at(snapshot, Vec3(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0)).force.isZero(0.0));
  EXPECT_TRUE(force_at(snapshot, Vec3(0.0, 0.0, std::numeric_limits<double>::infinity())).force.isZero(0.0));
  snapshot.flags &= ~static_cast<std::uint32_t>(ForceSnapshot::is_held);
  EXPECT_TRUE(force_at(snapshot, hand).force.isZero(0.0));
  EXPECT_TRUE(force_at(ForceSnapshot{}, hand).force.isZero(0.0));
}

TEST(ForceSnapshot, TakesNoMemoryInAThousandTicks) {
#ifndef RHEXIS_COUNTS_MALLOC
  GTEST_SKIP() << "the sanitizer has its own malloc";
#else
  long before = allocations;
  { const VectorX counted = VectorX::Zero(100); }
  EXPECT_GT(allocations, before) << "the count has to see Eigen's malloc";
  before = allocations;
  static double* volatile seen = nullptr;  // what nobody sees may be left out
  seen = new double;
  delete seen;
  EXPECT_GT(allocations, before) << "and operator new";

  for (const ContactMode mode : {ContactMode::hold, ContactMode::push}) {
    const ContactLaw law = some_law(mode);
    Vec3 sum = Vec3::Zero();
    Eigen::Matrix<double, 9, 1> nodal = Eigen::Matrix<double, 9, 1>::Zero();
    before = allocations;
    for (int tick = 0; tick < 1000; ++tick) {
      const Vec3 hand(1e-5 * tick, -2e-5 * tick, 1e-3);
      const ForceSnapshot snapshot = make_snapshot(law, {.force_limit = 3.0});
      sum += force_at(snapshot, hand).force;
      sum += law.force(hand);
      nodal += law.nodal_forces(hand);
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(sum.norm() + nodal.norm(), 0.0);
  }
#endif
}

}  // namespace
}  // namespace rhexis::response::test
