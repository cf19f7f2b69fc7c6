#include "mesh/io/vtk_cells.h"

#include <cmath>

#include <fmt/format.h>

#include "mesh/io/read_failure.h"

namespace rhexis::mesh::io {
namespace {

constexpr std::int64_t kVtkTetra = 10;

enum class Use { tet, leave_out, not_linear, not_a_tet };
struct CellKind {
  Use use;
  const char* name;
};

/// VTK's cell types (vtkCellType.h). Cells of the surface and below are no part of the body; volumes are, so one that
/// cannot be used must not vanish.
CellKind kind_of(std::int64_t type) {
  switch (type) {
    case 0: return {Use::leave_out, "empty cells"};
    case 1:
    case 2: return {Use::leave_out, "vertices"};
    case 3:
    case 4: return {Use::leave_out, "lines"};
    case 5:
    case 6: return {Use::leave_out, "triangles"};
    case 7:
    case 8:
    case 9: return {Use::leave_out, "quadrilaterals and polygons"};
    case kVtkTetra: return {Use::tet, "tetrahedra"};
    case 11:
    case 12: return {Use::not_a_tet, "a hexahedron"};
    case 13: return {Use::not_a_tet, "a wedge"};
    case 14: return {Use::not_a_tet, "a pyramid"};
    case 21:
    case 35: return {Use::leave_out, "second-order lines"};
    case 22:
    case 23:
    case 28:
    case 34:
    case 36: return {Use::leave_out, "second-order surface cells"};
    case 24: return {Use::not_linear, "a second-order tetrahedron"};
    case 71:
    case 78: return {Use::not_linear, "a tetrahedron of higher order"};
    default: return {Use::not_a_tet, nullptr};
  }
}

void refuse_cell(std::size_t cell, std::int64_t type, const CellKind& kind, int line) {
  const std::string what = kind.name != nullptr ? kind.name : fmt::format("of VTK's type {}", type);
  refuse(fmt::format("cell {} is {}", cell, what),
         kind.use == Use::not_linear ? "save the mesh with elements of first order"
                                     : "split the volume into linear tetrahedra",
         line);
}

}  // namespace

void check_size(std::size_t found, std::size_t expected, std::string_view name, int line) {
  if (found != expected) refuse(fmt::format("{} holds {} values where {} should be", name, found, expected), "", line);
}

void VtkBuilder::set_points(const Reals& coordinates) {
  const std::vector<double>& x = coordinates.values;
  if (x.size() % 3 != 0) refuse(fmt::format("points hold {} values, no multiple of 3", x.size()), "", coordinates.line);
  check_count(x.size() / 3, "points", coordinates.line);
  raw_.nodes.reserve(x.size() / 3);
  for (std::size_t i = 0; i < x.size(); i += 3) {
    const Vec3 point(x[i], x[i + 1], x[i + 2]);
    if (!point.allFinite()) {
      refuse(fmt::format("point {} lies at ({}, {}, {})", i / 3, x[i], x[i + 1], x[i + 2]),
             "coordinates have to be finite", coordinates.line_of(i));
    }
    raw_.nodes.push_back(point);
  }
}

void VtkBuilder::set_cells(const VtkCells& cells) {
  const auto& [connectivity, ends, types] = cells;
  cell_count_ = types.values.size();
  check_count(cell_count_, "cells", types.line);
  check_size(ends.values.size(), cell_count_, "offsets", ends.line);
  const auto points = static_cast<std::int64_t>(raw_.nodes.size());
  const auto entries = static_cast<std::int64_t>(connectivity.values.size());
  std::int64_t begin = 0;
  for (std::size_t cell = 0; cell < cell_count_; ++cell) {
    const std::int64_t end = ends.values[cell];
    if (end < begin || end > entries) {
      refuse(fmt::format("cell {} ends at entry {} of the connectivity, which should lie from {} to {}", cell, end,
                         begin, entries),
             "", ends.line_of(cell));
    }
    for (std::int64_t entry = begin; entry < end; ++entry) {
      const std::int64_t point = connectivity.values[static_cast<std::size_t>(entry)];
      if (point < 0 || point >= points) {
        refuse(fmt::format("cell {} names point {}, the points are 0 to {}", cell, point, points - 1), "",
               connectivity.line_of(static_cast<std::size_t>(entry)));
      }
    }
    const std::int64_t type = types.values[cell];
    const CellKind kind = kind_of(type);
    if (kind.use == Use::leave_out) {
      ++raw_.left_out[kind.name];
    } else if (kind.use != Use::tet) {
      refuse_cell(cell, type, kind, types.line_of(cell));
    } else {
      if (end - begin != 4) {
        refuse(fmt::format("cell {} is a tetrahedron with {} points instead of 4", cell, end - begin), "",
               ends.line_of(cell));
      }
      Tet tet;
      for (std::size_t k = 0; k < 4; ++k) {
        tet[k] = NodeId(static_cast<std::size_t>(connectivity.values[static_cast<std::size_t>(begin) + k]));
      }
      raw_.tets.push_back(tet);
      tet_cells_.push_back(cell);
    }
    begin = end;
  }
  if (begin != entries) {
    refuse(fmt::format("the connectivity holds {} entries, the cells use {}", entries, begin), "", connectivity.line);
  }
}

void VtkBuilder::add_field(std::string name, Centering centering, std::size_t components, Reals values) {
  const bool of_points = centering == Centering::point;
  const std::size_t entities = of_points ? point_count() : cell_count_;
  if (components == 0 || components > std::max<std::size_t>(values.values.size(), 1)) {
    if (entities > 0) refuse(fmt::format("array {} has {} components", in_quotes(name), components), "", values.line);
    components = 1;
  }
  check_size(values.values.size(), entities * components, "array " + in_quotes(name), values.line);
  if (!of_points && tet_cells_.size() != cell_count_) {
    for (std::size_t tet = 0; tet < tet_cells_.size(); ++tet) {
      std::copy_n(values.values.begin() + static_cast<std::ptrdiff_t>(tet_cells_[tet] * components), components,
                  values.values.begin() + static_cast<std::ptrdiff_t>(tet * components));
    }
    values.values.resize(tet_cells_.size() * components);
  }
  raw_.fields.push_back({std::move(name), centering, static_cast<int>(components), std::move(values.values)});
}

void VtkBuilder::skip_field(std::string_view name, std::string_view why) {
  raw_.notes.push_back(fmt::format("array {} left out: {}", in_quotes(name), why));
}

}  // namespace rhexis::mesh::io
