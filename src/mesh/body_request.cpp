#include "mesh/body_request.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace rhexis::mesh {
namespace {

constexpr int kFewest = 4;  ///< nodes of a body, at the very least

/// Goes from `nodes` up or down, one by one at first, then in steps of 1%; a count found by such a step is pulled back
/// by bisection towards the last one that could not be had. 0 when there is none.
int nearest_count(int nodes, int direction, const std::function<bool(int)>& can_have) {
  constexpr int kOneByOne = 50;
  int tried = 0;
  int missed = nodes;
  int found = nodes;
  do {
    const int step = ++tried <= kOneByOne ? 1 : std::max(1, missed / 100);
    missed = found;
    found += direction * step;
    if (found < kFewest || found > kMaxGeneratedNodes) return 0;
  } while (!can_have(found));
  while (std::abs(found - missed) > 1) {
    const int middle = missed + (found - missed) / 2;
    (can_have(middle) ? found : missed) = middle;
  }
  return found;
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
  const int start = std::clamp(nodes, kFewest - 1, kMaxGeneratedNodes + 1);
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
