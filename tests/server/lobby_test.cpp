#include "server/lobby.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/served.h"

namespace rhexis::server {
namespace {

using testing::ElementsAre;
using wire::Payload;

class Seat : public Viewer {
 public:
  void send(const wire::SharedMessage& message) override { heard.push_back(message); }
  [[nodiscard]] std::vector<Payload> kinds() const {
    std::vector<Payload> out;
    for (const wire::SharedMessage& message : heard) out.push_back(message->kind);
    return out;
  }
  /// What the last Role says.
  [[nodiscard]] wire::RoleT role() const {
    wire::RoleT role;
    for (const wire::SharedMessage& message : heard)
      if (message->kind == Payload::Role) role = *(*wire::decode(message->bytes))->payload.AsRole();
    return role;
  }

  std::vector<wire::SharedMessage> heard;
};

template <typename PayloadT>
wire::PayloadUnion said(PayloadT payload) {
  wire::PayloadUnion out;
  out.Set(std::move(payload));
  return out;
}

struct LobbyCase : testing::Test {
  test::Listener target;
  Lobby lobby{target};
  Seat a;
  Seat b;
  Seat c;
};

TEST_F(LobbyCase, WhoComesInTheMiddleHearsTheLastBodyAndAllEditsSinceThenTheState) {
  lobby.take(wire::encode(wire::BodyT{}));
  lobby.take(wire::encode(wire::EditT{}));
  const wire::SharedMessage body = wire::encode(wire::BodyT{});
  const wire::SharedMessage edit = wire::encode(wire::EditT{});
  const wire::SharedMessage other_edit = wire::encode(wire::EditT{});
  const wire::SharedMessage state = wire::encode(wire::StateT{});
  for (const wire::SharedMessage& message : {body, edit, wire::encode(wire::StateT{}), other_edit, state, state})
    lobby.take(message);
  lobby.join(a);
  EXPECT_THAT(a.kinds(),
              ElementsAre(Payload::Hello, Payload::Role, Payload::Body, Payload::Edit, Payload::Edit, Payload::State));
  EXPECT_THAT(std::vector(a.heard.begin() + 2, a.heard.end()), ElementsAre(body, edit, other_edit, state));
  lobby.take(wire::encode(wire::EditT{}));
  lobby.join(b);
  EXPECT_EQ(b.kinds().back(), Payload::Edit) << "the state that was of an older topology is of no use";
}

TEST_F(LobbyCase, WhoComesHearsOfTheTrialThatIsOn) {
  lobby.take(wire::encode(wire::BodyT{}));
  lobby.take(wire::encode(wire::TrialT{}));
  wire::TrialT second;
  second.number = 2;
  lobby.take(wire::encode(second));
  lobby.join(a);
  ASSERT_EQ(a.kinds().back(), Payload::Trial);
  EXPECT_EQ((*wire::decode(a.heard.back()->bytes))->payload.AsTrial()->number, 2U);
}

TEST_F(LobbyCase, TheFirstHasTheHandAndItsCommandsAloneAreCarriedOut) {
  lobby.join(a);
  lobby.join(b);
  EXPECT_TRUE(a.role().hand);
  EXPECT_FALSE(b.role().hand);
  EXPECT_TRUE(b.role().hand_taken);
  EXPECT_EQ(a.role().clients, 2U);
  lobby.hear(a, said(wire::ResetT{}));
  lobby.hear(b, said(wire::UndoT{}));
  EXPECT_THAT(target.posted(), ElementsAre(Payload::Reset));
  EXPECT_EQ(b.kinds().back(), Payload::Notice);
  const std::size_t before = b.heard.size();
  lobby.hear(b, said(wire::MoveT{}));
  EXPECT_EQ(b.heard.size(), before) << "a thousand moves a second are not answered one by one";
  EXPECT_EQ(target.posted().size(), 1U);
}

TEST_F(LobbyCase, TheHandGoesToWhoAskedFirstWhenItIsGivenBack) {
  for (Seat* seat : {&a, &b, &c}) lobby.join(*seat);
  lobby.hear(c, said(wire::TakeHandT{}));
  lobby.hear(b, said(wire::TakeHandT{}));
  EXPECT_EQ(c.kinds().back(), Payload::Notice);
  EXPECT_TRUE(a.role().hand) << "it is not taken away";
  lobby.hear(a, said(wire::GiveHandT{}));
  EXPECT_THAT(target.posted(), ElementsAre(Payload::LetGo));
  EXPECT_TRUE(c.role().hand);
  EXPECT_FALSE(a.role().hand);
  lobby.hear(b, said(wire::GiveHandT{}));  // does not want it any more
  lobby.hear(c, said(wire::GiveHandT{}));
  for (const Seat* seat : {&a, &b, &c}) {
    EXPECT_FALSE(seat->role().hand);
    EXPECT_FALSE(seat->role().hand_taken);
  }
  lobby.hear(a, said(wire::ResetT{}));
  EXPECT_EQ(a.kinds().back(), Payload::Notice);
  lobby.hear(b, said(wire::TakeHandT{}));
  EXPECT_TRUE(b.role().hand);
}

TEST_F(LobbyCase, WhoGoesFreesTheHandAndTheBody) {
  lobby.join(a);
  lobby.join(b);
  lobby.hear(b, said(wire::TakeHandT{}));
  lobby.leave(a);
  lobby.leave(a);
  EXPECT_THAT(target.posted(), ElementsAre(Payload::LetGo));
  EXPECT_TRUE(b.role().hand);
  EXPECT_EQ(b.role().clients, 1U);
  lobby.leave(b);
  lobby.join(c);
  EXPECT_TRUE(c.role().hand) << "alone again, so the first";
}

TEST_F(LobbyCase, WhoAskedAndWentDoesNotGetTheHand) {
  for (Seat* seat : {&a, &b, &c}) lobby.join(*seat);
  lobby.hear(b, said(wire::TakeHandT{}));
  lobby.leave(b);
  lobby.hear(a, said(wire::GiveHandT{}));
  EXPECT_FALSE(c.role().hand_taken);
}

TEST_F(LobbyCase, APingIsAnsweredByItsNumberWhoeverHasTheHand) {
  lobby.join(a);
  lobby.join(b);
  wire::PingT ping;
  ping.number = 77;
  lobby.hear(b, said(std::move(ping)));
  EXPECT_EQ((*wire::decode(b.heard.back()->bytes))->payload.AsPong()->number, 77U);
  EXPECT_TRUE(target.posted().empty());
}

}  // namespace
}  // namespace rhexis::server
