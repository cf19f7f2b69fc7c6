#pragma once

/// The tangent of every model, displacement models included:
///
///     [ A    B ] [du]      A   3n x 3n    SymmetricBlockMatrix
///     [ B^T -C ] [dp]      B   3n x m     CouplingMatrix, stored by columns (one per pressure unknown)
///                          C   m x m      SymmetricCsr, positive definite; stands with a minus sign
///
/// m = 0 for the displacement models. A follower pressure whose surface has a free rim adds a skew part to A.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "linalg/block_matrix.h"

namespace rhexis::linalg {

/// Compressed rows of a scalar pattern: columns of a row ascend.
struct CsrPattern {
  std::vector<std::int32_t> row_start;
  std::vector<std::int32_t> column;
  [[nodiscard]] std::int32_t rows() const {
    return row_start.empty() ? 0 : static_cast<std::int32_t>(row_start.size()) - 1;
  }
};

/// B^T: row = pressure unknown, column = node of the displacement space, entry = 1 x 3.
struct CouplingMatrix {
  std::shared_ptr<const CsrPattern> pattern;
  std::vector<double> values;  ///< 3 per entry

  CouplingMatrix() = default;
  explicit CouplingMatrix(std::shared_ptr<const CsrPattern> of);
  [[nodiscard]] std::int32_t rows() const { return pattern ? pattern->rows() : 0; }
  /// p = B^T u.
  void multiply(const VectorX& u, VectorX& p) const;
  template <int k>
  void multiply(const Lanes<k>& u, Lanes<k>& p) const;
  /// u += scale * B p.
  void add_transposed(const VectorX& p, double scale, VectorX& u) const;
  template <int k>
  void add_transposed(const Lanes<k>& p, double scale, Lanes<k>& u) const;
};

/// Scalar symmetric matrix: the lower triangle with the diagonal last in each row.
struct SymmetricCsr {
  std::shared_ptr<const CsrPattern> pattern;
  std::vector<double> values;

  SymmetricCsr() = default;
  explicit SymmetricCsr(std::shared_ptr<const CsrPattern> of);
  [[nodiscard]] std::int32_t rows() const { return pattern ? pattern->rows() : 0; }
  /// y = C x.
  void multiply(const VectorX& x, VectorX& y) const;
  /// y += scale * C x.
  void add_product(const VectorX& x, double scale, VectorX& y) const;
  template <int k>
  void add_product(const Lanes<k>& x, double scale, Lanes<k>& y) const;
};

/// The skew part of the load stiffness, added to A by blocks of A's pattern: block (i, j) of the lower triangle is S,
/// block (j, i) is -S^T; diagonal blocks are skew.
struct SkewBlocks {
  std::vector<double> values;  ///< 9 per block of A's pattern
};

struct SaddleMatrix {
  SymmetricBlockMatrix A;
  CouplingMatrix B;
  SymmetricCsr C;
  std::optional<SkewBlocks> skew;

  [[nodiscard]] std::int32_t displacement_unknowns() const { return 3 * A.rows(); }
  [[nodiscard]] std::int32_t pressure_unknowns() const { return C.rows(); }
  /// (yu, yp) = K (xu, xp), skew part included.
  void multiply(const VectorX& xu, const VectorX& xp, VectorX& yu, VectorX& yp) const;
  template <int k>
  void multiply(const Lanes<k>& xu, const Lanes<k>& xp, Lanes<k>& yu, Lanes<k>& yp) const;
};

/// Which displacement unknowns are solved for. Dof 3 * node + component.
struct FreeDofs {
  std::vector<std::int32_t> index;  ///< per dof: its place among the free ones, -1 when held
  std::vector<std::int32_t> dof;    ///< per free one: its dof, ascending
  [[nodiscard]] std::int32_t count() const { return static_cast<std::int32_t>(dof.size()); }
};
/// `held[d]` true where dof d is prescribed.
[[nodiscard]] FreeDofs make_free_dofs(const std::vector<bool>& held);

}  // namespace rhexis::linalg
