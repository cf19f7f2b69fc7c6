#pragma once

/// Cracks that are there from the start, and the first crack of a body that has none.

#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "fracture/crack.h"
#include "fracture/front_surroundings.h"
#include "fracture/incision.h"
#include "fracture/tet_stress.h"

namespace rhexis::fracture {

struct InitialCrack {
  std::vector<Crack> cracks;  ///< one per front: see make_crack
  CutSurface surface;         ///< what to incise
};

/// The scene's [[crack]]: the plane from `from` to `to` (m), all the way through the body along `through` (any length).
/// A front stands where the line through `to` passes through the body, one crack per separate stretch; and where the
/// one through `from` does, when `from` is well inside the body (a slit with two tips). On a plate `through` must be z.
/// The normal points towards the middle of the body's box where it is to one side: it mirrors with the body, and so
/// does the path.
/// Errors: no way between the points, `through` along it, no front in the body.
[[nodiscard]] Expected<InitialCrack> make_crack(const Vec3& from, const Vec3& to, const Vec3& through,
                                                const Surroundings& surroundings);

/// Where a body without a crack tears first: at the tet with a surface face whose largest principal stress is largest,
/// when that reaches `strength` (Pa). The plane is normal to that stress and the crack runs inward: a plate is cut
/// through by one mean edge from its rim (a slit of two tips where it is not at the rim), any other body gets half a
/// disc of one and a half mean edges' radius; both times `larger`. `tets` at the hand do not count. Empty when the
/// strength is not reached, or where the cut would meet nothing.
[[nodiscard]] std::optional<InitialCrack> start_crack(const mesh::TornMesh& body, std::span<const TetStress> tets,
                                                      double strength, const Surroundings& surroundings,
                                                      double larger = 1.0);

/// A straight crack to start with, the scene's [[crack]]: it opens all of the body that lies along `through`.
struct CrackLine {
  Vec3 from = Vec3::Zero();      ///< m
  Vec3 to = Vec3::Zero();        ///< m
  Vec3 through = Vec3::UnitZ();  ///< of any length
};
struct FirstCut {
  InitialCrack start;
  Incision incision;  ///< opens something
};
/// make_crack and its incision. Errors: as make_crack; a crack that opens nothing.
[[nodiscard]] Expected<FirstCut> cut_initial(const mesh::TornMesh& body, const CrackLine& line,
                                             const Surroundings& surroundings, const IncisionSettings& settings);
/// start_crack and its incision: at its size or, where that opens nothing, at the least of up to four times it that
/// does. By splitting, a cut of one edge often does not free a single face. Empty as start_crack, or when none opens
/// anything.
[[nodiscard]] std::optional<FirstCut> cut_first(const mesh::TornMesh& body, std::span<const TetStress> tets,
                                                double strength, const Surroundings& surroundings,
                                                const IncisionSettings& settings);

}  // namespace rhexis::fracture
