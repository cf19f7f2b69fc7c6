#pragma once

/// Mass and damping of a body that moves, step by step of one fixed length h (backward Euler). The step from u_n, with
/// velocity v_n, ends where
///
///     R(u) - F(u) + M ((u - u_n - h v_n) / h^2 + a (u - u_n) / h) + b (R(u) - R(u_n)) / h = 0,
///
/// and the next one begins there with v = (u - u_n) / h. M is lumped: a quarter of a tet's mass to each of its nodes. a
/// and b are Rayleigh's: b dR/dt is b K v, of the mixed models too. Divided by s = 1 + b / h this is an equilibrium of
/// R(u) with a force and a diagonal of its own, and is solved as one:
///
///     R(u) - F(u) / s - force(u) = 0,   tangent A + c M,   c = (1 / h^2 + a / h) / s.
///
/// What holds a point by a multiplier f / s, and gives way by s C, acts with f and C.

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "linalg/saddle_matrix.h"
#include "model/model.h"

namespace rhexis::solver {

struct Dynamics {
  double density = 0.0;            ///< kg/m^3, of the undeformed body, more than 0
  double mass_damping = 0.0;       ///< a, 1/s
  double stiffness_damping = 0.0;  ///< b, s
  double step = 0.016;             ///< h, s
};

/// Where a step set out from: all that a body has besides its state.
struct Motion {
  VectorX u;         ///< u_n, m
  VectorX velocity;  ///< v_n, m/s
  VectorX internal;  ///< R(u_n), N
};

class Inertia {
 public:
  /// At rest at `u`.
  Inertia(const Dynamics& dynamics, const model::Model& model, const VectorX& u);

  /// The body has torn: another model of it, of the same tets and more nodes, each of which moves as the one that it is
  /// a copy of. The step is the same, to be ended by the torn body: what a node has done of it, from `before` to
  /// `after` being the carrying over alone, it has done still.
  void follow(const model::Model& model, const std::vector<std::int32_t>& copied, const VectorX& before,
              const VectorX& after);
  /// R(u_n) of what is left after a tear is not known any more: from now on that of `internal` (N).
  void set_internal(const VectorX& internal) { motion_.internal = internal; }
  /// The step has ended at `u`, where the internal force is `internal` (N), and the next one begins.
  void begin(const VectorX& u, const VectorX& internal);
  /// The same, but that all motion is taken out of the body.
  void halt(const VectorX& u, const VectorX& internal);

  [[nodiscard]] const Motion& motion() const { return motion_; }
  void set_motion(Motion motion) { motion_ = std::move(motion); }
  [[nodiscard]] const VectorX& mass() const { return mass_; }   ///< kg, per node
  [[nodiscard]] double step() const { return dynamics_.step; }  ///< h, s
  [[nodiscard]] double scale() const { return scale_; }         ///< s
  [[nodiscard]] double per_mass() const { return per_mass_; }   ///< c, 1/s^2
  /// out += force(u), N.
  void add_force(const VectorX& u, VectorX& out) const;
  /// K += c M.
  void add_tangent(linalg::SaddleMatrix& K) const;
  /// N: |M v| / (s h), what would stop the body in a step, of the step that ends at `u` or the one before, whichever is
  /// more: a body that turns back stands still, and is not at rest.
  [[nodiscard]] double momentum(const VectorX& u) const;
  /// N: what moves the body by `length` (m) in a step, where nothing else holds it.
  [[nodiscard]] double force_for(double length) const { return per_mass_ * length * mass_.norm(); }
  /// J, of a step that ends at `u`.
  [[nodiscard]] double kinetic_energy(const VectorX& u) const;

 private:
  void lump(const model::Model& model);

  Dynamics dynamics_;
  double scale_ = 1.0;
  double per_mass_ = 0.0;
  VectorX mass_;
  Motion motion_;
};

/// rho V of each tet, 0 of those that are left out, kg; P1 models.
[[nodiscard]] std::vector<double> tet_masses(const model::Model& model, double density);

}  // namespace rhexis::solver
