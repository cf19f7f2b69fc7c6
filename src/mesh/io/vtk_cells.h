#pragma once

/// What VTU, legacy VTK and VTKHDF have in common: points, cells as connectivity + ends + types, and data arrays.

#include <functional>
#include <string>
#include <vector>

#include "mesh/io/numbers.h"
#include "mesh/io/raw_mesh.h"

namespace rhexis::mesh::io {

struct VtkCells {
  Integers connectivity;  ///< points of all cells, one cell after the other
  Integers ends;          ///< for each cell, the index in `connectivity` behind its last point
  Integers types;         ///< VTK's cell types
};

class VtkBuilder {
 public:
  /// x, y, z of all points. Throws ReadFailure when one is not finite.
  void set_points(const Reals& coordinates);
  /// Keeps the tets; points have to be set before. Throws ReadFailure when an index is out of range, when cells do not
  /// fit together, and on volumes other than linear tets.
  void set_cells(const VtkCells& cells);
  /// Points and cells have to be set before; values of cells that are no tets are dropped. Throws ReadFailure when
  /// there are not `components` values for each point or cell.
  void add_field(std::string name, Centering centering, std::size_t components, Reals values);
  /// Says that an array was left out, and why.
  void skip_field(std::string_view name, std::string_view why);

  [[nodiscard]] std::size_t point_count() const { return raw_.nodes.size(); }
  [[nodiscard]] std::size_t cell_count() const { return cell_count_; }
  [[nodiscard]] RawMesh take() { return std::move(raw_); }

 private:
  RawMesh raw_;
  std::size_t cell_count_ = 0;
  std::vector<std::size_t> tet_cells_;  ///< the cell that each tet was, ascending
};

/// Refuses when an array that has to hold `expected` values holds another number.
void check_size(std::size_t found, std::size_t expected, std::string_view name, int line);

}  // namespace rhexis::mesh::io
