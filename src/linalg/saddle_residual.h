#pragma once

/// The residual b - K x over the free dofs, and its size. Forces (N) and volumes (m^3) cannot be added up as they are:
/// the row of a pressure is multiplied by sqrt(mean |A_ii| / C_jj), the symmetric scaling that gives A and C one
/// diagonal.

#include "base/vec.h"
#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class SaddleResidual {
 public:
  /// Both must outlive the calls below.
  void set_system(const SaddleMatrix& K, const FreeDofs& free);

  /// |(bu, scaled bp)| over the free dofs and all pressures.
  [[nodiscard]] double norm(const VectorX& bu, const VectorX& bp) const;
  /// Leaves b - K x in u() and p() (zero on held dofs, unscaled) and returns its norm.
  double measure(const VectorX& bu, const VectorX& bp, const VectorX& xu, const VectorX& xp);
  [[nodiscard]] const VectorX& u() const { return u_; }
  [[nodiscard]] const VectorX& p() const { return p_; }
  /// Factor of each pressure row, N / m^3.
  [[nodiscard]] const VectorX& pressure_scale() const { return scale_; }

 private:
  const SaddleMatrix* K_ = nullptr;
  const FreeDofs* free_ = nullptr;
  VectorX scale_;
  VectorX u_;
  VectorX p_;
};

/// Every value is a number; of the right-hand side, over the free dofs.
[[nodiscard]] bool is_finite(const SaddleMatrix& K);
[[nodiscard]] bool is_finite(const FreeDofs& free, const VectorX& bu, const VectorX& bp);

/// Sets the held entries to zero.
void clear_held(const FreeDofs& free, VectorX& u);
void clear_held(const FreeDofs& free, TwoLanes& u);
void clear_held(const FreeDofs& free, FourLanes& u);

}  // namespace rhexis::linalg
