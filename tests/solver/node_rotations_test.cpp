#include "solver/node_rotations.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "mesh/generate.h"

namespace rhexis::solver {
namespace {

class NodeRotationsTest : public testing::Test {
 protected:
  NodeRotationsTest() : space_(model::make_p1_space(mesh::make_structured_box(Vec3(0.04, 0.04, 0.12), {2, 2, 6}))) {}
  /// u = F X - X.
  VectorX moved(const Mat3& F) const {
    VectorX u(static_cast<Eigen::Index>(space_.dof_count()));
    for (std::size_t i = 0; i < space_.nodes.size(); ++i)
      u.segment<3>(static_cast<Eigen::Index>(3 * i)) = F * space_.nodes[i] - space_.nodes[i];
    return u;
  }
  model::DisplacementSpace space_;
};

TEST_F(NodeRotationsTest, AreTheRotationOfAUniformMotion) {
  const Mat3 R = Eigen::AngleAxisd(2.1, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  Mat3 U;
  U << 1.3, 0.1, 0.0, 0.1, 0.8, -0.05, 0.0, -0.05, 1.1;
  std::vector<Mat3> found;
  NodeRotations(space_).measure(moved(R * U), found);
  ASSERT_EQ(found.size(), space_.node_count());
  for (const Mat3& of : found) EXPECT_LT((of - R).norm(), 1e-6);  // Newton's iteration is stopped
  NodeRotations(space_).measure(moved(R), found);
  for (const Mat3& of : found) EXPECT_LT((of - R).norm(), 1e-13);
}

TEST_F(NodeRotationsTest, AreTheIdentityWhereThereIsNone) {
  space_.nodes.emplace_back(1.0, 1.0, 1.0);  // without a tet
  std::vector<Mat3> found;
  NodeRotations(space_).measure(moved(Vec3(1.0, 1.0, -1.0).asDiagonal()), found);  // inside out
  for (const Mat3& of : found) EXPECT_EQ(of, Mat3(Mat3::Identity()));
}

}  // namespace
}  // namespace rhexis::solver
