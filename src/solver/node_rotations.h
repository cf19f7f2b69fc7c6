#pragma once

/// How far the surroundings of each node have turned: what a factor of an earlier state is brought up to date by.
/// A body that bends turns more than it strains, and a tangent of nearly incompressible tissue that is off by a small
/// angle is off by kappa / mu times that:
///
///     K(u) ~ T K(u0) T^T,   T = diag over the nodes of R(u) R(u0)^T.
///
/// (The warp-cancelling factorisation of Hecht, Lee, Shewchuk and O'Brien 2012, for a preconditioner.)

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "element/linear_tet.h"
#include "model/space.h"

namespace rhexis::solver {

class NodeRotations {
 public:
  /// Of a P1 space. `left_out` as of Model::left_out.
  explicit NodeRotations(const model::DisplacementSpace& space, std::span<const std::uint8_t> left_out = {});

  /// Per node the rotation of the mean deformation gradient of its tets, near enough for a preconditioner: T is regular
  /// in any case. The identity where that gradient is no positive number of volumes, and without a tet.
  void measure(const VectorX& u, std::vector<Mat3>& out) const;

 private:
  struct Tet {
    std::array<std::int32_t, 4> node;
    element::LinearTet shape;  ///< reference
  };
  std::vector<Tet> tets_;
  std::size_t nodes_;
};

}  // namespace rhexis::solver
