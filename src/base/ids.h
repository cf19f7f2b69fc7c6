#pragma once

/// Typed indices: a NodeId cannot be used where a TetId is meant. 32 bits: meshes stay below 2^31 entities, which the
/// readers check.

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace rhexis {

template <class Tag>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(std::int32_t value) : value_(value) {}
  constexpr explicit Id(std::size_t value) : value_(static_cast<std::int32_t>(value)) {}

  /// The plain integer, for printing and arithmetic.
  [[nodiscard]] constexpr std::int32_t value() const { return value_; }
  /// The integer as an index into a std::vector.
  [[nodiscard]] constexpr std::size_t index() const { return static_cast<std::size_t>(value_); }
  [[nodiscard]] constexpr bool valid() const { return value_ >= 0; }

  friend constexpr auto operator<=>(Id, Id) = default;

 private:
  std::int32_t value_ = -1;
};

using NodeId = Id<struct NodeTag>;  ///< a node of the mesh, 0-based, in the order of the file
using TetId = Id<struct TetTag>;    ///< a tetrahedron of the mesh, 0-based, in the order of the file

}  // namespace rhexis

template <class Tag>
struct std::hash<rhexis::Id<Tag>> {
  std::size_t operator()(rhexis::Id<Tag> id) const noexcept { return std::hash<std::int32_t>{}(id.value()); }
};
