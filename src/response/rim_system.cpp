#include "response/rim_system.h"

#include <algorithm>
#include <iterator>

#include "base/check.h"
#include "linalg/front_kernels.h"
#include "linalg/null_pivot.h"

namespace rhexis::response {
namespace {

void find_places(const std::vector<std::int32_t>& of, const std::vector<std::int32_t>& in, std::vector<int>& out) {
  out.clear();
  auto at = in.begin();
  for (const std::int32_t dof : of) {
    at = std::lower_bound(at, in.end(), dof);
    out.push_back(static_cast<int>(at - in.begin()));
  }
}

void add_rows(const Eigen::MatrixXd& from, const std::vector<int>& place, Eigen::MatrixXd& to) {
  for (Eigen::Index column = 0; column < from.cols(); ++column) {
    for (std::size_t i = 0; i < place.size(); ++i) {
      to(place[i], column) += from(static_cast<Eigen::Index>(i), column);
    }
  }
}

/// Lower triangles. Places ascend, and hardly ever skip one: whole runs are added at a time.
void add_lower(const Eigen::MatrixXd& from, const std::vector<int>& place, Eigen::MatrixXd& to) {
  const std::size_t n = place.size();
  std::vector<std::size_t> run_end(n);
  for (std::size_t i = n; i-- > 0;) run_end[i] = i + 1 < n && place[i + 1] == place[i] + 1 ? run_end[i + 1] : i + 1;
  const linalg::FrontKernels& kernels = linalg::front_kernels();
  for (std::size_t j = 0; j < n; ++j) {
    const double* const source = from.data() + static_cast<Eigen::Index>(j) * from.rows();
    double* const target = to.data() + place[j] * to.rows();
    for (std::size_t i = j; i < n; i = run_end[i]) {
      kernels.add(target + place[i], source + i, static_cast<int>(run_end[i] - i));
    }
  }
}

VectorX take(const VectorX& x, const std::vector<int>& place) {
  VectorX out(static_cast<Eigen::Index>(place.size()));
  for (std::size_t i = 0; i < place.size(); ++i) out[static_cast<Eigen::Index>(i)] = x[place[i]];
  return out;
}

}  // namespace

bool RimSystem::factor(const linalg::FrontTree& outside, const linalg::FrontTree* inside) {
  dofs_.clear();
  outside_.clear();
  inside_.clear();
  if (inside != nullptr) {
    std::set_union(outside.kept_dofs().begin(), outside.kept_dofs().end(), inside->kept_dofs().begin(),
                   inside->kept_dofs().end(), std::back_inserter(dofs_));
    find_places(outside.kept_dofs(), dofs_, outside_);
    find_places(inside->kept_dofs(), dofs_, inside_);
  }
  const auto n = static_cast<Eigen::Index>(dofs_.size());
  const int size = static_cast<int>(n);
  L_.resize(n, n);
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(n, 1);
  if (inside != nullptr) {
    for (Eigen::Index j = 0; j < n; ++j) L_.col(j).tail(n - j).setZero();
    add_lower(outside.schur(), outside_, L_);
    add_lower(inside->schur(), inside_, L_);
    add_rows(outside.schur_load(), outside_, load);
    add_rows(inside->schur_load(), inside_, load);
  }
  const VectorX diagonal = L_.diagonal();
  work_.resize(dofs_.size() * linalg::kFactorWidth);
  if (!linalg::front_kernels().factor(L_.data(), size, size, size, work_.data())) return false;
  const VectorX pivots = L_.diagonal().array().square() / diagonal.array();
  if (n > 0 && !(pivots.minCoeff() > linalg::null_pivot(size))) return false;
  forward(load);
  load_ = load.col(0);
  return true;
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
         sizeof(int) * (outside_.capacity() + inside_.capacity()) + sizeof(double) * work_.capacity();
}

}  // namespace rhexis::response
