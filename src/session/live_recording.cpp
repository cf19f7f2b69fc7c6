// How a live session is recorded: from a body made anew and a haptic loop that starts at tick 0, so that all can be
// computed again.

#include <ctime>

#include "session/live_session.h"

namespace rhexis::session {
namespace {

/// "plate-tear-20250131-174512", with a number behind it where that is taken.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& scene) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  const std::string name =
      fmt::format("{}-{:04}{:02}{:02}-{:02}{:02}{:02}", std::filesystem::path(scene).stem().string(),
                  local.tm_year + 1900, local.tm_mon + 1, local.tm_mday, local.tm_hour, local.tm_min, local.tm_sec);
  std::filesystem::path path = folder / (name + ".h5");
  std::error_code code;
  for (int k = 2; std::filesystem::exists(path, code); ++k) path = folder / fmt::format("{}-{}.h5", name, k);
  return path;
}

}  // namespace

Expected<void> LiveSession::begin_loop() {
  holder_.script->order({});  // what was ordered before counts other ticks
  auto loop = std::make_unique<HandLoop>(*holder_.device, holder_.script,
                                         haptics::LoopSettings{.tick = holder_.tick, .priority = settings_.priority});
  if (Expected<void> started = loop->loop.start(); !started) return started;
  loop_ = std::move(loop);
  rates_.restart();
  hand_ = {};
  steps_ = 0;
  trace_.clear();
  recorder_ticks_lost_ = 0;
  return {};
}

Expected<void> LiveSession::begin_recording() {
  if (settings_.recordings.empty()) return fail("nothing can be recorded here", "--recordings FOLDER");
  Expected<std::unique_ptr<OpenBody>> body = reopen(interaction_->body());
  if (!body) return fail(std::move(body.error()));
  std::error_code code;
  std::filesystem::create_directories(settings_.recordings, code);  // what is wrong with it, making the file says
  const haptics::DeviceTraits& traits = holder_.device->traits();
  Expected<std::unique_ptr<Recorder>> recorder = Recorder::create(
      free_name(settings_.recordings, interaction_->body().scene.file), {.version = settings_.version,
                                                                         .device = traits.name,
                                                                         .tick = holder_.tick,
                                                                         .device_max_force = traits.max_force,
                                                                         .device_resolution = traits.resolution,
                                                                         .device_delay = traits.delay,
                                                                         .counts_from_hold = traits.counts_from_hold});
  if (!recorder) return fail(std::move(recorder.error()));
  if (loop_) loop_->loop.stop();
  interaction_ = std::make_unique<Interaction>(std::move(*body), scene_reader(), *this);
  if (Expected<void> begun = begin_loop(); !begun) return begun;
  recorder_ = std::move(*recorder);
  recorder_->add_scene(next_step(), interaction_->body().scene);
  has_body(/*anew=*/true);
  return {};
}

/// It is closed beside the physics, which does not wait for the disk.
void LiveSession::end_recording() {
  if (!recorder_) return;
  say_what_closed(/*waits=*/true);
  closed_.file = recorder_->path().filename().string();
  closed_.seconds = 1e-3 * static_cast<double>(interaction_->tick());
  closing_ = std::async(std::launch::async, [recorder = std::move(recorder_)] { return recorder->close(); });
}

void LiveSession::watch_recording() {
  if (const std::string trouble = recorder_ ? recorder_->trouble() : std::string(); !trouble.empty()) {
    end_recording();
    says(wire::Level::error, trouble);
  }
  say_what_closed(/*waits=*/false);
}

void LiveSession::say_what_closed(bool waits) {
  if (!closing_.valid()) return;
  if (!waits && closing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  closed_.bytes = closing_.get();
  send(wire::encode(closed_));
}

}  // namespace rhexis::session
