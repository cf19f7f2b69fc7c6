#pragma once

/// From what the criterion says at the points of a front to the surface that the crack sweeps, and the front after it.
/// One tick: judge_front -> plan_advance -> cut_along (sweep, incise; longer until something opens) -> the body takes
/// the edit -> advanced.

#include <optional>
#include <span>
#include <vector>

#include "fracture/crack.h"
#include "fracture/criterion.h"
#include "fracture/front_surroundings.h"
#include "fracture/incision.h"

namespace rhexis::fracture {

/// What each point of a front speaks for: one section for a plate (its line), else one per point, half-way to its
/// neighbours and at least `mean_edge` (m) to both sides.
[[nodiscard]] std::vector<FrontSection> front_sections(const Crack& crack, double mean_edge);

/// One judgement per section. None for a crack that is finished.
[[nodiscard]] std::vector<Judgement> judge_front(const Criterion& criterion, const Crack& crack, double mean_edge,
                                                 std::span<const TetStress> tets);

struct Advance {
  std::vector<Vec3> step;  ///< per point of the front, m: where it goes, straight
  double length = 0.0;     ///< m, the largest step
  double angle = 0.0;      ///< radians, of the mean step, from +x in the x-y plane, in (-pi, pi]
  double turn = 0.0;       ///< radians, the largest angle between a step and the direction before it
  double value = 0.0;      ///< Pa, the largest among the points
  bool stopped = false;    ///< every point has run into the flank of another crack: see cut_along
};

/// Empty when the criterion is met at no point. A plate goes one way by one length. Elsewhere each met point takes its
/// own step and the others none; the steps are smoothed along the front as far as it takes to keep the front regular
/// (no segment turns back or falls below a quarter of its length, no corner becomes sharper than 60 degrees), and its
/// ends go on to the surface. `judgements`: of
/// judge_front.
[[nodiscard]] std::optional<Advance> plan_advance(const Crack& crack, std::span<const Judgement> judgements,
                                                  const Surroundings& surroundings);

/// An unfinished crack goes on by `length` (m) along `direction` (unit, normal to its front), whatever a criterion
/// says.
[[nodiscard]] Advance imposed_advance(const Crack& crack, const Vec3& direction, double length,
                                      const Surroundings& surroundings);

/// The surface between the front and where the steps lead, extended by `margin` (m) beyond the front's ends. Normals as
/// those of the front: upper flank above.
[[nodiscard]] CutSurface sweep(const Crack& crack, const Advance& advance, double margin);

/// What cut_along reaches beyond the ends of a front, and how much longer it makes an advance that opens nothing,
/// in mean edges; and how many times.
inline constexpr double kCutMargin = 0.5;
inline constexpr double kLengthening = 0.25;
inline constexpr int kMostLengthenings = 12;
/// How far beyond the flank of another crack a step ends that runs into it, in mean edges: the nodes of a flank may lie
/// that far off what was swept.
inline constexpr double kIntoFlank = 0.25;

/// The incision along an advance, which is made longer until it opens something, the front has left the body, or all of
/// it has run into the flank of another crack (or an earlier part of this one): there a step ends, and what is beyond
/// that flank is whole.
/// `advance` is what was done. An empty edit: nothing is there to cut, and the crack is finished.
[[nodiscard]] Incision cut_along(const mesh::TornMesh& body, const Surroundings& surroundings, const Crack& crack,
                                 Advance& advance, const IncisionSettings& settings);

/// The crack after the advance; `body` has taken the edit. Fronts end on the surface of the intact body and have points
/// about a mean edge apart. More than one where the front has come to pass through separate parts; a crack with
/// `finished` set when it has left the body, was stopped by other cracks, or has nothing in the solve ahead of it.
/// Never empty. The area swept so far goes with the first.
[[nodiscard]] std::vector<Crack> advanced(const Crack& crack, const Advance& advance, const Surroundings& surroundings,
                                          const mesh::TornMesh& body);

}  // namespace rhexis::fracture
