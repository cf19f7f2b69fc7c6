#include "session/frame_maker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "tests/session/live_case.h"

namespace rhexis::session {
namespace {

using test::payload;

/// An interaction, and the frames that a live session makes of it where it is `watched`: a State after every step.
struct Case final : InteractionListener {
  explicit Case(bool is_watched = true) : watched(is_watched) {
    Expected<std::unique_ptr<OpenBody>> body = open_body({.file = "s.toml", .text = test::kLivePlate, .overrides = {}});
    EXPECT_TRUE(body.has_value()) << body.error().message();
    interaction = std::make_unique<Interaction>(
        std::move(*body), [](const std::string&) { return fail("none"); }, *this);
    has_body(/*anew=*/true);
  }
  void has_body(bool /*anew*/) override {
    if (watched) static_cast<void>(frames.body(*interaction));
  }
  void has_torn(const AdvanceRecord& /*advance*/, const SurfaceChange& change) override {
    ++tears;
    if (watched) static_cast<void>(frames.edit(*interaction, change));
  }
  void says(wire::Level /*level*/, const std::string& /*text*/) override {}

  /// Of the face whose middle is nearest to `at`.
  void hold(const Vec3& at) {
    const SurfaceTracker& surface = interaction->body().surface;
    const mesh::TetMesh& mesh = interaction->tear().body().mesh();
    double nearest = 1e9;
    wire::GraspT grasp;
    for (std::uint32_t slot = 0; slot < surface.faces().size(); ++slot) {
      if (surface.is_empty(slot)) continue;
      Vec3 middle = Vec3::Zero();
      for (const std::uint32_t vertex : surface.faces()[slot]) middle += mesh.node(surface.nodes()[vertex]) / 3.0;
      if ((middle - at).norm() >= nearest) continue;
      nearest = (middle - at).norm();
      grasp.face = slot;
    }
    grasp.weights = std::make_unique<wire::Vec3>(0.5, 0.25, 0.25);
    interaction->carry_out(payload(std::move(grasp)));
  }
  StepOutcome step(const Vec3& by) {
    haptics::HandState hand;
    hand.tick = ++tick;
    hand.grasp = interaction->law().grasp;
    hand.flags = (interaction->law().flags & response::ForceSnapshot::is_held) != 0 ? haptics::HandState::holds : 0U;
    hand.hand = {by[0], by[1], by[2]};
    const StepOutcome out = interaction->step(hand, true);
    if (watched) state = frames.state(*interaction, hand);
    return out;
  }
  /// How far the last State is from a solve of its own, as a part of the largest displacement.
  [[nodiscard]] double difference() const {
    VectorX u;
    interaction->tear().displacement(u);
    const std::vector<NodeId>& nodes = interaction->body().surface.nodes();
    EXPECT_EQ(state.displacement.size(), 3 * nodes.size());
    double most = 0.0;
    for (std::size_t k = 0; k < state.displacement.size(); ++k) {
      const auto dof = static_cast<Eigen::Index>(3 * nodes[k / 3].index() + k % 3);
      most = std::max(most, std::abs(static_cast<double>(state.displacement[k]) - u[dof]));
    }
    const double largest = u.cwiseAbs().maxCoeff();
    return largest > 0.0 ? most / largest : most;
  }

  bool watched;
  FrameMaker frames;
  std::unique_ptr<Interaction> interaction;
  wire::StateT state;
  std::uint64_t tick = 0;
  int tears = 0;
};

/// To where the plate tears, and not straight.
Vec3 way(int k) { return {-0.0008 * k, 0.002 * std::sin(0.1 * k), 0.0001 * k}; }

TEST(FrameMaker, AStateIsThatOfASolveWhateverHasHappenedToTheBody) {
  Case at;
  constexpr double kFloat = 6e-8;  // 2^-24
  const auto pull = [&](int steps) {
    at.step(Vec3::Zero());
    for (int k = 1; k <= steps; ++k) {
      at.step(way(k));
      ASSERT_LT(at.difference(), kFloat) << k;
    }
  };
  at.hold({0.10, 0.0, 0.005});
  pull(200);
  EXPECT_GT(at.tears, 3);
  at.interaction->carry_out(payload(wire::UndoT()));
  at.step(Vec3::Zero());
  EXPECT_EQ(at.difference(), 0.0);
  at.hold({0.05, 0.02, 0.01});
  pull(20);
  at.hold({0.05, 0.02, 0.01});  // the same nodes again
  pull(20);
  at.interaction->carry_out(payload(wire::ResetT()));
  at.hold({0.05, 0.02, 0.01});
  pull(20);
}

TEST(FrameMaker, HasNoPartInWhatHappens) {
  Case watched;
  Case alone(/*is_watched=*/false);
  for (Case* at : {&watched, &alone}) at->hold({0.10, 0.0, 0.005});
  for (int k = 0; k <= 200; ++k) {
    const StepOutcome a = watched.step(way(k));
    const StepOutcome b = alone.step(way(k));
    ASSERT_EQ(a.law, b.law) << k;
    ASSERT_EQ(a.fingerprint, b.fingerprint) << k;
    ASSERT_EQ(a.force, b.force) << k;
  }
  EXPECT_GT(watched.tears, 3);
}

}  // namespace
}  // namespace rhexis::session
