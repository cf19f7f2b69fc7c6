#pragma once

/// Numbers from a seed, the same on every machine.

#include <cstdint>
#include <random>

#include "base/vec.h"

namespace rhexis::test {

class RandomDraws {
 public:
  explicit RandomDraws(std::uint64_t seed) : random_(seed) {}

  double uniform(double from, double to) {
    return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1.0p-53;
  }
  std::size_t choose(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
  /// One draw after the other: the order of arguments is the compiler's.
  Vec3 vector(double from, double to) {
    Vec3 v;
    for (int c = 0; c < 3; ++c) v[c] = uniform(from, to);
    return v;
  }
  Vec3 direction() {
    Vec3 v = vector(-1, 1);
    while (v.norm() > 1.0 || v.norm() < 0.1) v = vector(-1, 1);
    return v.normalized();
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace rhexis::test
