#pragma once

/// Writes the file of a record, topology by topology in the order of their numbers. The same record gives the same
/// bytes: nothing of the time or the place is in it.

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "mesh/io/hdf5_handle.h"
#include "record/store/record.h"

namespace rhexis::record::store {

class RecordWriter {
 public:
  /// Replaces a file of that name.
  static Expected<RecordWriter> create(const std::filesystem::path& path, const RecordHead& head);
  /// The next topology; its lists are as long as the head says: RHEXIS_CHECK.
  Expected<void> append(const TopologyData& data);
  /// After the last one: the file is whole.
  Expected<void> finish();

 private:
  RecordWriter() = default;
  [[nodiscard]] tl::unexpected<Error> failed() const;
  template <class Value>
  bool append_row(const mesh::io::Hdf5Handle& data, const std::vector<Value>& row);

  std::string name_;
  mesh::io::Hdf5Handle file_;
  mesh::io::Hdf5Handle flags_, in_solve_, stiffness_, compliance_, rest_, factor_;
  std::size_t topologies_ = 0;
  std::size_t points_ = 0, edges_ = 0, nodes_ = 0, entries_ = 0;
  bool has_loads_ = false;
  std::size_t next_ = 0;
  std::vector<std::int64_t> moved_start_{0}, gone_start_{0}, frozen_start_{0};
  std::vector<std::int32_t> moved_node_, gone_tet_, frozen_tet_;
  std::vector<double> moved_to_;
};

/// Bytes of the file's datasets for so many topologies; what their edits take, and HDF5 itself, is beside that.
[[nodiscard]] double bytes_of_record(const RecordHead& head, double topologies);

}  // namespace rhexis::record::store
