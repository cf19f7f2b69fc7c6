#include "response/rim_system.h"

#include <algorithm>
#include <iterator>

#include "base/check.h"
#include "linalg/front_kernels.h"
#include "linalg/null_pivot.h"

namespace rhexis::response {
namespace {

std::vector<Eigen::Index> places(const std::vector<std::int32_t>& of, const std::vector<std::int32_t>& in) {
  std::vector<Eigen::Index> out;
  auto at = in.begin();
  for (const std::int32_t dof : of) {
    at = std::lower_bound(at, in.end(), dof);
    out.push_back(at - in.begin());
  }
  return out;
}

void add_rows(const Eigen::MatrixXd& from, const std::vector<Eigen::Index>& place, Eigen::MatrixXd& to) {
  for (Eigen::Index column = 0; column < from.cols(); ++column) {
    for (std::size_t i = 0; i < place.size(); ++i) {
      to(place[i], column) += from(static_cast<Eigen::Index>(i), column);
    }
  }
}

void add_block(const Eigen::MatrixXd& from, const std::vector<Eigen::Index>& place, Eigen::MatrixXd& to) {
  for (std::size_t j = 0; j < place.size(); ++j) {
    for (std::size_t i = 0; i < place.size(); ++i) {
      to(place[i], place[j]) += from(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
}

VectorX take(const VectorX& x, const std::vector<Eigen::Index>& place) {
  VectorX out(static_cast<Eigen::Index>(place.size()));
  for (std::size_t i = 0; i < place.size(); ++i) out[static_cast<Eigen::Index>(i)] = x[place[i]];
  return out;
}

}  // namespace

std::optional<RimSystem> RimSystem::make(const linalg::FrontTree& outside, const linalg::FrontTree* inside) {
  RimSystem out;
  if (inside == nullptr) return out;
  std::set_union(outside.kept_dofs().begin(), outside.kept_dofs().end(), inside->kept_dofs().begin(),
                 inside->kept_dofs().end(), std::back_inserter(out.dofs_));
  out.outside_ = places(outside.kept_dofs(), out.dofs_);
  out.inside_ = places(inside->kept_dofs(), out.dofs_);

  const auto n = static_cast<Eigen::Index>(out.dofs_.size());
  out.L_ = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(n, 1);
  add_block(outside.schur(), out.outside_, out.L_);
  add_block(inside->schur(), out.inside_, out.L_);
  add_rows(outside.schur_load(), out.outside_, load);
  add_rows(inside->schur_load(), out.inside_, load);

  const VectorX diagonal = out.L_.diagonal();
  const int size = static_cast<int>(n);
  std::vector<double> work(static_cast<std::size_t>(n) * linalg::kFactorWidth);
  if (!linalg::front_kernels().factor(out.L_.data(), size, size, size, work.data())) return std::nullopt;
  const VectorX pivots = out.L_.diagonal().array().square() / diagonal.array();
  if (n > 0 && !(pivots.minCoeff() > linalg::null_pivot(size))) return std::nullopt;
  out.forward(load);
  out.load_ = load.col(0);
  return out;
}

Eigen::Index RimSystem::place(std::int32_t dof) const {
  const auto at = std::lower_bound(dofs_.begin(), dofs_.end(), dof);
  return at != dofs_.end() && *at == dof ? at - dofs_.begin() : -1;
}

void RimSystem::add_outside(const Eigen::MatrixXd& kept, Eigen::MatrixXd& to) const { add_rows(kept, outside_, to); }
void RimSystem::add_inside(const Eigen::MatrixXd& kept, Eigen::MatrixXd& to) const { add_rows(kept, inside_, to); }
void RimSystem::forward(Eigen::MatrixXd& b) const {
  const auto n = static_cast<int>(L_.rows());
  if (n > 0) linalg::front_kernels().forward(L_.data(), n, n, 0, b.data(), n, static_cast<int>(b.cols()));
}
void RimSystem::backward(VectorX& y) const {
  const auto n = static_cast<int>(L_.rows());
  if (n > 0) linalg::front_kernels().backward(L_.data(), n, n, 0, y.data());
}
VectorX RimSystem::at_outside(const VectorX& x) const { return take(x, outside_); }
VectorX RimSystem::at_inside(const VectorX& x) const { return take(x, inside_); }

std::size_t RimSystem::memory_bytes() const {
  return sizeof(double) * static_cast<std::size_t>(L_.size() + load_.size()) + sizeof(std::int32_t) * dofs_.capacity() +
         sizeof(Eigen::Index) * (outside_.capacity() + inside_.capacity());
}

}  // namespace rhexis::response
