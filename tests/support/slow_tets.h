#pragma once

/// The models on linear tets the obvious way, one tet at a time with Eigen: the oracle of the batched kernels, and what
/// they are timed against.

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <vector>

#include "material/mooney_rivlin.h"
#include "material/st_venant_kirchhoff.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"
#include "model/make_model.h"

namespace rhexis::test {

/// One tet: energy density V W, force on its 12 displacements (node-major), stiffness, and V dJ/du.
struct SlowTet {
  double energy = 0.0;
  double J = 1.0;
  double volume = 0.0;
  Eigen::Matrix<double, 12, 1> force, coupling;
  Eigen::Matrix<double, 12, 12> stiffness;
};

namespace slow {

using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Gradients = Eigen::Matrix<double, 3, 4>;

/// d(F, row-major)/d(u).
inline Eigen::Matrix<double, 9, 12> gradient_operator(const Gradients& G) {
  Eigen::Matrix<double, 9, 12> out = Eigen::Matrix<double, 9, 12>::Zero();
  for (int a = 0; a < 4; ++a) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out(3 * i + j, 3 * a + i) = G(j, a);
    }
  }
  return out;
}

/// Engineering strain xx yy zz xy yz xz of F^T du (x) G.
inline Eigen::Matrix<double, 6, 12> strain_operator(const Gradients& G, const Mat3& F) {
  Eigen::Matrix<double, 6, 12> B;
  for (int a = 0; a < 4; ++a) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 f = F.row(i), g = G.col(a);
      B.col(3 * a + i) << f[0] * g[0], f[1] * g[1], f[2] * g[2], f[0] * g[1] + f[1] * g[0], f[1] * g[2] + f[2] * g[1],
          f[0] * g[2] + f[2] * g[0];
    }
  }
  return B;
}

inline Mat6 isotropic(const material::Elastic& elastic) {
  Mat6 D = Mat6::Zero();
  D.topLeftCorner<3, 3>().setConstant(elastic.lame_lambda());
  D.diagonal().array() += elastic.lame_mu();
  D.diagonal().head<3>().array() += elastic.lame_mu();
  return D;
}

inline Mat3 to_matrix(const material::Sym<double>& s) {
  Mat3 out;
  out << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  return out;
}

/// Energy, force and stiffness from E and a law in it; `lambda` adds lambda (J - 1).
template <class Law>
void total_lagrangian(const Law& law, const Gradients& G, const Mat3& F, double lambda, SlowTet& out) {
  double f[9];
  for (int i = 0; i < 9; ++i) f[i] = F(i / 3, i % 3);
  const material::Deformation<double> d = material::deformation_of(f, out.J);
  const Mat3 Cinv = (F.transpose() * F).inverse();
  const Mat3 S = to_matrix(law.stress(d)) + lambda * out.J * Cinv;
  const material::Sym66<double> packed = law.tangent(d);
  constexpr int kRow[6] = {0, 1, 2, 0, 1, 0}, kCol[6] = {0, 1, 2, 1, 2, 2};
  Mat6 D;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) {
      const int i = kRow[r], j = kCol[r], k = kRow[c], l = kCol[c];
      D(r, c) =
          packed(r, c) + lambda * out.J * (Cinv(i, j) * Cinv(k, l) - Cinv(i, k) * Cinv(j, l) - Cinv(i, l) * Cinv(j, k));
    }
  }
  const Eigen::Matrix<double, 6, 12> B = strain_operator(G, F);
  Vec6 s;
  s << S(0, 0), S(1, 1), S(2, 2), S(0, 1), S(1, 2), S(0, 2);
  out.energy = out.volume * (law.energy(d) + lambda * (out.J - 1.0));
  out.force = out.volume * B.transpose() * s;
  out.stiffness = out.volume * B.transpose() * D * B;
  const Eigen::Matrix4d geometric = out.volume * G.transpose() * S * G;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) out.stiffness.block<3, 3>(3 * a, 3 * b).diagonal().array() += geometric(a, b);
  }
}

/// The rotation that maximises tr(R^T F): the smallest singular value takes the sign of det F.
struct SlowPolar {
  Mat3 U, V, R;
  Vec3 s;
};
inline SlowPolar polar(const Mat3& F) {
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  SlowPolar out{svd.matrixU(), svd.matrixV(), Mat3::Identity(), svd.singularValues()};
  if (out.U.determinant() * out.V.determinant() < 0.0) {
    out.U.col(2) *= -1.0;
    out.s[2] *= -1.0;
  }
  out.R = out.U * out.V.transpose();
  return out;
}

inline void corotated(const material::Elastic& m, const Gradients& G, const Mat3& F, bool warped, SlowTet& out) {
  const SlowPolar p = polar(F);
  const double lambda = m.lame_lambda(), mu = m.lame_mu(), stretch = p.s.sum() - 3.0;
  out.energy = out.volume * (mu * (F - p.R).squaredNorm() + 0.5 * lambda * stretch * stretch);
  const Mat3 P = 2.0 * mu * (F - p.R) + lambda * stretch * p.R;
  const Eigen::Matrix<double, 3, 4> nodal = out.volume * P * G;
  out.force = Eigen::Map<const Vec12>(nodal.data());
  if (warped) {
    const Eigen::Matrix<double, 6, 12> B = strain_operator(G, Mat3::Identity());
    Mat12 rotation = Mat12::Zero();
    for (int a = 0; a < 4; ++a) rotation.block<3, 3>(3 * a, 3 * a) = p.R;
    out.stiffness = rotation * (out.volume * B.transpose() * isotropic(m) * B) * rotation.transpose();
    return;
  }
  Eigen::Matrix<double, 9, 9> A;
  for (int c = 0; c < 9; ++c) {
    Mat3 dF = Mat3::Zero();
    dF(c / 3, c % 3) = 1.0;
    Mat3 omega = p.U.transpose() * dF * p.V;
    omega = Mat3(omega - omega.transpose());
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (i != j) omega(i, j) /= p.s[i] + p.s[j];
      }
    }
    const Mat3 dR = p.U * omega * p.V.transpose();
    const Mat3 dP = 2.0 * mu * (dF - dR) + lambda * (p.R.cwiseProduct(dF).sum() * p.R + stretch * dR);
    for (int r = 0; r < 9; ++r) A(r, c) = dP(r / 3, r % 3);
  }
  const Eigen::Matrix<double, 9, 12> g = gradient_operator(G);
  out.stiffness = out.volume * g.transpose() * A * g;
}

}  // namespace slow

/// One tet of a model; `lambda` is read by hyperelastic alone.
inline SlowTet slow_tet(const model::ModelSettings& settings, const std::array<Vec3, 4>& X,
                        const std::array<Vec3, 4>& u, double lambda) {
  Mat3 edges, moved;
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::size_t>(a + 1);
    edges.col(a) = X[n] - X[0];
    moved.col(a) = u[n] - u[0];
  }
  const Mat3 inverse = edges.inverse();
  slow::Gradients G;
  G.rightCols<3>() = inverse.transpose();
  G.col(0) = -G.rightCols<3>().rowwise().sum();
  const Mat3 F = Mat3::Identity() + moved * inverse;
  SlowTet out;
  out.volume = edges.determinant() / 6.0;
  out.J = F.determinant();
  out.coupling.setZero();
  switch (settings.kind) {
    case model::ModelKind::linear: {
      const Eigen::Matrix<double, 6, 12> B = slow::strain_operator(G, Mat3::Identity());
      slow::Vec12 displacement;
      displacement << u[0], u[1], u[2], u[3];
      out.stiffness = out.volume * B.transpose() * slow::isotropic(settings.elastic) * B;
      out.force = out.stiffness * displacement;
      out.energy = 0.5 * displacement.dot(out.force);
      break;
    }
    case model::ModelKind::corotated:
      slow::corotated(settings.elastic, G, F, settings.corotated_tangent == model::CorotatedTangent::warped, out);
      break;
    case model::ModelKind::geometrically_nonlinear:
      slow::total_lagrangian(material::StVenantKirchhoffLaw{settings.elastic.lame_lambda(), settings.elastic.lame_mu()},
                             G, F, 0.0, out);
      break;
    default:
      slow::total_lagrangian(material::MooneyRivlinLaw{settings.law.c1, settings.law.c2}, G, F, lambda, out);
      const Mat3 cofactor = out.J * F.inverse().transpose();
      const Eigen::Matrix<double, 3, 4> nodal = out.volume * cofactor * G;
      out.coupling = Eigen::Map<const slow::Vec12>(nodal.data());
  }
  return out;
}

struct SlowResult {
  double energy = 0.0;
  VectorX residual;                     ///< (R_u, R_lambda)
  Eigen::SparseMatrix<double> tangent;  ///< whole
};

/// The whole body: triplets, then setFromTriplets. The jump terms by faces, as the sum in (5) reads.
inline SlowResult slow_evaluate(const mesh::TetMesh& mesh, const model::ModelSettings& settings,
                                const model::State& state) {
  const bool mixed = settings.kind == model::ModelKind::hyperelastic;
  const auto dofs = static_cast<Eigen::Index>(3 * mesh.node_count());
  const auto tets = static_cast<Eigen::Index>(mesh.tet_count());
  SlowResult out;
  out.residual = VectorX::Zero(dofs + (mixed ? tets : 0));
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(mesh.tet_count() * (144 + 24 + 9));
  for (Eigen::Index t = 0; t < tets; ++t) {
    const TetId id(static_cast<std::size_t>(t));
    const mesh::Tet& tet = mesh.tet(id);
    std::array<Vec3, 4> u;
    for (std::size_t a = 0; a < 4; ++a) u[a] = state.u.segment<3>(3 * tet[a].value());
    const double lambda = mixed ? state.lambda[t] : 0.0;
    const SlowTet e = slow_tet(settings, corners(mesh, id), u, lambda);
    out.energy += e.energy;
    for (int r = 0; r < 12; ++r) {
      const int row = 3 * tet[static_cast<std::size_t>(r / 3)].value() + r % 3;
      out.residual[row] += e.force[r];
      for (int c = 0; c < 12; ++c) {
        triplets.emplace_back(row, 3 * tet[static_cast<std::size_t>(c / 3)].value() + c % 3, e.stiffness(r, c));
      }
      if (mixed) {
        triplets.emplace_back(row, static_cast<int>(dofs + t), e.coupling[r]);
        triplets.emplace_back(static_cast<int>(dofs + t), row, e.coupling[r]);
      }
    }
    if (mixed) {
      const double kappa = settings.law.kappa;
      out.energy -= 0.5 * e.volume * lambda * lambda / kappa;
      out.residual[dofs + t] += e.volume * (e.J - 1.0 - lambda / kappa);
      triplets.emplace_back(static_cast<int>(dofs + t), static_cast<int>(dofs + t), -e.volume / kappa);
    }
  }
  if (mixed && settings.beta > 0.0) {
    for (const mesh::InteriorFace& face : mesh::find_faces(mesh).interior) {
      const TetId sides[2] = {face.first.tet, face.second.tet};
      for (const TetId from : sides) {  // both tets of a face meet it
        const double factor =
            settings.beta * mesh::longest_edge(mesh, from) * mesh::face_area(mesh, face.first) / settings.law.kappa;
        const double jump = state.lambda[sides[0].value()] - state.lambda[sides[1].value()];
        out.energy -= 0.5 * factor * jump * jump;
        for (int i = 0; i < 2; ++i) {
          out.residual[dofs + sides[i].value()] -= factor * (i == 0 ? jump : -jump);
          for (int j = 0; j < 2; ++j) {
            triplets.emplace_back(static_cast<int>(dofs + sides[i].value()), static_cast<int>(dofs + sides[j].value()),
                                  i == j ? -factor : factor);
          }
        }
      }
    }
  }
  out.tangent.resize(out.residual.size(), out.residual.size());
  out.tangent.setFromTriplets(triplets.begin(), triplets.end());
  return out;
}

}  // namespace rhexis::test
