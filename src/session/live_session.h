#pragma once

/// One interaction, live: the physics on a thread of its own, a device on the haptic loop's, commands of clients in,
/// frames out. What happens is decided by Interaction; this gives it a clock, queues, a device and a recorder.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "haptics/pointer_device.h"
#include "session/frame_maker.h"
#include "session/frame_sink.h"
#include "session/hand_loop.h"
#include "session/interaction.h"
#include "session/live_rates.h"
#include "session/live_settings.h"
#include "session/recorder.h"
#include "session/scripted_hand.h"

namespace rhexis::session {

class LiveSession final : public CommandTarget, public InteractionListener {
 public:
  /// The physics steps once in this time, or as soon as it can.
  static constexpr std::chrono::milliseconds kStep{1};
  /// A State is made once in this time; less often where that would take more than a third of the physics' time.
  static constexpr std::chrono::milliseconds kFrame{20};
  /// A step that takes longer is late, and said to be.
  static constexpr double kLate = 0.1;  // s
  /// So many edits are followed by a whole Body.
  static constexpr int kEditsPerBody = 32;
  /// Commands that wait for a step. More are dropped, and it is said.
  static constexpr std::size_t kMostCommands = 1024;

  /// Makes the device, opens the first scene. `sink` outlives the session. Errors: the device's, the scene's, the
  /// settings'; a scene without a pull for a device that follows one.
  static Expected<std::unique_ptr<LiveSession>> open(LiveSettings settings, FrameSink& sink);
  ~LiveSession() override;  ///< stops

  /// The loops begin. Errors: the device's, a recording that cannot be made.
  Expected<void> start();
  /// Both loops end, the device is given no force, the recording is closed. May be called twice.
  void stop();

  void post(wire::PayloadUnion command) override;
  [[nodiscard]] wire::SharedMessage hello() const override { return hello_; }

  /// Of the last start. While the session runs a recording may replace it.
  [[nodiscard]] const haptics::HapticLoop& haptic_loop() const { return loop_->loop; }

 private:
  using Clock = std::chrono::steady_clock;

  /// A device, the script that it may follow, and how the loop treats it.
  struct Holder {
    std::shared_ptr<ScriptedHand> script;
    std::unique_ptr<haptics::Device> device;
    haptics::TickSettings tick;
  };

  LiveSession(LiveSettings settings, FrameSink& sink, Holder holder, std::unique_ptr<OpenBody> body);
  void run();
  void step();
  void take_commands();
  void carry_out(const wire::PayloadUnion& command);
  bool is_for_page(const wire::PayloadUnion& command);
  void carry_out_of_task(const wire::PayloadUnion& command);
  void bind_hand();
  void send_trial();
  /// What the haptic loop is to feel: the body's law, or what a task puts in its place.
  [[nodiscard]] response::ForceSnapshot felt_law() const;
  void take_trace();
  void send_state();
  void watch_recording();  ///< ends one that has come to trouble
  void say_what_closed(bool waits);

  Expected<void> begin_recording();
  void end_recording();
  Expected<void> begin_loop();
  [[nodiscard]] Interaction::ReadScene scene_reader();
  [[nodiscard]] std::uint64_t next_step() const { return steps_ + 1; }

  void has_body(bool anew) override;
  void has_torn(const AdvanceRecord& advance, const SurfaceChange& change) override;
  void says(wire::Level level, const std::string& text) override;
  void send(const wire::SharedMessage& message);
  void send_body();

  LiveSettings settings_;
  FrameSink& sink_;
  wire::SharedMessage hello_;
  Holder holder_;
  haptics::PointerDevice* pointer_ = nullptr;  ///< the holder's device, where it is that of the page

  // Between the threads of clients and that of the physics.
  std::mutex commands_mutex_;
  std::vector<wire::PayloadUnion> commands_;
  bool dropped_commands_ = false;
  std::mutex pointer_mutex_;  ///< the pointer takes one writer at a time
  std::atomic<bool> stops_{false};
  std::thread physics_;

  // Of the physics alone.
  std::unique_ptr<HandLoop> loop_;
  std::unique_ptr<Interaction> interaction_;
  FrameMaker frames_;
  std::uint64_t steps_ = 0;
  haptics::HandState hand_;
  bool is_bound_ = false;  ///< the hand, to what the task shows
  LiveRates rates_;
  std::vector<float> trace_;  ///< N, 3 a tick since the last State
  std::uint64_t trace_tick_ = 0;
  Clock::time_point next_frame_{};
  int edits_ = 0;        ///< since the last Body
  bool opened_ = false;  ///< in this step: it may take long
  Clock::time_point last_late_{};

  std::unique_ptr<Recorder> recorder_;
  std::uint64_t recorder_ticks_lost_ = 0;
  std::future<std::uint64_t> closing_;  ///< bytes of the recording that is being closed
  wire::RecordedT closed_;              ///< what will be said of it
};

}  // namespace rhexis::session
