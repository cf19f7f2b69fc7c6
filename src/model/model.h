#pragma once

/// What a deformation model is to the rest of the house: constant data, a State that changes, a Scratch passed in. No
/// `mutable`, no hidden state: two threads may evaluate one model with two scratches.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/ids.h"
#include "base/vec.h"
#include "linalg/saddle_matrix.h"
#include "linalg/saddle_solver.h"
#include "mesh/tet_mesh.h"
#include "model/space.h"

namespace rhexis::model {

/// The unknowns. Lengths: u 3 * space().node_count(), lambda pressure_unknowns() (0 for displacement models).
struct State {
  VectorX u;       ///< displacement, m, node-major
  VectorX lambda;  ///< mean Cauchy stress, Pa, positive in tension; per tet (P0) or per vertex (P1)
};

/// Work space of an evaluation; made once by Model::make_scratch, so that evaluations do not allocate.
struct Scratch {
  VectorX J;  ///< det F of each tet as of the last residual (smallest over quadrature points where there are several)
};

/// What an evaluation noticed. NaN and inversion are caught where they are born.
struct Evaluation {
  int inverted_tets = 0;  ///< tets with J <= 0
  TetId worst_tet;        ///< of the smallest J
  double min_J = 1.0;
  bool finite = true;  ///< false: some tet's force is not finite; worst_tet names the first one
};

/// R = d(stored energy)/d(u, lambda), without loads.
struct Residual {
  VectorX u;       ///< N
  VectorX lambda;  ///< m^3
};

/// Per-tet output; of quantities at quadrature points the volume average.
struct TetFields {
  std::vector<double> J;
  std::vector<double> lambda;  ///< of the mixed models; of displacement models the mean Cauchy stress, Pa
  std::vector<double> stress;  ///< Cauchy, 6 per tet: xx yy zz xy yz xz, Pa
};

/// One tet of a state.
struct TetState {
  Mat3 stress = Mat3::Zero();  ///< Cauchy, Pa
  Mat3 P = Mat3::Zero();       ///< first Piola-Kirchhoff stress dW/dF, Pa; of `linear` the same as Cauchy's
  double W = 0.0;              ///< stored energy per reference volume, J/m^3; of a mixed model its Lagrangian's density
};

class Model {
 public:
  virtual ~Model() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;  ///< as in the scene: "hyperelastic"
  [[nodiscard]] virtual const DisplacementSpace& space() const = 0;
  [[nodiscard]] virtual std::int32_t pressure_unknowns() const { return 0; }
  /// True when lambda is continuous with one unknown per vertex (Taylor-Hood), false when it is one per tet.
  [[nodiscard]] virtual bool pressure_at_vertices() const { return false; }
  [[nodiscard]] virtual bool is_linear() const { return false; }
  /// Per tet, nonzero where it is no part of the body; empty: all are.
  [[nodiscard]] virtual std::span<const std::uint8_t> left_out() const { return {}; }
  /// m^3 of each tet, 0 of those that are left out. Not of mass-spring and taylor-hood: RHEXIS_CHECK.
  [[nodiscard]] virtual std::vector<double> tet_volumes() const;
  /// False for models whose law has no answer at J <= 0 (a step into that is cut); true where inversion is defined
  /// (linear, mass-spring, corotated, St. Venant-Kirchhoff): it is counted and reported instead.
  [[nodiscard]] virtual bool allows_inversion() const = 0;

  [[nodiscard]] virtual State initial_state() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Scratch> make_scratch() const = 0;
  /// Pattern allocated, values zero.
  [[nodiscard]] virtual linalg::SaddleMatrix make_tangent() const = 0;

  virtual Evaluation residual(const State& state, Scratch& scratch, Residual& out) const = 0;
  /// The derivative of the residual; `out` from make_tangent, overwritten.
  virtual Evaluation tangent(const State& state, Scratch& scratch, linalg::SaddleMatrix& out) const = 0;
  /// What `tangent` adds up, tet by tet: `blocks` 90 per tet of the mesh, the 3 x 3 blocks (by rows) of the pairs
  /// (0,0), (1,0), (1,1), (2,0), ... (3,3) of its four nodes in ascending order, N/m; `coupling` 12 per tet, its row of
  /// B^T in that order, m^2, empty of displacement models. Not of mass-spring and taylor-hood: RHEXIS_CHECK.
  virtual Evaluation tet_tangents(const State& state, Scratch& scratch, std::vector<double>& blocks,
                                  std::vector<double>& coupling) const;
  /// Stored energy (the Lagrangian of the mixed models), J; for tests and line search.
  [[nodiscard]] virtual double energy(const State& state) const = 0;
  [[nodiscard]] virtual TetFields fields(const State& state) const = 0;
  /// Of one tet whose deformation gradient is F. Not of mass-spring and taylor-hood: RHEXIS_CHECK.
  [[nodiscard]] virtual TetState tet_state(const State& state, TetId tet, const Mat3& F) const;
  /// |V (J - 1)| and |R_lambda| scales for the convergence test of mixed models: the norm of V_e (J_e - 1).
  [[nodiscard]] virtual double volume_change_norm(const State&) const { return 0.0; }
  /// SPD stand-ins in the reference state for MINRES.
  [[nodiscard]] virtual linalg::BlockPreconditioner preconditioner() const = 0;
  /// Bytes of constant data (batches, patterns), for the report.
  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
};

}  // namespace rhexis::model
