#include "solver/live_linear.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include <Eigen/LU>

#include "base/check.h"
#include "base/parallel.h"

namespace rhexis::solver {
namespace {

/// Error of the map that stands in for C^-1 within an iteration: conjugate gradients take as many iterations with 0.3
/// as with 0.01. What it leaves is left in the residual, which is taken with C itself.
constexpr double kPressureReduction = 5e-1;
/// The same where E W is made.
constexpr double kPatchReduction = 1e-4;

/// The tangents of the tets, with their pressures eliminated by D, each at the state of its last look.
class TetTangents final : public linalg::ElementSource {
 public:
  TetTangents(const model::Model& model, const linalg::FreeDofs& free, const model::State& state) {
    const auto scratch = model.make_scratch();
    model.tet_tangents(state, *scratch, blocks_, coupling_);
    take_nodes(model, free);
    out_.resize(nodes_.size());
    for (std::size_t t = 0; t < nodes_.size(); ++t) out_[t] = is_nothing(t);
  }
  /// Touched tets at `state`, the others as they were.
  void follow(const model::Model& model, const linalg::FreeDofs& free, const model::State& state,
              const TornModel& torn) {
    std::vector<double> blocks;
    std::vector<double> coupling;
    const auto scratch = model.make_scratch();
    model.tet_tangents(state, *scratch, blocks, coupling);
    take_nodes(model, free);
    for (const std::int32_t tet : torn.touched) {
      const auto at = static_cast<std::ptrdiff_t>(tet);
      std::copy_n(blocks.begin() + 90 * at, 90, blocks_.begin() + 90 * at);
      if (!coupling.empty()) std::copy_n(coupling.begin() + 12 * at, 12, coupling_.begin() + 12 * at);
      out_[static_cast<std::size_t>(tet)] = is_nothing(static_cast<std::size_t>(tet));
    }
  }
  /// Back by T per node, to where the others are: T^T K T, T^T b.
  void turn_back(std::span<const std::int32_t> tets, const std::vector<Mat3>& turn) {
    for (const std::int32_t tet : tets) {
      const auto at = static_cast<std::size_t>(tet);
      const auto of = [&](std::size_t a) -> const Mat3& { return turn[static_cast<std::size_t>(nodes_[at][a])]; };
      double* block = blocks_.data() + 90 * at;
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b <= a; ++b, block += 9) {
          Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> K(block);
          K = (of(a).transpose() * K * of(b)).eval();
        }
        if (coupling_.empty()) continue;
        Eigen::Map<Vec3> b(coupling_.data() + 12 * at + 3 * a);
        b = (of(a).transpose() * b).eval();
      }
    }
  }
  /// Per tet, nonzero: the model leaves it out.
  const std::vector<std::uint8_t>& left_out() const { return out_; }
  /// Per tet, m^3/Pa.
  void set_diagonal(const VectorX& d) { d_ = d; }
  /// Adds this part of its mean diagonal to the diagonal of each tet.
  void shift_by(double part) { shift_ = part; }

  std::int32_t node_count() const override { return static_cast<std::int32_t>(free_.size()); }
  std::int32_t element_count() const override { return static_cast<std::int32_t>(nodes_.size()); }
  bool is_active(std::int32_t tet) const override { return out_[static_cast<std::size_t>(tet)] == 0; }
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
  std::size_t memory_bytes() const {
    return sizeof(double) * (blocks_.size() + coupling_.size()) + sizeof(nodes_[0]) * nodes_.size();
  }

 private:
  /// A tet that the model leaves out.
  std::uint8_t is_nothing(std::size_t tet) const {
    const double* block = blocks_.data() + 90 * tet;
    return std::all_of(block, block + 90, [](double value) { return value == 0.0; }) ? 1 : 0;
  }
  void take_nodes(const model::Model& model, const linalg::FreeDofs& free) {
    const std::vector<std::int32_t>& connectivity = model.space().connectivity;
    nodes_.resize(connectivity.size() / 4);
    for (std::size_t t = 0; t < nodes_.size(); ++t) {
      std::copy_n(connectivity.begin() + static_cast<std::ptrdiff_t>(4 * t), 4, nodes_[t].begin());
      std::sort(nodes_[t].begin(), nodes_[t].end());
    }
    free_.assign(model.space().node_count(), 0);
    for (const std::int32_t dof : free.dof) free_[static_cast<std::size_t>(dof / 3)] |= 1U << (dof % 3);
  }

  std::vector<double> blocks_, coupling_;
  std::vector<std::array<std::int32_t, 4>> nodes_;
  std::vector<std::uint8_t> out_;  ///< per tet
  std::vector<unsigned> free_;     ///< per node
  VectorX d_;
  double shift_ = 0.0;
};

linalg::ChebyshevInverse inverse_of_pressures(const model::Model& model) {
  const linalg::SaddleMatrix K = model.make_tangent();
  return K.C.rows() > 0 ? linalg::ChebyshevInverse(K.C, kPressureReduction) : linalg::ChebyshevInverse();
}

}  // namespace

void TornModel::add(const TornModel& next) {
  copied.insert(copied.end(), next.copied.begin(), next.copied.end());
  touched.insert(touched.end(), next.touched.begin(), next.touched.end());
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
}

/// Never changes once made.
struct LiveLinear::Preconditioner {
  TetTangents tets;
  std::shared_ptr<const linalg::FrontTree> tree;
  std::shared_ptr<const linalg::FrontSolver> solver;  ///< of the tree
  linalg::PressurePatches patches;
  bool torn = false;  ///< the patches are of a body that has torn since
  std::shared_ptr<const NodeRotations> rotations;
  std::vector<Mat3> rotation;  ///< per node, at its state

  void solve(const VectorX& r, VectorX& z, linalg::FrontSolver::Work& work) const {
    solver->solve(r, z, work);
    patches.apply(r, z);
  }
  /// D, E W and G.
  void set_patches(const linalg::SaddleMatrix& K) {
    const linalg::ChebyshevInverse inverse(K.C, kPatchReduction);
    patches.set(K, [&](const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
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
  void correct_patches(const linalg::SaddleMatrix& K, const linalg::FreeDofs& free) {
    patches.correct(K, free, [&](const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
      VectorX column;
      VectorX solved;
      linalg::FrontSolver::Work work;
      for (Eigen::Index j = 0; j < b.cols(); ++j) {
        column = b.col(j);
        solver->solve(column, solved, work);
        x.col(j) = solved;
      }
    });
  }
};

LiveLinear::LiveLinear(std::shared_ptr<const model::Model> model, linalg::FreeDofs free, const model::State& state)
    : model_(std::move(model)), free_(std::move(free)), c_inverse_(inverse_of_pressures(*model_)) {
  preconditioner_ = prepare(*model_, free_, state, nullptr);
}

LiveLinear::~LiveLinear() = default;

LiveLinear::Prepared LiveLinear::prepare(const model::Model& model, const linalg::FreeDofs& free,
                                         const model::State& state, const Preconditioner* before) {
  auto out = std::make_shared<Preconditioner>(Preconditioner{.tets = TetTangents(model, free, state),
                                                             .tree = {},
                                                             .solver = {},
                                                             .patches = {},
                                                             .rotations = {},
                                                             .rotation = {}});
  out->rotations = before != nullptr ? before->rotations
                                     : std::make_shared<const NodeRotations>(model.space(), out->tets.left_out());
  out->rotations->measure(state.u, out->rotation);
  linalg::SaddleMatrix K = model.make_tangent();
  if (K.C.rows() > 0) {
    model.tangent(state, *model.make_scratch(), K);
    if (before != nullptr && !before->torn) {
      out->patches = before->patches;
    } else {
      out->set_patches(K);
    }
    out->tets.set_diagonal(out->patches.diagonal());
  }
  // A body under compression may have no definite tangent: what is solved is one that is stiffer.
  constexpr double kFirstShift = 0.03;
  constexpr double kLargestShift = 1e4;
  for (double shift = 0.0;; shift = std::max(kFirstShift, 3.0 * shift)) {
    out->tets.shift_by(shift);
    out->tree = before != nullptr ? before->tree->refactored(out->tets) : linalg::FrontTree::make(out->tets, {});
    if (out->tree->outcome() == linalg::FrontOutcome::ok) break;
    RHEXIS_CHECK(shift <= kLargestShift, "not positive definite with {} of its diagonal added", shift);
  }
  out->solver = std::make_shared<const linalg::FrontSolver>(*out->tree);
  if (K.C.rows() > 0) out->correct_patches(K, free);
  return out;
}

LiveLinear::Prepared LiveLinear::followed(const Preconditioner& before, const model::State& state,
                                          const TornModel& torn) const {
  auto out = std::make_shared<Preconditioner>(before);
  for (const std::int32_t parent : torn.copied)
    out->rotation.push_back(before.rotation[static_cast<std::size_t>(parent)]);
  out->tets.follow(*model_, free_, state, torn);
  out->rotations = std::make_shared<const NodeRotations>(model_->space(), out->tets.left_out());
  std::vector<Mat3> turn;
  out->rotations->measure(state.u, turn);
  for (std::size_t i = 0; i < turn.size(); ++i) turn[i] = (turn[i] * out->rotation[i].transpose()).eval();
  out->tets.turn_back(torn.touched, turn);
  linalg::ElementChange change;
  change.copied = torn.copied;
  change.touched = torn.touched;
  out->tree = before.tree->updated(out->tets, change);
  if (out->tree->outcome() != linalg::FrontOutcome::ok) return nullptr;
  out->solver = std::make_shared<const linalg::FrontSolver>(*out->tree, before.solver.get());
  out->patches.follow(torn.copied, free_);
  out->torn = true;
  return out;
}

void LiveLinear::follow(std::shared_ptr<const model::Model> model, linalg::FreeDofs free, const model::State& state,
                        const TornModel& torn) {
  model_ = std::move(model);
  free_ = std::move(free);
  c_inverse_ = inverse_of_pressures(*model_);
  K_ = nullptr;
  point_.reset();
  rotation_.clear();
  if (task_.under_way()) {
    torn_since_.add(torn);
    state_then_ = state;
  }
  preconditioner_ = followed(*preconditioner_, state, torn);
  if (!preconditioner_) preconditioner_ = prepare(*model_, free_, state, nullptr);
}

void LiveLinear::set_tangent(const linalg::SaddleMatrix& K, const model::State& state) {
  K_ = &K;
  const Eigen::Index dofs = K.displacement_unknowns();
  work_.resize(dofs);
  for (VectorX* v : {&p_, &q_}) v->resize(K.C.rows());
  preconditioner_->rotations->measure(state.u, rotation_);
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
  VectorX unit = VectorX::Zero(static_cast<Eigen::Index>(model_->space().dof_count()));
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
    worked_ += result.iterations;
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
  worked_ = 0;
  torn_since_ = {};
  task_.start([this, model = model_, free = free_, state, before = preconditioner_] {
    const OneThreadHere beside;
    refreshed_ = prepare(*model, free, state, before.get());
  });
}

bool LiveLinear::take_refreshed() {
  if (!task_.under_way() || worked_ < kRefreshWork) return false;
  task_.wait();
  Prepared next = std::move(refreshed_);
  if (!torn_since_.touched.empty()) next = followed(*next, state_then_, torn_since_);
  if (!next) return false;
  preconditioner_ = std::move(next);
  solve_for_point();
  if (!point_ && !rotation_.empty()) turn();
  return true;
}

std::size_t LiveLinear::memory_bytes() const {
  return preconditioner_->tree->memory_bytes() + preconditioner_->solver->memory_bytes() +
         preconditioner_->patches.memory_bytes() + preconditioner_->tets.memory_bytes() + c_inverse_.memory_bytes();
}

}  // namespace rhexis::solver
