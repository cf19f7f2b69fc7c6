#pragma once

/// The element kernels: energy, forces and stiffness of runs of tet batches, added into global arrays. Compiled for
/// several instruction sets, chosen once at run time.

#include <cstdint>
#include <string_view>

#include "element/tet_batch.h"
#include "material/mooney_rivlin.h"
#include "material/neo_hookean.h"
#include "material/st_venant_kirchhoff.h"

namespace rhexis::element {

/// A run of batches and where their results go. Global arrays are indexed by node or by tet of the mesh.
struct TetRun {
  const TetBatch* batches = nullptr;
  const BlockPlaces* places = nullptr;  ///< read by tangents alone
  std::int32_t count = 0;               ///< batches
};

/// Response of a displacement model, small strain: sigma = lambda tr(eps) I + 2 mu eps.
struct SmallStrain {
  double lame_lambda = 0.0;  ///< Pa
  double lame_mu = 0.0;      ///< Pa
};

/// V (mu |F - R|^2 + lambda/2 tr(R^T F - I)^2), equation (2) of the paper's Table 2.
struct Corotated {
  double lame_lambda = 0.0;  ///< Pa
  double lame_mu = 0.0;      ///< Pa
};

/// The same energy and force, with R K_e R^T for its tangent.
struct WarpedCorotated : Corotated {};

/// `u` is the displacement, 3 per node, m; `J` is written for every tet, and is NaN for one whose force is not finite.
template <class Response>
struct DisplacementKernels {
  /// Sum over the run, J.
  double (*energy)(const Response&, const TetRun&, const double* u) = nullptr;
  /// force += dE/du, N.
  void (*residual)(const Response&, const TetRun&, const double* u, double* force, double* J) = nullptr;
  /// blocks += d2E/du2, N/m, 9 per block.
  void (*tangent)(const Response&, const TetRun&, const double* u, double* blocks, double* J) = nullptr;
};

/// Isochoric law + lambda (J - 1); the terms in lambda alone are constant matrices of the model.
template <class Law>
struct MixedKernels {
  /// Sum of V (W + lambda (J - 1)), J.
  double (*energy)(const Law&, const TetRun&, const double* u, const double* lambda) = nullptr;
  /// force += d/du, N; volume[t] += V (J - 1), m^3.
  void (*residual)(const Law&, const TetRun&, const double* u, const double* lambda, double* force, double* volume,
                   double* J) = nullptr;
  /// blocks += A, N/m; coupling = B^T, 12 per tet in the order of its ascending nodes, m^2.
  void (*tangent)(const Law&, const TetRun&, const double* u, const double* lambda, double* blocks, double* coupling,
                  double* J) = nullptr;
};

/// A further law is one more member here, filled in simd/kernel_table.h.
struct TetKernels {
  std::string_view instruction_set;
  DisplacementKernels<SmallStrain> linear;
  DisplacementKernels<Corotated> corotated;
  DisplacementKernels<WarpedCorotated> warped_corotated;
  DisplacementKernels<material::StVenantKirchhoffLaw> st_venant_kirchhoff;
  MixedKernels<material::MooneyRivlinLaw> mooney_rivlin;
  MixedKernels<material::NeoHookeanLaw> neo_hookean;
  /// Rotations nearest to eight matrices, [9][kBatch] row-major both; 64-byte aligned.
  void (*polar)(const double* F, double* R) = nullptr;
};

namespace portable {
[[nodiscard]] TetKernels make_tet_kernels();
}
namespace avx2 {
[[nodiscard]] TetKernels make_tet_kernels();
}
namespace avx512 {
[[nodiscard]] TetKernels make_tet_kernels();
}

/// The kernels of `name` (portable, avx2, avx512); nullptr when this processor or build has none.
[[nodiscard]] const TetKernels* find_tet_kernels(std::string_view name);

/// The fastest that this processor runs, or what the environment variable RHEXIS_SIMD names; chosen once.
[[nodiscard]] const TetKernels& tet_kernels();

}  // namespace rhexis::element
