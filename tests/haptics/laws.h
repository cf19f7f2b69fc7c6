#pragma once

/// Laws and readings for the tests of the haptic loop.

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include "haptics/device.h"
#include "haptics/motion.h"
#include "haptics/tick_settings.h"
#include "response/snapshot.h"

namespace rhexis::haptics::test {

using response::ForceSnapshot;

/// In [-1, 1), from bits that the standard fixes.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; }

inline Vec3 random_vector(std::mt19937_64& random) {
  Vec3 out;
  for (int i = 0; i < 3; ++i) out[i] = uniform(random);
  return out;
}

/// Symmetric, eigenvalues from 10 to 10,000 N/m, evenly in the logarithm.
inline Mat3 random_stiffness(std::mt19937_64& random) {
  Mat3 any;
  for (int i = 0; i < 3; ++i) any.col(i) = random_vector(random);
  const Mat3 along = Eigen::HouseholderQR<Mat3>(any).householderQ();
  Vec3 values;
  for (int i = 0; i < 3; ++i) values[i] = std::pow(10.0, 2.5 + 1.5 * uniform(random));
  return along * values.asDiagonal() * along.transpose();
}

inline ForceSnapshot make_law(const Mat3& stiffness, std::uint32_t grasp = 1, std::uint64_t number = 1) {
  ForceSnapshot law;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) law.stiffness[static_cast<std::size_t>(3 * i + j)] = stiffness(i, j);
  law.normal = {0.0, 0.0, 1.0};
  law.flags = ForceSnapshot::is_held;
  law.grasp = grasp;
  law.number = number;
  return law;
}

/// As the law of a push comes out: along the normal (+z) alone.
inline ForceSnapshot make_push(double stiffness) {
  ForceSnapshot law = make_law(stiffness * Vec3::UnitZ() * Vec3::UnitZ().transpose());
  law.flags |= ForceSnapshot::pushes_only;
  return law;
}

inline Reading at(const Vec3& position) {
  Reading reading;
  reading.position = position;
  return reading;
}

/// A device that pushes back with up to 8.9 N.
inline DeviceTraits strong_device() {
  DeviceTraits traits;
  traits.name = "strong";
  traits.max_force = 8.9;
  return traits;
}

inline DeviceTraits pointing_device() {
  DeviceTraits traits;
  traits.name = "pointing";
  traits.counts_from_hold = true;
  return traits;
}

inline std::shared_ptr<Motion> moving(std::vector<Leg> legs) { return std::make_shared<Motion>(std::move(legs)); }
inline std::shared_ptr<Motion> at_rest() { return moving({}); }

inline Vec3 vec(const std::array<double, 3>& value) { return {value[0], value[1], value[2]}; }

}  // namespace rhexis::haptics::test
