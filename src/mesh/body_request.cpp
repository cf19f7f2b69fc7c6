#include "mesh/body_request.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace rhexis::mesh {
namespace {

/// 0 when none was found.
int nearest_count(int nodes, int direction, const std::function<bool(int)>& can_have) {
  constexpr int kOneByOne = 50;
  int step = 1;
  int tried = 0;
  for (std::int64_t n = std::int64_t{nodes} + direction; n >= 4 && n <= kMaxGeneratedNodes; n += direction * step) {
    if (can_have(static_cast<int>(n))) return static_cast<int>(n);
    if (++tried >= kOneByOne) step = std::max(1, static_cast<int>(n / 100));
  }
  return 0;
}

}  // namespace

bool usable_length(double length) { return length >= 1e-30 && length <= 1e30; }

Expected<void> check_box(const Vec3& size) {
  for (int axis = 0; axis < 3; ++axis)
    if (!usable_length(size[axis]))
      return fail(fmt::format("size[{}] = {} is no length", axis, size[axis]), "positive metres");
  return {};
}

tl::unexpected<Error> no_such_count(std::string_view body, int nodes, const std::function<bool(int)>& can_have) {
  const int start = std::clamp(nodes, 0, kMaxGeneratedNodes + 1);
  const int below = nearest_count(start, -1, can_have);
  const int above = nearest_count(start, +1, can_have);
  std::string remedy;
  if (below > 0 && above > 0)
    remedy = fmt::format("{} and {} can be had", below, above);
  else if (below > 0 || above > 0)
    remedy = fmt::format("{} can be had", std::max(below, above));
  else
    remedy = "its sides are too unequal for any count";
  return fail(fmt::format("a {} of this shape cannot have {} nodes", body, nodes), remedy);
}

double hashed_fraction(std::uint64_t a, std::uint64_t b) {
  // The finaliser of splitmix64 over both numbers: every bit of the input stirs every bit of the output.
  const auto stir = [](std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  };
  return static_cast<double>(stir(stir(a) ^ b) >> 11) * 0x1p-53;
}

}  // namespace rhexis::mesh
