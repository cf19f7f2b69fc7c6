#include "solver/live_linear.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <Eigen/LU>

#include "base/check.h"
#include "base/parallel.h"
#include "solver/inertia.h"

namespace rhexis::solver {
namespace {

/// Error of the map that stands in for C^-1 within an iteration: conjugate gradients take as many iterations with 0.3
/// as with 0.01. What it leaves is left in the residual, which is taken with C itself.
constexpr double kPressureReduction = 3e-1;
/// The same where E W is made.
constexpr double kPatchReduction = 1e-4;
/// Of what it leaves: to a percent.
constexpr int kCarefulRounds = 3;
/// A direction of negative curvature is followed as far as if its curvature were positive, and that at least this part
/// of the preconditioner's.
constexpr double kFlat = 0.1;

/// The tangents of the tets, with their pressures eliminated by D, each at the state of its last look.
class TetTangents final : public linalg::ElementSource {
 public:
  /// `inertia`: of the mass, N/m per volume.
  TetTangents(const model::Model& model, const linalg::FreeDofs& free, const model::State& state, double inertia)
      : inertia_(inertia) {
    const auto scratch = model.make_scratch();
    model.tet_tangents(state, *scratch, blocks_, coupling_);
    take_nodes(model, free);
  }
  /// Touched tets at `state`, turned back by T, which is per node; the others as they were.
  void follow(const model::Model& model, const linalg::FreeDofs& free, const model::State& state,
              std::span<const std::int32_t> touched, const std::vector<Mat3>& T) {
    std::vector<double> blocks;
    std::vector<double> coupling;
    const auto scratch = model.make_scratch();
    model.tet_tangents(state, *scratch, blocks, coupling);
    take_nodes(model, free);
    for (const std::int32_t tet : touched) {
      const auto t = static_cast<std::size_t>(tet);
      const auto turn = [&](std::size_t a) -> const Mat3& { return T[static_cast<std::size_t>(nodes_[t][a])]; };
      std::size_t at = 90 * t;
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b <= a; ++b, at += 9)
          Block(blocks_.data() + at) = turn(a).transpose() * Block(blocks.data() + at) * turn(b);
      }
      for (std::size_t a = 0; a < 4 && !coupling.empty(); ++a) {
        const std::size_t of = 12 * t + 3 * a;
        Eigen::Map<Vec3>(coupling_.data() + of) = turn(a).transpose() * Eigen::Map<Vec3>(coupling.data() + of);
      }
    }
  }
  /// Per tet, m^3/Pa.
  void set_diagonal(const VectorX& d) { d_ = d; }
  /// Adds this part of its trace to the diagonal of each tet.
  void shift_by(double part) { shift_ = part; }

  std::int32_t node_count() const override { return static_cast<std::int32_t>(free_.size()); }
  std::int32_t element_count() const override { return static_cast<std::int32_t>(nodes_.size()); }
  bool is_active(std::int32_t tet) const override {
    return left_out_.empty() || left_out_[static_cast<std::size_t>(tet)] == 0;
  }
  std::array<std::int32_t, 4> nodes(std::int32_t tet) const override { return nodes_[static_cast<std::size_t>(tet)]; }
  void stiffness(std::int32_t tet, linalg::ElementMatrix& out) const override {
    const double* block = blocks_.data() + 90 * static_cast<std::size_t>(tet);
    for (Eigen::Index a = 0; a < 4; ++a) {
      for (Eigen::Index b = 0; b <= a; ++b, block += 9) {
        const Eigen::Map<const RowMajor> K(block);
        out.block<3, 3>(3 * a, 3 * b) = K;
        out.block<3, 3>(3 * b, 3 * a) = K.transpose();
      }
    }
    if (!coupling_.empty()) {
      const Eigen::Map<const linalg::ElementVector> b(coupling_.data() + 12 * static_cast<std::size_t>(tet));
      out.noalias() += b * b.transpose() / d_[tet];
    }
    if (!mass_.empty()) out.diagonal().array() += 0.25 * mass_[static_cast<std::size_t>(tet)];
    if (shift_ > 0.0) out.diagonal().array() += shift_ * out.diagonal().cwiseAbs().mean();
  }
  void load(std::int32_t, linalg::ElementVector& out) const override { out.setZero(); }
  Vec3 node_load(std::int32_t) const override { return Vec3::Zero(); }
  unsigned free_components(std::int32_t node) const override { return free_[static_cast<std::size_t>(node)]; }

  std::size_t memory_bytes() const {
    return sizeof(double) * (blocks_.size() + coupling_.size()) + sizeof(nodes_[0]) * nodes_.size();
  }

 private:
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  using Block = Eigen::Map<RowMajor>;

  void take_nodes(const model::Model& model, const linalg::FreeDofs& free) {
    const std::vector<std::int32_t>& connectivity = model.space().connectivity;
    nodes_.resize(connectivity.size() / 4);
    for (std::size_t t = 0; t < nodes_.size(); ++t) {
      std::copy_n(connectivity.begin() + static_cast<std::ptrdiff_t>(4 * t), 4, nodes_[t].begin());
      std::sort(nodes_[t].begin(), nodes_[t].end());
    }
    const std::span<const std::uint8_t> out = model.left_out();
    left_out_.assign(out.begin(), out.end());
    free_.assign(model.space().node_count(), 0);
    for (const std::int32_t dof : free.dof) free_[static_cast<std::size_t>(dof / 3)] |= 1U << (dof % 3);
    if (inertia_ > 0.0) mass_ = tet_masses(model, inertia_);
  }

  std::vector<double> blocks_, coupling_;
  std::vector<std::array<std::int32_t, 4>> nodes_;
  std::vector<std::uint8_t> left_out_;  ///< per tet
  std::vector<unsigned> free_;          ///< per node
  VectorX d_;
  double inertia_;
  std::vector<double> mass_;  ///< per tet, of its mass on the tangent's diagonal, N/m; empty: it has none
  double shift_ = 0.0;
};

/// What a map (b, x) gives of each column.
template <typename Map>
linalg::PressurePatches::Solve by_columns(Map map) {
  return [map](const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
    VectorX column;
    VectorX solved;
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      column = b.col(j);
      map(column, solved);
      x.col(j) = solved;
    }
  };
}

/// Patches of C, and what else of it a preconditioner keeps: A and B set a weight alone.
linalg::PressurePatches patches_of(const linalg::SaddleMatrix& K) {
  linalg::PressurePatches out;
  const linalg::ChebyshevInverse inverse(K.C, kPatchReduction);
  linalg::ChebyshevInverse::Work work;
  out.set(K, by_columns([&](const VectorX& b, VectorX& x) { inverse.apply(b, x, work); }));
  return out;
}

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
  std::shared_ptr<const model::Model> model;  ///< whose C it knows
  TetTangents tets;
  std::shared_ptr<const linalg::FrontTree> tree;
  std::shared_ptr<const linalg::FrontSolver> solver;  ///< of the tree
  linalg::PressurePatches patches;
  std::vector<Mat3> rotation;  ///< per node, at its state

  void solve(const VectorX& r, VectorX& z, linalg::FrontSolver::Work& work) const {
    solver->solve(r, z, work);
    patches.apply(r, z);
  }
};

LiveLinear::LiveLinear(std::shared_ptr<const model::Model> model, linalg::FreeDofs free, const model::State& state,
                       double inertia)
    : model_(std::move(model)),
      free_(std::move(free)),
      inertia_(inertia),
      c_inverse_(inverse_of_pressures(*model_)),
      rotations_(model_->space(), model_->left_out()) {
  preconditioner_ = prepare(model_, free_, state, inertia_, nullptr);
}

LiveLinear::~LiveLinear() = default;

LiveLinear::Prepared LiveLinear::prepare(const std::shared_ptr<const model::Model>& model, const linalg::FreeDofs& free,
                                         const model::State& state, double inertia, const Preconditioner* before) {
  auto out = std::make_shared<Preconditioner>(
      Preconditioner{model, TetTangents(*model, free, state, inertia), nullptr, nullptr, {}, {}});
  TetTangents& tets = out->tets;
  linalg::SaddleMatrix K = model->make_tangent();
  if (K.C.rows() > 0) {
    model->tangent(state, *model->make_scratch(), K);
    out->patches = before != nullptr && before->model == model ? before->patches : patches_of(K);
  }
  NodeRotations(model->space(), model->left_out()).measure(state.u, out->rotation);
  tets.set_diagonal(out->patches.diagonal());
  // A body under compression may have no definite tangent: what is solved is one that is stiffer.
  constexpr double kFirstShift = 0.03;
  constexpr double kLargestShift = 1e4;
  for (double shift = 0.0;; shift = std::max(kFirstShift, 3.0 * shift)) {
    tets.shift_by(shift);
    out->tree = before != nullptr ? before->tree->refactored(tets) : linalg::FrontTree::make(tets, {});
    if (out->tree->outcome() == linalg::FrontOutcome::ok) break;
    RHEXIS_CHECK(shift <= kLargestShift, "not positive definite with {} of its diagonal added", shift);
  }
  out->solver = std::make_shared<const linalg::FrontSolver>(*out->tree);
  if (out->patches.count() > 0) {
    linalg::FrontSolver::Work work;
    out->patches.correct(K, free, by_columns([&](const VectorX& b, VectorX& x) { out->solver->solve(b, x, work); }));
  }
  return out;
}

LiveLinear::Prepared LiveLinear::followed(const Preconditioner& before, const model::State& state,
                                          const TornModel& torn) const {
  auto out = std::make_shared<Preconditioner>(before);
  for (const std::int32_t parent : torn.copied)
    out->rotation.push_back(out->rotation[static_cast<std::size_t>(parent)]);
  std::vector<Mat3> T;
  rotations_.measure(state.u, T);
  for (std::size_t i = 0; i < T.size(); ++i) T[i] = (T[i] * out->rotation[i].transpose()).eval();
  out->tets.follow(*model_, free_, state, torn.touched, T);
  linalg::ElementChange change;
  change.copied = torn.copied;
  change.touched = torn.touched;
  out->tree = before.tree->updated(out->tets, change);
  if (out->tree->outcome() != linalg::FrontOutcome::ok) return nullptr;
  out->solver = std::make_shared<const linalg::FrontSolver>(*out->tree, before.solver.get());
  out->patches.follow(torn.copied, free_);
  return out;
}

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
  preconditioner_ = followed(*preconditioner_, state, torn);
  if (!preconditioner_) preconditioner_ = prepare(model_, free_, state, inertia_, nullptr);
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
    invert_pressure(q_, p_, careful_);
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

/// x ~ C^-1 b, not in place. Carefully: what the map leaves, some times over.
void LiveLinear::invert_pressure(const VectorX& b, VectorX& x, bool careful) {
  c_inverse_.apply(b, x, c_work_);
  for (int round = 0; careful && round < kCarefulRounds; ++round) {
    left_.resize(b.size());
    K_->C.multiply(x, left_);
    left_ = b - left_;
    c_inverse_.apply(left_, more_, c_work_);
    x += more_;
  }
}

void LiveLinear::first_answer(int j, VectorX& xu, VectorX& xp) {
  xu = answer_[static_cast<std::size_t>(j)];
  if (xp.size() == 0) return;
  K_->B.multiply(xu, q_);
  invert_pressure(q_, xp, true);
}

double LiveLinear::energy_of_pressure(const VectorX& rp) {
  if (rp.size() == 0) return 0.0;
  invert_pressure(rp, p_, true);
  return 0.5 * rp.dot(p_);
}

LiveSolve LiveLinear::solve(Point point, const VectorX& bu, const VectorX& bp, double tolerance, int most, bool careful,
                            VectorX& xu, VectorX& xp) {
  RHEXIS_CHECK(K_ != nullptr, "no tangent");
  LiveSolve out;
  careful_ = careful;
  constrained_ = point == Point::fixed && point_.has_value();
  r_ = bu;
  if (bp.size() > 0) {
    invert_pressure(bp, p_, careful_);
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
    if (out.truncated && point == Point::fixed) {
      const double slope = r_.dot(work_.z);
      xu += slope / std::max(std::abs(work_.p.dot(work_.q)), kFlat * slope) * work_.p;
    }
  }
  xp.setZero(bp.size());
  if (bp.size() > 0) {
    K_->B.multiply(xu, q_);
    q_ -= bp;
    invert_pressure(q_, xp, careful_);
  }
  return out;
}

void LiveLinear::refresh(const model::State& state) {
  if (task_.under_way()) return;
  worked_ = 0;
  torn_since_ = {};
  ready_ = false;
  task_.start([this, state, model = model_, free = free_, inertia = inertia_, before = preconditioner_] {
    const OneThreadHere beside;
    refreshed_ = prepare(model, free, state, inertia, before.get());
    ready_ = true;
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
