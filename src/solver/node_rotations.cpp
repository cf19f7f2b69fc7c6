#include "solver/node_rotations.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/check.h"
#include "element/cofactor.h"

namespace rhexis::solver {
namespace {

/// Of Newton's iteration for the polar factor, which is quadratic: strains of a half are rotations to 1e-6 after these.
constexpr int kIterations = 4;

Mat3 rotation_of(const Mat3& F) {
  const double determinant = F.determinant();
  if (!(determinant > 0.0) || !std::isfinite(determinant)) return Mat3::Identity();
  Mat3 R = F / std::cbrt(determinant);
  for (int k = 0; k < kIterations; ++k) {
    const Mat3 cofactor = element::cofactor(R);
    R = (0.5 * (R + cofactor / R.row(0).dot(cofactor.row(0)))).eval();
  }
  return R.allFinite() ? R : Mat3(Mat3::Identity());
}

}  // namespace

NodeRotations::NodeRotations(const model::DisplacementSpace& space, std::span<const std::uint8_t> left_out)
    : nodes_(space.node_count()) {
  RHEXIS_CHECK(space.order == 1, "order {}", space.order);
  const std::size_t count = space.connectivity.size() / 4;
  tets_.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    if (!left_out.empty() && left_out[t] != 0) continue;
    Tet& tet = tets_.emplace_back();
    for (std::size_t a = 0; a < 4; ++a) tet.node[a] = space.connectivity[4 * t + a];
    std::array<Vec3, 4> corners;
    for (std::size_t a = 0; a < 4; ++a) corners[a] = space.nodes[static_cast<std::size_t>(tet.node[a])];
    tet.shape = element::make_linear_tet(corners);
  }
}

void NodeRotations::measure(const VectorX& u, std::vector<Mat3>& out) const {
  out.assign(nodes_, Mat3::Zero());
  for (const Tet& tet : tets_) {
    std::array<Vec3, 4> w;
    for (std::size_t a = 0; a < 4; ++a) w[a] = u.segment<3>(3 * Eigen::Index{tet.node[a]});
    const Mat3 F = tet.shape.volume * (Mat3::Identity() + element::displacement_gradient(tet.shape, w));
    for (const std::int32_t node : tet.node) out[static_cast<std::size_t>(node)] += F;
  }
  for (Mat3& F : out) F = rotation_of(F);
}

}  // namespace rhexis::solver
