#pragma once

/// The maximum hoop stress (Erdogan and Sih 1963) from a mesh that does not resolve the tip: the hoop stress of a ring
/// of tets around the front is fitted over the angle, and the crack goes where the fit is largest. Single tets scatter
/// by more than the angle that is sought; the fit uses all of them.
///
/// The basis, at distance r and angle theta from the present direction, is the two singular terms of Williams' series
/// and the three of a uniform stress:
///   (r0/r)^1/2 cos^3(theta/2),  (r0/r)^1/2 sin(theta) cos(theta/2),  1,  cos 2 theta,  sin 2 theta.
/// So it is exact in a uniform field and next to an ideal tip, and near a notch in between.

#include "fracture/criterion.h"

namespace rhexis::fracture {

/// The ring, in mean edges: outside of the tets that touch the tip, inside of the local object.
inline constexpr double kRingInner = 0.75;
inline constexpr double kRingOuter = 3.5;

class MaximumHoop final : public Criterion {
 public:
  explicit MaximumHoop(const CriterionSettings& settings) : settings_(settings) {}
  /// The value is that of the fit at the ring's mean radius. A ring of too few tets for the fit is judged by its mean
  /// stress.
  [[nodiscard]] Judgement judge(const FrontSection& section, std::span<const TetStress> tets) const override;

 private:
  CriterionSettings settings_;
};

}  // namespace rhexis::fracture
