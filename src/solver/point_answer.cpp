#include "solver/point_answer.h"

#include <algorithm>
#include <utility>

#include <Eigen/LU>

namespace rhexis::solver {
namespace {

using linalg::Lanes;
using linalg::PerLane;

/// Solves, each from what the one before has left, at most: the map that stands in for C^-1 leaves something of the
/// pressure's row.
constexpr int kRounds = 4;
/// No solve is asked for less than this, relative: where little is wanting an iteration brings more.
constexpr double kLeastReduction = 0.5;
/// Relative residual of a column with which it is none; it is solved for carefully then.
constexpr double kNoAnswer = 0.5;

}  // namespace

void PointAnswer::begin(const HeldPoint& point, LiveLinear& linear) {
  point_ = point;
  linear.first_answer(u_, lambda_);
  rotation_ = linear.rotation();
}

void PointAnswer::follow(std::span<const std::int32_t> copied) {
  const Eigen::Index nodes = u_.rows() / 3;
  u_.conservativeResize(u_.rows() + 3 * static_cast<Eigen::Index>(copied.size()), Eigen::NoChange);
  for (std::size_t i = 0; i < copied.size(); ++i) {
    u_.middleRows<3>(3 * (nodes + static_cast<Eigen::Index>(i))) = u_.middleRows<3>(3 * Eigen::Index{copied[i]});
    rotation_.push_back(rotation_[static_cast<std::size_t>(copied[i])]);
  }
}

void PointAnswer::turn(const LiveLinear& linear, const linalg::FreeDofs& free) {
  const std::vector<Mat3>& now = linear.rotation();
  Mat3 of_point = Mat3::Zero();
  for (int k = 0; k < point_.count; ++k) {
    const auto node = static_cast<std::size_t>(point_.node[static_cast<std::size_t>(k)]);
    of_point += point_.weight[k] * now[node] * rotation_[node].transpose();
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    auto Z = u_.block<3, 3>(static_cast<Eigen::Index>(3 * i), 0);
    Z = (now[i] * rotation_[i].transpose() * Z * of_point.transpose()).eval();
  }
  linalg::clear_held(free, u_);
  lambda_.leftCols<3>() = (lambda_.leftCols<3>() * of_point.transpose()).eval();
  rotation_ = now;
}

template <int k>
PerLane<k> PointAnswer::measure(int first, const linalg::SaddleMatrix& K, const linalg::FreeDofs& free, Work<k>& work) {
  work.left_u.resize(work.xu.rows(), k);
  work.left_p.resize(work.xp.rows(), k);
  K.multiply(work.xu, work.xp, work.left_u, work.left_p);
  work.left_u = -work.left_u;
  work.left_p = -work.left_p;
  for (int lane = 0; lane < k - 1; ++lane) point_.add(Vec3::Unit(first + lane), work.left_u, lane);
  linalg::clear_held(free, work.left_u);
  PerLane<k> sum = linalg::dots<k>(work.left_u, work.left_u);
  const VectorX& scale = scale_.pressure_scale();
  for (Eigen::Index p = 0; p < work.left_p.rows(); ++p) sum += (scale[p] * work.left_p.row(p).array()).square();
  return sum.sqrt() / point_.weight.norm();
}

/// From what is left, and `beside` from its own; adds to the columns and gives the iterations.
template <int k>
int PointAnswer::solve(LiveLinear& linear, const std::array<LiveOrder, k>& columns, Beside* beside, Work<k>& work) {
  constexpr int kSpare = k - 1;
  std::array<LiveOrder, k> orders = columns;
  work.left_u.col(kSpare).setZero();
  work.left_p.col(kSpare).setZero();
  if (beside != nullptr) {
    orders[kSpare] = beside->order;
    work.left_u.col(kSpare) = beside->bu;
    work.left_p.col(kSpare) = beside->bp;
  }
  const auto solves = linear.solve<k>(orders, work.left_u, work.left_p, work.du, work.dp);
  if (beside != nullptr) {
    beside->solve = solves[kSpare];
    beside->xu = work.du.col(kSpare);
    beside->xp = work.dp.col(kSpare);
  }
  for (int lane = 0; lane < k; ++lane) {
    if (lane < kSpare && work.du.col(lane).allFinite() && work.dp.col(lane).allFinite()) continue;
    work.du.col(lane).setZero();
    work.dp.col(lane).setZero();
  }
  work.xu += work.du;
  work.xp += work.dp;
  int iterations = 0;
  for (const LiveSolve& of : solves) iterations = std::max(iterations, of.iterations);
  return iterations;
}

template <int k>
PointAnswer::Report PointAnswer::refresh_columns(int first, const linalg::SaddleMatrix& K, const linalg::FreeDofs& free,
                                                 LiveLinear& linear, const Wanted& wanted, Beside* beside) {
  constexpr int kColumns = k - 1;
  Report report;
  auto& work = std::get<Work<k>>(work_);
  work.xu.setZero(u_.rows(), k);
  work.xp.setZero(lambda_.rows(), k);
  work.xu.leftCols(kColumns) = u_.middleCols(first, kColumns);
  work.xp.leftCols(kColumns) = lambda_.middleCols(first, kColumns);
  scale_.set_system(K, free);
  PerLane<k> left = measure<k>(first, K, free, work);
  if (!(left < 1.0).all()) {  // worse than none
    linalg::FourLanes u;
    linalg::FourLanes lambda;
    linear.first_answer(u, lambda);
    for (int lane = 0; lane < kColumns; ++lane) {
      if (left[lane] < 1.0) continue;
      work.xu.col(lane) = u.col(first + lane);
      work.xp.col(lane) = lambda.col(first + lane);
    }
    left = measure<k>(first, K, free, work);
  }
  std::array<bool, k> stuck{};
  bool careful = false;
  int most = wanted.iterations;
  for (int round = 0; round < kRounds; ++round) {
    std::array<LiveOrder, k> orders;
    bool any = false;
    for (int lane = 0; lane < kColumns; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      if (stuck[l] || !(left[lane] > wanted.residual) || report.iterations >= most) continue;
      any = true;
      orders[l] = {.tolerance = std::min(kLeastReduction, 0.5 * wanted.residual / left[lane]),
                   .most = most - report.iterations,
                   .careful = careful};
    }
    if (!any) break;
    report.iterations += solve<k>(linear, orders, std::exchange(beside, nullptr), work);
    const PerLane<k> before = std::exchange(left, measure<k>(first, K, free, work));
    bool undone = false;
    for (int lane = 0; lane < kColumns; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      if (orders[l].most == 0 || left[lane] < before[lane]) continue;
      // Near where the body gives way. As it was: another frame like it would do nothing else.
      work.xu.col(lane) -= work.du.col(lane);
      work.xp.col(lane) -= work.dp.col(lane);
      undone = true;
      stuck[l] = before[lane] < kNoAnswer || careful;
    }
    if (!undone) continue;
    report.worn = true;
    careful = true;
    most = wanted.iterations + report.iterations;
    left = measure<k>(first, K, free, work);
  }
  u_.middleCols(first, kColumns) = work.xu.leftCols(kColumns);
  lambda_.middleCols(first, kColumns) = work.xp.leftCols(kColumns);
  if (beside != nullptr) {  // the column does not need it
    beside->solve = linear.solve(beside->order, beside->bu, beside->bp, beside->xu, beside->xp);
    report.iterations += beside->solve.iterations;
  }
  return report;
}
template PointAnswer::Report PointAnswer::refresh_columns<2>(int, const linalg::SaddleMatrix&, const linalg::FreeDofs&,
                                                             LiveLinear&, const Wanted&, Beside*);
template PointAnswer::Report PointAnswer::refresh_columns<4>(int, const linalg::SaddleMatrix&, const linalg::FreeDofs&,
                                                             LiveLinear&, const Wanted&, Beside*);

Mat3 PointAnswer::compliance() const {
  Mat3 C;
  for (int j = 0; j < 3; ++j) C.col(j) = point_.of(u_, j);
  return C;
}

void PointAnswer::add(const Vec3& f, model::State& state) const {
  state.u.noalias() += u_.leftCols<3>() * f;
  if (lambda_.rows() > 0) state.lambda.noalias() += lambda_.leftCols<3>() * f;
}

void PointAnswer::add_turned(const std::vector<Mat3>& now, const Vec3& gap, const linalg::FreeDofs& free,
                             model::State& state) {
  const auto turn = [&](std::size_t node) { return Mat3(now[node] * rotation_[node].transpose()); };
  Mat3 of_point = Mat3::Zero();  // N T Z
  for (int k = 0; k < point_.count; ++k) {
    const std::int32_t node = point_.node[static_cast<std::size_t>(k)];
    of_point += point_.weight[k] * turn(static_cast<std::size_t>(node)) * u_.block<3, 3>(3 * Eigen::Index{node}, 0);
  }
  const Vec3 f = of_point.inverse() * gap;
  move_.resize(u_.rows());
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    move_.segment<3>(at) = turn(i) * (u_.block<3, 3>(at, 0) * f);
  }
  linalg::clear_held(free, move_);
  state.u += move_;
  if (lambda_.rows() > 0) state.lambda.noalias() += lambda_.leftCols<3>() * f;
}

Vec3 PointAnswer::dot(const model::Residual& r) const {
  Vec3 out = u_.leftCols<3>().transpose() * r.u;
  if (lambda_.rows() > 0) out += lambda_.leftCols<3>().transpose() * r.lambda;
  return out;
}

}  // namespace rhexis::solver
