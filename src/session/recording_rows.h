#pragma once

/// What a recording holds, row by row (docs/recording.md): fixed in size, written as bytes.

#include <array>
#include <cstdint>
#include <type_traits>

#include "haptics/hand_state.h"
#include "haptics/tick_ring.h"

namespace rhexis::session {

/// One tick of the haptic loop.
using TickRow = haptics::TickSample;

/// One step of the physics: what it read of the hand, and what came of it.
struct StepRow {
  std::uint64_t number = 0;  ///< from 1; also of the law that it published
  haptics::HandState hand;   ///< that it read
  std::uint32_t fresh = 0;   ///< 1: `hand` is another one than that of the last step
  std::uint32_t advances = 0;
  std::uint64_t topology = 0;
  std::uint64_t fingerprint = 0;  ///< of the body, chained over its edits
  std::uint64_t law = 0;          ///< Hash of the snapshot that it published
  std::array<double, 3> force{};  ///< N, on the hand, of the body itself
};

/// No frame, command or scene is larger.
inline constexpr std::uint64_t kMostPieceBytes = std::uint64_t{1} << 28;
/// Nor is a scene's mesh file, beside which its text has room.
inline constexpr std::uint64_t kMostMeshBytes = kMostPieceBytes / 2;

/// A piece of the recording's `bytes`.
struct PieceRow {
  std::uint64_t at = 0;    ///< commands, scenes: the step before which it was taken up; frames: tick of the haptic loop
  std::uint64_t kind = 0;  ///< commands, frames: wire::Payload; scenes: 0
  std::uint64_t offset = 0;  ///< in `bytes`
  std::uint64_t size = 0;
};

/// How much of each table is whole: written after what it counts.
struct FlushRow {
  std::uint64_t ticks = 0, steps = 0, commands = 0, scenes = 0, frames = 0, bytes = 0;
};

/// Rows are written as they lie in memory.
template <class Row>
inline constexpr bool kIsRow = std::is_trivially_copyable_v<Row> && std::is_standard_layout_v<Row>;
static_assert(kIsRow<TickRow> && sizeof(TickRow) == 104);
static_assert(kIsRow<StepRow> && sizeof(StepRow) == 184);
static_assert(kIsRow<PieceRow> && sizeof(PieceRow) == 32);
static_assert(kIsRow<FlushRow> && sizeof(FlushRow) == 48);

}  // namespace rhexis::session
