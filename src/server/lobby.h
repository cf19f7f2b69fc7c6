#pragma once

/// Who is there, who has the hand, and what each has to hear. Knows no network, and no threads: all calls come from
/// one.

#include <memory>
#include <vector>

#include "session/frame_sink.h"
#include "wire/frame.h"

namespace rhexis::server {

/// One client, as the lobby sees it.
class Viewer {
 public:
  virtual ~Viewer() = default;
  /// Must not come back into the lobby.
  virtual void send(const wire::SharedMessage& message) = 0;
};

/// The first who comes has the hand. Later ones ask for it: they get it when it is given back or its client is gone, in
/// the order of their asking. Who loses the hand lets the body go.
class Lobby {
 public:
  /// `target` outlives the lobby.
  explicit Lobby(session::CommandTarget& target) : target_(target) {}

  /// Sends what a client has to know: Hello, Role, the last Body, all Edits since, where a replay is, the last State.
  void join(Viewer& viewer);
  /// Does nothing for one who is not there.
  void leave(Viewer& viewer);
  /// A frame of the interaction, for everybody.
  void take(const wire::SharedMessage& message);
  /// What a client says, as read_client_frame() let it pass. Carried out, or answered with a Notice.
  void hear(Viewer& viewer, wire::PayloadUnion said);

  [[nodiscard]] std::size_t size() const { return guests_.size(); }

 private:
  void ask_for_hand(Viewer& viewer);
  void give_hand(Viewer& viewer);
  void free_hand();
  void send_role(Viewer& viewer) const;
  void send_roles() const;

  session::CommandTarget& target_;
  std::vector<Viewer*> guests_;  ///< in the order of their coming
  Viewer* hand_ = nullptr;
  std::vector<Viewer*> askers_;            ///< for the hand, in the order of their asking
  std::vector<wire::SharedMessage> body_;  ///< the last Body and all Edits since
  wire::SharedMessage timeline_;           ///< the last, null before there is one
  wire::SharedMessage trial_;              ///< null: no experiment
  wire::SharedMessage state_;              ///< the last, null where it is of another topology than the last of body_
};

}  // namespace rhexis::server
