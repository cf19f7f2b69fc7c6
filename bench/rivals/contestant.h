#pragma once

/// A bar that follows a hand frame by frame, whoever computes it.

#include <memory>

#include "base/vec.h"
#include "bench/rivals/bar.h"
#include "bench/rivals/bullet_bar.h"

namespace rhexis::rivals {

class Contestant {
 public:
  virtual ~Contestant() = default;
  /// The hand takes hold of the body at rest.
  virtual void hold() {}
  /// One frame: the hand's node is to be at `hand`, m.
  virtual void frame(const Vec3& hand) = 0;
  [[nodiscard]] virtual VectorX displacement() = 0;  ///< m
  [[nodiscard]] virtual Vec3 force() = 0;            ///< of the hand on the body, N
};

/// `corotated` and `hyperelastic` as play has them: solver/live_equilibrium.h with its defaults.
[[nodiscard]] std::unique_ptr<Contestant> make_live(const Bar& bar, std::shared_ptr<const model::Model> model);
/// `linear` as play has it: response/exact_response.h.
[[nodiscard]] std::unique_ptr<Contestant> make_linear(const Bar& bar);
[[nodiscard]] std::unique_ptr<Contestant> make_bullet(const Bar& bar, BulletLaw law, const BulletSettings& settings);

}  // namespace rhexis::rivals
