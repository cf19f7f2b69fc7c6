// How a live session goes through a task: its commands, the hand bound, its law in place of the body's.

#include "session/live_task.h"
#include "session/live_session.h"

namespace rhexis::session {
namespace {

Vec3 vector_of(const wire::Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

void LiveSession::carry_out_of_task(const wire::PayloadUnion& command) {
  switch (command.type) {
    case wire::Payload::LetGo: interaction_->carry_out(command); break;
    case wire::Payload::Grasp:
      if (!is_bound_) {
        says(wire::Level::info, "the hand is still letting go of what it held: take hold again");
        break;
      }
      interaction_->carry_out(command);
      if (!interaction_->tear().hand().holds()) break;
      settings_.task->has_hold();
      send_trial();
      break;
    case wire::Payload::Feel:
    case wire::Payload::Answer: {
      wire::PayloadUnion let_go;
      let_go.Set(wire::LetGoT{});
      interaction_->carry_out(let_go);
      opened_ = true;  // another plate may have to be torn
      is_bound_ = false;
      if (const Expected<void> done = settings_.task->carry_out(command); !done)
        says(wire::Level::warning, done.error().message());
      break;
    }
    default: says(wire::Level::info, "that is not for an experiment");
  }
}

/// Once nothing is felt any more of what the hand held: else its place along another direction would jump.
void LiveSession::bind_hand() {
  const bool rests = (hand_.flags & haptics::HandState::holds) == 0 && hand_.force == std::array<double, 3>{};
  if (is_bound_ || !rests) return;
  const wire::TrialT trial = settings_.task->show();
  interaction_->hold_only_at(vector_of(*trial.point));
  loop_->device.bind(vector_of(*trial.direction));
  is_bound_ = true;
  send_trial();
}

void LiveSession::send_trial() {
  wire::TrialT trial = settings_.task->show();
  trial.shows_force = holder_.device->traits().max_force <= 0.0;
  send(wire::encode(std::move(trial)));
}

response::ForceSnapshot LiveSession::felt_law() const {
  response::ForceSnapshot law = interaction_->law();
  if (settings_.task == nullptr || (law.flags & response::ForceSnapshot::is_held) == 0) return law;
  const response::ContactLaw& felt = settings_.task->felt();
  for (std::size_t k = 0; k < 9; ++k)
    law.stiffness[k] = felt.stiffness(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3));
  for (std::size_t k = 0; k < 3; ++k) law.rest[k] = law.start[k] = felt.rest[static_cast<Eigen::Index>(k)];
  return law;
}

}  // namespace rhexis::session
