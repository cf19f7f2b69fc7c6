#pragma once

/// From the surface that a crack sweeps to a MeshEdit. Both methods leave the mesh as it is: the caller applies the
/// edit.

#include <cstdint>
#include <vector>

#include "fracture/crack.h"
#include "fracture/front_surroundings.h"
#include "mesh/mesh_edit.h"
#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

enum class IncisionMethod { keep_nodes, split };

/// A remaining tet may become flatter than the worst of the intact mesh by this factor, no more: its radius ratio stays
/// >= (smallest radius ratio of the intact mesh) * kFlattestTet. No unit.
inline constexpr double kFlattestTet = 0.2;

/// A node closer to the plane than this times the mean edge length counts as above it (section 2.4); on a flank of the
/// crack, or on the body's surface, where it has tets on one side only, it is of that side.
inline constexpr double kOnPlane = 1e-9;

struct IncisionSettings {
  IncisionMethod method = IncisionMethod::keep_nodes;
  double mean_edge = 0.0;               ///< m, of the intact mesh
  double smallest_radius_ratio = 0.0;   ///< of the intact mesh
  std::vector<std::uint8_t> immovable;  ///< per node of the present mesh, copies included: supported or held by the
                                        ///< hand; those stay where they are. A copy may be held and its original not.
};

struct Incision {
  mesh::MeshEdit edit;      ///< without `frozen`: see pieces.h. Empty when nothing is removed and nothing comes apart
  int edges_cut = 0;        ///< edges that the surface crosses, less those at which the same crack has been; 0 if empty
  int nodes_off_plane = 0;  ///< ends of those edges that could not be brought to the plane
  double volume_lost = 0.0;  ///< m^3, before minus after
};

/// keep_nodes (Nakao et al. 2007; (4.10)-(4.13) of the thesis): both ends of every crossed edge are projected onto the
/// surface, tets with a crossed edge are removed; no node is added. split: nodes near the surface are snapped to it,
/// tets are sorted by side, and the nodes between the sides are doubled; no volume is lost but what snapping moves.
/// In both a move that would invert or flatten a remaining tet is shortened, made by the other end, or left; a node
/// that is immovable or of a frozen piece stays. Both join on to what edits of the body swept before: a crack that runs
/// on advance by advance, turning, parts what a single cut along its whole surface would. A surface that
/// opens nothing (it meets no edge; or no face comes free of the front, or all that it meets is open already) is not
/// remembered: make it longer, or add it to the next. `surroundings` have followed all edits of the body: what an
/// incision costs grows with the surface, not with the body.
[[nodiscard]] Incision incise(const mesh::TornMesh& body, const Surroundings& surroundings, const CutSurface& surface,
                              const IncisionSettings& settings);

}  // namespace rhexis::fracture
