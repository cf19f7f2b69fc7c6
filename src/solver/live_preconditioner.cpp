#include "solver/live_preconditioner.h"

#include <algorithm>

#include "base/check.h"
#include "linalg/chebyshev_inverse.h"

namespace rhexis::solver {
namespace {

/// Error of C^-1 where E W is made.
constexpr double kPatchReduction = 1e-4;
constexpr Eigen::Index kLanes = 4;

/// What a map (b, x) of lanes gives of each column.
template <typename Map>
linalg::PressurePatches::Solve by_lanes(Map map) {
  return [map](const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
    linalg::FourLanes given;
    linalg::FourLanes solved;
    for (Eigen::Index j = 0; j < b.cols(); j += kLanes) {
      const Eigen::Index count = std::min(kLanes, b.cols() - j);
      given.setZero(b.rows(), kLanes);
      given.leftCols(count) = b.middleCols(j, count);
      map(given, solved);
      x.middleCols(j, count) = solved.leftCols(count);
    }
  };
}

/// Patches of C, and what else of it a preconditioner keeps: A and B set a weight alone.
linalg::PressurePatches patches_of(const linalg::SaddleMatrix& K) {
  linalg::PressurePatches out;
  const linalg::ChebyshevInverse inverse(K.C, kPatchReduction);
  linalg::ChebyshevInverse::Work work;
  out.set(K, by_lanes([&](const linalg::FourLanes& b, linalg::FourLanes& x) { inverse.apply(b, x, work); }));
  return out;
}

}  // namespace

void TornModel::add(const TornModel& next) {
  copied.insert(copied.end(), next.copied.begin(), next.copied.end());
  touched.insert(touched.end(), next.touched.begin(), next.touched.end());
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
}

LivePreconditioner::Shared LivePreconditioner::make(const std::shared_ptr<const model::Model>& model,
                                                    const linalg::FreeDofs& free, const model::State& state,
                                                    double inertia, const LivePreconditioner* before) {
  std::shared_ptr<LivePreconditioner> out(new LivePreconditioner(model, TetTangents(*model, free, state, inertia)));
  TetTangents& tets = out->tets_;
  linalg::SaddleMatrix K = model->make_tangent();
  if (K.C.rows() > 0) {
    model->tangent(state, *model->make_scratch(), K);
    out->patches_ = before != nullptr && before->model_ == model ? before->patches_ : patches_of(K);
  }
  NodeRotations(model->space(), model->left_out()).measure(state.u, out->rotation_);
  tets.set_diagonal(out->patches_.diagonal());
  // A body under compression may have no definite tangent: what is solved is one that is stiffer.
  constexpr double kFirstShift = 0.03;
  constexpr double kLargestShift = 1e4;
  for (double shift = 0.0;; shift = std::max(kFirstShift, 3.0 * shift)) {
    tets.shift_by(shift);
    out->tree_ = before != nullptr ? before->tree_->refactored(tets) : linalg::FrontTree::make(tets, {});
    if (out->tree_->outcome() == linalg::FrontOutcome::ok) break;
    RHEXIS_CHECK(shift <= kLargestShift, "not positive definite with {} of its diagonal added", shift);
  }
  out->solver_ = std::make_shared<const linalg::FrontSolver>(*out->tree_);
  if (out->patches_.count() > 0) {
    linalg::FrontSolver::Work work;
    out->patches_.correct(
        K, free, by_lanes([&](const linalg::FourLanes& b, linalg::FourLanes& x) { out->solver_->solve(b, x, work); }));
  }
  return out;
}

LivePreconditioner::Shared LivePreconditioner::followed(const model::Model& model, const linalg::FreeDofs& free,
                                                        const model::State& state, const NodeRotations& rotations,
                                                        const TornModel& torn) const {
  std::shared_ptr<LivePreconditioner> out(new LivePreconditioner(*this));
  for (const std::int32_t parent : torn.copied)
    out->rotation_.push_back(out->rotation_[static_cast<std::size_t>(parent)]);
  std::vector<Mat3> T;
  rotations.measure(state.u, T);
  for (std::size_t i = 0; i < T.size(); ++i) T[i] = (T[i] * out->rotation_[i].transpose()).eval();
  out->tets_.follow(model, free, state, torn.touched, T);
  linalg::ElementChange change;
  change.copied = torn.copied;
  change.touched = torn.touched;
  out->tree_ = tree_->updated(out->tets_, change);
  if (out->tree_->outcome() != linalg::FrontOutcome::ok) return nullptr;
  out->solver_ = std::make_shared<const linalg::FrontSolver>(*out->tree_, solver_.get());
  out->patches_.follow(torn.copied, free);
  return out;
}

std::size_t LivePreconditioner::memory_bytes() const {
  return tree_->memory_bytes() + solver_->memory_bytes() + patches_.memory_bytes() + tets_.memory_bytes();
}

}  // namespace rhexis::solver
