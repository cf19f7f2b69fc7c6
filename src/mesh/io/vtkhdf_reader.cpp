#include <fmt/format.h>

#include "mesh/io/hdf5_input.h"
#include "mesh/io/read_failure.h"
#include "mesh/io/readers.h"
#include "mesh/io/vtk_cells.h"

namespace rhexis::mesh::io {
namespace {

/// The number of points, cells or connectivity entries: a list with one entry per part.
std::size_t read_count(Hdf5Input& in, hid_t root, const char* name) {
  const auto counts = in.dataset<std::int64_t>(root, name).values.values;
  if (counts.size() != 1) {
    refuse(fmt::format("{} lists {} parts", name, counts.size()),
           "merge the parts before saving, and save one time step");
  }
  if (counts.front() < 0) refuse(fmt::format("{} is {}", name, counts.front()));
  check_count(static_cast<std::uint64_t>(counts.front()), name);
  return static_cast<std::size_t>(counts.front());
}

Integers read_list(Hdf5Input& in, hid_t root, const char* name, std::size_t expected) {
  auto table = in.dataset<std::int64_t>(root, name);
  check_size(table.values.values.size(), expected, name, 0);
  return std::move(table.values);
}

void check_head(Hdf5Input& in, hid_t root) {
  const std::string type = in.text_attribute(root, "Type");
  if (type != "UnstructuredGrid")
    refuse(fmt::format("it holds a VTKHDF file of the type {}", in_quotes(type)), "save it as UnstructuredGrid");
  const std::vector<std::int64_t> version = in.integer_attribute(root, "Version");
  if (version.front() != 1 && version.front() != 2)
    refuse(fmt::format("VTKHDF version {} is not read", version.front()), "1 or 2");
  if (in.has(root, "Steps")) refuse("it holds time steps", "save one step to a file of its own");
}

void read_fields(Hdf5Input& in, hid_t root, const char* group_name, Centering centering, VtkBuilder& builder) {
  if (!in.has(root, group_name)) return;
  const Hdf5Handle group = in.group(root, group_name);
  for (const std::string& name : in.names(group)) {
    if (!in.is_numeric(group, name.c_str())) {
      builder.skip_field(name, "it is not an array of plain numbers");
      continue;
    }
    auto table = in.dataset<double>(group, name.c_str());
    builder.add_field(name, centering, table.columns, std::move(table.values));
  }
}

MeshFile read_vtkhdf(std::string_view bytes, const ReadOptions& options) {
  Hdf5Input in(bytes);
  const Hdf5Handle root = in.group(in.file(), "VTKHDF");
  check_head(in, root);
  const std::size_t points = read_count(in, root, "NumberOfPoints");
  const std::size_t cells = read_count(in, root, "NumberOfCells");
  const std::size_t entries = read_count(in, root, "NumberOfConnectivityIds");

  VtkBuilder builder;
  const auto coordinates = in.dataset<double>(root, "Points");
  if (coordinates.columns != 3) refuse(fmt::format("Points has {} columns", coordinates.columns), "it should have 3");
  check_size(coordinates.values.values.size(), 3 * points, "Points", 0);
  builder.set_points(coordinates.values);

  VtkCells grid;
  grid.connectivity = read_list(in, root, "Connectivity", entries);
  grid.ends = read_list(in, root, "Offsets", cells + 1);
  if (grid.ends.values.front() != 0)
    refuse(fmt::format("Offsets starts with {}", grid.ends.values.front()), "it should be 0");
  grid.ends.values.erase(grid.ends.values.begin());
  grid.types = read_list(in, root, "Types", cells);
  builder.set_cells(grid);

  read_fields(in, root, "PointData", Centering::point, builder);
  read_fields(in, root, "CellData", Centering::cell, builder);
  return finish(builder.take(), options);
}

}  // namespace

Expected<MeshFile> parse_vtkhdf(std::string_view bytes, const std::string& file, const ReadOptions& options) {
  return guarded(file, [&] { return read_vtkhdf(bytes, options); });
}

}  // namespace rhexis::mesh::io
