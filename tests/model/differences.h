#pragma once

/// Derivatives along a direction, for the tests of gradients and tangents.

#include "base/vec.h"

namespace rhexis::test {

/// f'(0) by the central formula of order 6: with h about 0.01 of the scale on which f changes, truncation
/// (h^6 f^(7) / 140) and rounding (epsilon / h) are both near 1e-14 of f.
template <class F>
auto derivative(const F& f, double h) {
  const auto difference = [&](double s) { return ((f(s) - f(-s)) / (60.0 * h)).eval(); };
  auto result = (45.0 * difference(h)).eval();
  result -= 9.0 * difference(2.0 * h);
  result += difference(3.0 * h);
  return result;
}

/// The same of a number.
template <class F>
double scalar_derivative(const F& f, double h) {
  return derivative([&](double s) { return Eigen::Matrix<double, 1, 1>(f(s)); }, h).value();
}

}  // namespace rhexis::test
