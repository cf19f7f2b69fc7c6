#pragma once

/// A live interaction as a function: commands and the hand's states in, laws for the haptic loop and events out. No
/// clock, no thread, no device: the same inputs in the same order give the same bits, which is what a recording is
/// checked by. LiveSession feeds it from a device and clients, replay_check from a file.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "haptics/hand_state.h"
#include "response/snapshot.h"
#include "session/open_body.h"
#include "session/script.h"
#include "wire/frame.h"

namespace rhexis::session {

/// Hears what happens, as it happens.
class InteractionListener {
 public:
  virtual ~InteractionListener() = default;
  /// Another body, or the same one anew, or one with its last tear taken back: all of it may have changed.
  virtual void has_body(bool anew) = 0;
  virtual void has_torn(const AdvanceRecord& advance, const SurfaceChange& change) = 0;
  /// In words, for those who watch.
  virtual void says(wire::Level level, const std::string& text) = 0;
};

/// What a step leaves on record.
struct StepOutcome {
  std::uint64_t number = 0;    ///< of the step, from 1; also of the snapshot that it publishes
  Vec3 force = Vec3::Zero();   ///< N, on the hand, of the body itself
  std::uint64_t topology = 0;  ///< number of edits the body has taken
  std::uint64_t fingerprint = 0;
  std::uint64_t law = 0;  ///< Hash of the snapshot's bytes
  int advances = 0;       ///< in this step
};

class Interaction {
 public:
  /// A scene that a client names, read. Errors: not one that may be opened, cannot be read.
  using ReadScene = std::function<Expected<SceneChoice>(const std::string& file)>;

  /// `listener` has to outlive this; it is told of nothing before the first step or command.
  Interaction(std::unique_ptr<OpenBody> body, ReadScene read_scene, InteractionListener& listener);

  /// Grasp, LetGo, Reset, Undo, Pause, Step, Script, SetValue, OpenScene, Compare; others are not for it. What makes no
  /// sense, or is wrong, is said, and all stays as it was.
  void carry_out(const wire::PayloadUnion& command);

  /// From now on every Grasp is one of this point (m, reference), wherever the client has seen it.
  void hold_only_at(const Vec3& point) { only_point_ = point; }

  /// One step of the physics: take the hand's motion, follow the script, move the body by the hand and let it tear
  /// once, publish. While it tears the hand counts as standing still: so each advance has a law and a step of its own,
  /// and the cracks are those of one long tick. `fresh`: `hand` is another one than that of the last step.
  StepOutcome step(const haptics::HandState& hand, bool fresh);

  /// The law to publish after the last step.
  [[nodiscard]] const response::ForceSnapshot& law() const { return law_; }
  [[nodiscard]] const ScriptedPull& orders() const { return script_.orders(); }

  [[nodiscard]] const OpenBody& body() const { return *body_; }
  [[nodiscard]] TearSession& tear() const { return body_->tear(); }
  [[nodiscard]] bool is_paused() const { return paused_; }
  [[nodiscard]] bool is_scripted() const { return script_.is_on(); }
  [[nodiscard]] std::uint64_t tick() const { return now_; }  ///< of the haptic loop, at the last step
  /// m, of the hand from where it took hold, as the body was last moved by it.
  [[nodiscard]] const Vec3& hand() const { return by_; }

 private:
  void grasp(const wire::GraspT& command);
  bool hold(const Vec3& at, response::ContactMode mode);
  void let_go();
  void follow_script(std::uint64_t passed);
  void move_body();
  void tell_of(const AdvanceRecord& advance);
  void publish();
  void open(SceneChoice choice);
  void take_up(Expected<std::unique_ptr<OpenBody>> body);
  void set_value(const wire::SetValueT& command);
  void undo();
  void compare();
  void watch_record();
  [[nodiscard]] bool runs() const { return !paused_ || now_ < run_until_; }
  void say(const Error& error) { listener_.says(wire::Level::error, error.message()); }

  std::unique_ptr<OpenBody> body_;
  ReadScene read_scene_;
  InteractionListener& listener_;
  Script script_;
  response::ForceSnapshot law_;

  std::optional<Vec3> only_point_;  ///< m
  std::uint64_t steps_ = 0;
  std::uint64_t now_ = 0;        ///< tick of the haptic loop
  std::uint64_t run_until_ = 0;  ///< while paused: the clock runs until this tick
  bool paused_ = false;
  std::uint32_t grasps_ = 0;   ///< the number of the present hold, or of the last
  bool torn_off_ = false;      ///< the last hold ended by tearing
  Vec3 start_ = Vec3::Zero();  ///< m, displacement of the point when it was taken hold of
  Vec3 by_ = Vec3::Zero();
  bool settled_ = false;      ///< another tick at the same place of the hand would change nothing
  std::string last_trouble_;  ///< said already
  bool compares_ = false;     ///< asked for, with every body
  response::RecordUse said_;  ///< of the record, since the body was opened
  int advances_ = 0;          ///< in the present step
  int tearing_ = 0;           ///< steps that have torn since the hand was followed last
};

}  // namespace rhexis::session
