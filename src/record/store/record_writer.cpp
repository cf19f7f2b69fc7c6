#include "record/store/record_writer.h"

#include <initializer_list>
#include <type_traits>

#include "base/check.h"
#include "mesh/io/hdf5_scalars.h"
#include "record/store/record_layout.h"

namespace rhexis::record::store {
namespace {

using mesh::io::Hdf5Handle;
using mesh::io::Hdf5Quiet;
using mesh::io::set_number_attribute;
using mesh::io::set_text_attribute;
using mesh::io::stored_type;
using Sizes = std::vector<hsize_t>;

/// Without the times that HDF5 notes by itself.
Hdf5Handle timeless(hid_t property_class) {
  Hdf5Handle properties(H5Pcreate(property_class), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  return properties;
}

Hdf5Handle make_group(hid_t in, const char* name) {
  return {H5Gcreate2(in, name, H5P_DEFAULT, timeless(H5P_GROUP_CREATE), H5P_DEFAULT), H5Gclose};
}

template <class Value>
Hdf5Handle make_dataset(hid_t in, const char* name, const Sizes& sizes) {
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose);
  const Hdf5Handle properties = timeless(H5P_DATASET_CREATE);
  H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER);  // every entry is written
  return {H5Dcreate2(in, name, stored_type<Value>(), space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose};
}

template <class Value>
bool write_all(hid_t in, const char* name, const std::vector<Value>& values, const Sizes& sizes) {
  const Hdf5Handle data = make_dataset<Value>(in, name, sizes);
  return data.valid() &&
         (values.empty() || H5Dwrite(data, stored_type<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
}
template <class Value>
bool write_list(hid_t in, const char* name, const std::vector<Value>& values) {
  return write_all(in, name, values, {values.size()});
}

bool write_parameters(hid_t file, const RecordHead& head) {
  const Hdf5Handle group = make_group(file, name::kParameters);
  std::vector<double> frame;
  for (const Vec3* axis : {&head.frame.x, &head.frame.y, &head.frame.z})
    frame.insert(frame.end(), axis->data(), axis->data() + 3);
  return group.valid() && set_number_attribute<std::int64_t>(group, name::kAdvances, head.parameters.advances) &&
         set_number_attribute<double>(group, name::kPullLength, head.parameters.pull_length) &&
         write_list(group, name::kDirections, direction_angles(head.parameters)) &&
         write_list(group, name::kLengths, head.parameters.lengths) &&
         write_list(group, name::kPullDirections, pull_angles(head.parameters)) &&
         write_all(group, name::kFrame, frame, {3, 3});
}

bool write_body(hid_t file, const RecordHead& head) {
  const Hdf5Handle mesh = make_group(file, name::kMesh);
  const Hdf5Handle grasp = make_group(file, name::kGrasp);
  std::vector<std::int32_t> edges;
  for (const auto& edge : head.edges) edges.insert(edges.end(), edge.begin(), edge.end());
  return mesh.valid() && grasp.valid() && write_all(mesh, name::kNodes, head.nodes, {head.nodes.size() / 3, 3}) &&
         write_all(mesh, name::kTets, head.tets, {head.tets.size() / 4, 4}) &&
         write_list(grasp, name::kPoints, head.points) && write_all(grasp, name::kEdges, edges, {head.edges.size(), 2});
}

/// As it lies in a row of the file.
Sizes row_of(std::initializer_list<hsize_t> sizes, std::size_t topologies) {
  Sizes out{topologies};
  out.insert(out.end(), sizes);
  return out;
}

}  // namespace

tl::unexpected<Error> RecordWriter::failed() const {
  return fail("the record cannot be written", "room on the disk, and a folder that can be written to", name_);
}

Expected<RecordWriter> RecordWriter::create(const std::filesystem::path& path, const RecordHead& head) {
  const Hdf5Quiet quiet;
  RecordWriter out;
  out.name_ = path.string();
  out.topologies_ = static_cast<std::size_t>(Numbering(head.parameters).count());
  out.points_ = head.points.size();
  out.edges_ = head.edges.size();
  out.nodes_ = head.nodes.size() / 3;
  out.entries_ = head.pattern.entries();
  out.has_loads_ = head.has_loads;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110);
  out.file_ = {H5Fcreate(out.name_.c_str(), H5F_ACC_TRUNC, timeless(H5P_FILE_CREATE), access), H5Fclose};
  if (!out.file_.valid()) return out.failed();
  const hid_t file = out.file_;
  const Hdf5Handle op = make_group(file, name::kOperator);
  const Hdf5Handle topologies = make_group(file, name::kTopologies);
  const std::size_t t = out.topologies_;
  if (op.valid() && topologies.valid()) {
    out.flags_ = make_dataset<std::uint8_t>(topologies, name::kFlags, {t});
    out.in_solve_ = make_dataset<std::uint8_t>(topologies, name::kInSolve, row_of({out.points_}, t));
    out.stiffness_ = make_dataset<double>(topologies, name::kStiffness, row_of({out.points_, 6}, t));
    out.compliance_ = make_dataset<double>(topologies, name::kCompliance, row_of({out.edges_, 3, 3}, t));
    if (head.has_loads) out.rest_ = make_dataset<double>(topologies, name::kRest, row_of({out.nodes_, 3}, t));
    out.factor_ = head.single_precision ? make_dataset<float>(op, name::kFactor, row_of({out.entries_}, t))
                                        : make_dataset<double>(op, name::kFactor, row_of({out.entries_}, t));
  }
  const bool made = out.flags_.valid() && out.in_solve_.valid() && out.stiffness_.valid() && out.compliance_.valid() &&
                    (!head.has_loads || out.rest_.valid()) && out.factor_.valid();
  if (!made || !set_text_attribute(file, name::kFormat, kRecordFormat) ||
      !set_number_attribute<std::int64_t>(file, name::kVersion, kRecordVersion) ||
      !set_number_attribute<std::uint64_t>(file, name::kFingerprint, head.fingerprint) ||
      !set_text_attribute(file, name::kProgram, head.program) || !set_text_attribute(file, name::kTitle, head.title) ||
      !write_parameters(file, head) || !write_body(file, head) || !write_list(op, name::kDof, head.pattern.dof) ||
      !write_list(op, name::kStart, head.pattern.start) || !write_list(op, name::kRow, head.pattern.row))
    return out.failed();
  return out;
}

template <class Value>
bool RecordWriter::append_row(const Hdf5Handle& data, const std::vector<Value>& row) {
  const Hdf5Handle space(H5Dget_space(data), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  Sizes count(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, count.data(), nullptr);
  Sizes start(count.size(), 0);
  start[0] = next_;
  count[0] = 1;
  const hsize_t values = row.size();
  const Hdf5Handle memory(H5Screate_simple(1, &values, nullptr), H5Sclose);
  return row.empty() ||
         (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) >= 0 &&
          H5Dwrite(data, stored_type<Value>(), memory, space, H5P_DEFAULT, row.data()) >= 0);
}

Expected<void> RecordWriter::append(const TopologyData& data) {
  const Hdf5Quiet quiet;
  const std::size_t entries = std::visit([](const auto& values) { return values.size(); }, data.factor);
  RHEXIS_CHECK(next_ < topologies_ && data.in_solve.size() == points_ && data.stiffness.size() == 6 * points_ &&
                   data.compliance.size() == 9 * edges_ && data.rest.size() == (has_loads_ ? 3 * nodes_ : 0) &&
                   entries == entries_,
               "topology {} of {}", next_, topologies_);
  const bool written = append_row(flags_, std::vector<std::uint8_t>{data.flags}) &&
                       append_row(in_solve_, data.in_solve) && append_row(stiffness_, data.stiffness) &&
                       append_row(compliance_, data.compliance) && (!has_loads_ || append_row(rest_, data.rest)) &&
                       std::visit([&](const auto& values) { return append_row(factor_, values); }, data.factor);
  if (!written) return failed();
  const auto add = [](const auto& from, auto& to, std::vector<std::int64_t>& start) {
    to.insert(to.end(), from.begin(), from.end());
    start.push_back(static_cast<std::int64_t>(to.size()));
  };
  add(data.moved_nodes, moved_node_, moved_start_);
  add(data.gone_tets, gone_tet_, gone_start_);
  add(data.frozen_tets, frozen_tet_, frozen_start_);
  moved_to_.insert(moved_to_.end(), data.moved_to.begin(), data.moved_to.end());
  ++next_;
  return {};
}

Expected<void> RecordWriter::finish() {
  RHEXIS_CHECK(next_ == topologies_, "{} of {} topologies", next_, topologies_);
  const Hdf5Quiet quiet;
  {
    const Hdf5Handle edits = make_group(file_, name::kEdits);
    if (!edits.valid() || !write_list(edits, name::kMovedStart, moved_start_) ||
        !write_list(edits, name::kMovedNode, moved_node_) ||
        !write_all(edits, name::kMovedTo, moved_to_, {moved_to_.size() / 3, 3}) ||
        !write_list(edits, name::kGoneStart, gone_start_) || !write_list(edits, name::kGoneTet, gone_tet_) ||
        !write_list(edits, name::kFrozenStart, frozen_start_) || !write_list(edits, name::kFrozenTet, frozen_tet_))
      return failed();
  }
  for (Hdf5Handle* data : {&flags_, &in_solve_, &stiffness_, &compliance_, &rest_, &factor_}) *data = Hdf5Handle();
  if (H5Fflush(file_, H5F_SCOPE_GLOBAL) < 0) return failed();
  file_ = Hdf5Handle();
  return {};
}

double bytes_of_record(const RecordHead& head, double topologies) {
  const auto bytes = [](const auto& list) {
    return static_cast<double>(list.size() * sizeof(typename std::decay_t<decltype(list)>::value_type));
  };
  const double shared = bytes(head.nodes) + bytes(head.tets) + bytes(head.points) + bytes(head.edges) +
                        bytes(head.pattern.dof) + bytes(head.pattern.start) + bytes(head.pattern.row);
  const double points = static_cast<double>(head.points.size());
  const double each =
      1.0 + points * (1.0 + 6.0 * sizeof(double)) + 9.0 * sizeof(double) * static_cast<double>(head.edges.size()) +
      (head.has_loads ? bytes(head.nodes) : 0.0) +
      static_cast<double>(head.pattern.entries()) * (head.single_precision ? sizeof(float) : sizeof(double));
  return shared + each * topologies;
}

}  // namespace rhexis::record::store
