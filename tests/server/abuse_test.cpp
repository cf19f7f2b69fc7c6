// Those who mean no good: the server stays up, and who behaves does not notice.

#include <gtest/gtest.h>

#include <random>
#include <thread>

#include "tests/server/live_socket.h"
#include "tests/server/served.h"

namespace rhexis {
namespace {

using test::LiveSocket;
using test::milliseconds;
using wire::Payload;

/// Somebody who behaves is still served.
void expect_well(const test::Served& served) {
  LiveSocket client(served.port);
  ASSERT_EQ(client.shake_hands(), 101);
  wire::PingT ping;
  ping.number = 42;
  ASSERT_TRUE(client.say(std::move(ping)));
  const auto pong = client.hear(Payload::Pong);
  ASSERT_NE(pong, nullptr);
  EXPECT_EQ(pong->payload.AsPong()->number, 42U);
}

std::vector<test::Socket::Bytes> honest_frames() {
  wire::GraspT grasp;
  grasp.face = 3;
  grasp.weights = std::make_unique<wire::Vec3>(0.2, 0.3, 0.5);
  wire::SetValueT set;
  set.key = "material.young";
  set.value = "1e6";
  wire::OpenSceneT open;
  open.file = "plate.toml";
  return {wire::encode(std::move(grasp))->bytes, wire::encode(std::move(set))->bytes,
          wire::encode(std::move(open))->bytes, wire::encode(wire::PingT{})->bytes};
}

TEST(Abuse, GarbledFramesEndTheirConnectionAndNothingElse) {
  test::Served served("garbled");
  std::mt19937_64 random(11);
  const std::vector<test::Socket::Bytes> honest = honest_frames();
  auto client = std::make_unique<LiveSocket>(served.port);
  ASSERT_EQ(client->shake_hands(), 101);
  int refused = 0;
  int passed = 0;
  for (int k = 0; k < 4000; ++k) {
    test::Socket::Bytes bytes = honest[random() % honest.size()];
    if (k % 8 == 0) {
      bytes.resize(random() % 200);
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    } else {
      for (std::uint64_t n = random() % 3; n > 0; --n)
        bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
      if (random() % 10 == 0) bytes.resize(random() % bytes.size());
    }
    wire::PingT ping;
    ping.number = static_cast<std::uint64_t>(k) << 20;
    const std::uint64_t number = ping.number;
    if (client->send(2, bytes)) client->say(std::move(ping));
    auto pong = client->hear(Payload::Pong);
    while (pong != nullptr && pong->payload.AsPong()->number != number) pong = client->hear(Payload::Pong);
    if (pong != nullptr) {
      ++passed;
      continue;
    }
    EXPECT_TRUE(client->close_code == 1007 || client->close_code == 0) << client->close_code;
    ++refused;
    client = std::make_unique<LiveSocket>(served.port);
    ASSERT_EQ(client->shake_hands(), 101);
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(passed, 100);
  expect_well(served);
}

TEST(Abuse, GarbledWebSocketsAndRequestsToo) {
  test::Served served("noise");
  std::mt19937_64 random(12);
  for (int k = 0; k < 300; ++k) {
    LiveSocket client(served.port);
    if (k % 2 == 0) {
      ASSERT_EQ(client.shake_hands(), 101);
    }
    test::Socket::Bytes noise(random() % 400);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    client.socket().send(noise);
  }
  for (const char* request :
       {"\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "GET / HTTP/1.1\r\n\r\n", "\x16\x03\x01\x02\x00\x01",
        "GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: upgrade\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n"}) {
    test::Socket socket(served.port);
    socket.send(std::string(request));
    const std::string answer = socket.receive_all(milliseconds(100));
    EXPECT_NE(test::status_of(answer), 200) << request;
    EXPECT_NE(test::status_of(answer), 101) << request;
  }
  expect_well(served);
}

TEST(Abuse, OversizedAndTextFramesAreRefusedWithTheirCode) {
  test::Served served("oversized");
  const auto code_for = [&](int kind, std::size_t size) {
    LiveSocket client(served.port);
    EXPECT_EQ(client.shake_hands(), 101);
    client.send(kind, test::Socket::Bytes(size));
    return client.hear_the_end();
  };
  EXPECT_EQ(code_for(2, 64 * 1024 + 1), 1009);
  EXPECT_EQ(code_for(1, 10), 1003);
  EXPECT_EQ(code_for(2, 64 * 1024), 1007) << "not too large, but no frame";
  // A size of 2^63 announced, in pieces without end, or a message whose end never comes: refused when it is too much.
  LiveSocket liar(served.port);
  ASSERT_EQ(liar.shake_hands(), 101);
  liar.socket().send(test::Socket::Bytes{0x82, 0xff, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1, 2, 3, 4});
  EXPECT_EQ(liar.hear_the_end(), 1009);
  LiveSocket endless(served.port);
  ASSERT_EQ(endless.shake_hands(), 101);
  for (int k = 0; k < 20; ++k) endless.send(k == 0 ? 2 : 0, test::Socket::Bytes(10000), false);
  endless.hear_the_end();
  EXPECT_TRUE(endless.close_code == 1009 || endless.socket().ends_within(milliseconds(1000)));
  expect_well(served);
}

TEST(Abuse, HalfOpenConnectionsAreDroppedInTime) {
  test::Served served("half-open", [](server::ServerSettings& settings) {
    settings.limits.request_time = milliseconds(300);
    settings.limits.handshake_time = milliseconds(300);
  });
  std::vector<test::Socket> sockets;
  for (int k = 0; k < 30; ++k) {
    sockets.emplace_back(served.port);
    if (k % 3 == 1) sockets.back().send(std::string("GET / HTT"));
    if (k % 3 == 2) sockets.back().send(std::string("GET / HTTP/1.1\r\nHost: localhost\r\nX: "));
  }
  for (test::Socket& socket : sockets) EXPECT_TRUE(socket.ends_within(milliseconds(2000)));
  expect_well(served);
}

TEST(Abuse, MoreConnectionsThanTheBoundAreClosedAndThoseThereGoOn) {
  test::Served served("crowd", [](server::ServerSettings& settings) {
    settings.limits.connections = 20;
    settings.limits.clients = 3;
  });
  LiveSocket first(served.port);
  ASSERT_EQ(first.shake_hands(), 101);
  ASSERT_NE(first.hear(Payload::Hello), nullptr);
  {
    std::vector<test::Socket> crowd;
    for (int k = 0; k < 200; ++k) crowd.emplace_back(served.port);
    int closed = 0;
    for (test::Socket& socket : crowd) closed += socket.ends_within(milliseconds(20)) ? 1 : 0;
    EXPECT_GE(closed, 180);
    EXPECT_LT(closed, 200);
    first.say(wire::PingT{});
    EXPECT_NE(first.hear(Payload::Pong), nullptr);
  }
  std::this_thread::sleep_for(milliseconds(100));
  std::vector<std::unique_ptr<LiveSocket>> clients;
  for (int k = 0; k < 3; ++k) {
    clients.push_back(std::make_unique<LiveSocket>(served.port));
    ASSERT_EQ(clients.back()->shake_hands(), 101) << k;
  }
  EXPECT_NE(clients[1]->hear(Payload::Hello), nullptr);
  EXPECT_EQ(clients[2]->hear_the_end(), 1013) << "the fourth of three";
}

TEST(Abuse, AThousandConnectsInARowAndAtOnce) {
  test::Served served("thousand");
  for (int k = 0; k < 1000; ++k) {
    test::Socket socket(served.port);
    ASSERT_TRUE(socket.connected()) << k;
    if (k % 4 == 1) socket.send(std::string("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"));
    if (k % 4 == 2) socket.send(std::string("GET /li"));
  }
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int k = 0; k < 125; ++k) {
        LiveSocket client(served.port);
        if (k % 2 == 0) client.shake_hands();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::this_thread::sleep_for(milliseconds(100));
  expect_well(served);
}

TEST(Abuse, WhoTalksWithoutEndIsListenedToSlowlyAndKeepsNobodyWaiting) {
  test::Served served("talker", [](server::ServerSettings& settings) {
    settings.limits.frames_per_second = 200.0;
    settings.limits.frames_at_once = 100.0;
  });
  LiveSocket talker(served.port);
  ASSERT_EQ(talker.shake_hands(), 101);
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < 300; ++k) talker.say(wire::ResetT{});
  expect_well(served);
  EXPECT_LT(served.target.posted().size(), 290U);
  EXPECT_TRUE(served.target.gets(Payload::Reset, 300)) << "none is lost";
  // 300 - 100 at 200 a second.
  EXPECT_GT(std::chrono::steady_clock::now() - start, milliseconds(900));
}

}  // namespace
}  // namespace rhexis
