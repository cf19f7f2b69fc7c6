#include "model/taylor_hood.h"

#include <algorithm>

#include "base/parallel.h"
#include "material/mooney_rivlin.h"
#include "model/evaluation.h"
#include "model/taylor_hood_assembly.h"
#include "model/taylor_hood_element.h"

// The Lagrangian is (2) of the paper without the jump term, which the pair does not need:
//
//     Phi = int W_M + int lambda (J - 1) - int lambda^2 / (2 kappa).

namespace rhexis::model {
namespace {

using namespace taylor_hood;

constexpr std::size_t kTetGrain = 256;

template <class Law>
class TaylorHood final : public Model {
  static_assert(Law::kIsochoric, "lambda is the mean stress only if the law has none of its own");

 public:
  TaylorHood(const mesh::TetMesh& mesh, const Law& law, double kappa, double initial_lambda)
      : assembly_(mesh),
        law_(law),
        kappa_(kappa),
        initial_lambda_(initial_lambda),
        compliance_(assembly_.vertex_mass()) {
    for (double& value : compliance_.values) value /= kappa_;
  }

  std::string_view name() const override { return "taylor-hood"; }
  const DisplacementSpace& space() const override { return assembly_.space(); }
  std::int32_t pressure_unknowns() const override { return assembly_.vertex_count(); }
  bool pressure_at_vertices() const override { return true; }
  bool allows_inversion() const override { return false; }

  State initial_state() const override {
    State state;
    state.u.setZero(static_cast<Eigen::Index>(space().dof_count()));
    state.lambda.setConstant(assembly_.vertex_count(), initial_lambda_);
    // Nothing pulls the lambda of a vertex without a tet towards anything.
    for (std::int32_t v = 0; v < assembly_.vertex_count(); ++v) {
      if (!assembly_.has_tet(v)) state.lambda[v] = 0.0;
    }
    return state;
  }

  std::unique_ptr<Scratch> make_scratch() const override {
    auto scratch = std::make_unique<Scratch>();
    scratch->J.setOnes(static_cast<Eigen::Index>(assembly_.tet_count()));
    return scratch;
  }

  linalg::SaddleMatrix make_tangent() const override { return assembly_.make_matrix(); }

  Evaluation residual(const State& state, Scratch& scratch, Residual& out) const override {
    out.u.setZero();
    out.lambda.setZero();
    assembly_.for_each_tet([&](std::size_t t) {
      NodeColumns u, force;
      VertexValues lambda, volume;
      assembly_.gather(t, state, u, lambda);
      scratch.J[static_cast<Eigen::Index>(t)] =
          taylor_hood::residual(law_, kappa_, assembly_.geometry(t), u, lambda, force, volume);
      assembly_.scatter(t, force, out.u);
      assembly_.scatter(t, volume, out.lambda);
    });
    return evaluation_of(scratch.J);
  }

  Evaluation tangent(const State& state, Scratch& scratch, linalg::SaddleMatrix& out) const override {
    out.skew.reset();
    out.A.set_zero();
    std::fill(out.B.values.begin(), out.B.values.end(), 0.0);
    out.C.values = compliance_.values;
    assembly_.for_each_tet([&](std::size_t t) {
      NodeColumns u;
      VertexValues lambda;
      PairBlocks K;
      std::array<NodeColumns, 4> B;
      assembly_.gather(t, state, u, lambda);
      scratch.J[static_cast<Eigen::Index>(t)] = taylor_hood::tangent(law_, assembly_.geometry(t), u, lambda, K, B);
      assembly_.scatter(t, K, out.A);
      assembly_.scatter(t, B, out.B);
    });
    return evaluation_of(scratch.J);
  }

  double energy(const State& state) const override {
    VectorX per_tet(static_cast<Eigen::Index>(assembly_.tet_count()));
    for_each_tet_alone(state, [&](std::size_t t, const NodeColumns& u, const VertexValues& lambda) {
      per_tet[static_cast<Eigen::Index>(t)] = taylor_hood::energy(law_, kappa_, assembly_.geometry(t), u, lambda);
    });
    return per_tet.sum();
  }

  TetFields fields(const State& state) const override {
    TetFields out = make_tet_fields(assembly_.tet_count());
    for_each_tet_alone(state, [&](std::size_t t, const NodeColumns& u, const VertexValues& lambda) {
      const Averages mean = averages(law_, assembly_.geometry(t), u, lambda);
      set_tet(out, t, mean.J, lambda.mean(), mean.stress);
    });
    return out;
  }

  /// The norm of int N_v (J - 1), what the constraint weighs lambda / kappa against.
  double volume_change_norm(const State& state) const override {
    VectorX change = VectorX::Zero(assembly_.vertex_count());
    assembly_.for_each_tet([&](std::size_t t) {
      NodeColumns u;
      VertexValues lambda;
      assembly_.gather(t, state, u, lambda);
      VertexValues volume = VertexValues::Zero();
      for (const RulePoint& point : kRule) {
        const Kinematics k = kinematics_of(u, shape_gradients(assembly_.geometry(t), point.L));
        const double w = point.weight * assembly_.geometry(t).volume * k.volume_change;
        for (std::size_t v = 0; v < 4; ++v) volume[static_cast<Eigen::Index>(v)] += point.L[v] * w;
      }
      assembly_.scatter(t, volume, change);
    });
    return change.norm();
  }

  /// A0 = int 2 mu eps : eps, S0 = mass / mu + C: equivalent to A and to the Schur complement at rest, whatever the
  /// mesh size.
  linalg::BlockPreconditioner preconditioner() const override {
    const double mu = shear_modulus();
    Moduli moduli;  // mu (delta_ik delta_JL + delta_iL delta_kJ)
    for (PaddedBlock& block : moduli) block.setZero();
    for (int J = 0; J < 3; ++J) {
      for (int i = 0; i < 3; ++i) {
        moduli[static_cast<std::size_t>(4 * J)][4 * i] += mu;
        moduli[static_cast<std::size_t>(3 * J + i)][3 * i + J] += mu;
      }
    }
    linalg::BlockPreconditioner out;
    out.A0 = assembly_.make_matrix().A;
    assembly_.for_each_tet([&](std::size_t t) {
      PairBlocks K;
      for (PaddedBlock& block : K) block.setZero();
      const Geometry& tet = assembly_.geometry(t);
      for (const RulePoint& point : kRule) {
        add_stiffness(moduli, shape_gradients(tet, point.L), point.weight * tet.volume, K);
      }
      assembly_.scatter(t, K, out.A0);
    });
    out.S0 = compliance_;
    for (double& value : out.S0.values) value *= 1.0 + kappa_ / mu;
    return out;
  }

  std::size_t memory_bytes() const override {
    return assembly_.memory_bytes() + compliance_.values.size() * sizeof(double);
  }

 private:
  /// Calls body(tet, u, lambda); the body writes to what belongs to its tet alone.
  template <class Body>
  void for_each_tet_alone(const State& state, const Body& body) const {
    parallel_ranges(assembly_.tet_count(), kTetGrain, [&](std::size_t begin, std::size_t end) {
      NodeColumns u;
      VertexValues lambda;
      for (std::size_t t = begin; t < end; ++t) {
        assembly_.gather(t, state, u, lambda);
        body(t, u, lambda);
      }
    });
  }

  /// Of the law at rest, Pa: dS_xy / d(2 E_xy).
  double shear_modulus() const {
    constexpr double kIdentity[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    return law_.tangent(material::deformation_of(kIdentity, 1.0))(3, 3);
  }

  Assembly assembly_;
  Law law_;
  double kappa_ = 0.0;               ///< Pa
  double initial_lambda_ = 0.0;      ///< Pa
  linalg::SymmetricCsr compliance_;  ///< C: vertex mass / kappa, m^3/Pa
};

}  // namespace

std::unique_ptr<Model> make_taylor_hood(const mesh::TetMesh& mesh, const ModelSettings& settings) {
  const material::MooneyRivlinLaw law{settings.law.c1, settings.law.c2};
  return std::make_unique<TaylorHood<material::MooneyRivlinLaw>>(mesh, law, settings.law.kappa,
                                                                 settings.initial_lambda);
}

}  // namespace rhexis::model
