// A device that follows the scene's script holds the body of a live session, and the page watches.

#include <gmock/gmock.h>

#include "haptics/device_list.h"
#include "session/live_session.h"
#include "session/replay_check.h"
#include "tests/session/live_case.h"

namespace rhexis::session {
namespace {

using test::LiveCase;
using test::payload;
using test::wait_until;
using testing::HasSubstr;

/// At the device: it can give 8.9 N, and the plate tears at 34 N.
constexpr double kForceScale = 0.2;

MakeDevice device(const std::string& name) {
  return [name](std::shared_ptr<haptics::HandPath> script) {
    return haptics::make_device(name,
                                {.hand = std::move(script), .emulator = haptics::EmulatorSettings::firmly_held()});
  };
}

wire::PayloadUnion script(bool on) {
  wire::ScriptT command;
  command.on = on;
  return payload(command);
}

/// Until its script is over: true when the plate has torn by then.
bool tears(const LiveCase& at) {
  return wait_until([&] { return at.state().advances > 3; }) && wait_until([&] { return !at.state().scripted; });
}

class FollowsTheScript : public testing::TestWithParam<const char*> {};

TEST_P(FollowsTheScript, HoldsPullsAndTearsWithoutAPage) {
  LiveCase at(std::string("device-") + GetParam());
  at.settings.device = device(GetParam());
  at.settings.force_scale = kForceScale;
  at.start();
  ASSERT_TRUE(wait_until([&] { return at.state().held; }));
  at.live->post(at.grasp_near({0.20, 0.20, 0.005}));
  EXPECT_TRUE(at.hears(std::string("the device '") + GetParam() + "' holds the body: the page watches"));
  at.live->post(payload(wire::LetGoT()));
  at.live->post(test::move_to(0.1, 0.1, 0.1));
  ASSERT_TRUE(tears(at));
  at.live->stop();
  double strongest = 0.0;
  for (const wire::PayloadUnion& frame : at.frames.all()) {
    if (frame.type != wire::Payload::State) continue;
    const wire::StateT& state = *frame.AsState();
    strongest = std::max(strongest, Vec3(state.force->x(), state.force->y(), state.force->z()).norm());
    EXPECT_LT(std::abs(state.hand->y()), 0.02) << "where the page's moves would have it";
  }
  EXPECT_GT(strongest, 0.5);
  EXPECT_LE(strongest, 8.9 * (1.0 + 1e-12));
}

TEST_P(FollowsTheScript, ABodyMadeAnewIsPulledAnew) {
  LiveCase at(std::string("again-") + GetParam());
  at.settings.device = device(GetParam());
  at.settings.force_scale = kForceScale;
  at.start();
  ASSERT_TRUE(tears(at));
  const std::uint32_t epoch = at.state().epoch;
  at.live->post(payload(wire::ResetT()));
  ASSERT_TRUE(wait_until([&] { return at.state().epoch > epoch && at.state().held; }));
  ASSERT_TRUE(tears(at));
  at.live->post(payload(wire::UndoT()));
  at.live->post(script(true));
  EXPECT_TRUE(wait_until([&] { return at.state().scripted; })) << "or when a page asks for it";
  at.live->post(script(false));
  EXPECT_TRUE(wait_until([&] { return !at.state().scripted && !at.state().held; }));
}

TEST_P(FollowsTheScript, ComesOutOfARecordingTheSameToTheLastBit) {
  LiveCase at(std::string("recorded-") + GetParam());
  at.settings.device = device(GetParam());
  at.settings.force_scale = kForceScale;
  at.settings.recordings = at.folder.path() / "recordings";
  at.settings.records = true;
  at.start();
  ASSERT_TRUE(tears(at));
  at.live->stop();
  const Expected<CheckReport> report = check_recording(at.folder.only_file("recordings"));
  ASSERT_TRUE(report.has_value()) << report.error().message();
  EXPECT_EQ(report->difference, "");
  EXPECT_GE(report->advances, 3U);
}

INSTANTIATE_TEST_SUITE_P(LiveDevice, FollowsTheScript, testing::Values("script", "emulator"));

TEST(LiveDevice, TheEmulatedHandGivesWayToTheBody) {
  LiveCase at("device-lag");
  at.settings.device = device("emulator");
  at.settings.scene = at.folder.write("slow.toml", test::kLivePlate + "hold = 60.0\n[interaction]\nmax_force = 8.9\n");
  at.settings.overrides = {"fracture.strength=1e9"};
  at.start();
  ASSERT_TRUE(wait_until([&] { return at.state().time > 2.0; }));
  at.live->stop();
  const wire::StateT state = at.state();
  const double force = state.force->x();
  EXPECT_GT(force, 0.5);
  // In equilibrium: the hand's spring of 500 N/m, pulled 120 mm, holds against the force of the coupling.
  EXPECT_NEAR(-state.hand->x(), 0.12 - force / 500.0, 2e-3);
}

TEST(LiveDevice, WhatCannotHoldIsSaid) {
  LiveCase at("device-wrong");
  const auto refused = [&] { return LiveSession::open(at.settings, at.frames).error().message(); };
  at.settings.device = device("emulater");
  EXPECT_THAT(refused(), HasSubstr("did you mean 'emulator'?"));
  at.settings.device = device("script");
  const std::string plate = test::kLivePlate;
  at.settings.scene = at.folder.write("still.toml", plate.substr(0, plate.find("[[pull]]")));
  EXPECT_THAT(refused(), HasSubstr("nothing for device 'script' to do (add a [[pull]])"));
  at.settings.device = {};
  at.settings.force_scale = 0.0;
  EXPECT_THAT(refused(), HasSubstr("force by 0 (more than 0)"));
  at.settings.force_scale = 1.0;
  EXPECT_TRUE(LiveSession::open(at.settings, at.frames)) << "a pointer needs no script";
}

}  // namespace
}  // namespace rhexis::session
