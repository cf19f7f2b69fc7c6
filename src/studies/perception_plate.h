#pragma once

/// The plate of an experiment, its crack run on at any angle: the body that is seen, and the laws that are felt.

#include <memory>
#include <vector>

#include "base/error.h"
#include "response/contact.h"
#include "session/open_body.h"
#include "studies/perception_settings.h"

namespace rhexis::studies {

class PerceptionPlate {
 public:
  /// Errors: of the scene; a scene that tears by itself, is of large strain, has no crack that goes through along z, or
  /// whose response is not the exact one; an advance of the sample, or a point, that cannot be.
  static Expected<PerceptionPlate> open(const PerceptionSettings& settings);

  /// With a crack that has run on by the experiment's length at `angle` (degrees, from +x).
  [[nodiscard]] Expected<std::unique_ptr<session::OpenBody>> torn(double angle) const;
  /// Of that plate, held at each of the experiment's points.
  [[nodiscard]] Expected<std::vector<response::ContactLaw>> laws(double angle) const;

 private:
  PerceptionPlate(const PerceptionSettings& settings, std::unique_ptr<session::OpenBody> intact)
      : points_(settings.points), length_(settings.length), intact_(std::move(intact)) {}

  std::vector<PlacedVector> points_;
  double length_;
  std::shared_ptr<const session::OpenBody> intact_;  ///< with the scene's own cracks
};

}  // namespace rhexis::studies
