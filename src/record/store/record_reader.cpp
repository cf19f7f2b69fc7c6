#include "record/store/record_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "mesh/io/hdf5_checks.h"
#include "mesh/io/hdf5_scalars.h"
#include "record/store/record_layout.h"

namespace rhexis::record::store {
namespace {

using mesh::io::Hdf5Handle;
using mesh::io::Hdf5Quiet;
using mesh::io::number_attribute;
using mesh::io::stored_type;
using mesh::io::text_attribute;
using Sizes = std::vector<hsize_t>;

constexpr std::size_t kMostAngles = 100'000;
/// How far from orthonormal the axes of the frame may be.
constexpr double kOrthonormal = 1e-9;

template <class Value>
bool all_finite(const std::vector<Value>& values) {
  return std::all_of(values.begin(), values.end(), [](Value value) { return std::isfinite(value); });
}

bool all_within(const std::vector<std::int32_t>& values, std::size_t count) {
  return std::all_of(values.begin(), values.end(),
                     [&](std::int32_t value) { return value >= 0 && static_cast<std::size_t>(value) < count; });
}

bool ascends(const std::vector<std::int32_t>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

/// The diagonal of a Cholesky factor, by which is divided, is above zero.
template <class Value>
bool is_factor(const OperatorPattern& pattern, const std::vector<Value>& values) {
  return all_finite(values) && std::all_of(pattern.start.begin(), pattern.start.end() - 1, [&](std::int64_t diagonal) {
           return values[static_cast<std::size_t>(diagonal)] > 0;
         });
}

/// From 0, never descending, to `end`.
bool are_offsets(const std::vector<std::int64_t>& start, std::size_t end) {
  return !start.empty() && start.front() == 0 && std::is_sorted(start.begin(), start.end()) &&
         start.back() == static_cast<std::int64_t>(end);
}

bool is_good(const OperatorPattern& pattern, std::size_t dofs) {
  if (!all_within(pattern.dof, dofs) || !are_offsets(pattern.start, pattern.entries())) return false;
  for (std::size_t j = 0; j < pattern.dof.size(); ++j) {
    const auto begin = static_cast<std::size_t>(pattern.start[j]);
    const auto end = static_cast<std::size_t>(pattern.start[j + 1]);
    if (begin == end || pattern.row[begin] != static_cast<std::int32_t>(j) || pattern.row[end - 1] >= pattern.rows())
      return false;
    for (std::size_t p = begin + 1; p < end; ++p)
      if (pattern.row[p] <= pattern.row[p - 1]) return false;
  }
  return true;
}

}  // namespace

tl::unexpected<Error> RecordFile::wrong(std::string what) const {
  return fail(std::move(what), "a record of `rhexis precompute`", name_);
}

Hdf5Handle RecordFile::group(const char* name) const {
  if (!mesh::io::is_object(file_, name, H5O_TYPE_GROUP)) return {};
  return {H5Gopen2(file_, name, H5P_DEFAULT), H5Gclose};
}

/// `count` rows from row `from` of a dataset of these sizes.
template <class Value>
Expected<std::vector<Value>> RecordFile::read_rows(const char* group_name, const char* name, Sizes sizes, hsize_t from,
                                                   hsize_t count) const {
  const Hdf5Quiet quiet;
  const auto bad = [&](const char* what) { return wrong(fmt::format("its '{}/{}' {}", group_name, name, what)); };
  const Hdf5Handle in = group(group_name);
  if (!in.valid() || !mesh::io::is_object(in, name, H5O_TYPE_DATASET)) return bad("is not there");
  const Hdf5Handle data(H5Dopen2(in, name, H5P_DEFAULT), H5Dclose);
  const Hdf5Handle type(data.valid() ? H5Dget_type(data) : -1, H5Tclose);
  const Hdf5Handle properties(data.valid() ? H5Dget_create_plist(data) : -1, H5Pclose);
  if (!type.valid() || H5Tequal(type, stored_type<Value>()) <= 0) return bad("has numbers of another form");
  if (!mesh::io::is_plain_storage(data) || H5Pget_nfilters(properties) != 0 ||
      H5Pget_layout(properties) != H5D_CONTIGUOUS)
    return bad("is not stored as `rhexis precompute` does");
  const Hdf5Handle space(H5Dget_space(data), H5Sclose);
  Sizes there(sizes.size());
  if (!space.valid() || H5Sget_simple_extent_ndims(space) != static_cast<int>(sizes.size()) ||
      H5Sget_simple_extent_dims(space, there.data(), nullptr) < 0 || there != sizes)
    return bad("has another size than the rest says");
  hsize_t values = count;
  for (std::size_t k = 1; k < sizes.size(); ++k) {
    if (sizes[k] != 0 && values > file_bytes_ / sizes[k]) return bad("claims more than the file has room for");
    values *= sizes[k];
  }
  if (values > file_bytes_ / sizeof(Value)) return bad("claims more than the file has room for");
  std::vector<Value> out(values);
  if (out.empty()) return out;
  Sizes start(sizes.size(), 0);
  start[0] = from;
  sizes[0] = count;
  const Hdf5Handle memory(H5Screate_simple(1, &values, nullptr), H5Sclose);
  if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, sizes.data(), nullptr) < 0 ||
      H5Dread(data, stored_type<Value>(), memory, space, H5P_DEFAULT, out.data()) < 0)
    return bad("cannot be read");
  return out;
}

template <class Value>
Expected<std::vector<Value>> RecordFile::read(const char* group_name, const char* name, Sizes sizes) const {
  const hsize_t rows = sizes.front();
  return read_rows<Value>(group_name, name, std::move(sizes), 0, rows);
}

/// Rows of a dataset that is a list, or has so many columns.
template <class Value>
Expected<hsize_t> RecordFile::length(const char* group_name, const char* name, std::size_t columns) const {
  const Hdf5Quiet quiet;
  const Hdf5Handle in = group(group_name);
  const bool there = in.valid() && mesh::io::is_object(in, name, H5O_TYPE_DATASET);
  const Hdf5Handle data(there ? H5Dopen2(in, name, H5P_DEFAULT) : -1, H5Dclose);
  const Hdf5Handle space(data.valid() ? H5Dget_space(data) : -1, H5Sclose);
  std::array<hsize_t, 2> sizes{0, 1};
  const int rank = columns > 1 ? 2 : 1;
  if (!space.valid() || H5Sget_simple_extent_ndims(space) != rank ||
      H5Sget_simple_extent_dims(space, sizes.data(), nullptr) < 0 || sizes[1] != columns ||
      sizes[0] > file_bytes_ / (columns * sizeof(Value)))
    return wrong(fmt::format("its '{}/{}' is not there, or no list", group_name, name));
  return sizes[0];
}

Expected<RecordFile> RecordFile::open(const std::filesystem::path& path) {
  const Hdf5Quiet quiet;
  RecordFile out;
  out.name_ = path.string();
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) return out.wrong("there is no such file");
  if (!std::filesystem::is_regular_file(status)) return out.wrong("not a file");
  out.file_bytes_ = std::filesystem::file_size(path, code);
  if (code || !mesh::io::has_hdf5_signature(path)) return out.wrong("not an HDF5 file");
  out.file_ = {H5Fopen(out.name_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!out.file_.valid()) return out.wrong("cannot be opened: cut short, or broken");
  for (const auto part : {&RecordFile::read_head, &RecordFile::read_parameters, &RecordFile::read_body,
                          &RecordFile::read_pattern, &RecordFile::check_edits})
    if (Expected<void> done = (out.*part)(); !done) return fail(std::move(done.error()));
  return out;
}

Expected<void> RecordFile::read_head() {
  if (text_attribute(file_, name::kFormat) != kRecordFormat) return wrong("not a record");
  std::int64_t version = -1;
  if (!number_attribute(file_, name::kVersion, version) || version != kRecordVersion)
    return fail(fmt::format("a record of version {}", version),
                fmt::format("version {}, which this program reads: compute it anew", kRecordVersion), name_);
  if (!number_attribute(file_, name::kFingerprint, head_.fingerprint)) return wrong("it has no fingerprint");
  head_.program = text_attribute(file_, name::kProgram);
  head_.title = text_attribute(file_, name::kTitle);
  return {};
}

Expected<void> RecordFile::read_parameters() {
  Parameters& parameters = head_.parameters;
  std::int64_t advances = 0;
  const Hdf5Handle in = group(name::kParameters);
  if (!in.valid() || !number_attribute(in, name::kAdvances, advances) || advances < 0 || advances > kMostAdvances ||
      !number_attribute(in, name::kPullLength, parameters.pull_length) || !(parameters.pull_length > 0.0) ||
      !std::isfinite(parameters.pull_length))
    return wrong("its advances or its length of a pull are none");
  parameters.advances = static_cast<int>(advances);
  std::array<std::vector<double>, 3> lists;
  std::size_t at = 0;
  for (const char* name : {name::kDirections, name::kLengths, name::kPullDirections}) {
    const Expected<hsize_t> count = length<double>(name::kParameters, name, 1);
    if (!count) return fail(count.error());
    if (*count == 0 || *count > kMostAngles) return wrong(fmt::format("it has {} {}", *count, name));
    Expected<std::vector<double>> list = read<double>(name::kParameters, name, {*count});
    if (!list) return fail(std::move(list.error()));
    lists[at++] = std::move(*list);
  }
  parameters.directions = static_cast<int>(lists[0].size());
  parameters.lengths = lists[1];
  parameters.pull_directions = static_cast<int>(lists[2].size());
  const bool ascending = std::adjacent_find(lists[1].begin(), lists[1].end(), std::greater_equal<>()) == lists[1].end();
  if (lists[0] != direction_angles(parameters) || lists[2] != pull_angles(parameters) || !all_finite(lists[1]) ||
      !ascending || lists[1].front() <= 0.0)
    return wrong("its directions or lengths are not those of a record");
  if (Numbering::count_of(parameters) > kMostTopologies) return wrong("it has too many topologies");
  topologies_ = Numbering(parameters).count();

  const Expected<std::vector<double>> frame = read<double>(name::kParameters, name::kFrame, {3, 3});
  if (!frame) return fail(frame.error());
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> axes(frame->data());
  if (!((axes * axes.transpose() - Mat3::Identity()).norm() < kOrthonormal)) return wrong("its frame is none");
  head_.frame = {axes.row(0).transpose(), axes.row(1).transpose(), axes.row(2).transpose()};
  return {};
}

Expected<void> RecordFile::read_body() {
  const Expected<hsize_t> nodes = length<double>(name::kMesh, name::kNodes, 3);
  const Expected<hsize_t> tets = length<std::int32_t>(name::kMesh, name::kTets, 4);
  const Expected<hsize_t> points = length<std::int32_t>(name::kGrasp, name::kPoints, 1);
  const Expected<hsize_t> edges = length<std::int32_t>(name::kGrasp, name::kEdges, 2);
  for (const Expected<hsize_t>* size : {&nodes, &tets, &points, &edges})
    if (!*size) return fail(size->error());
  Expected<std::vector<double>> X = read<double>(name::kMesh, name::kNodes, {*nodes, 3});
  Expected<std::vector<std::int32_t>> corners = read<std::int32_t>(name::kMesh, name::kTets, {*tets, 4});
  Expected<std::vector<std::int32_t>> grasp = read<std::int32_t>(name::kGrasp, name::kPoints, {*points});
  Expected<std::vector<std::int32_t>> pairs = read<std::int32_t>(name::kGrasp, name::kEdges, {*edges, 2});
  if (!X) return fail(std::move(X.error()));
  for (Expected<std::vector<std::int32_t>>* list : {&corners, &grasp, &pairs})
    if (!*list) return fail(std::move(list->error()));
  if (!all_finite(*X) || !all_within(*corners, *nodes)) return wrong("its mesh is none");
  if (!all_within(*grasp, *nodes) || !all_within(*pairs, *points) || !ascends(*grasp))
    return wrong("its grasp points or their edges are none");
  head_.nodes = std::move(*X);
  head_.tets = std::move(*corners);
  head_.points = std::move(*grasp);
  for (std::size_t e = 0; e < *edges; ++e) {
    head_.edges.push_back({(*pairs)[2 * e], (*pairs)[2 * e + 1]});
    if (head_.edges.back()[0] >= head_.edges.back()[1]) return wrong("its grasp points or their edges are none");
  }
  const Hdf5Handle in = group(name::kTopologies);
  head_.has_loads = in.valid() && mesh::io::is_object(in, name::kRest, H5O_TYPE_DATASET);
  return {};
}

Expected<void> RecordFile::read_pattern() {
  const Expected<hsize_t> rows = length<std::int32_t>(name::kOperator, name::kDof, 1);
  const Expected<hsize_t> entries = length<std::int32_t>(name::kOperator, name::kRow, 1);
  if (!rows) return fail(rows.error());
  if (!entries) return fail(entries.error());
  Expected<std::vector<std::int32_t>> dof = read<std::int32_t>(name::kOperator, name::kDof, {*rows});
  Expected<std::vector<std::int64_t>> start = read<std::int64_t>(name::kOperator, name::kStart, {*rows + 1});
  Expected<std::vector<std::int32_t>> row = read<std::int32_t>(name::kOperator, name::kRow, {*entries});
  if (!dof) return fail(std::move(dof.error()));
  if (!start) return fail(std::move(start.error()));
  if (!row) return fail(std::move(row.error()));
  head_.pattern = {std::move(*dof), std::move(*start), std::move(*row)};
  if (!is_good(head_.pattern, head_.nodes.size())) return wrong("the pattern of its operators is none");

  const Hdf5Handle in = group(name::kOperator);
  const bool there = mesh::io::is_object(in, name::kFactor, H5O_TYPE_DATASET);
  const Hdf5Handle data(there ? H5Dopen2(in, name::kFactor, H5P_DEFAULT) : -1, H5Dclose);
  const Hdf5Handle type(data.valid() ? H5Dget_type(data) : -1, H5Tclose);
  if (!type.valid()) return wrong("its 'operator/factor' is not there");
  head_.single_precision = H5Tequal(type, stored_type<float>()) > 0;
  return {};
}

Expected<void> RecordFile::check_edits() {
  const auto rows = static_cast<hsize_t>(topologies_) + 1;
  const auto take = [&](const char* start_name, const char* list_name, std::size_t count,
                        std::vector<std::int64_t>& start) -> Expected<void> {
    Expected<std::vector<std::int64_t>> offsets = read<std::int64_t>(name::kEdits, start_name, {rows});
    if (!offsets) return fail(std::move(offsets.error()));
    const Expected<hsize_t> size = length<std::int32_t>(name::kEdits, list_name, 1);
    if (!size) return fail(size.error());
    const Expected<std::vector<std::int32_t>> list = read<std::int32_t>(name::kEdits, list_name, {*size});
    if (!list) return fail(list.error());
    if (!are_offsets(*offsets, *size) || !all_within(*list, count))
      return wrong(fmt::format("its '{}/{}' is none", name::kEdits, list_name));
    start = std::move(*offsets);
    return {};
  };
  if (Expected<void> done = take(name::kMovedStart, name::kMovedNode, head_.nodes.size() / 3, moved_start_); !done)
    return done;
  if (Expected<void> done = take(name::kGoneStart, name::kGoneTet, head_.tets.size() / 4, gone_start_); !done)
    return done;
  return take(name::kFrozenStart, name::kFrozenTet, head_.tets.size() / 4, frozen_start_);
}

Expected<Record> RecordFile::read_record() const {
  const auto t = static_cast<hsize_t>(topologies_);
  const hsize_t points = head_.points.size();
  Expected<std::vector<std::uint8_t>> flags = read<std::uint8_t>(name::kTopologies, name::kFlags, {t});
  Expected<std::vector<std::uint8_t>> in_solve = read<std::uint8_t>(name::kTopologies, name::kInSolve, {t, points});
  Expected<std::vector<double>> stiffness = read<double>(name::kTopologies, name::kStiffness, {t, points, 6});
  Expected<std::vector<double>> compliance =
      read<double>(name::kTopologies, name::kCompliance, {t, head_.edges.size(), 3, 3});
  Expected<std::vector<double>> rest;
  if (head_.has_loads) rest = read<double>(name::kTopologies, name::kRest, {t, head_.nodes.size() / 3, 3});
  if (!flags) return fail(std::move(flags.error()));
  if (!in_solve) return fail(std::move(in_solve.error()));
  for (Expected<std::vector<double>>* list : {&stiffness, &compliance, &rest}) {
    if (!*list) return fail(std::move(list->error()));
    if (!all_finite(**list)) return wrong("a stiffness or displacement in it is not a number");
  }
  return Record{head_,           std::move(*flags), std::move(*in_solve), std::move(*stiffness), std::move(*compliance),
                std::move(*rest)};
}

Expected<TopologyData> RecordFile::read_topology(int topology) const {
  const auto all = static_cast<hsize_t>(topologies_);
  const auto t = static_cast<hsize_t>(topology);
  const hsize_t points = head_.points.size();
  TopologyData out;
  Expected<void> done;
  const auto take = [&](auto list, auto& into) {
    if (list) into = std::move(*list);
    if (!list && done) done = fail(std::move(list.error()));
  };
  std::vector<std::uint8_t> flags(1);
  take(read_rows<std::uint8_t>(name::kTopologies, name::kFlags, {all}, t, 1), flags);
  take(read_rows<std::uint8_t>(name::kTopologies, name::kInSolve, {all, points}, t, 1), out.in_solve);
  take(read_rows<double>(name::kTopologies, name::kStiffness, {all, points, 6}, t, 1), out.stiffness);
  take(read_rows<double>(name::kTopologies, name::kCompliance, {all, head_.edges.size(), 3, 3}, t, 1), out.compliance);
  if (head_.has_loads)
    take(read_rows<double>(name::kTopologies, name::kRest, {all, head_.nodes.size() / 3, 3}, t, 1), out.rest);
  const hsize_t entries = head_.pattern.entries();
  if (head_.single_precision) {
    take(read_rows<float>(name::kOperator, name::kFactor, {all, entries}, t, 1),
         out.factor.emplace<std::vector<float>>());
  } else {
    take(read_rows<double>(name::kOperator, name::kFactor, {all, entries}, t, 1),
         out.factor.emplace<std::vector<double>>());
  }
  const auto take_part = [&](const char* name, const std::vector<std::int64_t>& start,
                             std::vector<std::int32_t>& into) {
    const auto from = static_cast<hsize_t>(start[t]);
    take(read_rows<std::int32_t>(name::kEdits, name, {static_cast<hsize_t>(start.back())}, from,
                                 static_cast<hsize_t>(start[t + 1]) - from),
         into);
  };
  take_part(name::kMovedNode, moved_start_, out.moved_nodes);
  take_part(name::kGoneTet, gone_start_, out.gone_tets);
  take_part(name::kFrozenTet, frozen_start_, out.frozen_tets);
  take(read_rows<double>(name::kEdits, name::kMovedTo, {static_cast<hsize_t>(moved_start_.back()), 3},
                         static_cast<hsize_t>(moved_start_[t]), out.moved_nodes.size()),
       out.moved_to);
  if (!done) return fail(std::move(done.error()));
  out.flags = flags.front();
  const auto is_good_factor = [&](const auto& values) { return is_factor(head_.pattern, values); };
  if (!std::visit(is_good_factor, out.factor))
    return wrong(fmt::format("the operator of topology {} is none", topology));
  if (!ascends(out.moved_nodes) || !ascends(out.gone_tets) || !ascends(out.frozen_tets))
    return wrong(fmt::format("the edits of topology {} are not in order", topology));
  if (!all_finite(out.stiffness) || !all_finite(out.compliance) || !all_finite(out.rest) || !all_finite(out.moved_to))
    return wrong(fmt::format("topology {} holds what is not a number", topology));
  return out;
}

Expected<std::uint64_t> fingerprint_of(const std::filesystem::path& path) {
  const Expected<RecordFile> file = RecordFile::open(path);
  if (!file) return fail(file.error());
  return file->head().fingerprint;
}

}  // namespace rhexis::record::store
