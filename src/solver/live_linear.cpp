#include "solver/live_linear.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include <Eigen/LU>

#include "base/check.h"
#include "base/parallel.h"

namespace rhexis::solver {
namespace {

/// Error of the map that stands in for C^-1 within an iteration: conjugate gradients take as many iterations with 0.3
/// as with 0.01. What it leaves is left in the residual, which is taken with C itself.
constexpr double kPressureReduction = 3e-1;
/// The same where E W is made.
constexpr double kPatchReduction = 1e-4;

/// The tangents of the tets of one state, with their pressures eliminated by D.
class TetTangents final : public linalg::ElementSource {
 public:
  TetTangents(const model::Model& model, const linalg::FreeDofs& free, const model::State& state) {
    const auto scratch = model.make_scratch();
    model.tet_tangents(state, *scratch, blocks_, coupling_);
    const std::vector<std::int32_t>& connectivity = model.space().connectivity;
    nodes_.resize(connectivity.size() / 4);
    for (std::size_t t = 0; t < nodes_.size(); ++t) {
      std::copy_n(connectivity.begin() + static_cast<std::ptrdiff_t>(4 * t), 4, nodes_[t].begin());
      std::sort(nodes_[t].begin(), nodes_[t].end());
    }
    free_.assign(model.space().node_count(), 0);
    for (const std::int32_t dof : free.dof) free_[static_cast<std::size_t>(dof / 3)] |= 1U << (dof % 3);
  }
  /// Per tet, m^3/Pa.
  void set_diagonal(const VectorX& d) { d_ = d; }
  /// Adds this part of its trace to the diagonal of each tet.
  void shift_by(double part) { shift_ = part; }

  std::int32_t node_count() const override { return static_cast<std::int32_t>(free_.size()); }
  std::int32_t element_count() const override { return static_cast<std::int32_t>(nodes_.size()); }
  bool is_active(std::int32_t) const override { return true; }
  std::array<std::int32_t, 4> nodes(std::int32_t tet) const override { return nodes_[static_cast<std::size_t>(tet)]; }
  void stiffness(std::int32_t tet, linalg::ElementMatrix& out) const override {
    const double* block = blocks_.data() + 90 * static_cast<std::size_t>(tet);
    for (Eigen::Index a = 0; a < 4; ++a) {
      for (Eigen::Index b = 0; b <= a; ++b, block += 9) {
        const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> K(block);
        out.block<3, 3>(3 * a, 3 * b) = K;
        out.block<3, 3>(3 * b, 3 * a) = K.transpose();
      }
    }
    if (!coupling_.empty()) {
      const Eigen::Map<const linalg::ElementVector> b(coupling_.data() + 12 * static_cast<std::size_t>(tet));
      out.noalias() += b * b.transpose() / d_[tet];
    }
    if (shift_ > 0.0) out.diagonal().array() += shift_ * out.diagonal().cwiseAbs().mean();
  }
  void load(std::int32_t, linalg::ElementVector& out) const override { out.setZero(); }
  Vec3 node_load(std::int32_t) const override { return Vec3::Zero(); }
  unsigned free_components(std::int32_t node) const override { return free_[static_cast<std::size_t>(node)]; }

 private:
  std::vector<double> blocks_, coupling_;
  std::vector<std::array<std::int32_t, 4>> nodes_;
  std::vector<unsigned> free_;  ///< per node
  VectorX d_;
  double shift_ = 0.0;
};

}  // namespace

/// Never changes once made.
struct LiveLinear::Preconditioner {
  std::shared_ptr<const linalg::FrontTree> tree;
  std::unique_ptr<const linalg::FrontSolver> solver;  ///< of the tree
  linalg::PressurePatches patches;
  std::vector<Mat3> rotation;  ///< per node, at its state

  void solve(const VectorX& r, VectorX& z, linalg::FrontSolver::Work& work) const {
    solver->solve(r, z, work);
    patches.apply(r, z);
  }
};

LiveLinear::LiveLinear(const model::Model& model, const linalg::FreeDofs& free, const model::State& state)
    : model_(model), free_(free), rotations_(model.space()) {
  linalg::SaddleMatrix K = model.make_tangent();
  if (K.C.rows() > 0) {
    c_inverse_ = linalg::ChebyshevInverse(K.C, kPressureReduction);
    model.tangent(state, *model.make_scratch(), K);
    set_patches(K);
  }
  preconditioner_ = prepare(state, nullptr);
}

/// Once: A and B set a weight alone, and C stays.
void LiveLinear::set_patches(const linalg::SaddleMatrix& K) {
  const linalg::ChebyshevInverse inverse(K.C, kPatchReduction);
  patches_.set(K, [&](const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
    VectorX column;
    VectorX solved;
    linalg::ChebyshevInverse::Work work;
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      column = b.col(j);
      inverse.apply(column, solved, work);
      x.col(j) = solved;
    }
  });
}

LiveLinear::~LiveLinear() = default;

std::shared_ptr<const LiveLinear::Preconditioner> LiveLinear::prepare(const model::State& state,
                                                                      const linalg::FrontTree* before) const {
  auto out = std::make_shared<Preconditioner>();
  TetTangents tets(model_, free_, state);
  out->patches = patches_;
  rotations_.measure(state.u, out->rotation);
  tets.set_diagonal(patches_.diagonal());
  // A body under compression may have no definite tangent: what is solved is one that is stiffer.
  constexpr double kFirstShift = 0.03;
  constexpr double kLargestShift = 3.0;
  for (double shift = 0.0;; shift = std::max(kFirstShift, 3.0 * shift)) {
    tets.shift_by(shift);
    out->tree = before != nullptr ? before->refactored(tets) : linalg::FrontTree::make(tets, {});
    if (out->tree->outcome() == linalg::FrontOutcome::ok) break;
    RHEXIS_CHECK(shift <= kLargestShift, "not positive definite with {} of its diagonal added", shift);
  }
  out->solver = std::make_unique<const linalg::FrontSolver>(*out->tree);
  if (patches_.count() > 0) {
    linalg::SaddleMatrix K = model_.make_tangent();
    model_.tangent(state, *model_.make_scratch(), K);
    out->patches.correct(K, free_, [&](const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
      VectorX column;
      VectorX solved;
      linalg::FrontSolver::Work work;
      for (Eigen::Index j = 0; j < b.cols(); ++j) {
        column = b.col(j);
        out->solver->solve(column, solved, work);
        x.col(j) = solved;
      }
    });
  }
  return out;
}

void LiveLinear::set_tangent(const linalg::SaddleMatrix& K, const model::State& state) {
  K_ = &K;
  const Eigen::Index dofs = K.displacement_unknowns();
  work_.resize(dofs);
  for (VectorX* v : {&p_, &q_}) v->resize(K.C.rows());
  rotations_.measure(state.u, rotation_);
  turn();
}

/// T, and P~^-1 N^T by it.
void LiveLinear::turn() {
  turn_.resize(rotation_.size());
  for (std::size_t i = 0; i < turn_.size(); ++i) turn_[i] = rotation_[i] * preconditioner_->rotation[i].transpose();
  if (!point_) return;
  Mat3 answer;
  for (int j = 0; j < 3; ++j) {
    VectorX& of = answer_[static_cast<std::size_t>(j)];
    of.setZero(of_nodes_.front().size());
    for (int k = 0; k < point_->count; ++k) {
      const Mat3& at = turn_[static_cast<std::size_t>(point_->node[static_cast<std::size_t>(k)])];
      for (int c = 0; c < 3; ++c) of += point_->weight[k] * at(j, c) * of_nodes_[static_cast<std::size_t>(3 * k + c)];
    }
    for (std::size_t i = 0; i < turn_.size(); ++i) {
      auto x = of.segment<3>(static_cast<Eigen::Index>(3 * i));
      x = (turn_[i] * x).eval();
    }
    linalg::clear_held(free_, of);
    answer.col(j) = point_->of(of);
  }
  answer_inverse_ = answer.inverse();
}

void LiveLinear::apply(const VectorX& x, VectorX& y) {
  K_->A.multiply(x, y);
  if (q_.size() > 0) {
    K_->B.multiply(x, q_);
    c_inverse_.apply(q_, p_, c_work_);
    K_->B.add_transposed(p_, 1.0, y);
  }
  linalg::clear_held(free_, y);
  project(y);
}

void LiveLinear::set_constraint(const std::optional<HeldPoint>& point) {
  point_ = point;
  solve_for_point();
}

void LiveLinear::solve_for_point() {
  of_nodes_.clear();
  if (!point_) return;
  VectorX unit = VectorX::Zero(static_cast<Eigen::Index>(model_.space().dof_count()));
  for (int k = 0; k < 3 * point_->count; ++k) {
    const Eigen::Index dof = 3 * Eigen::Index{point_->node[static_cast<std::size_t>(k / 3)]} + k % 3;
    unit[dof] = 1.0;
    preconditioner_->solve(unit, of_nodes_.emplace_back(), front_work_);
    unit[dof] = 0.0;
  }
  if (!rotation_.empty()) turn();
}

/// r -= N^T (N N^T)^-1 N r.
void LiveLinear::project(VectorX& r) const {
  if (constrained_) point_->add(-point_->of(r) / point_->weight.squaredNorm(), r);
}

/// T P~^-1 T^T r, and what of it moves the point taken back.
void LiveLinear::precondition(const VectorX& r, VectorX& z) {
  turned_.resize(r.size());
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    turned_.segment<3>(at).noalias() = turn_[i].transpose() * r.segment<3>(at);
  }
  preconditioner_->solve(turned_, solved_, front_work_);
  z.resize(r.size());
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    z.segment<3>(at).noalias() = turn_[i] * solved_.segment<3>(at);
  }
  linalg::clear_held(free_, z);
  if (!constrained_) return;
  const Vec3 off = answer_inverse_ * point_->of(z);
  for (std::size_t j = 0; j < 3; ++j) z -= off[static_cast<Eigen::Index>(j)] * answer_[j];
}

LiveSolve LiveLinear::solve(Point point, const VectorX& bu, const VectorX& bp, double tolerance, int most, VectorX& xu,
                            VectorX& xp) {
  RHEXIS_CHECK(K_ != nullptr, "no tangent");
  LiveSolve out;
  constrained_ = point == Point::fixed && point_.has_value();
  r_ = bu;
  if (bp.size() > 0) {
    c_inverse_.apply(bp, p_, c_work_);
    K_->B.add_transposed(p_, 1.0, r_);
  }
  linalg::clear_held(free_, r_);
  project(r_);
  xu.setZero(bu.size());
  const double norm = r_.norm();
  if (norm > 0.0) {
    const linalg::CgResult result = linalg::conjugate_gradients(
        [&](const VectorX& x, VectorX& y) { apply(x, y); }, [&](const VectorX& r, VectorX& z) { precondition(r, z); },
        tolerance * norm, most, work_, r_, xu);
    out.iterations = result.iterations;
    out.truncated = result.end == linalg::CgEnd::negative_curvature;
    if (out.truncated && result.iterations == 1) xu = work_.z;  // nothing yet: the preconditioned residual, downhill
  }
  xp.setZero(bp.size());
  if (bp.size() > 0) {
    K_->B.multiply(xu, q_);
    q_ -= bp;
    c_inverse_.apply(q_, xp, c_work_);
  }
  return out;
}

void LiveLinear::refresh(const model::State& state) {
  if (task_.under_way()) return;
  ready_ = false;
  task_.start([this, state, tree = preconditioner_->tree] {
    const OneThreadHere beside;
    refreshed_ = prepare(state, tree.get());
    ready_ = true;
  });
}

bool LiveLinear::take_refreshed() {
  if (!task_.under_way() || !ready_) return false;
  task_.wait();
  preconditioner_ = std::move(refreshed_);
  solve_for_point();
  if (!point_ && !rotation_.empty()) turn();
  return true;
}

}  // namespace rhexis::solver
