#include "model/p1_hyperelastic.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "model/evaluation.h"
#include "model/p1_model.h"
#include "model/pressure_matrix.h"

namespace rhexis::model {
namespace {

using element::TetRun;

/// One row per tet with its four nodes, ascending.
std::shared_ptr<const linalg::CsrPattern> make_coupling_pattern(const mesh::TetMesh& mesh) {
  auto pattern = std::make_shared<linalg::CsrPattern>();
  pattern->row_start.reserve(mesh.tet_count() + 1);
  pattern->column.reserve(4 * mesh.tet_count());
  pattern->row_start.push_back(0);
  for (mesh::Tet tet : mesh.tets) {
    std::sort(tet.begin(), tet.end());
    for (const NodeId node : tet) pattern->column.push_back(node.value());
    pattern->row_start.push_back(static_cast<std::int32_t>(pattern->column.size()));
  }
  return pattern;
}

template <class Law>
class P1Hyperelastic final : public P1Model {
 public:
  P1Hyperelastic(const mesh::TetMesh& mesh, const element::TetKernels& kernels, const element::MixedKernels<Law>& own,
                 const Law& law, const ModelSettings& settings, LeftOut left_out)
      : P1Model(mesh, kernels, left_out),
        own_(own),
        law_(law),
        shear_modulus_(settings.law.shear_modulus()),
        kappa_(settings.law.kappa),
        coupling_(make_coupling_pattern(mesh)),
        C_(make_pressure_matrix(mesh, settings.law.kappa, settings.beta, left_out)) {
    volume_.setZero(static_cast<Eigen::Index>(mesh.tet_count()));
    initial_lambda_.setZero(volume_.size());
    for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
      if (!left_out.empty() && left_out[t] != 0) continue;
      volume_[static_cast<Eigen::Index>(t)] = mesh::signed_volume(mesh, TetId(t));
      initial_lambda_[static_cast<Eigen::Index>(t)] = settings.initial_lambda;
    }
  }

  std::string_view name() const override { return "hyperelastic"; }
  std::int32_t pressure_unknowns() const override { return static_cast<std::int32_t>(tet_count()); }
  /// J^(-2/3) has no answer there.
  bool allows_inversion() const override { return false; }

  State initial_state() const override {
    return {VectorX::Zero(static_cast<Eigen::Index>(space().dof_count())), initial_lambda_};
  }

  /// C is constant and filled here, once; tangent() leaves it alone.
  linalg::SaddleMatrix make_tangent() const override {
    linalg::SaddleMatrix out = P1Model::make_tangent();
    out.B = linalg::CouplingMatrix(coupling_);
    out.C = C_;
    return out;
  }

  /// Equations (3), (4) with the jump term of (5): R_lambda = V (J - 1) - C lambda.
  Evaluation residual(const State& state, Scratch& scratch, Residual& out) const override {
    out.u.setZero(state.u.size());
    out.lambda.setZero(state.lambda.size());
    C_.add_product(state.lambda, -1.0, out.lambda);
    batches().for_each_chunk([&](const TetRun& run, std::size_t) {
      own_.residual(law_, run, state.u.data(), state.lambda.data(), out.u.data(), out.lambda.data(), scratch.J.data());
    });
    return evaluation_of(scratch.J);
  }

  Evaluation tangent(const State& state, Scratch& scratch, linalg::SaddleMatrix& out) const override {
    out.skew.reset();
    set_zero(out.A.values);
    batches().for_each_chunk([&](const TetRun& run, std::size_t) {
      own_.tangent(law_, run, state.u.data(), state.lambda.data(), out.A.values.data(), out.B.values.data(),
                   scratch.J.data());
    });
    return evaluation_of(scratch.J);
  }

  Evaluation tet_tangents(const State& state, Scratch& scratch, std::vector<double>& blocks,
                          std::vector<double>& coupling) const override {
    blocks.assign(90 * tet_count(), 0.0);
    coupling.assign(12 * tet_count(), 0.0);
    for_each_chunk_apart([&](const TetRun& run) {
      own_.tangent(law_, run, state.u.data(), state.lambda.data(), blocks.data(), coupling.data(), scratch.J.data());
    });
    return evaluation_of(scratch.J);
  }

  /// The Lagrangian (2) with the jump term, external work left out.
  double energy(const State& state) const override {
    const double stored =
        sum_over_chunks([&](const TetRun& run) { return own_.energy(law_, run, state.u.data(), state.lambda.data()); });
    VectorX product(state.lambda.size());
    C_.multiply(state.lambda, product);
    return stored - 0.5 * state.lambda.dot(product);
  }

  TetFields fields(const State& state) const override {
    TetFields out = collect_fields(
        state.u, [&](std::size_t tet, const Mat3& F, double) { return tet_state(state, TetId(tet), F).stress; });
    out.lambda.assign(state.lambda.begin(), state.lambda.end());
    return out;
  }

  /// sigma = F S F^T / J + lambda I, of which the first part has no trace, so that lambda is the mean;
  /// P = J sigma F^-T and W = W_iso + lambda (J - 1) - lambda^2 / (2 kappa), the density of the Lagrangian (2).
  TetState tet_state(const State& state, TetId tet, const Mat3& F) const override {
    double f[9];
    for (int i = 0; i < 9; ++i) f[i] = F(i / 3, i % 3);
    const double J = F.determinant();
    const material::Deformation<double> deformation = material::deformation_of(f, J);
    const material::Sym<double> s = law_.stress(deformation);
    Mat3 S;
    S << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
    const Mat3 isochoric = F * S;
    const double lambda = state.lambda[static_cast<Eigen::Index>(tet.index())];
    TetState out;
    out.stress = isochoric * F.transpose() / J + lambda * Mat3::Identity();
    out.P = isochoric + lambda * J * F.inverse().transpose();
    out.W = law_.energy(deformation) + lambda * (J - 1.0) - 0.5 * lambda * lambda / kappa_;
    return out;
  }

  double volume_change_norm(const State& state) const override {
    VectorX change = VectorX::Zero(volume_.size());
    for_each_tet(state.u, [&](std::size_t tet, const Mat3&, double J) {
      const auto t = static_cast<Eigen::Index>(tet);
      change[t] = volume_[t] * (J - 1.0);
    });
    return change.norm();
  }

  /// A0 stores mu eps:eps (the law's shear part without its projection, so that it is definite), S0 = V/mu + C bounds
  /// B^T A^-1 B + C on both sides on an inf-sup stable pair, and C gives P1/P0 what it lacks.
  linalg::BlockPreconditioner preconditioner() const override {
    linalg::BlockPreconditioner out{small_strain_stiffness(0.0, shear_modulus_), C_};
    for (Eigen::Index t = 0; t < volume_.size(); ++t) {
      const auto last = static_cast<std::size_t>(C_.pattern->row_start[static_cast<std::size_t>(t) + 1]) - 1;
      out.S0.values[last] += volume_[t] / shear_modulus_;
    }
    return out;
  }

  std::size_t memory_bytes() const override {
    const auto bytes = [](const linalg::CsrPattern& p) {
      return (p.row_start.size() + p.column.size()) * sizeof(std::int32_t);
    };
    return P1Model::memory_bytes() + bytes(*coupling_) + bytes(*C_.pattern) + C_.values.size() * sizeof(double) +
           static_cast<std::size_t>(volume_.size()) * sizeof(double);
  }

 private:
  const element::MixedKernels<Law>& own_;
  Law law_;
  double shear_modulus_ = 0.0;                          ///< Pa
  double kappa_ = 0.0;                                  ///< Pa
  std::shared_ptr<const linalg::CsrPattern> coupling_;  ///< of B^T
  linalg::SymmetricCsr C_;                              ///< diag(V) / kappa + K_S
  VectorX volume_;                                      ///< per tet, m^3, zero where left out
  VectorX initial_lambda_;                              ///< per tet, Pa, zero where left out
};

}  // namespace

std::unique_ptr<Model> make_hyperelastic(const mesh::TetMesh& mesh, const ModelSettings& settings,
                                         const element::TetKernels& kernels, LeftOut left_out) {
  const material::MooneyRivlin& p = settings.law;
  if (p.c2 == 0.0) {
    return std::make_unique<P1Hyperelastic<material::NeoHookeanLaw>>(mesh, kernels, kernels.neo_hookean,
                                                                     material::NeoHookeanLaw{p.c1}, settings, left_out);
  }
  return std::make_unique<P1Hyperelastic<material::MooneyRivlinLaw>>(
      mesh, kernels, kernels.mooney_rivlin, material::MooneyRivlinLaw{p.c1, p.c2}, settings, left_out);
}

}  // namespace rhexis::model
