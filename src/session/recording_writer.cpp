#include "session/recording_writer.h"

#include <cerrno>
#include <cstring>

#include "mesh/io/hdf5_scalars.h"
#include "session/recording_tables.h"

namespace rhexis::session {
namespace {

using mesh::io::Hdf5Handle;
using mesh::io::Hdf5Quiet;

constexpr hsize_t kChunkBytes = hsize_t{1} << 16;

template <class Row>
Hdf5Handle make_table(hid_t file, const char* name) {
  const hsize_t none = 0;
  const hsize_t unlimited = H5S_UNLIMITED;
  const hsize_t chunk = std::max<hsize_t>(1, kChunkBytes / sizeof(Row));
  const Hdf5Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (!space.valid() || !properties.valid() || H5Pset_chunk(properties, 1, &chunk) < 0) return {};
  const Hdf5Handle type = row_type<Row>();
  return {H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose};
}

}  // namespace

std::size_t RecordingBatch::size() const {
  return ticks.size() * sizeof(TickRow) + steps.size() * sizeof(StepRow) +
         (commands.size() + scenes.size() + frames.size()) * sizeof(PieceRow) + bytes.size();
}

void RecordingBatch::clear() {
  ticks.clear();
  steps.clear();
  commands.clear();
  scenes.clear();
  frames.clear();
  bytes.clear();
}

Expected<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path, const RecordingHead& head) {
  const Hdf5Quiet quiet;
  RecordingWriter out;
  out.name_ = path.string();
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  errno = 0;
  out.file_ = {H5Fcreate(out.name_.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access), H5Fclose};
  if (!out.file_.valid())
    return fail(fmt::format("the recording cannot be made: {}", errno != 0 ? std::strerror(errno) : "HDF5 refuses"),
                "a folder that can be written to", out.name_);
  const hid_t file = out.file_;
  out.ticks_ = make_table<TickRow>(file, table::kTicks);
  out.steps_ = make_table<StepRow>(file, table::kSteps);
  out.commands_ = make_table<PieceRow>(file, table::kCommands);
  out.scenes_ = make_table<PieceRow>(file, table::kScenes);
  out.frames_ = make_table<PieceRow>(file, table::kFrames);
  out.bytes_ = make_table<std::uint8_t>(file, table::kBytes);
  out.flushes_ = make_table<FlushRow>(file, table::kFlushes);
  const bool made = out.ticks_.valid() && out.steps_.valid() && out.commands_.valid() && out.scenes_.valid() &&
                    out.frames_.valid() && out.bytes_.valid() && out.flushes_.valid();
  if (!made || !mesh::io::set_text_attribute(file, "format", kRecordingFormat) ||
      !mesh::io::set_number_attribute(file, "version", kRecordingVersion) ||
      !mesh::io::set_text_attribute(file, "settings", text_of(head)) || H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 ||
      H5Fstart_swmr_write(file) < 0)
    return fail("the recording cannot be written", "room on the disk", out.name_);
  return out;
}

template <class Row>
Expected<void> RecordingWriter::append_rows(const Hdf5Handle& data, const std::vector<Row>& rows,
                                            std::uint64_t& count) {
  if (rows.empty()) return {};
  const hsize_t start = count;
  const hsize_t more = rows.size();
  const hsize_t whole = start + more;
  const Hdf5Handle memory(H5Screate_simple(1, &more, nullptr), H5Sclose);
  const Hdf5Handle type = row_type<Row>();
  bool good = H5Dset_extent(data, &whole) >= 0;
  const Hdf5Handle space(good ? H5Dget_space(data) : -1, H5Sclose);
  good = good && H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &more, nullptr) >= 0 &&
         H5Dwrite(data, type, memory, space, H5P_DEFAULT, rows.data()) >= 0 && H5Dflush(data) >= 0;
  if (!good) return fail("the recording cannot be written on", "room on the disk", name_);
  count = whole;
  return {};
}

Expected<void> RecordingWriter::append(const RecordingBatch& batch) {
  const Hdf5Quiet quiet;
  // `bytes` before the rows that point into it, all before the row that counts them.
  Expected<void> done = append_rows(bytes_, batch.bytes, whole_.bytes);
  if (done) done = append_rows(ticks_, batch.ticks, whole_.ticks);
  if (done) done = append_rows(scenes_, batch.scenes, whole_.scenes);
  if (done) done = append_rows(commands_, batch.commands, whole_.commands);
  if (done) done = append_rows(steps_, batch.steps, whole_.steps);
  if (done) done = append_rows(frames_, batch.frames, whole_.frames);
  if (done) done = append_rows(flushes_, std::vector<FlushRow>{whole_}, flush_count_);
  return done;
}

}  // namespace rhexis::session
