#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "mesh/io/hdf5_handle.h"
#include "mesh/io/writers.h"

namespace rhexis::mesh::io {
namespace {

/// Writes into one group. After the first failure nothing more is tried; `good()` tells.
class GroupWriter {
 public:
  GroupWriter(hid_t parent, const char* name) : group_(make_group(parent, name)), good_(group_.valid()) {}

  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] hid_t id() const { return group_; }

  /// `columns` 0 for a plain list.
  template <class T>
  void dataset(const char* name, hid_t file_type, hid_t memory_type, std::span<const T> values,
               std::size_t columns = 0) {
    const std::array<hsize_t, 2> size{columns > 0 ? values.size() / columns : values.size(), columns};
    const Hdf5Handle space(H5Screate_simple(columns > 0 ? 2 : 1, size.data(), nullptr), H5Sclose);
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    // No times of creation: the same results give the same bytes.
    good_ = good_ && H5Pset_obj_track_times(properties, false) >= 0;
    if (!good_) return;
    const Hdf5Handle data(H5Dcreate2(group_, name, file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
    good_ = data.valid() &&
            (values.empty() || H5Dwrite(data, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  }
  void doubles(const char* name, std::span<const double> values, std::size_t columns = 0) {
    dataset(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values, columns);
  }
  void integers(const char* name, std::span<const std::int64_t> values) {
    dataset(name, H5T_STD_I64LE, H5T_NATIVE_INT64, values);
  }

  void attribute(const char* name, hid_t file_type, hid_t memory_type, const Hdf5Handle& space, const void* value) {
    if (!good_) return;
    const Hdf5Handle made(H5Acreate2(group_, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    good_ = made.valid() && H5Awrite(made, memory_type, value) >= 0;
  }

 private:
  static Hdf5Handle make_group(hid_t parent, const char* name) {
    const Hdf5Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties, false);
    H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);  // fields keep their order
    return {H5Gcreate2(parent, name, H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose};
  }

  Hdf5Handle group_;
  bool good_;
};

bool write_head(GroupWriter& root) {
  const std::array<std::int64_t, 2> version{1, 0};
  const hsize_t two = 2;
  const Hdf5Handle pair(H5Screate_simple(1, &two, nullptr), H5Sclose);
  root.attribute("Version", H5T_STD_I64LE, H5T_NATIVE_INT64, pair, version.data());
  // VTK wants an ASCII string of fixed length.
  const std::string type = "UnstructuredGrid";
  const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(text, type.size());
  H5Tset_strpad(text, H5T_STR_NULLPAD);
  root.attribute("Type", text, text, Hdf5Handle(H5Screate(H5S_SCALAR), H5Sclose), type.data());
  return root.good();
}

bool write_mesh(GroupWriter& root, const TetMesh& mesh) {
  const auto nodes = static_cast<std::int64_t>(mesh.node_count());
  const auto tets = static_cast<std::int64_t>(mesh.tet_count());
  const std::int64_t entries = 4 * tets;
  root.integers("NumberOfPoints", {&nodes, 1});
  root.integers("NumberOfCells", {&tets, 1});
  root.integers("NumberOfConnectivityIds", {&entries, 1});
  std::vector<double> points;
  points.reserve(3 * mesh.node_count());
  for (const Vec3& x : mesh.nodes) points.insert(points.end(), {x[0], x[1], x[2]});
  root.doubles("Points", points, 3);
  std::vector<std::int64_t> connectivity;
  connectivity.reserve(4 * mesh.tet_count());
  for (const Tet& tet : mesh.tets) {
    for (const NodeId node : tet) connectivity.push_back(node.value());
  }
  root.integers("Connectivity", connectivity);
  std::vector<std::int64_t> offsets(mesh.tet_count() + 1);
  for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = 4 * static_cast<std::int64_t>(i);
  root.integers("Offsets", offsets);
  constexpr std::uint8_t kVtkTetra = 10;
  root.dataset<std::uint8_t>("Types", H5T_STD_U8LE, H5T_NATIVE_UINT8,
                             std::vector<std::uint8_t>(mesh.tet_count(), kVtkTetra));
  return root.good();
}

bool write_fields(GroupWriter& root, const char* name, Centering centering, const std::vector<Field>& fields) {
  GroupWriter group(root.id(), name);
  for (const Field& field : fields) {
    if (field.centering != centering) continue;
    group.doubles(field.name.c_str(), field.values,
                  field.components > 1 ? static_cast<std::size_t>(field.components) : 0);
  }
  return group.good();
}

}  // namespace

Expected<std::string> format_vtkhdf(const TetMesh& mesh, const std::vector<Field>& fields) {
  const Hdf5Quiet quiet;
  const auto failed = [] { return fail("HDF5 cannot write the mesh", "is there enough memory?"); };
  const Hdf5Handle file = open_in_memory({});
  if (!file.valid()) return failed();
  {
    GroupWriter root(file, "VTKHDF");
    if (!root.good() || !write_head(root) || !write_mesh(root, mesh) ||
        !write_fields(root, "PointData", Centering::point, fields) ||
        !write_fields(root, "CellData", Centering::cell, fields)) {
      return failed();
    }
  }
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0) return failed();
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size <= 0) return failed();
  std::string image(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, image.data(), image.size()) != size) return failed();
  return image;
}

}  // namespace rhexis::mesh::io
