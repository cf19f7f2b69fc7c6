#pragma once

/// A recording cut into what a stranger can put into it, so that mutations reach the rows and what they point to, and
/// not only HDF5's own bookkeeping.

#include <array>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "base/check.h"
#include "fuzz/parts.h"
#include "session/recording_tables.h"

namespace rhexis::fuzz {

struct RecordingParts {
  std::vector<char> settings;
  std::vector<session::TickRow> ticks;
  std::vector<session::StepRow> steps;
  std::vector<session::PieceRow> commands, scenes, frames;
  std::vector<session::FlushRow> flushes;
  std::vector<std::uint8_t> bytes;
};

/// Calls use(name, list) for each; `name` is the table's.
template <class Parts, class Use>
void each_part(Parts& parts, Use&& use) {
  namespace table = session::table;
  use("settings", parts.settings);
  use(table::kTicks, parts.ticks);
  use(table::kSteps, parts.steps);
  use(table::kCommands, parts.commands);
  use(table::kScenes, parts.scenes);
  use(table::kFrames, parts.frames);
  use(table::kFlushes, parts.flushes);
  use(table::kBytes, parts.bytes);
}

/// `bytes`, the last one, is all that is left.
inline RecordingParts parts_of(std::span<const std::uint8_t> input) {
  RecordingParts parts;
  each_part(parts, [&]<class Row>(const char* name, std::vector<Row>& rows) {
    if (name == session::table::kBytes) {
      take_rest(input, rows);
    } else {
      take_part(input, rows);
    }
  });
  return parts;
}

inline std::vector<std::uint8_t> input_of(const RecordingParts& parts) {
  std::vector<std::uint8_t> input;
  each_part(parts, [&]<class Row>(const char* name, const std::vector<Row>& rows) {
    if (name == session::table::kBytes) {
      add_rest(rows, input);
    } else {
      add_part(rows, input);
    }
  });
  return input;
}

/// As a recorder does it, but for the size of the chunks: a file of some kilobytes.
inline void write_recording(const std::string& path, const RecordingParts& parts) {
  using mesh::io::Hdf5Handle;
  const mesh::io::Hdf5Quiet quiet;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  RHEXIS_CHECK(file.valid(), "no file to fuzz with");
  const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose);
  const auto set_attribute = [&](const char* name, hid_t type, const void* value) {
    const Hdf5Handle attribute(H5Acreate2(file, name, type, one, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(attribute, type, value);
  };
  const auto set_text = [&](const char* name, const char* text, std::size_t size) {
    if (size == 0) return;
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, size);
    set_attribute(name, type, text);
  };
  set_text("format", session::kRecordingFormat, std::strlen(session::kRecordingFormat));
  set_text("settings", parts.settings.data(), parts.settings.size());
  set_attribute("version", H5T_STD_I64LE, &session::kRecordingVersion);
  each_part(parts, [&]<class Row>(const char* name, const std::vector<Row>& rows) {
    if constexpr (!std::is_same_v<Row, char>) {
      const hsize_t count = rows.size();
      const hsize_t unlimited = H5S_UNLIMITED;
      const hsize_t chunk = 512 / sizeof(Row);
      const Hdf5Handle space(H5Screate_simple(1, &count, &unlimited), H5Sclose);
      const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      H5Pset_chunk(properties, 1, &chunk);
      const Hdf5Handle type = session::row_type<Row>();
      const Hdf5Handle data(H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
      if (!rows.empty()) H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
    }
  });
}

}  // namespace rhexis::fuzz
