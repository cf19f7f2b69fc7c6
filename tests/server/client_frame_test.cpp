#include "server/client_frame.h"

#include <gtest/gtest.h>

#include <limits>

namespace rhexis::server {
namespace {

template <typename PayloadT>
bool passes(PayloadT payload) {
  return read_client_frame(wire::encode(std::move(payload))->bytes).has_value();
}

wire::MoveT move(double x) {
  wire::MoveT move;
  move.to = std::make_unique<wire::Vec3>(x, 0.0, 0.0);
  return move;
}

TEST(ClientFrame, WhatAClientSaysPassesAndWhatWeSayDoesNot) {
  EXPECT_TRUE(passes(move(0.1)));
  EXPECT_TRUE(passes(wire::ResetT{}));
  EXPECT_TRUE(passes(wire::PingT{}));
  EXPECT_FALSE(passes(wire::StateT{}));
  EXPECT_FALSE(passes(wire::BodyT{}));
  EXPECT_FALSE(passes(wire::RoleT{}));
}

TEST(ClientFrame, NumbersAreThereAndFinite) {
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(passes(move(wrong)));
    wire::SeekT seek;
    seek.time = wrong;
    EXPECT_FALSE(passes(std::move(seek)));
    wire::PlayT play;
    play.speed = wrong;
    EXPECT_FALSE(passes(std::move(play)));
    wire::GraspT grasp;
    grasp.weights = std::make_unique<wire::Vec3>(0.0, wrong, 0.0);
    EXPECT_FALSE(passes(std::move(grasp)));
  }
  EXPECT_FALSE(passes(wire::MoveT{}));
  EXPECT_FALSE(passes(wire::GraspT{}));
}

TEST(ClientFrame, EveryKindIsSomebodysToSend) {
  int of_clients = 0;
  for (int kind = 0; kind < 256; ++kind)
    of_clients += right_to_send(static_cast<wire::Payload>(kind)) == Right::nobody ? 0 : 1;
  // Behind Pong, but for Trial, which came later.
  EXPECT_EQ(of_clients, static_cast<int>(wire::Payload::MAX) - static_cast<int>(wire::Payload::Pong) - 1);
  EXPECT_EQ(right_to_send(wire::Payload::Trial), Right::nobody);
  EXPECT_EQ(right_to_send(wire::Payload::Pong), Right::nobody);
  EXPECT_EQ(right_to_send(wire::Payload::TakeHand), Right::anybody);
  for (const wire::Payload kind : {wire::Payload::Grasp, wire::Payload::Feel, wire::Payload::Answer})
    EXPECT_EQ(right_to_send(kind), Right::hand);
}

}  // namespace
}  // namespace rhexis::server
