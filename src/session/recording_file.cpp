#include "session/recording_file.h"

#include <algorithm>

#include "mesh/io/hdf5_checks.h"
#include "mesh/io/hdf5_scalars.h"
#include "session/recording_scene.h"
#include "session/recording_tables.h"

namespace rhexis::session {
namespace {

using mesh::io::Hdf5Handle;
using mesh::io::Hdf5Quiet;

constexpr hsize_t kLargestChunk = hsize_t{1} << 24;  // bytes; a recorder's are a hundredth of that
/// What a writer may be in the middle of is read again until its checksum is right. HDF5 waits 1 ns before the second
/// attempt, twice as long before each that follows, and by itself makes 100: for ever, where a file is garbled.
constexpr unsigned kAttempts = 20;

}  // namespace

tl::unexpected<Error> RecordingFile::wrong(std::string what) const {
  return fail(std::move(what), "a recording of `rhexis play`", name_);
}

Expected<RecordingFile> RecordingFile::open(const std::filesystem::path& path) {
  const Hdf5Quiet quiet;
  RecordingFile out;
  out.name_ = path.string();
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) return out.wrong("there is no such file");
  if (!std::filesystem::is_regular_file(status)) return out.wrong("not a file");
  out.file_bytes_ = std::filesystem::file_size(path, code);
  if (code || !mesh::io::has_hdf5_signature(path)) return out.wrong("not an HDF5 file");
  // As one who reads while another writes: so a file opens whose writer was killed.
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_metadata_read_attempts(access, kAttempts);
  out.file_ = {H5Fopen(out.name_.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access), H5Fclose};
  if (!out.file_.valid()) return out.wrong("cannot be opened: cut short, or not written by a recorder");
  if (Expected<void> done = out.read_head(); !done) return fail(std::move(done.error()));

  Expected<void> opened;
  const auto take = [&](Expected<Table> table, Table& into) {
    if (table) {
      into = std::move(*table);
    } else if (opened) {
      opened = fail(std::move(table.error()));
    }
  };
  Table flushes;
  take(out.open_table<TickRow>(table::kTicks), out.ticks_);
  take(out.open_table<StepRow>(table::kSteps), out.steps_);
  take(out.open_table<PieceRow>(table::kCommands), out.commands_);
  take(out.open_table<PieceRow>(table::kScenes), out.scenes_);
  take(out.open_table<PieceRow>(table::kFrames), out.frames_);
  take(out.open_table<std::uint8_t>(table::kBytes), out.bytes_);
  take(out.open_table<FlushRow>(table::kFlushes), flushes);
  if (opened) opened = out.find_whole(flushes);
  if (!opened) return fail(std::move(opened.error()));
  return out;
}

Expected<void> RecordingFile::read_head() {
  if (mesh::io::text_attribute(file_, "format") != kRecordingFormat) return wrong("not a recording");
  std::int64_t version = -1;
  if (!mesh::io::number_attribute(file_, "version", version) || version != kRecordingVersion)
    return fail(fmt::format("a recording of version {}", version),
                fmt::format("version {}, which this program reads", kRecordingVersion), name_);
  Expected<RecordingHead> head = parse_recording_head(mesh::io::text_attribute(file_, "settings"));
  if (!head) return fail(head.error().at(name_));
  head_ = std::move(*head);
  return {};
}

template <class Row>
Expected<RecordingFile::Table> RecordingFile::open_table(const char* name) const {
  const auto bad = [&](const char* what) { return wrong(fmt::format("its '{}' {}", name, what)); };
  if (!mesh::io::is_object(file_, name, H5O_TYPE_DATASET)) return bad("is not there");
  Table table{{H5Dopen2(file_, name, H5P_DEFAULT), H5Dclose}, 0};
  if (!table.data.valid()) return bad("cannot be opened");
  const Hdf5Handle type(H5Dget_type(table.data), H5Tclose);
  if (!type.valid() || H5Tequal(type, row_type<Row>()) <= 0) return bad("has rows of another form");
  const Hdf5Handle properties(H5Dget_create_plist(table.data), H5Pclose);
  hsize_t chunk = 0;
  if (!mesh::io::is_plain_storage(table.data) || H5Pget_layout(properties) != H5D_CHUNKED ||
      H5Pget_nfilters(properties) != 0 || H5Pget_chunk(properties, 1, &chunk) != 1 || chunk == 0 ||
      chunk > kLargestChunk / sizeof(Row))
    return bad("is not stored as a recorder does");
  const Hdf5Handle space(H5Dget_space(table.data), H5Sclose);
  hsize_t rows = 0;
  if (!space.valid() || H5Sget_simple_extent_ndims(space) != 1 || H5Sget_simple_extent_dims(space, &rows, nullptr) != 1)
    return bad("is not a list");
  if (rows > file_bytes_ / sizeof(Row) + chunk) return bad("claims more rows than the file has room for");
  table.rows = rows;
  return table;
}

/// The last flush that counts no more than there is, and no less than those before it.
Expected<void> RecordingFile::find_whole(const Table& flushes) {
  std::vector<FlushRow> rows(flushes.rows);
  if (Expected<void> done = read_rows(flushes, 0, rows); !done) return done;
  const auto follows = [&](const FlushRow& next) {
    return next.ticks >= count_.ticks && next.steps >= count_.steps && next.commands >= count_.commands &&
           next.scenes >= count_.scenes && next.frames >= count_.frames && next.bytes >= count_.bytes &&
           next.ticks <= ticks_.rows && next.steps <= steps_.rows && next.commands <= commands_.rows &&
           next.scenes <= scenes_.rows && next.frames <= frames_.rows && next.bytes <= bytes_.rows;
  };
  for (const FlushRow& row : rows) {
    if (!follows(row)) break;
    count_ = row;
  }
  if (count_.scenes == 0) return wrong("nothing in it is whole: it ended before its first flush");
  return {};
}

template <class Row>
Expected<void> RecordingFile::read_rows(const Table& table, std::uint64_t from, std::vector<Row>& rows) const {
  if (rows.empty()) return {};
  const Hdf5Quiet quiet;
  if (from > table.rows || rows.size() > table.rows - from) return wrong("a place in it lies behind its end");
  const hsize_t start = from;
  const hsize_t more = rows.size();
  const Hdf5Handle memory(H5Screate_simple(1, &more, nullptr), H5Sclose);
  const Hdf5Handle space(H5Dget_space(table.data), H5Sclose);
  if (H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &more, nullptr) < 0 ||
      H5Dread(table.data, row_type<Row>(), memory, space, H5P_DEFAULT, rows.data()) < 0)
    return wrong("a part of it cannot be read");
  return {};
}

Expected<void> RecordingFile::read(std::uint64_t from, std::vector<TickRow>& rows) const {
  return read_rows(ticks_, from, rows);
}

Expected<void> RecordingFile::read(std::uint64_t from, std::vector<StepRow>& rows) const {
  return read_rows(steps_, from, rows);
}

Expected<std::vector<PieceRow>> RecordingFile::pieces(const Table& table, std::uint64_t count, const char* what) const {
  std::vector<PieceRow> rows(count);
  if (Expected<void> done = read_rows(table, 0, rows); !done) return fail(std::move(done.error()));
  std::uint64_t before = 0;
  for (const PieceRow& row : rows) {
    if (row.at < before) return wrong(fmt::format("its {} are not in order", what));
    before = row.at;
    if (row.size > kMostPieceBytes || row.offset > count_.bytes || row.size > count_.bytes - row.offset)
      return wrong(fmt::format("one of its {} lies behind the end of 'bytes'", what));
  }
  return rows;
}

Expected<std::vector<PieceRow>> RecordingFile::commands() const {
  return pieces(commands_, count_.commands, "commands");
}
Expected<std::vector<PieceRow>> RecordingFile::scenes() const { return pieces(scenes_, count_.scenes, "scenes"); }
Expected<std::vector<PieceRow>> RecordingFile::frames() const { return pieces(frames_, count_.frames, "frames"); }

Expected<std::vector<std::uint8_t>> RecordingFile::bytes(const PieceRow& piece) const {
  std::vector<std::uint8_t> out(piece.size);
  if (Expected<void> done = read_rows(bytes_, piece.offset, out); !done) return fail(std::move(done.error()));
  return out;
}

Expected<wire::PayloadUnion> RecordingFile::command(const PieceRow& piece) const {
  Expected<std::vector<std::uint8_t>> raw = bytes(piece);
  if (!raw) return fail(std::move(raw.error()));
  Expected<std::unique_ptr<wire::FrameT>> frame = wire::decode(*raw);
  if (!frame) return wrong("a command in it cannot be read");
  return std::move((*frame)->payload);
}

Expected<SceneChoice> RecordingFile::scene(const PieceRow& piece) const {
  const Expected<std::vector<std::uint8_t>> raw = bytes(piece);
  if (!raw) return fail(raw.error());
  Expected<SceneChoice> scene = parse_scene_choice(*raw);
  if (!scene) return wrong(scene.error().what);
  return scene;
}

}  // namespace rhexis::session
