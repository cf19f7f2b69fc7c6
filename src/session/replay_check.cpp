#include "session/replay_check.h"

#include <bit>
#include <deque>
#include <optional>

#include "haptics/tick.h"
#include "session/interaction.h"
#include "session/recording_file.h"

namespace rhexis::session {
namespace {

constexpr std::size_t kBlock = 4096;  // rows

/// The rows of a table, one after the other.
template <class Row>
class RowsInOrder {
 public:
  RowsInOrder(const RecordingFile& file, std::uint64_t count) : file_(file), count_(count) {}

  /// nullptr behind the last.
  Expected<const Row*> peek() {
    if (next_ == count_) return nullptr;
    if (next_ >= first_ + block_.size()) {
      first_ = next_;
      block_.resize(std::min<std::uint64_t>(kBlock, count_ - next_));
      if (Expected<void> done = file_.read(first_, block_); !done) return fail(std::move(done.error()));
    }
    return &block_[next_ - first_];
  }
  void advance() { ++next_; }

 private:
  const RecordingFile& file_;
  std::uint64_t count_;
  std::uint64_t next_ = 0;
  std::uint64_t first_ = 0;
  std::vector<Row> block_;
};

class Silent final : public InteractionListener {
 public:
  void has_body(bool anew) override { bodies_ += anew ? 1 : 0; }
  void has_torn(const AdvanceRecord& /*advance*/, const SurfaceChange& /*change*/) override {}
  void says(wire::Level /*level*/, const std::string& /*text*/) override {}
  [[nodiscard]] std::uint64_t bodies() const { return bodies_; }

 private:
  std::uint64_t bodies_ = 0;
};

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

std::string vector_text(const std::array<double, 3>& v) {
  return fmt::format("({:.17g}, {:.17g}, {:.17g})", v[0], v[1], v[2]);
}

/// What differs first, as "name: recorded, computed"; empty: nothing.
class Comparison {
 public:
  template <class T>
  Comparison& of(const char* name, const T& recorded, const T& computed) {
    if (text_.empty() && recorded != computed)
      text_ = fmt::format("{} is {} in the recording, {} computed again", name, recorded, computed);
    return *this;
  }
  Comparison& of(const char* name, const std::array<double, 3>& recorded, const std::array<double, 3>& computed) {
    for (std::size_t c = 0; c < 3 && text_.empty(); ++c) {
      if (!same(recorded[c], computed[c]))
        text_ = fmt::format("{} is {} in the recording, {} computed again", name, vector_text(recorded),
                            vector_text(computed));
    }
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class Check {
 public:
  Check(const RecordingFile& file, std::vector<PieceRow> commands, std::vector<PieceRow> scenes)
      : file_(file),
        commands_(std::move(commands)),
        scenes_(std::move(scenes)),
        ticks_(file, file.count().ticks),
        steps_(file, file.count().steps),
        tick_(file.head().tick, file.head().traits()) {}

  Expected<CheckReport> run(const std::function<void(double)>& progress) {
    Expected<SceneChoice> first = file_.scene(scenes_.front());
    if (!first) return fail(std::move(first.error()));
    next_scene_ = 1;
    Expected<std::unique_ptr<OpenBody>> body = open_body(std::move(*first));
    if (!body) return fail(std::move(body.error()));
    interaction_.emplace(
        std::move(*body), [this](const std::string& file) { return recorded_scene(file); }, listener_);
    report_.version = file_.head().version;
    const std::uint64_t all = file_.count().steps;
    while (!stops()) {
      const Expected<const StepRow*> row = steps_.peek();
      if (!row) return fail(row.error());
      if (*row == nullptr) break;
      if (Expected<void> done = check_step(**row); !done) return fail(std::move(done.error()));
      steps_.advance();
      if (progress && report_.steps % kBlock == 0)
        progress(static_cast<double>(report_.steps) / static_cast<double>(all));
    }
    steps_are_over_ = true;
    if (!stops() && file_.count().ticks > 0) {
      if (Expected<void> done = run_loop_to(file_.count().ticks - 1); !done) return fail(std::move(done.error()));
    }
    report_.bodies = 1 + listener_.bodies();
    return report_;
  }

 private:
  /// By a difference, or by an input that was not flushed any more.
  [[nodiscard]] bool stops() const { return cut_short_ || !report_.difference.empty(); }

  Expected<void> check_step(const StepRow& row) {
    const std::uint64_t number = report_.steps + 1;
    if (row.number != number)
      return file_.wrong(fmt::format("step {} stands where step {} should", row.number, number));
    if (row.fresh > 1) return file_.wrong(fmt::format("step {} is neither fresh nor not", number));
    for (; next_command_ < commands_.size() && commands_[next_command_].at <= number; ++next_command_) {
      if (commands_[next_command_].at < number) return file_.wrong("a command comes before a step that is past");
      Expected<wire::PayloadUnion> command = file_.command(commands_[next_command_]);
      if (!command) return fail(std::move(command.error()));
      interaction_->carry_out(*command);
      if (scene_is_wrong_) return fail(*scene_is_wrong_);
    }
    if (row.fresh == 1) {
      if (Expected<void> done = run_loop_to(row.hand.tick); !done || stops()) return done;
      compare_hand(number, row.hand);
    } else if (row.hand.tick != hand_.tick) {
      return file_.wrong(fmt::format("step {} has read a hand of tick {} twice, which is none", number, row.hand.tick));
    }
    if (stops()) return {};
    const StepOutcome outcome = interaction_->step(hand_, row.fresh == 1);
    laws_.push_back(interaction_->law());
    Comparison comparison;
    comparison.of("topology", row.topology, outcome.topology)
        .of("number of advances", row.advances, static_cast<std::uint32_t>(outcome.advances))
        .of("fingerprint of the body", row.fingerprint, outcome.fingerprint)
        .of("force of the body / N", row.force, {outcome.force[0], outcome.force[1], outcome.force[2]})
        .of("fingerprint of the published law", row.law, outcome.law);
    differ(fmt::format("step {} (tick {})", number, hand_.tick), comparison);
    if (stops()) return {};
    ++report_.steps;
    report_.advances += static_cast<std::uint64_t>(outcome.advances);
    return {};
  }

  /// Computes the ticks of the haptic loop up to `last`.
  Expected<void> run_loop_to(std::uint64_t last) {
    while (report_.ticks <= last && !stops()) {
      const Expected<const TickRow*> row = ticks_.peek();
      if (!row) return fail(row.error());
      if (*row == nullptr) {
        cut_short_ = true;  // its last ticks were on their way to the disk
        return {};
      }
      if (Expected<void> done = check_tick(**row); !done) return done;
    }
    return {};
  }

  Expected<void> check_tick(const TickRow& row) {
    if (row.tick != report_.ticks)
      return file_.wrong(fmt::format("tick {} stands where tick {} should", row.tick, report_.ticks));
    if (row.fresh != 0) {
      if (row.number > report_.steps && steps_are_over_) {
        cut_short_ = true;  // the step that published it was on its way to the disk
        return {};
      }
      if (row.number == 0 || row.number > report_.steps || row.number < first_law_)
        return file_.wrong(
            fmt::format("tick {} feels law {}, which no step before it has published", row.tick, row.number));
      while (first_law_ < row.number) {
        laws_.pop_front();
        ++first_law_;
      }
      law_ = laws_.front();
    }
    const haptics::Reading reading{.position = {row.position[0], row.position[1], row.position[2]},
                                   .buttons = row.buttons,
                                   .present = row.present != 0};
    felt_ = tick_.step(reading, law_, row.fresh != 0).hand;
    Comparison comparison;
    comparison.of("law in force", row.number, felt_.number)
        .of("hold", row.grasp, felt_.grasp)
        .of("state of the hand", row.flags, felt_.flags)
        .of("place of the hand / m", row.hand, felt_.hand)
        .of("force on the hand / N", row.force, felt_.force);
    differ(fmt::format("tick {}", row.tick), comparison);
    if (stops()) return {};
    ++report_.ticks;
    ticks_.advance();
    return {};
  }

  void compare_hand(std::uint64_t step, const haptics::HandState& recorded) {
    if (stops()) return;
    Comparison comparison;
    comparison.of("tick of the hand", recorded.tick, felt_.tick)
        .of("law in force", recorded.number, felt_.number)
        .of("hold", recorded.grasp, felt_.grasp)
        .of("state of the hand", recorded.flags, felt_.flags)
        .of("place of the hand / m", recorded.hand, felt_.hand)
        .of("place of the device / m", recorded.device, felt_.device)
        .of("force on the hand / N", recorded.force, felt_.force)
        .of("force of the body on the hand / N", recorded.body_force, felt_.body_force);
    differ(fmt::format("step {} (tick {})", step, felt_.tick), comparison);
    hand_ = felt_;
  }

  void differ(const std::string& where, const Comparison& comparison) {
    if (!comparison.text().empty() && report_.difference.empty())
      report_.difference = fmt::format("{}: {}", where, comparison.text());
  }

  Expected<SceneChoice> recorded_scene(const std::string& file) {
    const auto not_read = [&] { return fail("the scene was not read in the recording", {}, file); };
    if (next_scene_ == scenes_.size() || scenes_[next_scene_].at != report_.steps + 1) return not_read();
    Expected<SceneChoice> scene = file_.scene(scenes_[next_scene_]);
    if (!scene) scene_is_wrong_ = scene.error();
    if (!scene || scene->file != file) return not_read();
    ++next_scene_;
    return scene;
  }

  const RecordingFile& file_;
  std::vector<PieceRow> commands_;
  std::vector<PieceRow> scenes_;
  std::size_t next_command_ = 0;
  std::size_t next_scene_ = 0;
  RowsInOrder<TickRow> ticks_;
  RowsInOrder<StepRow> steps_;

  Silent listener_;
  std::optional<Interaction> interaction_;
  haptics::HapticTick tick_;
  haptics::HandState felt_;  ///< of the last tick
  haptics::HandState hand_;  ///< that the last step read
  response::ForceSnapshot law_;
  std::deque<response::ForceSnapshot> laws_;  ///< published and perhaps still to be felt
  std::uint64_t first_law_ = 1;               ///< number of the first of them
  bool steps_are_over_ = false;
  bool cut_short_ = false;
  std::optional<Error> scene_is_wrong_;
  CheckReport report_;
};

}  // namespace

Expected<CheckReport> check_recording(const std::filesystem::path& path, const std::function<void(double)>& progress) {
  const Expected<RecordingFile> file = RecordingFile::open(path);
  if (!file) return fail(file.error());
  Expected<std::vector<PieceRow>> commands = file->commands();
  if (!commands) return fail(std::move(commands.error()));
  Expected<std::vector<PieceRow>> scenes = file->scenes();
  if (!scenes) return fail(std::move(scenes.error()));
  return Check(*file, std::move(*commands), std::move(*scenes)).run(progress);
}

}  // namespace rhexis::session
