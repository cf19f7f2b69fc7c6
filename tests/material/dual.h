#pragma once

/// Dual numbers: exact first derivatives of templated code.

#include <cmath>

namespace rhexis::test {

struct Dual {
  double v = 0.0;  ///< value
  double d = 0.0;  ///< derivative

  constexpr Dual() = default;
  constexpr Dual(double value, double derivative = 0.0) : v(value), d(derivative) {}

  friend Dual operator+(Dual a, Dual b) { return {a.v + b.v, a.d + b.d}; }
  friend Dual operator-(Dual a, Dual b) { return {a.v - b.v, a.d - b.d}; }
  friend Dual operator-(Dual a) { return {-a.v, -a.d}; }
  friend Dual operator*(Dual a, Dual b) { return {a.v * b.v, a.d * b.v + a.v * b.d}; }
  friend Dual operator/(Dual a, Dual b) { return {a.v / b.v, (a.d - a.v / b.v * b.d) / b.v}; }
};

inline Dual sqrt(Dual a) { return {std::sqrt(a.v), 0.5 * a.d / std::sqrt(a.v)}; }
inline Dual inverse_cbrt(Dual a) {
  const double r = 1.0 / std::cbrt(a.v);
  return {r, -r / (3.0 * a.v) * a.d};
}

}  // namespace rhexis::test
