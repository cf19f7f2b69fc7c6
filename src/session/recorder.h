#pragma once

/// Writes a whole interaction into one HDF5 file as it happens (docs/recording.md). Rows go into a queue that the
/// physics never waits at; a thread of its own puts them on the disk and flushes, at least ten times a second, so that
/// what a kill leaves behind opens and holds all up to its last flush.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/error.h"
#include "session/open_body.h"
#include "session/recording_head.h"
#include "session/recording_rows.h"
#include "wire/frame.h"

namespace rhexis::session {

class Recorder {
 public:
  /// What may wait for the disk, beside scenes, which take what they take. A State frame is left out when half of it is
  /// full; when it is all full, the recording ends.
  static constexpr std::size_t kMostWaiting = std::size_t{64} << 20;  // bytes
  static constexpr int kFlushMilliseconds = 50;

  /// A new file. Errors: it cannot be made, or is there already.
  static Expected<std::unique_ptr<Recorder>> create(const std::filesystem::path& path, const RecordingHead& head);
  ~Recorder();  ///< closes

  /// By one thread, in the order in which things happened. After the recording has ended they do nothing.
  void add(const TickRow& tick);
  void add(const StepRow& step);
  void add_command(std::uint64_t before_step, const wire::PayloadUnion& command);
  /// A scene that was opened, with what was set; also the first one. With a mesh too large for a recording, it ends.
  void add_scene(std::uint64_t before_step, const SceneChoice& scene);
  void add_frame(std::uint64_t tick, const wire::SharedMessage& frame);
  /// Empty while all is well; else why the recording has ended before it was closed. From then on nothing is added; the
  /// file holds all that came before.
  [[nodiscard]] std::string trouble() const;
  /// By the same thread: ends it.
  void end(const std::string& why);

  /// Waits until all is on the disk. Bytes of the file.
  std::uint64_t close();
  [[nodiscard]] const std::filesystem::path& path() const;

 private:
  struct Core;
  explicit Recorder(std::unique_ptr<Core> core);
  std::unique_ptr<Core> core_;
};

}  // namespace rhexis::session
