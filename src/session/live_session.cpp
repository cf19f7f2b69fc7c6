#include "session/live_session.h"

#include <algorithm>

#include "base/clock.h"
#include "scene/live_keys.h"

namespace rhexis::session {
namespace {

constexpr std::chrono::seconds kLateAgain{5};
/// Of the trace in a State: a second, if no State was made for longer.
constexpr std::size_t kMostTrace = 3 * 1000;

wire::SharedMessage make_hello(const LiveSettings& settings) {
  wire::HelloT hello;
  hello.version = settings.version;
  hello.scenes = settings.scenes;
  hello.devices = settings.devices;
  hello.declarations = settings.task == nullptr ? scene::live_keys_json() : "[]";
  return wire::encode(std::move(hello));
}

Expected<std::unique_ptr<OpenBody>> open_scene(const LiveSettings& settings) {
  if (settings.task != nullptr) return settings.task->open();
  Expected<SceneChoice> choice = read_scene_choice(settings.scene, settings.overrides);
  if (!choice) return fail(std::move(choice.error()));
  return open_body(std::move(*choice));
}

}  // namespace

Expected<std::unique_ptr<LiveSession>> LiveSession::open(LiveSettings settings, FrameSink& sink) {
  if (settings.task == nullptr &&
      std::find(settings.scenes.begin(), settings.scenes.end(), settings.scene) == settings.scenes.end())
    settings.scenes.insert(settings.scenes.begin(), settings.scene);
  Holder holder{.script = std::make_shared<ScriptedHand>(), .device = nullptr, .tick = {}};
  Expected<std::unique_ptr<haptics::Device>> device =
      settings.device ? settings.device(holder.script) : std::make_unique<haptics::PointerDevice>();
  if (!device) return fail(std::move(device.error()));
  holder.device = std::move(*device);
  holder.tick = haptics::settings_for(holder.device->traits());
  holder.tick.motion_scale = settings.motion_scale;
  holder.tick.force_scale = settings.force_scale;
  if (Expected<void> good = haptics::check_settings(holder.tick); !good) return fail(std::move(good.error()));
  Expected<std::unique_ptr<OpenBody>> body = open_scene(settings);
  if (!body) return fail(std::move(body.error()));
  if (const haptics::DeviceTraits& traits = holder.device->traits();
      traits.follows_script && (*body)->problem.pulls.empty())
    return fail(fmt::format("there is nothing for device '{}' to do", traits.name),
                settings.task != nullptr ? "a device that somebody holds" : "add a [[pull]]", (*body)->scene.file);
  return std::unique_ptr<LiveSession>(new LiveSession(std::move(settings), sink, std::move(holder), std::move(*body)));
}

LiveSession::LiveSession(LiveSettings settings, FrameSink& sink, Holder holder, std::unique_ptr<OpenBody> body)
    : settings_(std::move(settings)),
      sink_(sink),
      hello_(make_hello(settings_)),
      holder_(std::move(holder)),
      pointer_(dynamic_cast<haptics::PointerDevice*>(holder_.device.get())) {
  interaction_ = std::make_unique<Interaction>(std::move(body), scene_reader(), *this);
}

LiveSession::~LiveSession() { stop(); }

Expected<void> LiveSession::start() {
  if (Expected<void> opened = holder_.device->open(); !opened) return opened;
  Expected<void> begun = settings_.records ? begin_recording() : begin_loop();
  if (!begun) {
    holder_.device->close();
    return begun;
  }
  if (recorder_ == nullptr) has_body(/*anew=*/true);
  stops_ = false;
  physics_ = std::thread([this] { run(); });
  return {};
}

void LiveSession::stop() {
  if (!physics_.joinable()) return;
  stops_ = true;
  physics_.join();
  loop_->loop.stop();
  take_trace();
  holder_.device->close();
  end_recording();
  say_what_closed(/*waits=*/true);
}

void LiveSession::post(wire::PayloadUnion command) {
  const bool takes_hold = command.type == wire::Payload::Grasp;
  if (pointer_ != nullptr && (command.type == wire::Payload::Move || takes_hold)) {
    const wire::Vec3* to = takes_hold ? nullptr : command.AsMove()->to.get();
    const std::lock_guard lock(pointer_mutex_);
    pointer_->move_to(to != nullptr ? Vec3(to->x(), to->y(), to->z()) : Vec3(Vec3::Zero()));
  }
  if (command.type == wire::Payload::Move) return;
  const std::lock_guard lock(commands_mutex_);
  if (commands_.size() < kMostCommands) {
    commands_.push_back(std::move(command));
  } else {
    dropped_commands_ = true;
  }
}

void LiveSession::run() {
  Clock::time_point due = Clock::now();
  while (!stops_.load(std::memory_order_relaxed)) {
    step();
    due = std::max(due + kStep, Clock::now() - kStep);  // late steps are not made up for: the body is where the hand is
    std::this_thread::sleep_until(due);
  }
}

/// Take what clients ask; take the hand's newest motion; move the body by it, and let it tear; publish; show.
void LiveSession::step() {
  const Stopwatch watch;
  opened_ = false;
  take_commands();
  if (settings_.task != nullptr) bind_hand();
  const bool fresh = loop_->hands.take(hand_);
  const StepOutcome outcome = interaction_->step(hand_, fresh);
  steps_ = outcome.number;
  loop_->laws.publish(felt_law());
  holder_.script->order(interaction_->orders());
  take_trace();
  if (recorder_)
    recorder_->add(StepRow{.number = outcome.number,
                           .hand = hand_,
                           .fresh = fresh ? 1U : 0U,
                           .advances = static_cast<std::uint32_t>(outcome.advances),
                           .topology = outcome.topology,
                           .fingerprint = outcome.fingerprint,
                           .law = outcome.law,
                           .force = {outcome.force[0], outcome.force[1], outcome.force[2]}});
  watch_recording();
  if (edits_ >= kEditsPerBody) send_body();
  if (Clock::now() >= next_frame_) send_state();

  const double seconds = watch.seconds();
  rates_.add_step(seconds, outcome.number, hand_.number, loop_->loop);
  if (seconds > kLate && !opened_ && Clock::now() - last_late_ > kLateAgain) {
    last_late_ = Clock::now();
    says(wire::Level::warning, fmt::format("the physics is late: a step took {:.0f} ms", 1e3 * seconds));
  }
}

void LiveSession::take_commands() {
  std::vector<wire::PayloadUnion> commands;
  bool dropped = false;
  {
    const std::lock_guard lock(commands_mutex_);
    commands.swap(commands_);
    std::swap(dropped, dropped_commands_);
  }
  if (dropped) says(wire::Level::warning, "commands come faster than they can be carried out: some were left out");
  for (const wire::PayloadUnion& command : commands) carry_out(command);
}

void LiveSession::carry_out(const wire::PayloadUnion& command) {
  if (settings_.task != nullptr) return carry_out_of_task(command);
  switch (command.type) {
    case wire::Payload::ShowField:
      frames_.show(command.AsShowField()->field);
      next_frame_ = {};
      break;
    case wire::Payload::Record:
      if (command.AsRecord()->on == (recorder_ != nullptr)) break;
      if (recorder_) {
        end_recording();
      } else if (const Expected<void> begun = begin_recording(); !begun) {
        says(wire::Level::error, begun.error().message());
      }
      break;
    default:
      if (!is_for_page(command)) break;
      if (recorder_) recorder_->add_command(next_step(), command);
      interaction_->carry_out(command);
  }
}

/// What takes hold by itself is not disturbed by a page, nor by one that leaves and lets go of what it never held.
bool LiveSession::is_for_page(const wire::PayloadUnion& command) {
  const haptics::DeviceTraits& traits = holder_.device->traits();
  const bool takes_hold = command.type == wire::Payload::Grasp;
  if (!traits.follows_script || (!takes_hold && command.type != wire::Payload::LetGo)) return true;
  if (takes_hold) says(wire::Level::info, fmt::format("the device '{}' holds the body: the page watches", traits.name));
  return false;
}

/// Every tick of the haptic loop since the last step.
void LiveSession::take_trace() {
  haptics::TickSample tick;
  while (loop_->trace.pop(tick)) {
    if (recorder_) recorder_->add(tick);
    if (trace_.size() >= kMostTrace) trace_.clear();
    if (trace_.empty()) trace_tick_ = tick.tick;
    for (const double component : tick.force) trace_.push_back(static_cast<float>(component));
  }
  if (recorder_ && loop_->trace.dropped() > recorder_ticks_lost_)
    recorder_->end("the physics was away for so long that ticks of the haptic loop were lost: the recording has ended");
}

void LiveSession::send_state() {
  const Clock::time_point begin = Clock::now();
  wire::StateT state = frames_.state(*interaction_, hand_);
  state.recording = recorder_ != nullptr;
  if (settings_.task != nullptr)  // of the plate that is felt, which is not the one that is seen
    state.body_force = std::make_unique<wire::Vec3>(hand_.body_force[0], hand_.body_force[1], hand_.body_force[2]);
  state.rates = std::make_unique<wire::RatesT>(rates_.latest());
  state.trace_tick = trace_tick_;
  state.trace.swap(trace_);
  trace_.clear();
  send(wire::encode(std::move(state)));
  const Clock::time_point end = Clock::now();
  next_frame_ = std::max(begin + kFrame, end + 2 * (end - begin));
}

void LiveSession::has_body(bool anew) {
  opened_ = true;
  send_body();
  if (!anew || settings_.task != nullptr) return;
  if (holder_.device->traits().follows_script) {
    wire::PayloadUnion begin;
    wire::ScriptT on;
    on.on = true;
    begin.Set(on);
    post(std::move(begin));
  }
  const OpenBody& body = interaction_->body();
  for (const std::string& note : body.problem.notes) says(wire::Level::info, note);
  for (const std::string& warning : body.problem.warnings) says(wire::Level::warning, warning);
  for (const std::string& warning : body.start.warnings) says(wire::Level::warning, warning);
}

void LiveSession::has_torn(const AdvanceRecord& /*advance*/, const SurfaceChange& change) {
  send(wire::encode(frames_.edit(*interaction_, change)));
  ++edits_;
}

void LiveSession::says(wire::Level level, const std::string& text) {
  wire::NoticeT notice;
  notice.level = level;
  notice.text = text;
  send(wire::encode(std::move(notice)));
}

void LiveSession::send_body() {
  edits_ = 0;
  next_frame_ = {};  // where it is follows at once
  send(wire::encode(frames_.body(*interaction_)));
}

void LiveSession::send(const wire::SharedMessage& message) {
  if (recorder_) recorder_->add_frame(interaction_->tick(), message);
  sink_.take(message);
}

Interaction::ReadScene LiveSession::scene_reader() {
  return [this](const std::string& file) -> Expected<SceneChoice> {
    if (std::find(settings_.scenes.begin(), settings_.scenes.end(), file) == settings_.scenes.end())
      return fail("not one of the scenes that can be opened here", {}, file);
    Expected<SceneChoice> choice = read_scene_choice(file, {});
    if (choice && recorder_) recorder_->add_scene(next_step(), *choice);
    return choice;
  };
}

}  // namespace rhexis::session
