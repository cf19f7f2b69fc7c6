#pragma once

/// One tet of the Taylor-Hood pair: shape functions, quadrature, and the integrals of a law over it.
///
/// The rule has 14 points with positive weights and is exact to degree 5. On straight-sided tets grad u is linear, so
/// that everything volumetric is integrated exactly: lambda (J - 1) and its derivatives are of degree 4, and the
/// constraint sees the true volume. The law is no polynomial; there the error is of higher order than the elements'.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Geometry>

#include "base/vec.h"
#include "material/tensor.h"
#include "mesh/tet_mesh.h"

namespace rhexis::model::taylor_hood {

/// A point of the rule: its share of the volume and its barycentric coordinates, which are the P1 shape functions.
struct RulePoint {
  double weight = 0.0;
  std::array<double, 4> L{};
};

/// N. J. Walkington's 14 points of degree 5: two orbits of four (on the medians) and one of six (between opposite
/// edges).
constexpr std::array<RulePoint, 14> make_rule() {
  constexpr std::array<std::array<double, 2>, 2> kMedians{
      {{0.11268792571801585080, 0.31088591926330060980}, {0.07349304311636194934, 0.09273525031089122640}}};
  constexpr double kEdgeWeight = 0.04254602077708146644;
  constexpr double kEdge = 0.04550370412564964949;
  std::array<RulePoint, 14> rule;
  std::size_t next = 0;
  for (const auto& [weight, a] : kMedians) {
    for (std::size_t i = 0; i < 4; ++i) {
      rule[next] = {weight, {a, a, a, a}};
      rule[next++].L[i] = 1.0 - 3.0 * a;
    }
  }
  for (const auto& [i, j] : mesh::kTetEdges) {
    rule[next] = {kEdgeWeight, {kEdge, kEdge, kEdge, kEdge}};
    rule[next].L[static_cast<std::size_t>(i)] = 0.5 - kEdge;
    rule[next++].L[static_cast<std::size_t>(j)] = 0.5 - kEdge;
  }
  return rule;
}
inline constexpr std::array<RulePoint, 14> kRule = make_rule();

/// A column per node of a tet: 4 vertices, then the middles of mesh::kTetEdges.
using NodeColumns = Eigen::Matrix<double, 3, 10>;
using VertexValues = Eigen::Vector4d;

/// A 3 x 3 block, row-major, with one number of padding that keeps it in whole vector registers.
using PaddedBlock = Eigen::Array<double, 10, 1>;
/// A block for each pair of nodes a >= b, at a (a + 1) / 2 + b.
using PairBlocks = std::array<PaddedBlock, 55>;
/// First derivative of the first Piola-Kirchhoff stress, dP_iJ / dF_kL, at [3 J + L](3 i + k), Pa.
using Moduli = std::array<PaddedBlock, 9>;

/// Of the undeformed tet.
struct Geometry {
  std::array<Vec3, 4> grad_L;  ///< gradients of the barycentric coordinates, 1/m
  double volume = 0.0;         ///< m^3
};

inline Geometry geometry_of(const std::array<Vec3, 4>& X) {
  Geometry out;
  out.volume = (X[1] - X[0]).cross(X[2] - X[0]).dot(X[3] - X[0]) / 6.0;
  for (std::size_t k = 0; k < 4; ++k) {
    // Against the outward normal of the opposite face, whose length is twice the area.
    const auto& f = mesh::kTetFaces[k];
    const Vec3 &a = X[static_cast<std::size_t>(f[0])], &b = X[static_cast<std::size_t>(f[1])],
               &c = X[static_cast<std::size_t>(f[2])];
    out.grad_L[k] = -(b - a).cross(c - a) / (6.0 * out.volume);
  }
  return out;
}

/// P2 shape functions: L (2 L - 1) at the vertices, 4 L L' on the edges.
inline std::array<double, 10> shape_functions(const std::array<double, 4>& L) {
  std::array<double, 10> N{};
  for (std::size_t i = 0; i < 4; ++i) N[i] = L[i] * (2.0 * L[i] - 1.0);
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [i, j] = mesh::kTetEdges[e];
    N[4 + e] = 4.0 * L[static_cast<std::size_t>(i)] * L[static_cast<std::size_t>(j)];
  }
  return N;
}

/// Their gradients, 1/m.
inline NodeColumns shape_gradients(const Geometry& tet, const std::array<double, 4>& L) {
  NodeColumns G;
  for (std::size_t i = 0; i < 4; ++i) G.col(static_cast<Eigen::Index>(i)) = (4.0 * L[i] - 1.0) * tet.grad_L[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto i = static_cast<std::size_t>(mesh::kTetEdges[e][0]);
    const auto j = static_cast<std::size_t>(mesh::kTetEdges[e][1]);
    G.col(static_cast<Eigen::Index>(4 + e)) = 4.0 * (L[i] * tet.grad_L[j] + L[j] * tet.grad_L[i]);
  }
  return G;
}

/// The deformation at a point.
struct Kinematics {
  Mat3 F;
  Mat3 cof;                    ///< J F^-T = dJ/dF
  double volume_change = 0.0;  ///< J - 1, by the invariants of grad u: without cancellation at small strain
  double J = 1.0;
};

inline Kinematics kinematics_of(const NodeColumns& u, const NodeColumns& G) {
  const Mat3 H = u * G.transpose();
  Kinematics k;
  k.F = H + Mat3::Identity();
  k.cof.col(0) = k.F.col(1).cross(k.F.col(2));
  k.cof.col(1) = k.F.col(2).cross(k.F.col(0));
  k.cof.col(2) = k.F.col(0).cross(k.F.col(1));
  const double minors = H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0) + H(1, 1) * H(2, 2) - H(1, 2) * H(2, 1) +
                        H(0, 0) * H(2, 2) - H(0, 2) * H(2, 0);
  k.volume_change = H.trace() + minors + H.col(0).dot(H.col(1).cross(H.col(2)));
  k.J = 1.0 + k.volume_change;
  return k;
}

inline material::Deformation<double> deformation_of(const Kinematics& k) {
  const double F[9] = {k.F(0, 0), k.F(0, 1), k.F(0, 2), k.F(1, 0), k.F(1, 1),
                       k.F(1, 2), k.F(2, 0), k.F(2, 1), k.F(2, 2)};
  return material::deformation_of(F, k.J);
}

inline Mat3 to_matrix(const material::Sym<double>& s) {
  Mat3 out;
  out << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  return out;
}

/// A law has no answer at J <= 0: such a point has no stress; that the tet is inverted is reported by its J.
template <class Law>
Mat3 law_stress(const Law& law, const Kinematics& k) {
  return k.J > 0.0 ? to_matrix(law.stress(deformation_of(k))) : Mat3(Mat3::Zero());
}

/// The smallest J seen so far; NaN as soon as anything is not finite.
class SmallestJ {
 public:
  void see(double J, double other) {
    if (J < value_) value_ = J;
    if (!std::isfinite(J + other)) finite_ = false;
  }
  [[nodiscard]] double value() const { return finite_ ? value_ : std::numeric_limits<double>::quiet_NaN(); }

 private:
  double value_ = std::numeric_limits<double>::infinity();
  bool finite_ = true;
};

inline double interpolate(const VertexValues& values, const std::array<double, 4>& L) {
  return values[0] * L[0] + values[1] * L[1] + values[2] * L[2] + values[3] * L[3];
}

/// Index of component (i, j) in material::Sym66.
inline constexpr int kVoigt[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

/// dP/dF of P = F S + lambda cof F:
///   dP_iJ / dF_kL = delta_ik S_JL + F_iM D_MJNL F_kN + lambda eps_ikm eps_JLN F_mN.
template <class Law>
Moduli moduli_of(const Law& law, const Kinematics& k, double lambda) {
  Moduli out;
  for (PaddedBlock& block : out) block.setZero();
  if (k.J > 0.0) {
    const material::Deformation<double> deformation = deformation_of(k);
    const Mat3 S = to_matrix(law.stress(deformation));
    const material::Sym66<double> D = law.tangent(deformation);
    for (int J = 0; J < 3; ++J) {
      Eigen::Matrix<double, 3, 6> FD;  // F_iM D_MJ,v
      for (int v = 0; v < 6; ++v) {
        FD.col(v) = k.F.col(0) * D(kVoigt[0][J], v) + k.F.col(1) * D(kVoigt[1][J], v) + k.F.col(2) * D(kVoigt[2][J], v);
      }
      for (int L = 0; L < 3; ++L) {
        PaddedBlock& block = out[static_cast<std::size_t>(3 * J + L)];
        for (int i = 0; i < 3; ++i) {
          for (int m = 0; m < 3; ++m) {
            block[3 * i + m] = FD(i, kVoigt[0][L]) * k.F(m, 0) + FD(i, kVoigt[1][L]) * k.F(m, 1) +
                               FD(i, kVoigt[2][L]) * k.F(m, 2) + (i == m ? S(J, L) : 0.0);
          }
        }
      }
    }
  }
  for (int J = 0; J < 3; ++J) {
    const int L = (J + 1) % 3;
    const Vec3 f = lambda * k.F.col((J + 2) % 3);  // eps_JLN = 1
    for (int i = 0; i < 3; ++i) {
      const int m = (i + 1) % 3;
      const double c = f[(i + 2) % 3];  // eps_imn = 1
      out[static_cast<std::size_t>(3 * J + L)][3 * i + m] += c;
      out[static_cast<std::size_t>(3 * J + L)][3 * m + i] -= c;
      out[static_cast<std::size_t>(3 * L + J)][3 * i + m] -= c;
      out[static_cast<std::size_t>(3 * L + J)][3 * m + i] += c;
    }
  }
  return out;
}

/// K_ab(i, k) += weight G_a,J (dP_iJ / dF_kL) G_b,L.
inline void add_stiffness(const Moduli& moduli, const NodeColumns& G, double weight, PairBlocks& K) {
  for (Eigen::Index b = 0; b < 10; ++b) {
    std::array<PaddedBlock, 3> Z;
    for (std::size_t J = 0; J < 3; ++J) {
      Z[J] = weight * (G(0, b) * moduli[3 * J] + G(1, b) * moduli[3 * J + 1] + G(2, b) * moduli[3 * J + 2]);
    }
    for (Eigen::Index a = b; a < 10; ++a) {
      K[static_cast<std::size_t>(a * (a + 1) / 2 + b)] += G(0, a) * Z[0] + G(1, a) * Z[1] + G(2, a) * Z[2];
    }
  }
}

/// Gradient of the tet's energy. Returns the smallest J over the points, NaN when the forces are not finite.
template <class Law>
double residual(const Law& law, double kappa, const Geometry& tet, const NodeColumns& u, const VertexValues& lambda,
                NodeColumns& force, VertexValues& volume) {
  force.setZero();
  volume.setZero();
  SmallestJ smallest;
  for (const RulePoint& point : kRule) {
    const NodeColumns G = shape_gradients(tet, point.L);
    const Kinematics k = kinematics_of(u, G);
    const double w = point.weight * tet.volume;
    const double lambda_here = interpolate(lambda, point.L);
    const Mat3 P = k.F * law_stress(law, k) + lambda_here * k.cof;
    force.noalias() += (w * P) * G;
    const double constraint = w * (k.volume_change - lambda_here / kappa);
    for (std::size_t v = 0; v < 4; ++v) volume[static_cast<Eigen::Index>(v)] += point.L[v] * constraint;
    smallest.see(k.J, P.sum());
  }
  return smallest.value();
}

/// Second derivatives: K of A, and for each vertex the columns of B. Returns as `residual` does.
template <class Law>
double tangent(const Law& law, const Geometry& tet, const NodeColumns& u, const VertexValues& lambda, PairBlocks& K,
               std::array<NodeColumns, 4>& B) {
  for (PaddedBlock& block : K) block.setZero();
  for (NodeColumns& columns : B) columns.setZero();
  SmallestJ smallest;
  for (const RulePoint& point : kRule) {
    const NodeColumns G = shape_gradients(tet, point.L);
    const Kinematics k = kinematics_of(u, G);
    const double w = point.weight * tet.volume;
    const double lambda_here = interpolate(lambda, point.L);
    const Moduli moduli = moduli_of(law, k, lambda_here);
    add_stiffness(moduli, G, w, K);
    const NodeColumns dJ = (w * k.cof) * G;
    for (std::size_t v = 0; v < 4; ++v) B[v] += point.L[v] * dJ;
    smallest.see(k.J, lambda_here + moduli[0][0]);
  }
  return smallest.value();
}

/// W + lambda (J - 1) - lambda^2 / (2 kappa) over the tet, J; infinite where some J <= 0.
template <class Law>
double energy(const Law& law, double kappa, const Geometry& tet, const NodeColumns& u, const VertexValues& lambda) {
  double sum = 0.0;
  for (const RulePoint& point : kRule) {
    const Kinematics k = kinematics_of(u, shape_gradients(tet, point.L));
    if (k.J <= 0.0) return std::numeric_limits<double>::infinity();
    const double lambda_here = interpolate(lambda, point.L);
    sum += point.weight *
           (law.energy(deformation_of(k)) + lambda_here * k.volume_change - lambda_here * lambda_here / (2.0 * kappa));
  }
  return sum * tet.volume;
}

/// Averages over the reference volume.
struct Averages {
  double J = 0.0;
  Mat3 stress = Mat3::Zero();  ///< Cauchy, Pa
};

template <class Law>
Averages averages(const Law& law, const Geometry& tet, const NodeColumns& u, const VertexValues& lambda) {
  Averages out;
  for (const RulePoint& point : kRule) {
    const Kinematics k = kinematics_of(u, shape_gradients(tet, point.L));
    out.J += point.weight * k.J;
    if (k.J > 0.0) out.stress += point.weight / k.J * k.F * law_stress(law, k) * k.F.transpose();
    out.stress += point.weight * interpolate(lambda, point.L) * Mat3::Identity();
  }
  return out;
}

}  // namespace rhexis::model::taylor_hood
