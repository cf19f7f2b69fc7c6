#include "record/store/record.h"

#include <cmath>
#include <numbers>

namespace rhexis::record::store {

Vec3 Frame::direction(double angle) const {
  const double radians = angle * std::numbers::pi / 180.0;
  return std::cos(radians) * x + std::sin(radians) * y;
}

Mat3 Record::stiffness_at(int topology, int point) const {
  const double* k = stiffness.data() +
                    6 * (static_cast<std::size_t>(topology) * head.points.size() + static_cast<std::size_t>(point));
  Mat3 out;
  out << k[0], k[3], k[5],  //
      k[3], k[1], k[4],     //
      k[5], k[4], k[2];
  return out;
}

}  // namespace rhexis::record::store
