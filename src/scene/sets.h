#pragma once

/// Which nodes and faces the words of a scene mean.

#include "scene/body.h"

namespace rhexis::scene {

/// A side holds what lies within this fraction of the longest edge of the bounding box from it.
inline constexpr double kSideTolerance = 1e-6;
/// A box of fractions holds its borders: this much, in fractions, is rounding.
inline constexpr double kBoxTolerance = 1e-9;

/// Used nodes on a side of the body's box, ascending.
[[nodiscard]] std::vector<NodeId> nodes_on_side(const Body& body, const Side& side);
/// Boundary faces whose nodes all lie on a side, ordered.
[[nodiscard]] std::vector<mesh::TetFace> faces_on_side(const Body& body, const Side& side);

/// Adds the sets of the scene to the mesh. Errors: a set that holds no node, a node that is not there.
[[nodiscard]] Expected<void> add_sets(const Scene& scene, Body& body, std::vector<std::string>& notes);

}  // namespace rhexis::scene
