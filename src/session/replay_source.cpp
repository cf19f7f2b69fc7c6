#include "session/replay_source.h"

#include <algorithm>
#include <cmath>

namespace rhexis::session {
namespace {

constexpr std::chrono::milliseconds kLook{10};
constexpr std::chrono::milliseconds kTimeline{500};
/// Commands that wait. More are left out: the last seek is what counts.
constexpr std::size_t kMostCommands = 256;

double time_of(const PieceRow& frame) { return 1e-3 * static_cast<double>(frame.at); }
wire::Payload kind_of(const PieceRow& frame) { return static_cast<wire::Payload>(frame.kind); }

bool is_shown(const PieceRow& frame) {
  constexpr std::array kShown{wire::Payload::Body, wire::Payload::Edit, wire::Payload::State, wire::Payload::Notice};
  return std::any_of(kShown.begin(), kShown.end(),
                     [&](wire::Payload kind) { return frame.kind == static_cast<std::uint64_t>(kind); });
}

wire::SharedMessage make_hello(const std::string& version) {
  wire::HelloT hello;
  hello.version = version;
  hello.replay = true;
  return wire::encode(std::move(hello));
}

}  // namespace

Expected<std::unique_ptr<ReplaySource>> ReplaySource::open(const std::filesystem::path& path, FrameSink& sink) {
  Expected<RecordingFile> file = RecordingFile::open(path);
  if (!file) return fail(std::move(file.error()));
  Expected<std::vector<PieceRow>> frames = file->frames();
  if (!frames) return fail(std::move(frames.error()));
  std::erase_if(*frames, [](const PieceRow& frame) { return !is_shown(frame); });
  if (frames->empty() || kind_of(frames->front()) != wire::Payload::Body)
    return file->wrong("it does not begin with a body");
  return std::unique_ptr<ReplaySource>(new ReplaySource(std::move(*file), std::move(*frames), sink));
}

ReplaySource::ReplaySource(RecordingFile file, std::vector<PieceRow> frames, FrameSink& sink)
    : file_(std::move(file)),
      frames_(std::move(frames)),
      sink_(sink),
      hello_(make_hello(file_.head().version)),
      duration_(time_of(frames_.back())) {}

ReplaySource::~ReplaySource() { stop(); }

void ReplaySource::start() {
  stops_ = false;
  thread_ = std::thread([this] { run(); });
}

void ReplaySource::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  something_.notify_one();
  thread_.join();
}

void ReplaySource::post(wire::PayloadUnion command) {
  {
    const std::lock_guard lock(mutex_);
    if (commands_.size() >= kMostCommands) commands_.erase(commands_.begin());
    commands_.push_back(std::move(command));
  }
  something_.notify_one();
}

void ReplaySource::run() {
  seek(0.0);
  std::unique_lock lock(mutex_);
  while (!stops_) {
    something_.wait_for(lock, plays_ ? kLook : kTimeline, [&] { return stops_ || !commands_.empty(); });
    std::vector<wire::PayloadUnion> commands;
    commands.swap(commands_);
    lock.unlock();
    for (std::size_t k = 0; k < commands.size(); ++k) {
      // Of seeks that wait the last is enough: a hand that scrubs is faster than the frames.
      const bool is_old = commands[k].type == wire::Payload::Seek && k + 1 < commands.size() &&
                          commands[k + 1].type == wire::Payload::Seek;
      if (!is_old) carry_out(commands[k]);
    }
    if (plays_) play_on();
    if (Clock::now() - last_timeline_ >= kTimeline) send_timeline();
    lock.lock();
  }
}

void ReplaySource::carry_out(const wire::PayloadUnion& command) {
  if (command.type == wire::Payload::Seek) {
    seek(command.AsSeek()->time);
  } else if (command.type == wire::Payload::Play) {
    const double speed = command.AsPlay()->speed;
    time_ = now();
    since_ = Clock::now();
    if (std::isfinite(speed) && speed > 0.0) speed_ = std::clamp(speed, kLeastSpeed, kMostSpeed);
    plays_ = command.AsPlay()->on;
    if (plays_ && time_ >= duration_) seek(0.0);
    send_timeline();
  } else {
    say(wire::Level::info, "this is a recording: it can be played and sought, not held");
  }
}

double ReplaySource::now() const {
  if (!plays_) return time_;
  return std::min(duration_, time_ + speed_ * std::chrono::duration<double>(Clock::now() - since_).count());
}

std::size_t ReplaySource::first_after(double time) const {
  const auto after = std::upper_bound(frames_.begin(), frames_.end(), time,
                                      [](double t, const PieceRow& frame) { return t < time_of(frame); });
  return static_cast<std::size_t>(after - frames_.begin());
}

void ReplaySource::seek(double to) {
  if (!std::isfinite(to)) return;
  time_ = std::clamp(to, 0.0, duration_);
  since_ = Clock::now();
  std::size_t end = std::max<std::size_t>(1, first_after(time_));  // at least the first body
  std::size_t begin = end - 1;
  while (begin > 0 && kind_of(frames_[begin]) != wire::Payload::Body) --begin;
  end = with_state(begin, end);
  show(next_ > begin && next_ <= end ? next_ : begin, end, /*notices=*/false);
  next_ = end;
  send_timeline();
}

std::size_t ReplaySource::with_state(std::size_t begin, std::size_t end) const {
  const auto is = [&](std::size_t k, wire::Payload kind) { return kind_of(frames_[k]) == kind; };
  for (std::size_t k = begin; k < frames_.size(); ++k) {
    if (k > begin && is(k, wire::Payload::Body)) break;
    if (is(k, wire::Payload::State)) return std::max(end, k + 1);
  }
  return end;
}

void ReplaySource::play_on() {
  const double time = now();
  const std::size_t end = std::max(next_, first_after(time));
  show(next_, end, /*notices=*/true);
  next_ = end;
  if (time < duration_) return;
  time_ = duration_;
  plays_ = false;
  send_timeline();
}

void ReplaySource::show(std::size_t from, std::size_t to, bool notices) {
  std::size_t state = to;
  for (std::size_t k = from; k < to; ++k) {
    switch (kind_of(frames_[k])) {
      case wire::Payload::State: state = k; break;
      case wire::Payload::Notice:
        if (notices) send(k);
        break;
      case wire::Payload::Body: state = to; [[fallthrough]];  // what was before is of another body
      default:
        if (!send(k)) return;
    }
  }
  if (state < to) send(state);
}

bool ReplaySource::send(std::size_t frame) {
  Expected<std::vector<std::uint8_t>> bytes = file_.bytes(frames_[frame]);
  const Expected<std::unique_ptr<wire::FrameT>> decoded =
      bytes ? wire::decode(*bytes) : Expected<std::unique_ptr<wire::FrameT>>(fail(bytes.error()));
  if (!decoded || (*decoded)->payload.type != kind_of(frames_[frame])) {
    plays_ = false;
    say(wire::Level::error,
        file_.wrong(fmt::format("its frame at {:.3f} s cannot be read", time_of(frames_[frame]))).value().message());
    return false;
  }
  auto message = std::make_shared<wire::Message>();
  message->bytes = std::move(*bytes);
  message->kind = kind_of(frames_[frame]);
  sink_.take(message);
  return true;
}

void ReplaySource::send_timeline() {
  last_timeline_ = Clock::now();
  wire::TimelineT timeline;
  timeline.duration = duration_;
  timeline.time = now();
  timeline.speed = speed_;
  timeline.playing = plays_;
  for (const PieceRow& frame : frames_)
    if (kind_of(frame) == wire::Payload::Edit) timeline.marks.push_back(time_of(frame));
  sink_.take(wire::encode(std::move(timeline)));
}

void ReplaySource::say(wire::Level level, const std::string& text) {
  wire::NoticeT notice;
  notice.level = level;
  notice.text = text;
  sink_.take(wire::encode(std::move(notice)));
}

}  // namespace rhexis::session
