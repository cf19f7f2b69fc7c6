#pragma once

/// The hand at a device, where the program knows what it wants: the script of a scene, the motion of a test.

#include <cstdint>

#include "base/vec.h"

namespace rhexis::haptics {

struct HandPlace {
  Vec3 position = Vec3::Zero();  ///< m, from where the hold began
  std::uint32_t hold = 0;        ///< counts the holds from 1; 0: it holds nothing
};

class HandPath {
 public:
  virtual ~HandPath() = default;
  /// Under the rules of Device::read; asked for one tick after the other.
  virtual HandPlace at(std::uint64_t tick) noexcept = 0;
};

}  // namespace rhexis::haptics
