#pragma once

/// The tables of a recording as HDF5 has them: names, and the types of their rows.

#include <cstdint>

#include "mesh/io/hdf5_handle.h"
#include "session/recording_rows.h"

namespace rhexis::session {

inline constexpr const char* kRecordingFormat = "rhexis recording";
inline constexpr std::int64_t kRecordingVersion = 1;

/// Names of the datasets in the root group.
namespace table {
inline constexpr const char* kTicks = "ticks";
inline constexpr const char* kSteps = "steps";
inline constexpr const char* kCommands = "commands";
inline constexpr const char* kScenes = "scenes";
inline constexpr const char* kFrames = "frames";
inline constexpr const char* kBytes = "bytes";
inline constexpr const char* kFlushes = "flushes";
}  // namespace table

/// The HDF5 type of a row, as it lies in memory.
template <class Row>
[[nodiscard]] mesh::io::Hdf5Handle row_type();
template <>
mesh::io::Hdf5Handle row_type<TickRow>();
template <>
mesh::io::Hdf5Handle row_type<StepRow>();
template <>
mesh::io::Hdf5Handle row_type<PieceRow>();
template <>
mesh::io::Hdf5Handle row_type<FlushRow>();
template <>
mesh::io::Hdf5Handle row_type<std::uint8_t>();

}  // namespace rhexis::session
