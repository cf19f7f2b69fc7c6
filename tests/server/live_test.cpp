// The interaction as its clients hear it.

#include <gtest/gtest.h>

#include <thread>

#include "tests/server/live_socket.h"
#include "tests/server/served.h"

namespace rhexis {
namespace {

using test::LiveSocket;
using test::milliseconds;
using wire::Payload;

wire::SharedMessage edit(std::uint32_t topology, std::size_t numbers = 0) {
  wire::EditT frame;
  frame.topology = topology;
  frame.moved_to.resize(numbers);
  return wire::encode(std::move(frame));
}
wire::SharedMessage state(std::uint64_t tick, std::size_t numbers = 0) {
  wire::StateT frame;
  frame.tick = tick;
  frame.displacement.resize(numbers);
  return wire::encode(std::move(frame));
}

TEST(Live, AClientIsGreetedThenFollows) {
  test::Served served("greeted");
  served.server->take(wire::encode(wire::BodyT{}));
  served.server->take(edit(1));
  LiveSocket client(served.port);
  ASSERT_EQ(client.shake_hands(), 101);
  EXPECT_EQ(client.hear()->payload.AsHello()->version, "test");
  EXPECT_TRUE(client.hear()->payload.AsRole()->hand);
  EXPECT_EQ(client.hear()->payload.type, Payload::Body);
  EXPECT_EQ(client.hear()->payload.AsEdit()->topology, 1U);
  served.server->take(state(5));
  EXPECT_EQ(client.hear()->payload.AsState()->tick, 5U);
  client.say(wire::ResetT{});
  EXPECT_TRUE(served.target.gets(Payload::Reset));
}

TEST(Live, TwoViewersHaveOneHandThatIsFreeWhenItsClientIsGone) {
  test::Served served("hand");
  auto first = std::make_unique<LiveSocket>(served.port);
  ASSERT_EQ(first->shake_hands(), 101);
  EXPECT_TRUE(first->hear(Payload::Role)->payload.AsRole()->hand);
  LiveSocket second(served.port);
  ASSERT_EQ(second.shake_hands(), 101);
  EXPECT_FALSE(second.hear(Payload::Role)->payload.AsRole()->hand);
  second.say(wire::ResetT{});
  EXPECT_NE(second.hear(Payload::Notice), nullptr);
  first.reset();  // its connection is gone, without a word
  const auto role = second.hear(Payload::Role);
  ASSERT_NE(role, nullptr);
  EXPECT_FALSE(role->payload.AsRole()->hand_taken);
  EXPECT_EQ(role->payload.AsRole()->clients, 1U);
  second.say(wire::TakeHandT{});
  EXPECT_TRUE(second.hear(Payload::Role)->payload.AsRole()->hand);
  second.say(wire::ResetT{});
  EXPECT_TRUE(served.target.gets(Payload::Reset));
  EXPECT_EQ(served.target.posted(), (std::vector{Payload::LetGo, Payload::Reset}));
}

TEST(Live, AClientThatIsSilentIsAskedAndThenTakenForDead) {
  test::Served served("silent", [](server::ServerSettings& settings) { settings.limits.silence = milliseconds(400); });
  LiveSocket dead(served.port);
  ASSERT_EQ(dead.shake_hands(), 101);
  LiveSocket alive(served.port);
  ASSERT_EQ(alive.shake_hands(), 101);
  EXPECT_FALSE(alive.hear(Payload::Role)->payload.AsRole()->hand);
  alive.say(wire::TakeHandT{});
  // It answers pings while it waits; the other one keeps its connection and says nothing.
  auto role = alive.hear(Payload::Role, milliseconds(2000));
  while (role != nullptr && !role->payload.AsRole()->hand) role = alive.hear(Payload::Role, milliseconds(2000));
  ASSERT_NE(role, nullptr);
  EXPECT_TRUE(served.target.gets(Payload::LetGo));
  alive.say(wire::PingT{});
  EXPECT_NE(alive.hear(Payload::Pong), nullptr);
}

TEST(Live, ASlowClientMissesStatesButNoEdit) {
  test::Served served("slow");
  LiveSocket slow(served.port, 4096);
  ASSERT_EQ(slow.shake_hands(), 101);
  LiveSocket quick(served.port);
  ASSERT_EQ(quick.shake_hands(), 101);
  std::thread sender([&] {
    for (std::uint32_t k = 1; k <= 200; ++k) {
      for (std::uint32_t part = 0; part < 5; ++part) served.server->take(state(10 * k + part, 20000));
      served.server->take(edit(k, 1000));
      std::this_thread::sleep_for(milliseconds(1));
    }
    served.server->take(state(1'000'000, 20000));
  });
  const auto follow = [&](LiveSocket& client, milliseconds rest) {
    std::uint32_t topology = 0;
    int states = 0;
    std::uint64_t tick = 0;
    while (tick < 1'000'000) {
      const auto frame = client.hear();
      if (frame == nullptr) break;
      if (const wire::EditT* next = frame->payload.AsEdit()) {
        EXPECT_EQ(next->topology, topology + 1);
        topology = next->topology;
      }
      if (const wire::StateT* next = frame->payload.AsState()) {
        EXPECT_GT(next->tick, tick);
        if (next->tick < 1'000'000) {
          EXPECT_EQ(next->tick / 10, topology + 1) << "a state of another topology than the last edit's";
        }
        tick = next->tick;
        ++states;
      }
      std::this_thread::sleep_for(rest);
    }
    EXPECT_EQ(topology, 200U);
    EXPECT_EQ(tick, 1'000'000U) << "the newest state is missing: " << client.close_reason;
    return states;
  };
  int quick_states = 0;
  std::thread quick_reader([&] { quick_states = follow(quick, milliseconds(0)); });
  std::this_thread::sleep_for(milliseconds(300));
  const int slow_states = follow(slow, milliseconds(3));
  sender.join();
  quick_reader.join();
  EXPECT_LT(slow_states, 500) << "of 1001";
  EXPECT_GT(quick_states, slow_states);
}

TEST(Live, WhoCannotFollowAtAllIsSentAwayAndTheOthersDoNotNotice) {
  test::Served served("stuck", [](server::ServerSettings& settings) {
    settings.limits.waiting_bytes = 1'000'000;
    settings.limits.close_time = milliseconds(200);
  });
  LiveSocket stuck(served.port, 4096);
  ASSERT_EQ(stuck.shake_hands(), 101);
  LiveSocket well(served.port);
  ASSERT_EQ(well.shake_hands(), 101);
  for (std::uint32_t k = 1; k <= 300; ++k) {
    served.server->take(edit(k, 10000));
    const auto frame = well.hear(Payload::Edit);
    ASSERT_NE(frame, nullptr);
    ASSERT_EQ(frame->payload.AsEdit()->topology, k);
  }
  EXPECT_TRUE(served.target.gets(Payload::LetGo)) << "it had the hand";
  EXPECT_TRUE(stuck.socket().ends_within(milliseconds(3000)));
}

TEST(Live, WhoIsSentAwayHearsWhy) {
  test::Served served("reason", [](server::ServerSettings& settings) { settings.limits.waiting_frames = 20; });
  LiveSocket client(served.port);
  ASSERT_EQ(client.shake_hands(), 101);
  ASSERT_NE(client.hear(Payload::Role), nullptr);
  for (std::uint32_t k = 1; k <= 2000 && client.close_code == 0; ++k) served.server->take(edit(k, 1000));
  EXPECT_EQ(client.hear_the_end(), 1013);
  EXPECT_TRUE(client.close_reason.starts_with("too slow")) << client.close_reason;
}

TEST(Live, StopTellsEverybodyAndReturns) {
  test::Served served("stop");
  LiveSocket client(served.port);
  ASSERT_EQ(client.shake_hands(), 101);
  LiveSocket mute(served.port);
  ASSERT_EQ(mute.shake_hands(), 101);
  test::Socket idle(served.port);
  std::thread reader([&] { EXPECT_EQ(client.hear_the_end(), 1001); });
  const auto start = std::chrono::steady_clock::now();
  served.server->stop();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  reader.join();
  EXPECT_TRUE(idle.ends_within(milliseconds(1000)));
  served.server->take(state(1));
  served.server->stop();
  EXPECT_FALSE(test::Socket(served.port).connected());
}

TEST(Live, AServerThatNeverStartedEndsToo) {
  test::Listener target;
  const std::filesystem::path folder = test::fresh_folder("never");
  std::ofstream(folder / "index.html") << "x";
  server::ServerSettings settings;
  settings.port = 0;
  settings.page = folder;
  auto made = server::Server::listen(settings, target);
  ASSERT_TRUE(made.has_value());
  (*made)->take(edit(1));
  (*made)->stop();
}

}  // namespace
}  // namespace rhexis
