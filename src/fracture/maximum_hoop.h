#pragma once

/// The maximum hoop stress (Erdogan and Sih 1963) from a mesh that does not resolve the tip. Single tets there scatter
/// by more than the angle that is sought, so the stress of a whole ring of them is fitted, by least squares weighted
/// with their volumes, with the leading terms of Williams' series for a straight crack:
///   sigma(r, theta) = r^-1/2 (a_1 f_1 + b_1 g_1) + T + r^1/2 (a_3 f_3 + b_3 g_3)
/// in all three stresses of the section. The hoop stress of the first three terms half a mean edge from the front is
/// what is judged, and the crack goes where it is largest; the last two keep the plate's own stress out of them. The
/// fit takes the tets behind the front as well, whatever `ahead_only` says, which bounds the search and the advance
/// length.

#include "fracture/criterion.h"

namespace rhexis::fracture {

/// The ring, in mean edges: outside of the tets that touch the tip, inside of the local object.
inline constexpr double kRingInner = 0.75;
inline constexpr double kRingOuter = 3.5;

/// Where the fit is judged, in mean edges: about where the tets at a tip have their centroids, which the other criteria
/// judge by, so that one strength means much the same to all.
inline constexpr double kJudgedAt = 0.5;

class MaximumHoop final : public Criterion {
 public:
  explicit MaximumHoop(const CriterionSettings& settings) : settings_(settings) {}
  /// A ring of too few tets for the fit is judged by the hoop stress of its mean stress.
  [[nodiscard]] Judgement judge(const FrontSection& section, std::span<const TetStress> tets) const override;

 private:
  CriterionSettings settings_;
};

}  // namespace rhexis::fracture
