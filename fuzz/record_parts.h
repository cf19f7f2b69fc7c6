#pragma once

/// A precomputed record cut into what a stranger can put into it.

#include <span>
#include <string>
#include <vector>

#include "base/check.h"
#include "fuzz/parts.h"
#include "mesh/io/hdf5_scalars.h"
#include "record/store/record_layout.h"

namespace rhexis::fuzz {

struct RecordParts {
  std::vector<std::int64_t> advances;  ///< the first counts
  std::vector<double> pull_length;     ///< the first counts
  std::vector<double> directions, lengths, pull_directions, frame, nodes;
  std::vector<std::int32_t> tets, points, edges, dof;
  std::vector<std::int64_t> start;
  std::vector<std::int32_t> row;
  std::vector<std::uint8_t> flags, in_solve;
  std::vector<double> stiffness, compliance, rest, factor;
  std::vector<std::int64_t> moved_start, gone_start, frozen_start;
  std::vector<std::int32_t> moved_node, gone_tet, frozen_tet;
  std::vector<double> moved_to;
};

/// Calls use(group, name, list, sizes of one row of it) for each dataset.
template <class Parts, class Use>
void each_dataset(Parts& parts, Use&& use) {
  namespace name = record::store::name;
  using Sizes = std::vector<hsize_t>;
  use(name::kParameters, name::kDirections, parts.directions, Sizes{});
  use(name::kParameters, name::kLengths, parts.lengths, Sizes{});
  use(name::kParameters, name::kPullDirections, parts.pull_directions, Sizes{});
  use(name::kParameters, name::kFrame, parts.frame, Sizes{3});
  use(name::kMesh, name::kNodes, parts.nodes, Sizes{3});
  use(name::kMesh, name::kTets, parts.tets, Sizes{4});
  use(name::kGrasp, name::kPoints, parts.points, Sizes{});
  use(name::kGrasp, name::kEdges, parts.edges, Sizes{2});
  use(name::kOperator, name::kDof, parts.dof, Sizes{});
  use(name::kOperator, name::kStart, parts.start, Sizes{});
  use(name::kOperator, name::kRow, parts.row, Sizes{});
  use(name::kTopologies, name::kFlags, parts.flags, Sizes{});
  use(name::kTopologies, name::kInSolve, parts.in_solve, Sizes{parts.points.size()});
  use(name::kTopologies, name::kStiffness, parts.stiffness, Sizes{parts.points.size(), 6});
  use(name::kTopologies, name::kCompliance, parts.compliance, Sizes{parts.edges.size() / 2, 3, 3});
  use(name::kTopologies, name::kRest, parts.rest, Sizes{parts.nodes.size() / 3, 3});
  use(name::kOperator, name::kFactor, parts.factor, Sizes{parts.row.size()});
  use(name::kEdits, name::kMovedStart, parts.moved_start, Sizes{});
  use(name::kEdits, name::kMovedNode, parts.moved_node, Sizes{});
  use(name::kEdits, name::kMovedTo, parts.moved_to, Sizes{3});
  use(name::kEdits, name::kGoneStart, parts.gone_start, Sizes{});
  use(name::kEdits, name::kGoneTet, parts.gone_tet, Sizes{});
  use(name::kEdits, name::kFrozenStart, parts.frozen_start, Sizes{});
  use(name::kEdits, name::kFrozenTet, parts.frozen_tet, Sizes{});
}

inline RecordParts record_parts_of(std::span<const std::uint8_t> input) {
  RecordParts parts;
  take_part(input, parts.advances);
  take_part(input, parts.pull_length);
  each_dataset(parts, [&](const char*, const char*, auto& list, const auto&) { take_part(input, list); });
  return parts;
}

inline std::vector<std::uint8_t> input_of(const RecordParts& parts) {
  std::vector<std::uint8_t> input;
  add_part(parts.advances, input);
  add_part(parts.pull_length, input);
  each_dataset(parts, [&](const char*, const char*, const auto& list, const auto&) { add_part(list, input); });
  return input;
}

/// As many whole rows as a list has are written; without values of `rest` there is none of it.
inline void write_record(const std::string& path, const RecordParts& parts, bool single_precision) {
  using mesh::io::Hdf5Handle;
  namespace name = record::store::name;
  const mesh::io::Hdf5Quiet quiet;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110);
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  RHEXIS_CHECK(file.valid(), "no file to fuzz with");
  (void)mesh::io::set_text_attribute(file, name::kFormat, record::store::kRecordFormat);
  (void)mesh::io::set_text_attribute(file, name::kProgram, "rhexis");
  (void)mesh::io::set_text_attribute(file, name::kTitle, "");
  (void)mesh::io::set_number_attribute<std::int64_t>(file, name::kVersion, record::store::kRecordVersion);
  (void)mesh::io::set_number_attribute<std::uint64_t>(file, name::kFingerprint, 7);
  for (const char* group :
       {name::kParameters, name::kMesh, name::kGrasp, name::kOperator, name::kTopologies, name::kEdits})
    Hdf5Handle(H5Gcreate2(file, group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  {
    const Hdf5Handle group(H5Gopen2(file, name::kParameters, H5P_DEFAULT), H5Gclose);
    if (!parts.advances.empty())
      (void)mesh::io::set_number_attribute<std::int64_t>(group, name::kAdvances, parts.advances.front());
    if (!parts.pull_length.empty())
      (void)mesh::io::set_number_attribute<double>(group, name::kPullLength, parts.pull_length.front());
  }
  const auto put = [&]<class Value>(const char* group_name, const char* name, const std::vector<Value>& list,
                                    std::vector<hsize_t> sizes) {
    hsize_t row = 1;
    for (const hsize_t size : sizes) row *= size;
    const hsize_t rows = row == 0 ? parts.flags.size() : list.size() / row;
    sizes.insert(sizes.begin(), rows);
    const Hdf5Handle group(H5Gopen2(file, group_name, H5P_DEFAULT), H5Gclose);
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose);
    const hid_t type = mesh::io::stored_type<Value>();
    const Hdf5Handle data(H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    if (rows * row > 0) H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, list.data());
  };
  each_dataset(parts, [&]<class Value>(const char* group, const char* name, const std::vector<Value>& list,
                                       const std::vector<hsize_t>& sizes) {
    if (name == name::kRest && list.empty()) return;
    if constexpr (std::is_same_v<Value, double>) {
      if (single_precision && name == name::kFactor)
        return put(group, name, std::vector<float>(list.begin(), list.end()), sizes);
    }
    put(group, name, list, sizes);
  });
}

}  // namespace rhexis::fuzz
