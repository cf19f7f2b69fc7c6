#pragma once

/// Reads the file of a record. It may come from a stranger, or from another version: every size and every number of a
/// node, tet or row is held against what is there, and errors name the file and what is wrong with it.

#include <cstdint>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "mesh/io/hdf5_handle.h"
#include "record/store/record.h"

namespace rhexis::record::store {

class RecordFile {
 public:
  static Expected<RecordFile> open(const std::filesystem::path& path);

  [[nodiscard]] const RecordHead& head() const { return head_; }
  [[nodiscard]] int topologies() const { return topologies_; }
  /// What is looked up at the haptic rate.
  [[nodiscard]] Expected<Record> read_record() const;
  /// All of one topology, operator and edits too.
  [[nodiscard]] Expected<TopologyData> read_topology(int topology) const;

 private:
  RecordFile() = default;
  [[nodiscard]] tl::unexpected<Error> wrong(std::string what) const;
  Expected<void> read_head();
  Expected<void> read_parameters();
  Expected<void> read_body();
  Expected<void> read_pattern();
  Expected<void> check_edits();
  [[nodiscard]] mesh::io::Hdf5Handle group(const char* name) const;
  template <class Value>
  Expected<std::vector<Value>> read(const char* group, const char* name, std::vector<hsize_t> sizes) const;
  template <class Value>
  Expected<std::vector<Value>> read_rows(const char* group, const char* name, std::vector<hsize_t> sizes, hsize_t from,
                                         hsize_t count) const;
  template <class Value>
  Expected<hsize_t> length(const char* group, const char* name, std::size_t columns) const;

  std::string name_;
  std::uint64_t file_bytes_ = 0;
  mesh::io::Hdf5Handle file_;
  RecordHead head_;
  int topologies_ = 0;
  std::vector<std::int64_t> moved_start_, gone_start_, frozen_start_;
};

/// The fingerprint of a record, read without the rest. Errors: as RecordFile::open.
[[nodiscard]] Expected<std::uint64_t> fingerprint_of(const std::filesystem::path& path);

}  // namespace rhexis::record::store
