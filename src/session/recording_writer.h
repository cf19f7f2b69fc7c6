#pragma once

/// The file behind a recorder: tables that only grow, in an order that a kill between any two writes leaves readable.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "mesh/io/hdf5_handle.h"
#include "session/recording_head.h"
#include "session/recording_rows.h"

namespace rhexis::session {

/// Rows that go to the disk together.
struct RecordingBatch {
  std::vector<TickRow> ticks;
  std::vector<StepRow> steps;
  std::vector<PieceRow> commands;
  std::vector<PieceRow> scenes;
  std::vector<PieceRow> frames;
  std::vector<std::uint8_t> bytes;

  [[nodiscard]] std::size_t size() const;  ///< in bytes
  void clear();
};

class RecordingWriter {
 public:
  static Expected<RecordingWriter> create(const std::filesystem::path& path, const RecordingHead& head);

  /// Appends and flushes the rows, then says so in `flushes` and flushes that. Errors: the disk's.
  Expected<void> append(const RecordingBatch& batch);
  /// Makes it a file like any other, that no writer has open.
  void close() { *this = RecordingWriter(); }

 private:
  RecordingWriter() = default;
  template <class Row>
  Expected<void> append_rows(const mesh::io::Hdf5Handle& data, const std::vector<Row>& rows, std::uint64_t& count);

  // In the order of being made, so that the file is closed last.
  mesh::io::Hdf5Handle file_;
  mesh::io::Hdf5Handle ticks_, steps_, commands_, scenes_, frames_, bytes_, flushes_;
  FlushRow whole_;
  std::uint64_t flush_count_ = 0;
  std::string name_;
};

}  // namespace rhexis::session
