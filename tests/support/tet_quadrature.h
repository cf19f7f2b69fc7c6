#pragma once

/// Integration over tets for oracles: a collapsed 5 x 5 x 5 Gauss rule, exact to degree 7 and independent of the rules
/// in src/.

#include <array>
#include <functional>
#include <vector>

#include "mesh/tet_mesh.h"

namespace rhexis::test {

struct TetPoint {
  std::array<double, 4> barycentric{};
  double weight = 0.0;  ///< of the whole tet; the weights add up to 1
};

inline const std::vector<TetPoint>& tet_points() {
  static const std::vector<TetPoint> points = [] {
    constexpr std::array<double, 5> x{0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842, 0.953089922969332};
    constexpr std::array<double, 5> w{0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                                      0.118463442528095};
    std::vector<TetPoint> list;
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j < 5; ++j)
        for (std::size_t k = 0; k < 5; ++k) {
          const double a = x[i];
          const double b = x[j] * (1 - a);
          const double c = x[k] * (1 - a - b);
          list.push_back({{1 - a - b - c, a, b, c}, 6.0 * w[i] * w[j] * w[k] * (1 - a) * (1 - a - b)});
        }
    return list;
  }();
  return points;
}

/// Gradients of the four barycentric coordinates, 1/m.
inline std::array<Vec3, 4> barycentric_gradients(const std::array<Vec3, 4>& x) {
  Mat3 edges;
  edges << x[1] - x[0], x[2] - x[0], x[3] - x[0];
  const Mat3 inverse = edges.inverse();
  std::array<Vec3, 4> g;
  for (int k = 0; k < 3; ++k) g[static_cast<std::size_t>(k) + 1] = inverse.row(k).transpose();
  g[0] = -(g[1] + g[2] + g[3]);
  return g;
}

/// Values and gradients of the P1 (4) or P2 (10) shape functions at a point; P2 in the order of mesh::kTetEdges.
struct Shapes {
  std::vector<double> value;
  std::vector<Vec3> gradient;
};

inline Shapes shapes_at(int order, const std::array<double, 4>& l, const std::array<Vec3, 4>& g) {
  Shapes s;
  for (std::size_t i = 0; i < 4; ++i) {
    s.value.push_back(order == 1 ? l[i] : l[i] * (2 * l[i] - 1));
    s.gradient.push_back(order == 1 ? g[i] : Vec3((4 * l[i] - 1) * g[i]));
  }
  if (order == 2)
    for (const auto& [a, b] : mesh::kTetEdges) {
      const auto i = static_cast<std::size_t>(a);
      const auto j = static_cast<std::size_t>(b);
      s.value.push_back(4 * l[i] * l[j]);
      s.gradient.push_back(4 * (l[i] * g[j] + l[j] * g[i]));
    }
  return s;
}

}  // namespace rhexis::test
