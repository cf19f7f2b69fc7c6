#pragma once

/// Fill-reducing orders of elimination, found on a graph whose vertices are bundles of unknowns that stay together: the
/// three dofs of a node, or one pressure. METIS and AMD give the same order every time; SCOTCH, which MUMPS would take
/// by itself, does not.

#include <cholmod.h>

#include <cstdint>
#include <vector>

#include "linalg/cholesky_factor.h"
#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

/// Lower triangle by rows, columns ascending, the diagonal last. CHOLMOD sees the upper triangle by columns.
struct LowerRows {
  std::vector<std::int32_t> start{0};
  std::vector<std::int32_t> index;
  void end_row() { start.push_back(static_cast<std::int32_t>(index.size())); }
};

/// The matrix in CHOLMOD's eyes, which point into `rows` and `values`; nullptr: the pattern alone. Not written to.
[[nodiscard]] cholmod_sparse cholmod_view(const LowerRows& rows, const double* values);

struct UnknownGraph {
  LowerRows rows;
  std::vector<std::int32_t> unknown_start{0};  ///< vertices + 1: first unknown of each, those of a vertex are adjacent
};

/// Vertices: nodes with a free dof, in their order.
[[nodiscard]] UnknownGraph make_graph(const BlockPattern& pattern, const FreeDofs& free);
/// Vertices: the rows.
[[nodiscard]] UnknownGraph make_graph(const CsrPattern& pattern);
/// Vertices: nodes with a free dof, then the pressures.
[[nodiscard]] UnknownGraph make_graph(const SaddleMatrix& K, const FreeDofs& free);

/// Unknowns in the order of their elimination; empty when memory ran out. `how` is metis or amd.
[[nodiscard]] std::vector<std::int32_t> find_order(const UnknownGraph& graph, Ordering how);

}  // namespace rhexis::linalg
