#include "session/interaction.h"

#include <gmock/gmock.h>

#include "tests/session/interaction_case.h"
#include "tests/session/live_case.h"
#include "tests/support/replaced.h"

namespace rhexis::session {
namespace {

using test::payload;

using test::InteractionCase;

TEST(Interaction, AScriptIsTheOneOfTheCommandTear) {
  InteractionCase live;
  live.run_script();
  EXPECT_FALSE(live.interaction.is_scripted());
  EXPECT_THAT(live.heard.texts, testing::Contains("the script has come to its end"));

  // The loop of `rhexis tear`: 500 ticks, each held against the other's tears.
  const auto body = InteractionCase::open(InteractionCase::choice_of(test::kLivePlate));
  TearSession& tear = body->tear();
  ASSERT_TRUE(tear.grasp(body->problem.pulls[0].at).has_value());
  for (int k = 1; k <= 500; ++k) tear.tick(body->problem.pulls[0].by * (k / 500.0));
  ASSERT_EQ(live.interaction.tear().advances().size(), tear.advances().size());
  ASSERT_GT(tear.advances().size(), 3U);
  for (std::size_t k = 0; k < tear.advances().size(); ++k) {
    EXPECT_EQ(live.interaction.tear().advances()[k].force_before, tear.advances()[k].force_before) << k;
    // The live hand takes hold in a tick of its own; the first crack is there from the start.
    const int tick = tear.advances()[k].tick;
    EXPECT_EQ(live.interaction.body().advance_time[k], tick == 0 ? 0.0 : 1e-3 * (tick + 1)) << k;
    EXPECT_EQ(live.interaction.tear().advances()[k].length, tear.advances()[k].length) << k;
  }
}

/// The script of the scene twice, each step of one like that of the other.
void expect_same_bits(const std::string& text) {
  InteractionCase one(text);
  InteractionCase other(text);
  const std::vector<StepOutcome> a = one.run_script();
  const std::vector<StepOutcome> b = other.run_script();
  int tears = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].law, b[k].law) << k;
    ASSERT_EQ(a[k].fingerprint, b[k].fingerprint) << k;
    ASSERT_EQ(a[k].force, b[k].force) << k;
    tears += a[k].advances;
  }
  EXPECT_GT(tears, 3);
  EXPECT_NE(a.front().fingerprint, a.back().fingerprint);
  EXPECT_NE(a[100].law, a[101].law);  // each is another publication
}

TEST(Interaction, TheSameInputsGiveTheSameBits) {
  expect_same_bits(test::kLivePlate);
  expect_same_bits(test::replaced(test::kLivePlate, "kind = \"linear\"", "kind = \"hyperelastic\""));
}

TEST(Interaction, EveryLiveModelIsTornAndSwitchedWhileItIsOpen) {
  InteractionCase live;
  for (const char* model : {"hyperelastic", "corotated", "geometrically-nonlinear", "linear"}) {
    live.set("model.kind", model);
    ASSERT_EQ(live.interaction.tear().model_name(), model);
    live.heard.topologies.clear();
    for (const StepOutcome& step : live.run_script()) ASSERT_TRUE(step.force.allFinite()) << model;
    EXPECT_GT(live.heard.topologies.size(), 3U) << model;
    EXPECT_FALSE(live.interaction.is_scripted()) << model;
  }
}

/// It has its mass with the models that can have one.
TEST(Interaction, TheModelIsSwitchedOfASceneWithDynamicsToo) {
  InteractionCase live(
      test::replaced(test::kLivePlate, "kind = \"linear\"", "kind = \"linear\"\n[dynamics]\nstep = 0.004"));
  for (const char* model : {"linear", "corotated", "mass-spring", "hyperelastic", "linear"}) {
    live.set("model.kind", model);
    const TearSession& tear = live.interaction.tear();
    const bool moves = model != std::string("linear") && model != std::string("mass-spring");
    EXPECT_EQ(tear.model_name(), moves ? model : "linear");
    EXPECT_EQ(tear.settings().dynamics.has_value(), moves) << model;
    EXPECT_EQ(testing::Value(live.interaction.body().problem.warnings,
                             testing::Contains(testing::HasSubstr("'dynamics' is not read by model"))),
              !moves)
        << model;
    live.heard.topologies.clear();
    for (const StepOutcome& step : live.run_script()) ASSERT_TRUE(step.force.allFinite()) << model;
    EXPECT_GT(live.heard.topologies.size(), 3U) << model;
  }
}

TEST(Interaction, AfterAPullTheScriptWaitsBeforeTheNextAndBeforeItsEnd) {
  const std::string two =
      test::replaced(test::kLivePlate, "seconds = 0.5\n",
                     "seconds = 0.05\nhold = 0.01\nwait = 0.1\n[[pull]]\nat = [0.10, 0.0, 0.005]\nby = [-0.001, 0.0, "
                     "0.0]\nseconds = 0.02\nwait = 0.03\n");
  InteractionCase live(two);
  live.begin_script();
  std::vector<bool> held;
  while (live.interaction.is_scripted()) {
    ASSERT_LT(held.size(), 1000U);
    live.step();
    held.push_back(live.interaction.tear().hand().holds());
    if (!live.interaction.is_scripted()) break;
    EXPECT_THAT(live.heard.texts, testing::Not(testing::Contains("the script has come to its end")));
  }
  EXPECT_THAT(live.heard.texts, testing::Contains("the script has come to its end"));
  // Each pull has a step to take hold in, and lets go in its last tick; time stands still while the body tears.
  std::vector<std::size_t> lengths{0};
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (k > 0 && held[k] != held[k - 1]) lengths.push_back(0);
    ++lengths.back();
  }
  ASSERT_EQ(lengths.size(), 4U);
  EXPECT_GE(lengths[0], 60U);
  EXPECT_EQ(lengths[1], 101U);
  EXPECT_EQ(lengths[2], 20U);
  EXPECT_EQ(lengths[3], 31U);
}

TEST(Interaction, AnUndoneTearIsAnotherBodyThanTheOneBefore) {
  InteractionCase live;
  const std::uint64_t intact = live.step().fingerprint;
  live.run_script();
  const std::size_t tears = live.heard.topologies.size();
  ASSERT_GT(tears, 0U);
  for (std::size_t k = 0; k < tears; ++k) live.interaction.carry_out(payload(wire::UndoT()));
  EXPECT_TRUE(live.heard.texts.empty() || live.heard.texts.back() != "there is no tear to take back");
  EXPECT_NE(live.step().fingerprint, intact);  // it is the way that counts, not where it leads
  live.interaction.carry_out(payload(wire::UndoT()));
  EXPECT_EQ(live.heard.texts.back(), "there is no tear to take back");
  live.interaction.carry_out(payload(wire::ResetT()));
  EXPECT_EQ(live.step().fingerprint, intact);
  EXPECT_EQ(live.heard.bodies, 1);
}

TEST(Interaction, WithoutFractureTheBodyBendsAndNeverTears) {
  std::string text = test::kLivePlate;
  const std::string fracture = "[fracture]\ncriterion = \"maximum-principal\"\nstrength = 0.4e6\n";
  text.erase(text.find(fracture), fracture.size());
  InteractionCase live(text);
  const std::vector<StepOutcome> steps = live.run_script();
  EXPECT_TRUE(live.heard.topologies.empty());
  // It goes on where the other has torn long ago: in line with the way.
  const Vec3 early = steps[100].force / 100.0;
  EXPECT_GT(early.norm(), 0.0);
  EXPECT_LT((steps[450].force / 450.0 - early).norm(), 1e-9 * early.norm());
}

TEST(Interaction, AHandThatFollowsAnotherHoldIsNotFollowed) {
  InteractionCase live;
  wire::GraspT grasp;
  grasp.weights = std::make_unique<wire::Vec3>(1.0, 0.0, 0.0);
  const SurfaceTracker& surface = live.interaction.body().surface;
  const mesh::TetMesh& mesh = live.interaction.tear().body().mesh();
  while (mesh.node(surface.nodes()[surface.faces()[grasp.face][0]]).x() > 0.05) ++grasp.face;
  live.interaction.carry_out(payload(std::move(grasp)));
  live.step();
  ASSERT_TRUE(live.interaction.tear().hand().holds());
  haptics::HandState old;
  old.tick = ++live.tick;
  old.grasp = live.interaction.law().grasp + 1;
  old.flags = haptics::HandState::holds;
  old.hand = {-0.01, 0.0, 0.0};
  EXPECT_EQ(live.interaction.step(old, true).force, Vec3(Vec3::Zero()));
  live.by = Vec3(-0.001, 0.0, 0.0);
  EXPECT_GT(live.step().force.norm(), 0.0);
}

TEST(Interaction, WhatTheHandTearsOffIsLetGoAndSaid) {
  std::string text = test::kLivePlate;
  text.replace(text.find("strength = 0.4e6"), 16, "strength = 2.0e4");
  text.replace(text.find("to = [0.12, 0.06"), 16, "to = [0.12, 0.20");
  InteractionCase live(text);
  live.run_script();
  EXPECT_THAT(live.heard.texts, testing::Contains(testing::HasSubstr("the hand has let go")));
  EXPECT_NE(live.interaction.law().flags & response::ForceSnapshot::torn_off, 0U);
  EXPECT_FALSE(live.interaction.is_scripted());
  EXPECT_THAT(live.heard.texts, testing::Contains(testing::HasSubstr("pieces")));
}

}  // namespace
}  // namespace rhexis::session
