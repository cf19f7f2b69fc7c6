#include "linalg/pressure_patches.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "linalg/patches.h"
#include "linalg/saddle_residual.h"

namespace rhexis::linalg {
namespace {

/// Pressures in a patch and most patches: docs/solvers.md has the iteration counts that they were chosen by.
constexpr std::int32_t kPatchSize = 100;
constexpr std::int32_t kMostPatches = 16;
/// Least tr(B D^-1 B^T) / tr(A): about a bulk stiffness of 1.2 mu for pressures that C damps.
constexpr double kBulkShare = 0.36;

double trace(const SymmetricBlockMatrix& A) {
  double sum = 0.0;
  for (std::int32_t row = 0; row < A.rows(); ++row) {
    const auto block = static_cast<std::size_t>(A.pattern->row_start[static_cast<std::size_t>(row) + 1]) - 1;
    for (std::size_t c : {0U, 4U, 8U}) sum += A.values[9 * block + c];
  }
  return sum;
}

/// tr(B diag(d)^-1 B^T).
double trace_of_product(const CouplingMatrix& B, const VectorX& d) {
  double sum = 0.0;
  for (std::int32_t p = 0; p < B.rows(); ++p) {
    const auto first = static_cast<std::size_t>(B.pattern->row_start[static_cast<std::size_t>(p)]);
    const auto last = static_cast<std::size_t>(B.pattern->row_start[static_cast<std::size_t>(p) + 1]);
    for (std::size_t i = 3 * first; i < 3 * last; ++i) sum += B.values[i] * B.values[i] / d[p];
  }
  return sum;
}

}  // namespace

void PressurePatches::set(const SaddleMatrix& K, const Solve& c_inverse) {
  const SymmetricCsr& C = K.C;
  const std::int32_t m = C.rows();
  d_.resize(m);
  for (std::int32_t p = 0; p < m; ++p) {
    d_[p] = C.values[static_cast<std::size_t>(C.pattern->row_start[static_cast<std::size_t>(p) + 1]) - 1];
  }
  smooth_.resize(m, 0);
  G_.resize(0, 0);
  const bool diagonal = static_cast<std::int32_t>(C.pattern->column.size()) == m;
  if (diagonal) return;  // E = 0: P is S
  const double bulk = trace_of_product(K.B, d_);
  const std::vector<std::int32_t> patch =
      cut_into_patches(*C.pattern, std::max(kPatchSize, (m - 1) / kMostPatches + 1));
  // A pressure that no other is coupled to has no smooth part.
  std::vector<std::uint8_t> coupled(static_cast<std::size_t>(m), 0);
  for (std::int32_t p = 0; p < m; ++p) {
    const auto first = static_cast<std::size_t>(C.pattern->row_start[static_cast<std::size_t>(p)]);
    const auto last = static_cast<std::size_t>(C.pattern->row_start[static_cast<std::size_t>(p) + 1]);
    for (std::size_t i = first; i + 1 < last; ++i)
      coupled[static_cast<std::size_t>(p)] = coupled[static_cast<std::size_t>(C.pattern->column[i])] = 1;
  }
  std::int32_t count = 0;
  const auto for_each_coupled = [&](const auto& use) {
    for (std::int32_t p = 0; p < m; ++p)
      if (coupled[static_cast<std::size_t>(p)] != 0) use(p, patch[static_cast<std::size_t>(p)]);
  };
  for_each_coupled([&](std::int32_t, std::int32_t of) { count = std::max(count, of + 1); });
  smooth_.setZero(m, count);
  for_each_coupled([&](std::int32_t p, std::int32_t of) { smooth_(p, of) = 1.0; });
  const Eigen::MatrixXd indicators = smooth_;
  c_inverse(indicators, smooth_);
  Eigen::MatrixXd of_c = Eigen::MatrixXd::Zero(count, count);  // W^T C^-1 W
  VectorX of_d = VectorX::Zero(count);                         // W^T diag(C)^-1 W
  for_each_coupled([&](std::int32_t p, std::int32_t of) {
    of_c.row(of) += smooth_.row(p);
    of_d[of] += 1.0 / d_[p];
  });
  // The patches have to be smoother than the weight makes up for: G definite. Less weight makes it so, unless C = D up
  // to rounding or the patches oscillate; there is nothing to put back then.
  double weight = std::max(1.0, bulk > 0.0 ? kBulkShare * trace(K.A) / bulk : 1.0);
  for (;; weight = std::max(1.0, 0.5 * weight)) {
    G_ = of_c;
    G_.diagonal() -= weight * of_d;
    if (Eigen::LLT<Eigen::MatrixXd>(G_).info() == Eigen::Success) break;
    if (weight == 1.0) {
      smooth_.resize(m, 0);
      G_.resize(0, 0);
      return;
    }
  }
  d_ /= weight;
  for_each_coupled([&](std::int32_t p, std::int32_t of) { smooth_(p, of) -= 1.0 / d_[p]; });
}

void PressurePatches::correct(const SaddleMatrix& K, const FreeDofs& free, const Solve& p_inverse) {
  const Eigen::Index columns = count();
  V_.setZero(K.displacement_unknowns(), columns);
  if (columns == 0) return;
  Eigen::MatrixXd V(V_.rows(), columns);
  VectorX pressure(smooth_.rows());
  VectorX force(V.rows());
  for (Eigen::Index col = 0; col < columns; ++col) {
    pressure = smooth_.col(col);
    force.setZero();
    K.B.add_transposed(pressure, 1.0, force);
    clear_held(free, force);
    V.col(col) = force;
  }
  Eigen::MatrixXd solved(V.rows(), columns);
  p_inverse(V, solved);
  Eigen::MatrixXd inner = G_;
  inner.noalias() += V.transpose() * solved;
  coarse_.compute(inner);
  V_ = solved.cast<float>();
}

void PressurePatches::follow(std::span<const std::int32_t> copied, const FreeDofs& free) {
  if (count() == 0) return;
  const Eigen::Index nodes = V_.rows() / 3;
  V_.conservativeResize(V_.rows() + 3 * static_cast<Eigen::Index>(copied.size()), Eigen::NoChange);
  for (std::size_t i = 0; i < copied.size(); ++i)
    V_.middleRows<3>(3 * (nodes + static_cast<Eigen::Index>(i))) = V_.middleRows<3>(3 * Eigen::Index{copied[i]});
  for (Eigen::Index col = 0; col < V_.cols(); ++col) {
    VectorX of = V_.col(col).cast<double>();
    clear_held(free, of);
    V_.col(col) = of.cast<float>();
  }
}

template <int k>
void PressurePatches::apply_lanes(const Lanes<k>& r, Lanes<k>& z) const {
  if (count() == 0) return;
  Eigen::VectorXf lane(r.rows());
  for (int l = 0; l < k; ++l) {
    lane = r.col(l).template cast<float>();
    VectorX small = (V_.transpose() * lane).template cast<double>();
    coarse_.solveInPlace(small);
    lane.noalias() = V_ * small.cast<float>();
    z.col(l) -= lane.cast<double>();
  }
}
template void PressurePatches::apply_lanes<1>(const VectorX&, VectorX&) const;
template void PressurePatches::apply_lanes<2>(const TwoLanes&, TwoLanes&) const;
template void PressurePatches::apply_lanes<4>(const FourLanes&, FourLanes&) const;

std::size_t PressurePatches::memory_bytes() const {
  return sizeof(double) * static_cast<std::size_t>(d_.size() + smooth_.size() + 2 * G_.size()) +
         sizeof(float) * static_cast<std::size_t>(V_.size());
}

}  // namespace rhexis::linalg
