#include "bench/rivals/stable_neo_hookean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/CholmodSupport>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/check.h"

namespace rhexis::rivals {
namespace {

constexpr double kTolerance = 1e-9;
constexpr int kMostIterations = 60;
constexpr int kHalvings = 12;

/// det F F^-T without the inverse, and its derivative: bilinear in F.
Mat3 cofactors(const Mat3& a, const Mat3& b) {
  Mat3 out;
  for (int k = 0; k < 3; ++k) out.col(k) = a.col((k + 1) % 3).cross(b.col((k + 2) % 3));
  return out;
}
Mat3 cofactor(const Mat3& F) { return cofactors(F, F); }

/// Shape gradients by columns and the volume of each tet.
struct Element {
  Eigen::Matrix<double, 3, 4> gradients;
  double volume = 0.0;
};
Element element_of(const mesh::TetMesh& mesh, TetId tet) {
  const std::array<Vec3, 4> X = mesh::corners(mesh, tet);
  Mat3 D;
  for (int k = 0; k < 3; ++k) D.col(k) = X[static_cast<std::size_t>(k) + 1] - X[0];
  Element out;
  out.gradients.rightCols<3>() = D.inverse().transpose();
  out.gradients.col(0) = -out.gradients.rightCols<3>().rowwise().sum();
  out.volume = D.determinant() / 6.0;
  return out;
}
Mat3 deformation(const Element& element, const mesh::Tet& tet, const VectorX& u) {
  Mat3 F = Mat3::Identity();
  for (std::size_t a = 0; a < 4; ++a)
    F += u.segment<3>(3 * Eigen::Index{tet[a].value()}) *
         element.gradients.col(static_cast<Eigen::Index>(a)).transpose();
  return F;
}

/// `place`: of each dof among the free ones, -1 where it is prescribed.
Eigen::SparseMatrix<double> tangent_of(const Bar& bar, const StableNeoHookean& law, const VectorX& u,
                                       const std::vector<int>& place, Eigen::Index free) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(144 * bar.mesh.tet_count());
  for (std::size_t t = 0; t < bar.mesh.tet_count(); ++t) {
    const mesh::Tet& tet = bar.mesh.tets[t];
    const Element element = element_of(bar.mesh, TetId(t));
    const Mat3 F = deformation(element, tet, u);
    for (std::size_t b = 0; b < 4; ++b) {
      for (int j = 0; j < 3; ++j) {
        const int column = place[3 * tet[b].index() + static_cast<std::size_t>(j)];
        if (column < 0) continue;
        const Mat3 dF = Vec3::Unit(j) * element.gradients.col(static_cast<Eigen::Index>(b)).transpose();
        const Eigen::Matrix<double, 3, 4> df = element.volume * law.tangent(F, dF) * element.gradients;
        for (std::size_t a = 0; a < 4; ++a) {
          for (int i = 0; i < 3; ++i) {
            const int row = place[3 * tet[a].index() + static_cast<std::size_t>(i)];
            if (row >= column) entries.emplace_back(row, column, df(i, static_cast<Eigen::Index>(a)));
          }
        }
      }
    }
  }
  Eigen::SparseMatrix<double> K(free, free);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

}  // namespace

double StableNeoHookean::energy(const Mat3& F) const {
  const double I = F.squaredNorm();
  const double volume = F.determinant() - 1.0 - 0.75 * mu / lambda;
  return 0.5 * mu * (I - 3.0) - 0.5 * mu * std::log(I + 1.0) + 0.5 * lambda * volume * volume;
}

Mat3 StableNeoHookean::stress(const Mat3& F) const {
  const double I = F.squaredNorm();
  return mu * (1.0 - 1.0 / (I + 1.0)) * F + (lambda * (F.determinant() - 1.0) - 0.75 * mu) * cofactor(F);
}

Mat3 StableNeoHookean::tangent(const Mat3& F, const Mat3& dF) const {
  const double I = F.squaredNorm();
  const Mat3 cof = cofactor(F);
  const double of_trace = 2.0 * mu * F.cwiseProduct(dF).sum() / ((I + 1.0) * (I + 1.0));
  return mu * (1.0 - 1.0 / (I + 1.0)) * dF + of_trace * F + lambda * cof.cwiseProduct(dF).sum() * cof +
         (lambda * (F.determinant() - 1.0) - 0.75 * mu) * (cofactors(dF, F) + cofactors(F, dF));
}

VectorX internal_force(const Bar& bar, const StableNeoHookean& law, const VectorX& u) {
  VectorX force = VectorX::Zero(u.size());
  for (std::size_t t = 0; t < bar.mesh.tet_count(); ++t) {
    const mesh::Tet& tet = bar.mesh.tets[t];
    const Element element = element_of(bar.mesh, TetId(t));
    const Eigen::Matrix<double, 3, 4> f = element.volume * law.stress(deformation(element, tet, u)) * element.gradients;
    for (std::size_t a = 0; a < 4; ++a)
      force.segment<3>(3 * Eigen::Index{tet[a].value()}) += f.col(static_cast<Eigen::Index>(a));
  }
  return force;
}

VectorX converged(const Bar& bar, const StableNeoHookean& law, const Vec3& hand, VectorX near) {
  std::vector<int> place(3 * bar.mesh.node_count(), 0);
  for (const model::PrescribedDof& support : bar.led(hand).supports) {
    place[static_cast<std::size_t>(support.dof)] = -1;
    near[support.dof] = support.value;
  }
  int free = 0;
  for (int& p : place)
    if (p == 0) p = free++;
  const auto residual = [&](const VectorX& u, double& forces) {
    const VectorX internal = internal_force(bar, law, u);
    forces = internal.norm();
    VectorX out(free);
    for (std::size_t i = 0; i < place.size(); ++i)
      if (place[i] >= 0) out[place[i]] = internal[static_cast<Eigen::Index>(i)];
    return out;
  };
  double forces = 0.0;
  VectorX r = residual(near, forces);
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor;
  for (int iteration = 0; r.norm() > kTolerance * forces; ++iteration) {
    RHEXIS_CHECK(iteration < kMostIterations,
                 "Bullet's law: Newton has not converged in {} iterations, residual {:.1e}", kMostIterations,
                 r.norm() / forces);
    factor.compute(tangent_of(bar, law, near, place, free));
    RHEXIS_CHECK(factor.info() == Eigen::Success, "Bullet's law: its tangent is not definite");
    const VectorX du = factor.solve(r);
    const VectorX before = near;
    const double norm = r.norm();
    for (int halving = 0;; ++halving) {
      RHEXIS_CHECK(halving <= kHalvings, "Bullet's law: no step lessens the residual {:.1e}", norm / forces);
      for (std::size_t i = 0; i < place.size(); ++i)
        if (place[i] >= 0)
          near[static_cast<Eigen::Index>(i)] =
              before[static_cast<Eigen::Index>(i)] - std::ldexp(du[place[i]], -halving);
      r = residual(near, forces);
      if (r.norm() < 4.0 * norm) break;  // moves out of bending stretch first
    }
  }
  return near;
}

double derivative_error(const StableNeoHookean& law) {
  Mat3 F;
  F << 1.1, 0.2, -0.1, 0.05, 0.9, 0.3, -0.2, 0.1, 1.2;
  Mat3 dF;
  dF << 0.3, -0.5, 0.2, 0.7, 0.1, -0.4, 0.6, -0.2, 0.8;
  constexpr double kStep = 1e-5;
  const double energy = (law.energy(F + kStep * dF) - law.energy(F - kStep * dF)) / (2.0 * kStep);
  const Mat3 stress = (law.stress(F + kStep * dF) - law.stress(F - kStep * dF)) / (2.0 * kStep);
  const double work = law.stress(F).cwiseProduct(dF).sum();
  const Mat3 tangent = law.tangent(F, dF);
  return std::max(std::abs(energy - work) / std::abs(work), (stress - tangent).norm() / tangent.norm());
}

}  // namespace rhexis::rivals
