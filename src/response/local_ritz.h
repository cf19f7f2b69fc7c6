#pragma once

/// The stiffness at a held point of a torn body that is not in a record, from recorded bodies near it: far from the
/// crack the displacement is a sum of recorded ones, about the crack every dof is free, and the energy of the body as
/// it is torn is least (Ritz). In the words of the thesis: the local object is solved as it is, and the far field comes
/// from the record. An error of the far field counts in the force by its square, where an interpolation of forces takes
/// it as it is.
///
///     u = sum_k u_k c_k  on the far nodes,   free on the inner nodes;   u_k: recorded body k, its point moved by 1
///     min over c and the inner nodes of 1/2 u^T K u,  u(point) = d      gives  1/2 d^T S d,  S the stiffness
///
/// Needs the tets and nodes of all of them to have the same numbers: keep-nodes.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "mesh/torn_mesh.h"
#include "response/elastic_elements.h"

namespace rhexis::response {

/// A torn body without its history.
struct TornShape {
  std::vector<Vec3> nodes;           ///< m
  std::vector<std::uint8_t> solved;  ///< per tet: part of the stiffness
};
[[nodiscard]] TornShape shape_of(const mesh::TornMesh& body);

/// Tets, ascending, that are not the same in all shapes: in the solve of one and not of another, or with a node that is
/// elsewhere.
[[nodiscard]] std::vector<TetId> differing_tets(const mesh::TetMesh& intact, std::span<const TornShape* const> shapes);

/// The tets about the crack, and their dofs: those of the inner nodes, which are corners of the tets that differ, and
/// those of the boundary, the further corners of the tets around the inner nodes.
class LocalRegion {
 public:
  /// `mesh` and `model` outlive this.
  LocalRegion(const mesh::TetMesh& mesh, const ElasticModel& model, std::span<const TetId> differing);

  /// Free dofs (3 node + component), the inner ones first.
  [[nodiscard]] const std::vector<std::int32_t>& dofs() const { return dofs_; }
  [[nodiscard]] Eigen::Index inner() const { return inner_; }  ///< how many of them are inner
  /// Place in dofs() of a node's first dof; -1 when it is not in the region or is held in some component.
  [[nodiscard]] Eigen::Index place_of(NodeId node) const;
  /// Stiffness of the region's tets in a shape, N/m, on dofs(); both triangles.
  [[nodiscard]] Eigen::SparseMatrix<double> stiffness(const TornShape& shape) const;

 private:
  const mesh::TetMesh& mesh_;
  const ElasticModel& model_;
  std::vector<TetId> tets_;
  std::vector<std::int32_t> dofs_;
  Eigen::Index inner_ = 0;
  std::vector<std::int32_t> place_;  ///< per dof of the body, -1
};

/// What recorded bodies say of one point.
struct PointFields {
  Eigen::Index place = -1;     ///< LocalRegion::place_of the point
  Eigen::MatrixXd local;       ///< u_k on dofs(), 3 columns per recorded body, m/m
  Eigen::MatrixXd far_energy;  ///< u_k^T K u_l over the tets outside of the region, N/m
};

/// Recorded bodies, ready to be combined about a region.
class RecordedBodies {
 public:
  RecordedBodies(const LocalRegion& region, std::span<const TornShape* const> shapes);
  /// `compliance`: per body, columns of K^-1 of the point's three dofs, on the region's dofs, m/N. `stiffness`: per
  /// body, the point's, N/m.
  [[nodiscard]] PointFields fields(NodeId point, std::span<const Eigen::MatrixXd> compliance,
                                   std::span<const Mat3> stiffness) const;

 private:
  const LocalRegion& region_;
  std::vector<Eigen::SparseMatrix<double>> stiffness_;
};

/// A torn body whose inner dofs are condensed.
class LocalRitz {
 public:
  /// `shape` differs from the recorded bodies in the tets alone that the region was made of.
  LocalRitz(const LocalRegion& region, const TornShape& shape);
  /// Some inner dofs can move without energy.
  [[nodiscard]] bool singular() const { return inner_factor_.info() != Eigen::Success; }
  /// N/m. Never less than the exact one.
  [[nodiscard]] Mat3 stiffness(const PointFields& point) const;

 private:
  const LocalRegion& region_;
  Eigen::LLT<Eigen::MatrixXd> inner_factor_;
  Eigen::MatrixXd follow_;     ///< inner dofs by those of the boundary, -K_oo^-1 K_ob
  Eigen::MatrixXd condensed_;  ///< K_bb + K_bo follow, N/m
};

}  // namespace rhexis::response
