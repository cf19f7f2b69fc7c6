#pragma once

/// What all generators ask of their arguments, and what they say when a node count cannot be had.

#include <cstdint>
#include <functional>
#include <string_view>

#include "base/error.h"
#include "base/vec.h"

namespace rhexis::mesh {

/// More nodes than this are refused: a typing slip should not fill the memory.
inline constexpr int kMaxGeneratedNodes = 4'000'000;

/// Positive and finite, and such that the volume of a small part of a cube of that side is as well.
[[nodiscard]] bool usable_length(double length);
/// Error when a side of the box is not a usable length.
Expected<void> check_box(const Vec3& size);

/// "a bar of this shape cannot have 12 nodes (14 can be had)", with the nearest counts below and above for which
/// `can_have` is true. Nearest to 1% where they are far away.
[[nodiscard]] tl::unexpected<Error> no_such_count(std::string_view body, int nodes,
                                                  const std::function<bool(int)>& can_have);

/// i / n of a length; exactly the length at i = n, and the same bits at 2 i of 2 n.
[[nodiscard]] inline double part_of(double length, std::int64_t i, std::int64_t n) {
  return i == n ? length : static_cast<double>(i) * length / static_cast<double>(n);
}

/// A number in [0, 1) from integers: noise that is the same on every machine.
[[nodiscard]] double hashed_fraction(std::uint64_t a, std::uint64_t b);

}  // namespace rhexis::mesh
