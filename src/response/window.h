#pragma once

/// The part of the body around the crack fronts that is kept ready for the next edits, and its rim: the nodes that it
/// shares with the rest. An empty window leaves all tets outside, and has no rim.

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/torn_mesh.h"
#include "response/response.h"

namespace rhexis::response {

/// Lengths in radii of the local object. The defaults were measured: docs/exact-response.md.
struct WindowShape {
  /// A body whose whole factor takes fewer operations does better without a window.
  double fewest_flops = 3e10;
  double side = 1.25;   ///< half the width
  double edit = 1.0;    ///< what an edit reaches from the middle of its front; less than `side`
  double ahead = 2.0;   ///< from the front to the centre of the far end
  double behind = 0.0;  ///< from the front to the centre of the near end
  /// A window of more than this part of the tets in the solve does not pay, and none is made.
  double largest_part = 0.4;
};

class Window {
 public:
  /// Empty.
  Window() = default;
  /// A capsule about each focus, along the direction in which it runs.
  Window(const mesh::TornMesh& body, std::span<const Focus> focus, const WindowShape& shape);

  [[nodiscard]] bool is_empty() const { return tets_.empty(); }
  [[nodiscard]] bool holds(TetId tet) const { return !is_empty() && holds_[tet.index()] != 0; }
  [[nodiscard]] bool is_on_rim(NodeId node) const {
    return node.index() < on_rim_.size() && on_rim_[node.index()] != 0;
  }
  /// All inside, ascending, in the solve or not.
  [[nodiscard]] const std::vector<TetId>& tets() const { return tets_; }
  /// Nodes of tets inside and of tets in the solve outside, when it was placed; ascending.
  [[nodiscard]] const std::vector<std::int32_t>& rim() const { return rim_; }

  /// What the next edit at the focus will reach lies inside, as far as one can tell, or the window is empty.
  [[nodiscard]] bool has_room(const Focus& focus) const;
  /// The focus has gone half of the way on which it had room when the window was placed.
  [[nodiscard]] bool is_half_way(const Focus& focus) const;

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Capsule {
    Vec3 from = Vec3::Zero();
    Vec3 to = Vec3::Zero();
    double radius = 0.0;
    Vec3 front = Vec3::Zero();                           ///< of the focus that it was placed for
    [[nodiscard]] double distance(const Vec3& x) const;  ///< from its axis
  };
  [[nodiscard]] const Capsule* capsule_of(const Focus& focus) const;

  double edit_ = 0.0;
  std::vector<Capsule> capsules_;
  std::vector<std::uint8_t> holds_;   ///< per tet
  std::vector<std::uint8_t> on_rim_;  ///< per node; nodes appended later are not
  std::vector<TetId> tets_;
  std::vector<std::int32_t> rim_;
};

}  // namespace rhexis::response
