#pragma once

/// The bar as a deformable body of Bullet, led frame by frame. Bullet's headers stay behind this one.

#include <memory>
#include <string>

#include "base/vec.h"
#include "bench/rivals/bar.h"

namespace rhexis::rivals {

enum class BulletLaw {
  linear,       ///< btDeformableLinearElasticityForce: R (2 mu e + lambda tr e), e = sym(R^T F) - I
  neo_hookean,  ///< btDeformableNeoHookeanForce: bench/rivals/stable_neo_hookean.h
};

/// What Bullet lets its user choose, and what a derived class can (the iterations).
struct BulletSettings {
  double density = 1000.0;  ///< kg/m^3; less of it comes to rest sooner, and is harder for its conjugate gradients
  double damping = 0.0;     ///< s, of the stiffness
  int steps = 1;            ///< a frame
  int newton = 1;           ///< Newton iterations a step at most
  int iterations = 50;      ///< of its linear solver each at most; Bullet's own number is 50
  bool line_search = false;
  bool is_implicit = true;

  [[nodiscard]] std::string name() const;
};

class BulletBar {
 public:
  BulletBar(const Bar& bar, BulletLaw law, const BulletSettings& settings);
  ~BulletBar();
  BulletBar(const BulletBar&) = delete;
  BulletBar& operator=(const BulletBar&) = delete;

  /// One frame, in which the node of the hand goes on to `hand` (m) evenly.
  void frame(const Vec3& hand);
  [[nodiscard]] VectorX displacement() const;
  /// Elastic force of the body on its nodes at the displacement `u`, N, by Bullet's own code. The body stays as it is.
  [[nodiscard]] VectorX elastic_force(const VectorX& u);

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace rhexis::rivals
