// Any bytes as a recording. The first bit chooses: the file itself, where HDF5 is met first (see vtkhdf.cpp), or what a
// good file holds, so that mutations reach what our own reader does with it. Nothing is computed again: that is a whole
// interaction.

#include <algorithm>

#include "fuzz/recording_parts.h"
#include "session/recording_file.h"

namespace {

using namespace rhexis;

/// Each of a table's pieces may be as large as all of `bytes`.
constexpr std::size_t kMostPieces = 64;

template <class Row>
void read_all(const session::RecordingFile& file, std::uint64_t count) {
  std::vector<Row> rows(count);
  (void)file.read(0, rows);
  RHEXIS_CHECK(!file.read(count + (std::uint64_t{1} << 40), rows) || rows.empty(), "rows behind the end");
}

template <class Use>
void each_piece(const Expected<std::vector<session::PieceRow>>& pieces, const Use& use) {
  if (pieces) std::for_each_n(pieces->begin(), std::min(pieces->size(), kMostPieces), use);
}

void read_recording(const std::string& path) {
  const Expected<session::RecordingFile> file = session::RecordingFile::open(path);
  if (!file) {
    RHEXIS_CHECK(!file.error().what.empty() && file.error().file == path, "an error without a place");
    return;
  }
  RHEXIS_CHECK(haptics::check_settings(file->head().tick).has_value(), "settings that contradict themselves");
  read_all<session::TickRow>(*file, file->count().ticks);
  read_all<session::StepRow>(*file, file->count().steps);
  each_piece(file->commands(), [&](const session::PieceRow& piece) {
    const Expected<wire::PayloadUnion> command = file->command(piece);
    RHEXIS_CHECK(!command || command->value != nullptr, "a command that says nothing");
  });
  each_piece(file->scenes(), [&](const session::PieceRow& piece) { (void)file->scene(piece); });
  each_piece(file->frames(), [&](const session::PieceRow& piece) {
    if (const auto bytes = file->bytes(piece)) (void)wire::decode(*bytes);
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto write = [](const std::string& path, std::uint8_t, std::span<const std::uint8_t> input) {
    fuzz::write_recording(path, fuzz::parts_of(input));
  };
  fuzz::read_as_file({data, size}, write, read_recording);
  return 0;
}
