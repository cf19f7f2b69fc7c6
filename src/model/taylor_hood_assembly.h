#pragma once

/// Where the numbers of a tet go: patterns, places and an order of the tets in which threads never meet.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "linalg/saddle_matrix.h"
#include "mesh/tet_mesh.h"
#include "model/model.h"
#include "model/space.h"
#include "model/taylor_hood_element.h"

namespace rhexis::model::taylor_hood {

class Assembly {
 public:
  explicit Assembly(const mesh::TetMesh& mesh);

  [[nodiscard]] const DisplacementSpace& space() const { return space_; }
  [[nodiscard]] std::size_t tet_count() const { return geometry_.size(); }
  [[nodiscard]] std::int32_t vertex_count() const { return static_cast<std::int32_t>(space_.vertex_count()); }
  [[nodiscard]] const Geometry& geometry(std::size_t tet) const { return geometry_[tet]; }

  /// A, B and C with their patterns, all zero.
  [[nodiscard]] linalg::SaddleMatrix make_matrix() const;
  /// The mass matrix of the vertices' hat functions, m^3. A vertex without a tet gets the mean of the other diagonals,
  /// so that the matrix is definite.
  [[nodiscard]] linalg::SymmetricCsr vertex_mass() const;
  /// Whether a tet has the vertex.
  [[nodiscard]] bool has_tet(std::int32_t vertex) const;

  /// Calls body(tet) for every tet, on several threads, never at one time for two tets that share a node: the body may
  /// add to what belongs to its nodes. The order in which a node's tets come depends on the mesh alone.
  void for_each_tet(const std::function<void(std::size_t)>& body) const;

  void gather(std::size_t tet, const State& state, NodeColumns& u, VertexValues& lambda) const;
  void scatter(std::size_t tet, const NodeColumns& force, VectorX& out) const;
  void scatter(std::size_t tet, const VertexValues& values, VectorX& out) const;
  void scatter(std::size_t tet, const PairBlocks& K, linalg::SymmetricBlockMatrix& A) const;
  void scatter(std::size_t tet, const std::array<NodeColumns, 4>& columns, linalg::CouplingMatrix& B) const;

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  void find_places();
  void colour_tets();
  [[nodiscard]] const std::int32_t* nodes_of(std::size_t tet) const { return &space_.connectivity[10 * tet]; }

  DisplacementSpace space_;
  std::vector<Geometry> geometry_;
  std::shared_ptr<const linalg::BlockPattern> A_pattern_;
  std::shared_ptr<const linalg::CsrPattern> B_pattern_;
  std::shared_ptr<const linalg::CsrPattern> C_pattern_;
  std::vector<std::array<std::int32_t, 55>>
      A_place_;  ///< per tet: block of the pair; ~block when it goes in transposed
  std::vector<std::array<std::int32_t, 40>> B_place_;  ///< per tet: entry of (vertex v, node a) at 10 v + a
  std::vector<std::int32_t> tet_order_;                ///< tets by colour; tets of one colour share no node
  std::vector<std::size_t> colour_start_;              ///< colours + 1 offsets into tet_order_
};

}  // namespace rhexis::model::taylor_hood
