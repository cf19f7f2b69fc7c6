#include "response/recorded_contact.h"

#include <algorithm>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace rhexis::response {
namespace {

using record::store::LoadedRecord;

/// The symmetric D with D A D = B of two symmetric positive definite matrices.
Mat3 congruence(const Mat3& A, const Mat3& B) {
  const Eigen::SelfAdjointEigenSolver<Mat3> of(A);
  const Mat3 root = of.operatorSqrt();
  const Mat3 inverse = of.operatorInverseSqrt();
  const Mat3 middle = root * B * root;
  return inverse * Eigen::SelfAdjointEigenSolver<Mat3>(middle).operatorSqrt() * inverse;
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& positive) {
  const Eigen::MatrixXd out = positive.llt().solve(Eigen::MatrixXd::Identity(positive.rows(), positive.cols()));
  return 0.5 * (out + out.transpose());
}

/// Sums over the topologies that count.
class Sum {
 public:
  Sum(const LoadedRecord& record, std::span<const int> points)
      : record_(record),
        points_(points),
        alone_(points.size(), Mat3::Zero()),
        together_(Eigen::MatrixXd::Zero(size(points.size()), size(points.size()))) {}

  void add(int topology, double weight) {
    std::vector<std::size_t> in;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (record_.record().is_in_solve(topology, points_[i])) in.push_back(i);
    }
    torn_off_ = torn_off_ || in.size() < points_.size();
    Eigen::MatrixXd L(size(in.size()), size(in.size()));
    for (std::size_t a = 0; a < in.size(); ++a) {
      const Mat3 K = record_.record().stiffness_at(topology, points_[in[a]]);
      alone_[in[a]] += weight * K;
      L.block<3, 3>(size(a), size(a)) = inverse_of(K);
      for (std::size_t b = 0; b < a; ++b) {
        const Mat3 block = *record_.compliance(topology, points_[in[a]], points_[in[b]]);
        L.block<3, 3>(size(a), size(b)) = block;
        L.block<3, 3>(size(b), size(a)) = block.transpose();
      }
    }
    const Eigen::MatrixXd K = inverse_of(L);
    for (std::size_t a = 0; a < in.size(); ++a) {
      for (std::size_t b = 0; b < in.size(); ++b)
        together_.block<3, 3>(size(in[a]), size(in[b])) += weight * K.block<3, 3>(size(a), size(b));
    }
  }

  [[nodiscard]] bool torn_off() const { return torn_off_; }
  [[nodiscard]] bool knows_all() const {
    return std::none_of(alone_.begin(), alone_.end(), [](const Mat3& K) { return K.isZero(0.0); });
  }
  [[nodiscard]] Eigen::MatrixXd compliance() const {
    Eigen::MatrixXd C = inverse_of(together_);
    std::vector<Mat3> scale;
    std::vector<Mat3> own;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      own.emplace_back(inverse_of(alone_[i]));
      scale.push_back(congruence(C.block<3, 3>(size(i), size(i)), own.back()));
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      C.middleRows<3>(size(i)) = (scale[i] * C.middleRows<3>(size(i))).eval();
      C.middleCols<3>(size(i)) = (C.middleCols<3>(size(i)) * scale[i]).eval();
    }
    C = (0.5 * (C + C.transpose())).eval();  // which it is but for rounding, as the blocks below
    for (std::size_t i = 0; i < points_.size(); ++i) C.block<3, 3>(size(i), size(i)) = own[i];
    return C;
  }

 private:
  static Eigen::Index size(std::size_t points) { return static_cast<Eigen::Index>(3 * points); }

  const LoadedRecord& record_;
  std::span<const int> points_;
  std::vector<Mat3> alone_;   ///< N/m, per point
  Eigen::MatrixXd together_;  ///< N/m
  bool torn_off_ = false;
};

}  // namespace

std::optional<RecordedContact> recorded_contact(const LoadedRecord& record, const record::store::Lookup& lookup,
                                                std::span<const record::store::Advanced> advances,
                                                std::span<const NodeId> nodes) {
  std::vector<int> points;
  for (const NodeId node : nodes) {
    const std::optional<int> point = record.point_of(node.value());
    if (!point) return std::nullopt;
    for (const int other : points)
      if (!record.compliance(0, *point, other)) return std::nullopt;
    points.push_back(*point);
  }
  bool torn_off = false;
  for (std::size_t used = advances.size() + 1; used-- > 0;) {
    Sum sum(record, points);
    lookup.each_topology(advances.first(used), [&](int topology, double weight) { sum.add(topology, weight); });
    torn_off = torn_off || sum.torn_off();
    if (sum.knows_all()) return RecordedContact{sum.compliance(), torn_off};
  }
  return std::nullopt;
}

}  // namespace rhexis::response
