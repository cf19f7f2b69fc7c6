#include <gmock/gmock.h>

#include "scene/rigid_motion.h"

namespace rhexis::scene::test {
namespace {

using model::HeldComponent;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<HeldComponent> hold(const std::vector<Vec3>& points, const std::string& axes) {
  std::vector<HeldComponent> held;
  for (const Vec3& point : points)
    for (const char axis : axes) held.push_back({point, axis - 'x'});
  return held;
}

std::vector<HeldComponent> operator+(std::vector<HeldComponent> a, const std::vector<HeldComponent>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The unit cube.
std::vector<std::string> free_of_cube(const std::vector<HeldComponent>& held) {
  return free_rigid_motions(held, 0.5 * Vec3::Ones(), std::sqrt(3.0));
}

TEST(RigidMotion, NothingHeldLeavesAllSix) {
  EXPECT_THAT(free_of_cube({}), ElementsAre("translation along x", "translation along y", "translation along z",
                                            "rotation about an axis along x through (0.5, 0.5, 0.5) m",
                                            "rotation about an axis along y through (0.5, 0.5, 0.5) m",
                                            "rotation about an axis along z through (0.5, 0.5, 0.5) m"));
}

// The point named is the one of the axis that is nearest to the centre of the body.
TEST(RigidMotion, APointIsAJoint) {
  EXPECT_THAT(free_of_cube(hold({{1, 0, 0}}, "xyz")),
              ElementsAre("rotation about an axis along x through (0.5, 0, 0) m",
                          "rotation about an axis along y through (1, 0.5, 0) m",
                          "rotation about an axis along z through (1, 0, 0.5) m"));
}

TEST(RigidMotion, AnEdgeIsAHinge) {
  EXPECT_THAT(free_of_cube(hold({{0, 1, 0}, {1, 1, 0}}, "xyz")),
              ElementsAre("rotation about an axis along x through (0.5, 1, 0) m"));
  EXPECT_THAT(free_of_cube(hold({{0, 0, 0}, {1, 1, 1}}, "xyz")),
              ElementsAre("rotation about an axis along (0.577, 0.577, 0.577) through (0.5, 0.5, 0.5) m"));
}

TEST(RigidMotion, ThreePointsHold) {
  EXPECT_THAT(free_of_cube(hold({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, "xyz")), IsEmpty());
}

TEST(RigidMotion, ASideOnRollers) {
  EXPECT_THAT(free_of_cube(hold({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}}, "x")),
              ElementsAre("translation along y", "translation along z",
                          "rotation about an axis along x through (0.5, 0.5, 0.5) m"));
  EXPECT_THAT(free_of_cube(hold({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}}, "yz")),
              ElementsAre("translation along x", "rotation about an axis along y through (0, 0.5, 0.5) m",
                          "rotation about an axis along z through (0, 0.5, 0.5) m"));
}

// Three components here, two there, one elsewhere: the least that holds a body, and each of them is needed.
TEST(RigidMotion, ThreeTwoOne) {
  const auto a = hold({{0, 0, 0}}, "xyz"), b = hold({{1, 0, 0}}, "yz"), c = hold({{0, 1, 0}}, "z");
  EXPECT_THAT(free_of_cube(a + b + c), IsEmpty());
  EXPECT_THAT(free_of_cube(a + b), ElementsAre("rotation about an axis along x through (0.5, 0, 0) m"));
  EXPECT_THAT(free_of_cube(a + hold({{1, 0, 0}}, "z") + c),
              ElementsAre("rotation about an axis along z through (0, 0, 0.5) m"));
  EXPECT_THAT(free_of_cube(hold({{0, 0, 0}}, "yz") + b + c), ElementsAre("translation along x"));
}

// The displacement (1, 1, 1) + (1, 1, 1) x X has no x at (0, 1, 0) and (0, 2, 1), no y at (0, 0, 1) and (1, 0, 2), and
// no z at (1, 0, 0): five components that leave a turn with a slide.
TEST(RigidMotion, ATurnThatSlidesIsAScrew) {
  const auto five = hold({{0, 1, 0}, {0, 2, 1}}, "x") + hold({{0, 0, 1}, {1, 0, 2}}, "y") + hold({{1, 0, 0}}, "z");
  EXPECT_THAT(free_of_cube(five),
              ElementsAre("screw motion about an axis along (0.577, 0.577, 0.577) through (0.5, 0.5, 0.5) m"));
}

TEST(RigidMotion, SizeAndPlaceDoNotMatter) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Vec3 origin = scale * Vec3(100.0, -50.0, 20.0);
    const auto at = [&](double x, double y, double z) -> Vec3 { return origin + scale * Vec3(x, y, z); };
    const Vec3 centre = at(0.5, 0.5, 0.5);
    EXPECT_THAT(free_rigid_motions(hold({at(0, 0, 0), at(1, 0, 0), at(0, 1, 0)}, "xyz"), centre, scale), IsEmpty());
    EXPECT_EQ(free_rigid_motions(hold({at(0, 0, 0), at(1, 0, 0)}, "xyz"), centre, scale).size(), 1U);
  }
}

TEST(RigidMotion, NearlyOnALineHoldsAndOnALineDoesNot) {
  EXPECT_THAT(free_of_cube(hold({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-4, 0}}, "xyz")), IsEmpty());
  EXPECT_EQ(free_of_cube(hold({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}}, "xyz")).size(), 1U);
}

}  // namespace
}  // namespace rhexis::scene::test
