#include "response/snapshot.h"

namespace rhexis::response {

Felt force_at(const ForceSnapshot& snapshot, const Vec3& hand) noexcept {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Felt felt;
  if ((snapshot.flags & ForceSnapshot::is_held) == 0 || !hand.allFinite()) return felt;
  const Eigen::Map<const RowMajor> stiffness(snapshot.stiffness.data());
  const Eigen::Map<const Vec3> rest(snapshot.rest.data());
  const Eigen::Map<const Vec3> normal(snapshot.normal.data());
  const Vec3 force = stiffness * (hand - rest);
  if ((snapshot.flags & ForceSnapshot::pushes_only) != 0 && force.dot(normal) >= 0.0) return felt;
  const double length = force.norm();
  felt.limited = snapshot.force_limit > 0.0 && length > snapshot.force_limit;
  felt.force = felt.limited ? Vec3(force * (snapshot.force_limit / length)) : force;
  return felt;
}

}  // namespace rhexis::response
