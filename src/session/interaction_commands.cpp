// What clients may ask of an interaction.

#include <algorithm>

#include "session/interaction.h"
#include "session/scene_record.h"

namespace rhexis::session {
namespace {

/// What goes before the first '='.
std::string key_of(const std::string& override) { return override.substr(0, override.find('=')); }

bool is_point(const wire::Vec3& weights) {
  const Vec3 w(weights.x(), weights.y(), weights.z());
  return w.allFinite() && w.minCoeff() >= 0.0 && w.sum() > 0.0 && w.sum() < 1e6;
}

}  // namespace

void Interaction::carry_out(const wire::PayloadUnion& command) {
  switch (command.type) {
    case wire::Payload::Grasp: grasp(*command.AsGrasp()); break;
    case wire::Payload::LetGo:
      script_.end();
      let_go();
      break;
    case wire::Payload::Reset: take_up(reopen(*body_)); break;
    case wire::Payload::Undo: undo(); break;
    case wire::Payload::Pause:
      paused_ = command.AsPause()->on;
      run_until_ = now_;
      break;
    case wire::Payload::Step:
      if (paused_) run_until_ = std::max(run_until_, now_) + command.AsStep()->ticks;
      break;
    case wire::Payload::Script:
      let_go();
      script_.end();
      if (!command.AsScript()->on) break;
      if (body_->problem.pulls.empty()) listener_.says(wire::Level::info, "the scene has no [[pull]]");
      if (!body_->problem.pulls.empty()) script_.begin();
      break;
    case wire::Payload::SetValue: set_value(*command.AsSetValue()); break;
    case wire::Payload::Compare:
      compares_ = command.AsCompare()->on;
      compare();
      break;
    case wire::Payload::OpenScene: {
      Expected<SceneChoice> choice = read_scene_(command.AsOpenScene()->file);
      if (!choice) return say(choice.error());
      open(std::move(*choice));
      break;
    }
    default: break;
  }
}

/// Where the client has seen the point: the surface may have torn since, and then the nearest point is held.
void Interaction::grasp(const wire::GraspT& command) {
  if (only_point_) {
    hold(*only_point_, response::ContactMode::hold);
    return;
  }
  const SurfaceTracker& surface = body_->surface;
  if (command.face >= surface.faces().size() || surface.is_empty(command.face) || !command.weights ||
      !is_point(*command.weights)) {
    listener_.says(wire::Level::info, "there is no surface any more where the hand took hold");
    return;
  }
  const mesh::TetFace face = surface.face(command.face);
  if (!tear().body().is_solved(face.tet)) {
    listener_.says(wire::Level::info, "that piece has no support: it cannot be held");
    return;
  }
  script_.end();
  const std::array<NodeId, 3> corner = mesh::face_nodes(tear().body().mesh(), face);
  Vec3 weight(command.weights->x(), command.weights->y(), command.weights->z());
  weight /= weight.sum();
  Vec3 at = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) at += weight[static_cast<Eigen::Index>(k)] * tear().body().mesh().node(corner[k]);
  hold(at, command.push ? response::ContactMode::push : response::ContactMode::hold);
}

/// The hand lets go first: where it is, the body would tear again at once.
void Interaction::undo() {
  if (tear().body().topology() <= body_->first_topology) {
    listener_.says(wire::Level::info, "there is no tear to take back");
    return;
  }
  script_.end();
  let_go();
  const mesh::MeshEdit edit = tear().body().history().back();
  tear().undo();
  body_->surface = SurfaceTracker(tear().body());
  body_->fingerprint = chained(body_->fingerprint, edit, /*taken_back=*/true);
  body_->advance_time.pop_back();
  listener_.has_body(/*anew=*/false);
}

/// Beside a recorded response the exact one, and beside the exact one that of the record which the scene names.
void Interaction::compare() {
  tear().stop_comparing();
  if (!compares_) return;
  if (!tear().is_linear()) {
    compares_ = false;
    listener_.says(wire::Level::info,
                   "a record is of a body of small strains: only model \"linear\" is held against one");
    return;
  }
  const scene::TearProblem& problem = body_->problem;
  response::SharedRecord record;
  if (!body_->start.record) {
    Expected<response::SharedRecord> read = load_record(problem);
    if (!read) {
      compares_ = false;
      return say(read.error());
    }
    record = std::move(*read);
  }
  compares_ = tear().compare(record);
  if (!compares_)
    listener_.says(wire::Level::warning, "the exact response has no answer: a part of the torn body can move freely");
}

/// A key that was set before is set again in its place.
void Interaction::set_value(const wire::SetValueT& command) {
  SceneChoice choice = body_->scene;
  const std::string override = command.key + '=' + command.value;
  const auto same = std::find_if(choice.overrides.begin(), choice.overrides.end(),
                                 [&](const std::string& other) { return key_of(other) == command.key; });
  if (same != choice.overrides.end()) {
    *same = override;
  } else {
    choice.overrides.push_back(override);
  }
  open(std::move(choice));
}

void Interaction::open(SceneChoice choice) { take_up(open_body(std::move(choice))); }

void Interaction::take_up(Expected<std::unique_ptr<OpenBody>> body) {
  if (!body) return say(body.error());
  script_.end();
  body_ = std::move(*body);
  torn_off_ = false;
  by_.setZero();
  settled_ = false;
  tearing_ = 0;
  last_trouble_.clear();
  said_ = {};
  compare();
  listener_.has_body(/*anew=*/true);
}

}  // namespace rhexis::session
