#include "solver/live_linear.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "base/check.h"
#include "base/parallel.h"

namespace rhexis::solver {
namespace {

using linalg::FourLanes;
using linalg::Lanes;

/// Error of the map that stands in for C^-1 within an iteration: conjugate gradients take as many iterations with 0.3
/// as with 0.01. What it leaves is left in the residual, which is taken with C itself.
constexpr double kPressureReduction = 3e-1;
/// Of what it leaves: to a percent.
constexpr int kCarefulRounds = 3;
/// A direction of negative curvature is followed as far as if its curvature were positive, and that at least this part
/// of the preconditioner's.
constexpr double kFlat = 0.1;

linalg::ChebyshevInverse inverse_of_pressures(const model::Model& model) {
  const linalg::SaddleMatrix K = model.make_tangent();
  return K.C.rows() > 0 ? linalg::ChebyshevInverse(K.C, kPressureReduction) : linalg::ChebyshevInverse();
}

}  // namespace

LiveLinear::LiveLinear(std::shared_ptr<const model::Model> model, linalg::FreeDofs free, const model::State& state,
                       double inertia)
    : model_(std::move(model)),
      free_(std::move(free)),
      inertia_(inertia),
      c_inverse_(inverse_of_pressures(*model_)),
      rotations_(model_->space(), model_->left_out()) {
  preconditioner_ = LivePreconditioner::make(model_, free_, state, inertia_, nullptr);
}

LiveLinear::~LiveLinear() = default;

void LiveLinear::follow(std::shared_ptr<const model::Model> model, linalg::FreeDofs free, const model::State& state,
                        const TornModel& torn) {
  model_ = std::move(model);
  free_ = std::move(free);
  c_inverse_ = inverse_of_pressures(*model_);
  rotations_ = NodeRotations(model_->space(), model_->left_out());
  rotation_.clear();
  point_.reset();
  K_ = nullptr;
  if (task_.under_way()) {
    torn_since_.add(torn);
    state_then_ = state;
  }
  preconditioner_ = preconditioner_->followed(*model_, free_, state, rotations_, torn);
  if (!preconditioner_) preconditioner_ = LivePreconditioner::make(model_, free_, state, inertia_, nullptr);
}

void LiveLinear::set_tangent(const linalg::SaddleMatrix& K, const model::State& state) {
  K_ = &K;
  A_.take(K.A);
  rotations_.measure(state.u, rotation_);
  turn();
}

/// T, and P~^-1 N^T by it.
void LiveLinear::turn() {
  const std::vector<Mat3>& before = preconditioner_->rotation();
  turn_.resize(rotation_.size());
  for (std::size_t i = 0; i < turn_.size(); ++i) turn_[i] = rotation_[i] * before[i].transpose();
  if (!point_) return;
  answer_.setZero(of_nodes_.front().rows(), 4);
  for (int k = 0; k < point_->count; ++k) {
    Eigen::Matrix4d mix = Eigen::Matrix4d::Zero();
    mix.topLeftCorner<3, 3>() =
        point_->weight[k] * turn_[static_cast<std::size_t>(point_->node[static_cast<std::size_t>(k)])].transpose();
    answer_.noalias() += of_nodes_[static_cast<std::size_t>(k)] * mix;
  }
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    auto x = answer_.middleRows<3>(static_cast<Eigen::Index>(3 * i));
    x = (turn_[i] * x).eval();
  }
  linalg::clear_held(free_, answer_);
  Mat3 answer;
  for (int j = 0; j < 3; ++j) answer.col(j) = point_->of(answer_, j);
  answer_inverse_ = answer.inverse();
}

void LiveLinear::set_constraint(const std::optional<HeldPoint>& point) {
  point_ = point;
  solve_for_point();
}

void LiveLinear::solve_for_point() {
  of_nodes_.clear();
  if (!point_) return;
  FourLanes unit = FourLanes::Zero(static_cast<Eigen::Index>(model_->space().dof_count()), 4);
  for (int k = 0; k < point_->count; ++k) {
    auto block = unit.block<3, 3>(3 * Eigen::Index{point_->node[static_cast<std::size_t>(k)]}, 0);
    block.setIdentity();
    preconditioner_->solve(unit, of_nodes_.emplace_back(), front_work_);
    block.setZero();
  }
  if (!rotation_.empty()) turn();
}

template <int k>
void LiveLinear::apply(const Lanes<k>& x, bool careful, Work<k>& work, Lanes<k>& y) {
  A_.multiply(x, y);
  if (work.q.rows() > 0) {
    K_->B.multiply(x, work.q);
    invert_pressure<k>(work.q, careful, work, work.p);
    K_->B.add_transposed(work.p, 1.0, y);
  }
  linalg::clear_held(free_, y);
  project<k>(work, y);
}

/// r -= N^T (N N^T)^-1 N r, where the point is fixed.
template <int k>
void LiveLinear::project(const Work<k>& work, Lanes<k>& r) const {
  for (int lane = 0; lane < k; ++lane) {
    if (work.fixed[static_cast<std::size_t>(lane)])
      point_->add(-point_->of(r, lane) / point_->weight.squaredNorm(), r, lane);
  }
}

/// T P~^-1 T^T r, and what of it moves a point that is fixed taken back.
template <int k>
void LiveLinear::precondition(const Lanes<k>& r, Work<k>& work, Lanes<k>& z) {
  work.turned.resize(r.rows(), k);
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    work.turned.template middleRows<3>(at).noalias() = turn_[i].transpose().lazyProduct(r.template middleRows<3>(at));
  }
  preconditioner_->solve(work.turned, work.solved, front_work_);
  z.resize(r.rows(), k);
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    z.template middleRows<3>(at).noalias() = turn_[i].lazyProduct(work.solved.template middleRows<3>(at));
  }
  linalg::clear_held(free_, z);
  for (int lane = 0; lane < k; ++lane) {
    if (!work.fixed[static_cast<std::size_t>(lane)]) continue;
    const Vec3 off = answer_inverse_ * point_->of(z, lane);
    z.col(lane).noalias() -= answer_.leftCols<3>() * off;
  }
}

/// x ~ C^-1 b, not in place. Carefully: what the map leaves, some times over.
template <int k>
void LiveLinear::invert_pressure(const Lanes<k>& b, bool careful, Work<k>& work, Lanes<k>& x) {
  c_inverse_.apply(b, x, c_work_);
  for (int round = 0; careful && round < kCarefulRounds; ++round) {
    work.left = b;
    K_->C.add_product(x, -1.0, work.left);
    c_inverse_.apply(work.left, work.more, c_work_);
    x += work.more;
  }
}

void LiveLinear::first_answer(FourLanes& xu, FourLanes& xp) {
  xu = answer_;
  xp.setZero(K_->C.rows(), 4);
  if (xp.rows() == 0) return;
  auto& work = std::get<Work<4>>(work_);
  work.q.resize(xp.rows(), 4);
  K_->B.multiply(xu, work.q);
  invert_pressure<4>(work.q, true, work, xp);
}

double LiveLinear::energy_of_pressure(const VectorX& rp) {
  if (rp.size() == 0) return 0.0;
  auto& work = std::get<Work<1>>(work_);
  invert_pressure<1>(rp, true, work, work.p);
  return 0.5 * rp.dot(work.p);
}

template <int k>
std::array<LiveSolve, k> LiveLinear::solve(const std::array<LiveOrder, k>& orders, const Lanes<k>& bu,
                                           const Lanes<k>& bp, Lanes<k>& xu, Lanes<k>& xp) {
  RHEXIS_CHECK(K_ != nullptr, "no tangent");
  auto& work = std::get<Work<k>>(work_);
  bool careful = false;
  for (std::size_t l = 0; l < k; ++l) {
    work.fixed[l] = orders[l].most > 0 && orders[l].point == Point::fixed && point_.has_value();
    careful = careful || (orders[l].most > 0 && orders[l].careful);
  }
  work.cg.resize(bu.rows());
  work.q.resize(bp.rows(), k);
  work.r = bu;
  xu.setZero(bu.rows(), k);
  xp.setZero(bp.rows(), k);
  const bool pressures = bp.rows() > 0;
  if (pressures) {
    invert_pressure<k>(bp, careful, work, work.p);
    K_->B.add_transposed(work.p, 1.0, work.r);
    xp = -work.p;
  }
  linalg::clear_held(free_, work.r);
  project<k>(work, work.r);
  const linalg::PerLane<k> norm = linalg::dots<k>(work.r, work.r).sqrt();
  std::array<linalg::LaneTarget, k> target;
  for (std::size_t l = 0; l < k; ++l)
    target[l] = {orders[l].tolerance * norm[static_cast<Eigen::Index>(l)], orders[l].most};
  const auto take = [&](const linalg::PerLane<k>& step) {  // the pressures go along: C^-1 B^T of the direction
    for (Eigen::Index i = 0; pressures && i < xp.rows(); ++i) xp.row(i).array() += step * work.p.row(i).array();
  };
  const auto results = linalg::conjugate_gradients<k>(
      [&](const Lanes<k>& x, Lanes<k>& y) { apply<k>(x, careful, work, y); },
      [&](const Lanes<k>& r, Lanes<k>& z) { precondition<k>(r, work, z); }, take, target, work.cg, work.r, xu);
  std::array<LiveSolve, k> out;
  linalg::PerLane<k> further = linalg::PerLane<k>::Zero();
  int iterations = 0;
  for (std::size_t l = 0; l < k; ++l) {
    const auto lane = static_cast<Eigen::Index>(l);
    out[l].iterations = results[l].iterations;
    iterations = std::max(iterations, results[l].iterations);
    out[l].truncated = results[l].end == linalg::CgEnd::negative_curvature;
    if (out[l].truncated && orders[l].point == Point::fixed)
      further[lane] = results[l].slope / std::max(std::abs(results[l].curvature), kFlat * results[l].slope);
    if (orders[l].most > 0) continue;
    xp.col(lane).setZero();
  }
  worked_ += iterations;
  if ((further != 0.0).any()) {
    for (Eigen::Index i = 0; i < xu.rows(); ++i) xu.row(i).array() += further * work.cg.p.row(i).array();
    take(further);
  }
  return out;
}

template std::array<LiveSolve, 2> LiveLinear::solve<2>(const std::array<LiveOrder, 2>&, const Lanes<2>&,
                                                       const Lanes<2>&, Lanes<2>&, Lanes<2>&);
template std::array<LiveSolve, 4> LiveLinear::solve<4>(const std::array<LiveOrder, 4>&, const Lanes<4>&,
                                                       const Lanes<4>&, Lanes<4>&, Lanes<4>&);

LiveSolve LiveLinear::solve(const LiveOrder& order, const VectorX& bu, const VectorX& bp, VectorX& xu, VectorX& xp) {
  return solve<1>({order}, bu, bp, xu, xp)[0];
}

void LiveLinear::refresh(const model::State& state) {
  if (task_.under_way()) return;
  worked_ = 0;
  torn_since_ = {};
  ready_ = false;
  task_.start([this, state, model = model_, free = free_, inertia = inertia_, before = preconditioner_] {
    const OneThreadHere beside;
    refreshed_ = LivePreconditioner::make(model, free, state, inertia, before.get());
    ready_ = true;
  });
}

bool LiveLinear::take_refreshed() {
  if (!task_.under_way() || worked_ < kRefreshWork) return false;
  task_.wait();
  LivePreconditioner::Shared next = std::move(refreshed_);
  if (!torn_since_.touched.empty()) next = next->followed(*model_, free_, state_then_, rotations_, torn_since_);
  if (!next) return false;
  preconditioner_ = std::move(next);
  solve_for_point();
  if (!point_ && !rotation_.empty()) turn();
  return true;
}

std::size_t LiveLinear::memory_bytes() const {
  return preconditioner_->memory_bytes() + c_inverse_.memory_bytes() + A_.memory_bytes();
}

}  // namespace rhexis::solver
