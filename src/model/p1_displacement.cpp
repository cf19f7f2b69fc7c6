#include "model/p1_displacement.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "element/polar.h"
#include "model/evaluation.h"
#include "model/p1_model.h"

namespace rhexis::model {
namespace {

using element::TetRun;

Mat3 isotropic(const Mat3& strain, double lame_lambda, double lame_mu) {
  return lame_lambda * strain.trace() * Mat3::Identity() + 2.0 * lame_mu * strain;
}

/// Where stress is referred to the current volume.
TetState large_strain(const Mat3& F, const Mat3& P, double W) {
  return {P * F.transpose() / std::max(std::abs(F.determinant()), kLeastVolumeRatio), P, W};
}

TetState tet_state_of(const element::SmallStrain& m, const Mat3& F) {
  const Mat3 strain = 0.5 * (F + F.transpose()) - Mat3::Identity();
  const Mat3 stress = isotropic(strain, m.lame_lambda, m.lame_mu);
  return {stress, stress, 0.5 * stress.cwiseProduct(strain).sum()};
}

/// W = mu |F - R|^2 + lambda/2 tr(R^T F - I)^2, P = 2 mu (F - R) + lambda tr(R^T F - I) R.
TetState tet_state_of(const element::Corotated& m, const Mat3& F) {
  double f[9], r[9];
  for (int i = 0; i < 9; ++i) f[i] = F(i / 3, i % 3);
  element::nearest_rotation(f, r);
  const Mat3 R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r);
  const double stretch = (R.transpose() * F).trace() - 3.0;
  return large_strain(F, 2.0 * m.lame_mu * (F - R) + m.lame_lambda * stretch * R,
                      m.lame_mu * (F - R).squaredNorm() + 0.5 * m.lame_lambda * stretch * stretch);
}

/// W = S : E / 2, P = F S.
TetState tet_state_of(const material::StVenantKirchhoffLaw& m, const Mat3& F) {
  const Mat3 E = 0.5 * (F.transpose() * F - Mat3::Identity());
  const Mat3 S = isotropic(E, m.lame_lambda, m.lame_mu);
  return large_strain(F, F * S, 0.5 * S.cwiseProduct(E).sum());
}

template <class Response>
class P1Displacement final : public P1Model {
 public:
  P1Displacement(const mesh::TetMesh& mesh, std::string_view name, const element::TetKernels& kernels,
                 const element::DisplacementKernels<Response>& own, const material::Elastic& elastic, LeftOut left_out)
      : P1Model(mesh, kernels, left_out), name_(name), own_(own) {
    response_.lame_lambda = elastic.lame_lambda();
    response_.lame_mu = elastic.lame_mu();
  }

  std::string_view name() const override { return name_; }
  bool is_linear() const override { return std::is_same_v<Response, element::SmallStrain>; }
  bool allows_inversion() const override { return true; }

  State initial_state() const override {
    return {VectorX::Zero(static_cast<Eigen::Index>(space().dof_count())), VectorX()};
  }

  Evaluation residual(const State& state, Scratch& scratch, Residual& out) const override {
    out.u.setZero(state.u.size());
    batches().for_each_chunk([&](const TetRun& run, std::size_t) {
      own_.residual(response_, run, state.u.data(), out.u.data(), scratch.J.data());
    });
    return evaluation_of(scratch.J);
  }

  Evaluation tangent(const State& state, Scratch& scratch, linalg::SaddleMatrix& out) const override {
    out.skew.reset();
    set_zero(out.A.values);
    batches().for_each_chunk([&](const TetRun& run, std::size_t) {
      own_.tangent(response_, run, state.u.data(), out.A.values.data(), scratch.J.data());
    });
    return evaluation_of(scratch.J);
  }

  Evaluation tet_tangents(const State& state, Scratch& scratch, std::vector<double>& blocks,
                          std::vector<double>& coupling) const override {
    blocks.assign(90 * tet_count(), 0.0);
    coupling.clear();
    for_each_chunk_apart(
        [&](const TetRun& run) { own_.tangent(response_, run, state.u.data(), blocks.data(), scratch.J.data()); });
    return evaluation_of(scratch.J);
  }

  double energy(const State& state) const override {
    return sum_over_chunks([&](const TetRun& run) { return own_.energy(response_, run, state.u.data()); });
  }

  TetFields fields(const State& state) const override {
    return collect_fields(state.u,
                          [&](std::size_t, const Mat3& F, double) { return tet_state_of(response_, F).stress; });
  }

  TetState tet_state(const State&, TetId, const Mat3& F) const override { return tet_state_of(response_, F); }

  /// All three have the same stiffness at rest.
  linalg::BlockPreconditioner preconditioner() const override {
    return {small_strain_stiffness(response_.lame_lambda, response_.lame_mu), {}};
  }

 private:
  std::string_view name_;
  Response response_;
  const element::DisplacementKernels<Response>& own_;
};

}  // namespace

std::unique_ptr<Model> make_linear(const mesh::TetMesh& mesh, const ModelSettings& settings,
                                   const element::TetKernels& kernels, LeftOut left_out) {
  return std::make_unique<P1Displacement<element::SmallStrain>>(mesh, "linear", kernels, kernels.linear,
                                                                settings.elastic, left_out);
}

std::unique_ptr<Model> make_corotated(const mesh::TetMesh& mesh, const ModelSettings& settings,
                                      const element::TetKernels& kernels, LeftOut left_out) {
  if (settings.corotated_tangent == CorotatedTangent::warped) {
    return std::make_unique<P1Displacement<element::WarpedCorotated>>(
        mesh, "corotated", kernels, kernels.warped_corotated, settings.elastic, left_out);
  }
  return std::make_unique<P1Displacement<element::Corotated>>(mesh, "corotated", kernels, kernels.corotated,
                                                              settings.elastic, left_out);
}

std::unique_ptr<Model> make_geometrically_nonlinear(const mesh::TetMesh& mesh, const ModelSettings& settings,
                                                    const element::TetKernels& kernels, LeftOut left_out) {
  return std::make_unique<P1Displacement<material::StVenantKirchhoffLaw>>(
      mesh, "geometrically-nonlinear", kernels, kernels.st_venant_kirchhoff, settings.elastic, left_out);
}

}  // namespace rhexis::model
