#pragma once

/// Plays what a recording's clients have seen: to a sink, at any speed, from any time. Computes nothing; that is
/// replay_check.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "session/frame_sink.h"
#include "session/recording_file.h"

namespace rhexis::session {

class ReplaySource final : public CommandTarget {
 public:
  /// Times as fast as it happened.
  static constexpr double kLeastSpeed = 0.01;
  static constexpr double kMostSpeed = 100.0;

  /// Standing at the beginning. `sink` outlives it. Errors: the file's, a recording without a body.
  static Expected<std::unique_ptr<ReplaySource>> open(const std::filesystem::path& path, FrameSink& sink);
  ~ReplaySource() override;  ///< stops

  /// Shows the beginning, and waits for Play and Seek on a thread of its own.
  void start();
  void stop();

  /// Play, Seek; others are answered by a Notice, those that only an interaction knows how to follow.
  void post(wire::PayloadUnion command) override;
  [[nodiscard]] wire::SharedMessage hello() const override { return hello_; }
  [[nodiscard]] double duration() const { return duration_; }  ///< s

 private:
  using Clock = std::chrono::steady_clock;

  ReplaySource(RecordingFile file, std::vector<PieceRow> frames, FrameSink& sink);
  void run();
  void carry_out(const wire::PayloadUnion& command);
  /// Shows time `to`: from the last Body before it, or from where it is, whichever is nearer.
  void seek(double to);
  /// `end`, or behind it that of the first State of the body at `begin`: a body is sent some ticks before its first
  /// state is, and a page cannot draw the one without the other.
  [[nodiscard]] std::size_t with_state(std::size_t begin, std::size_t end) const;
  /// All that is due.
  void play_on();
  /// Frames [from, to) of the index: every one that must arrive, and the last State.
  void show(std::size_t from, std::size_t to, bool notices);
  bool send(std::size_t frame);
  void send_timeline();
  void say(wire::Level level, const std::string& text);
  [[nodiscard]] std::size_t first_after(double time) const;
  [[nodiscard]] double now() const;

  RecordingFile file_;
  std::vector<PieceRow> frames_;
  FrameSink& sink_;
  wire::SharedMessage hello_;
  double duration_ = 0.0;  ///< s

  std::mutex mutex_;
  std::condition_variable something_;
  std::vector<wire::PayloadUnion> commands_;
  bool stops_ = false;
  std::thread thread_;

  // Of the thread alone.
  std::size_t next_ = 0;  ///< frames before it have been shown
  double time_ = 0.0;     ///< s, when `since_` was
  Clock::time_point since_{};
  Clock::time_point last_timeline_{};
  double speed_ = 1.0;
  bool plays_ = false;
};

}  // namespace rhexis::session
