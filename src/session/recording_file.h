#pragma once

/// Reads a recording. It may come from a stranger, or from a program that was killed while it wrote: every count and
/// every place in it is held against what is there, and errors name the file and what is wrong with it.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/error.h"
#include "mesh/io/hdf5_handle.h"
#include "session/open_body.h"
#include "session/recording_head.h"
#include "session/recording_rows.h"
#include "wire/frame.h"

namespace rhexis::session {

class RecordingFile {
 public:
  static Expected<RecordingFile> open(const std::filesystem::path& path);

  [[nodiscard]] const RecordingHead& head() const { return head_; }
  /// How many rows of each table are whole; those behind them are as if they were not there.
  [[nodiscard]] const FlushRow& count() const { return count_; }

  /// `rows` become [from, from + rows.size()) of their table, which has so many.
  Expected<void> read(std::uint64_t from, std::vector<TickRow>& rows) const;
  Expected<void> read(std::uint64_t from, std::vector<StepRow>& rows) const;
  Expected<std::vector<PieceRow>> commands() const;
  Expected<std::vector<PieceRow>> scenes() const;
  Expected<std::vector<PieceRow>> frames() const;

  Expected<std::vector<std::uint8_t>> bytes(const PieceRow& piece) const;
  Expected<wire::PayloadUnion> command(const PieceRow& piece) const;
  Expected<SceneChoice> scene(const PieceRow& piece) const;

  /// In this file.
  [[nodiscard]] tl::unexpected<Error> wrong(std::string what) const;

 private:
  struct Table {
    mesh::io::Hdf5Handle data;
    std::uint64_t rows = 0;
  };
  RecordingFile() = default;
  template <class Row>
  Expected<Table> open_table(const char* name) const;
  template <class Row>
  Expected<void> read_rows(const Table& table, std::uint64_t from, std::vector<Row>& rows) const;
  Expected<void> read_head();
  Expected<void> find_whole(const Table& flushes);
  Expected<std::vector<PieceRow>> pieces(const Table& table, std::uint64_t count, const char* what) const;

  std::string name_;
  std::uint64_t file_bytes_ = 0;
  mesh::io::Hdf5Handle file_;
  Table ticks_, steps_, commands_, scenes_, frames_, bytes_;
  RecordingHead head_;
  FlushRow count_;
};

}  // namespace rhexis::session
