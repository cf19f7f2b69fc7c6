#pragma once

/// Several systems with one matrix, solved side by side: a row per unknown, a lane per system, the lanes of a row
/// together in memory; two or four of them. To fetch the matrix and to find the entries of a vector is most of what a
/// sparse product costs, and with lanes it is done once for all of them.

#include "base/vec.h"

namespace rhexis::linalg {

/// With one lane a VectorX.
template <int k>
using Lanes = Eigen::Matrix<double, Eigen::Dynamic, k, k == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
template <int k>
using SingleLanes = Eigen::Matrix<float, Eigen::Dynamic, k, k == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
using TwoLanes = Lanes<2>;
using FourLanes = Lanes<4>;

/// Per lane, of vectors that are k numbers wide.
template <int k>
using PerLane = Eigen::Array<double, 1, k>;

/// a . b of each lane, summed in the order of the rows.
template <int k>
PerLane<k> dots(const Lanes<k>& a, const Lanes<k>& b) {
  PerLane<k> sum = PerLane<k>::Zero();
  for (Eigen::Index i = 0; i < a.rows(); ++i) sum += a.row(i).array() * b.row(i).array();
  return sum;
}
template <>
inline PerLane<1> dots<1>(const VectorX& a, const VectorX& b) {
  return PerLane<1>::Constant(a.dot(b));
}

}  // namespace rhexis::linalg
