#pragma once

/// An interaction in a test, step by step.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "session/interaction.h"
#include "tests/session/live_case.h"

namespace rhexis::test {

/// Keeps what it hears.
struct Heard final : session::InteractionListener {
  void has_body(bool anew) override { bodies += anew ? 1 : 0; }
  void has_torn(const session::AdvanceRecord& advance, const session::SurfaceChange& /*change*/) override {
    topologies.push_back(advance.topology);
  }
  void says(wire::Level /*level*/, const std::string& text) override { texts.push_back(text); }
  int bodies = 0;
  std::vector<std::size_t> topologies;
  std::vector<std::string> texts;
};

/// An interaction without a clock: a step is a tick of the hand.
struct InteractionCase {
  explicit InteractionCase(std::string text = kLivePlate) : InteractionCase(choice_of(std::move(text))) {}
  explicit InteractionCase(session::SceneChoice choice)
      : interaction(
            open(std::move(choice)), [](const std::string&) { return fail("none"); }, heard) {}
  static session::SceneChoice choice_of(std::string text) {
    return {.file = "s.toml", .text = std::move(text), .overrides = {}};
  }
  static std::unique_ptr<session::OpenBody> open(session::SceneChoice choice) {
    Expected<std::unique_ptr<session::OpenBody>> body = session::open_body(std::move(choice));
    EXPECT_TRUE(body.has_value()) << body.error().message();
    return std::move(*body);
  }
  /// A step in which the hand is where a rigid device without delay has it, as time stands still while the body tears.
  session::StepOutcome step() {
    haptics::HandState hand;
    if (tore == 0) ++tick;
    hand.tick = tick;
    hand.grasp = interaction.law().grasp;
    const bool holds = (interaction.law().flags & response::ForceSnapshot::is_held) != 0;
    hand.flags = holds ? haptics::HandState::holds : 0U;
    const Vec3 at = interaction.orders().hold != 0 ? interaction.orders().at(tick) : by;
    hand.hand = {at[0], at[1], at[2]};
    const session::StepOutcome out = interaction.step(hand, true);
    tore = out.advances;
    return out;
  }
  void set(const std::string& key, const std::string& value) {
    wire::SetValueT set;
    set.key = key;
    set.value = value;
    interaction.carry_out(payload(std::move(set)));
  }
  void begin_script() {
    wire::ScriptT on;
    on.on = true;
    interaction.carry_out(payload(on));
  }
  /// Of the whole script.
  std::vector<session::StepOutcome> run_script() {
    begin_script();
    std::vector<session::StepOutcome> out;
    for (int k = 0; k < 600; ++k) out.push_back(step());
    return out;
  }

  Heard heard;
  session::Interaction interaction;
  std::uint64_t tick = 0;
  int tore = 0;  ///< advances of the last step
  Vec3 by = Vec3::Zero();
};

}  // namespace rhexis::test
