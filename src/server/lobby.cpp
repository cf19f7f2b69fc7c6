#include "server/lobby.h"

#include <algorithm>
#include <string>
#include <utility>

#include "server/client_frame.h"

namespace rhexis::server {
namespace {

wire::SharedMessage notice(wire::Level level, const std::string& text) {
  wire::NoticeT notice;
  notice.level = level;
  notice.text = text;
  return wire::encode(std::move(notice));
}

}  // namespace

void Lobby::join(Viewer& viewer) {
  guests_.push_back(&viewer);
  if (guests_.size() == 1) hand_ = &viewer;
  viewer.send(target_.hello());
  send_roles();
  for (const wire::SharedMessage& message : body_) viewer.send(message);
  if (timeline_ != nullptr) viewer.send(timeline_);
  if (trial_ != nullptr) viewer.send(trial_);
  if (state_ != nullptr) viewer.send(state_);
}

void Lobby::leave(Viewer& viewer) {
  if (std::erase(guests_, &viewer) == 0) return;
  std::erase(askers_, &viewer);
  if (hand_ == &viewer) free_hand();
  send_roles();
}

void Lobby::take(const wire::SharedMessage& message) {
  switch (message->kind) {
    case wire::Payload::Body:
      body_.assign(1, message);
      state_ = nullptr;
      break;
    case wire::Payload::Edit:
      body_.push_back(message);
      state_ = nullptr;
      break;
    case wire::Payload::Timeline: timeline_ = message; break;
    case wire::Payload::Trial: trial_ = message; break;
    case wire::Payload::State: state_ = message; break;
    default: break;
  }
  for (Viewer* guest : guests_) guest->send(message);
}

void Lobby::hear(Viewer& viewer, wire::PayloadUnion said) {
  if (said.type == wire::Payload::TakeHand) return ask_for_hand(viewer);
  if (said.type == wire::Payload::GiveHand) return give_hand(viewer);
  if (said.type == wire::Payload::Ping) {
    wire::PongT pong;
    pong.number = said.AsPing()->number;
    return viewer.send(wire::encode(std::move(pong)));
  }
  if (hand_ == &viewer) return target_.post(std::move(said));
  // What follows on a Grasp that was refused needs no answer of its own, a thousand times a second.
  if (said.type == wire::Payload::Move || said.type == wire::Payload::LetGo) return;
  viewer.send(notice(wire::Level::warning, hand_ == nullptr
                                               ? "nobody has the hand: take it to hold the body or change anything"
                                               : "somebody else has the hand: ask for it to change anything"));
}

void Lobby::ask_for_hand(Viewer& viewer) {
  if (hand_ == nullptr) hand_ = &viewer;
  if (hand_ == &viewer) return send_roles();
  if (std::find(askers_.begin(), askers_.end(), &viewer) == askers_.end()) askers_.push_back(&viewer);
  send_role(viewer);
  viewer.send(notice(wire::Level::info, "somebody else has the hand: it is yours when it is given back"));
}

void Lobby::give_hand(Viewer& viewer) {
  std::erase(askers_, &viewer);
  if (hand_ == &viewer) free_hand();
  send_roles();
}

void Lobby::free_hand() {
  hand_ = nullptr;
  wire::PayloadUnion let_go;
  let_go.Set(wire::LetGoT{});
  target_.post(std::move(let_go));
  if (askers_.empty()) return;
  hand_ = askers_.front();
  askers_.erase(askers_.begin());
}

void Lobby::send_role(Viewer& viewer) const {
  wire::RoleT role;
  role.hand = hand_ == &viewer;
  role.hand_taken = hand_ != nullptr;
  role.clients = static_cast<std::uint32_t>(guests_.size());
  viewer.send(wire::encode(std::move(role)));
}

void Lobby::send_roles() const {
  for (Viewer* guest : guests_) send_role(*guest);
}

}  // namespace rhexis::server
