// The experiment with a person, in a live session: what is seen, what is felt, what is answered.

#include "studies/perception_task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "tests/session/live_case.h"
#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using testing::HasSubstr;
using wire::Payload;
using wire::Presented;

constexpr std::uint64_t kGripTicks = 400;  // in which the grip has long closed
constexpr double kPull = 0.002;            // m: a force that no device's limit cuts

Vec3 vector_of(const std::unique_ptr<wire::Vec3>& v) { return {v->x(), v->y(), v->z()}; }

struct TaskCase {
  explicit TaskCase(const std::string& name, session::MakeDevice device = {})
      : folder(test::fresh_folder(name)), settings(*read_perception({})) {
    settings.seed = 5;
    Expected<std::shared_ptr<PerceptionTask>> made = PerceptionTask::make(settings, folder / TrialLog::kName);
    EXPECT_TRUE(made) << made.error().message();
    task = *made;
    session::LiveSettings live_settings;
    live_settings.task = task;
    live_settings.priority = 0;
    live_settings.device = std::move(device);
    live = std::move(*session::LiveSession::open(std::move(live_settings), frames));
    EXPECT_TRUE(live->start());
    EXPECT_TRUE(test::wait_until([&] { return frames.count(Payload::Trial) > 0; }));
  }

  [[nodiscard]] wire::TrialT trial() const { return *frames.last(Payload::Trial).AsTrial(); }
  [[nodiscard]] wire::StateT state() const { return *frames.last(Payload::State).AsState(); }
  template <class T>
  void say(T command) {
    live->post(test::payload(std::move(command)));
  }
  void choose(Presented presented) {
    wire::FeelT command;
    command.presented = presented;
    const std::size_t shown = frames.count(Payload::Trial);
    say(command);
    EXPECT_TRUE(test::wait_until([&] { return frames.count(Payload::Trial) > shown; }));
    EXPECT_EQ(trial().presented, presented);
  }
  void hold() {
    wire::GraspT grasp;  // anywhere: the point is locked
    grasp.weights = std::make_unique<wire::Vec3>(1.0, 0.0, 0.0);
    say(std::move(grasp));
    EXPECT_TRUE(test::wait_until([&] { return state().held; }));
  }
  void wait_for_grip() {
    const std::uint64_t begun = state().tick;
    EXPECT_TRUE(test::wait_until([&] { return state().tick > begun + kGripTicks; }));
  }
  /// Pulls at that plate, gives the State when the hand is there, and lets go.
  wire::StateT feel(Presented presented) {
    choose(presented);
    hold();
    const Vec3 to = kPull * settings.directions[first().direction].value + Vec3(0.0, 0.0, 0.01);
    live->post(test::move_to(to.x(), to.y(), to.z()));
    EXPECT_TRUE(
        test::wait_until([&] { return state().held && state().hand && state().force && state().hand->x() != 0.0; }));
    wait_for_grip();
    const wire::StateT there = state();
    say(wire::LetGoT{});
    EXPECT_TRUE(test::wait_until([&] { return !state().held; }));
    return there;
  }
  void answer(Presented same) {
    wire::AnswerT command;
    command.same = same;
    say(command);
  }
  [[nodiscard]] Trial first() const { return *PerceptionExperiment(settings, settings.seed).current(); }
  [[nodiscard]] bool hears(const std::string& part) const {
    return test::wait_until([&] {
      const std::vector<std::string> notices = frames.notices();
      return std::any_of(notices.begin(), notices.end(),
                         [&](const std::string& text) { return text.find(part) != std::string::npos; });
    });
  }

  std::filesystem::path folder;
  PerceptionSettings settings;
  test::KeptFrames frames;
  std::shared_ptr<PerceptionTask> task;
  std::unique_ptr<session::LiveSession> live;
};

TEST(PerceptionTask, ShowsTheSampleAndLetsEachPlateBeFelt) {
  TaskCase at("task-feel");
  const Trial trial = at.first();
  const PerceptionPlate plate = *PerceptionPlate::open(at.settings);
  const auto law = [&](double difference) { return (*plate.laws(90.0 - difference))[trial.point].stiffness; };
  const Presented odd = trial.same == Side::a ? Presented::b : Presented::a;
  std::vector<std::vector<float>> pictures;
  for (const Presented presented : {Presented::sample, Presented::a, Presented::b}) {
    const wire::StateT state = at.feel(presented);
    const Vec3 hand = vector_of(state.hand);
    const Vec3 along = at.settings.directions[trial.direction].value;
    EXPECT_NEAR((hand - kPull * along).norm(), 0.0, 1e-15) << "the direction is locked";
    const Vec3 expected = -law(presented == odd ? trial.difference : 0.0) * hand;
    // A law is summed once here and once in the haptic loop: a few roundings of a newton or less.
    EXPECT_NEAR((vector_of(state.force) - expected).norm(), 0.0, 1e-12 * expected.norm());
    EXPECT_NEAR((vector_of(state.body_force) - expected).norm(), 0.0, 1e-12 * expected.norm());
    pictures.push_back(state.displacement);
  }
  EXPECT_EQ(pictures[0], pictures[1]) << "the screen shows the sample, whatever is felt";
  EXPECT_EQ(pictures[0], pictures[2]);
  EXPECT_GT((law(trial.difference) - law(0.0)).norm(), 0.01 * law(0.0).norm()) << "there is something to feel";
  EXPECT_TRUE(at.trial().felt_sample && at.trial().felt_a && at.trial().felt_b && at.trial().shows_force);
}

TEST(PerceptionTask, TakesAnAnswerWhenAllIsFeltAndKeepsIt) {
  TaskCase at("task-answer");
  at.answer(Presented::a);
  ASSERT_TRUE(at.hears("not all plates have been felt"));
  EXPECT_EQ(at.task->standing().answered, 0U);
  for (const Presented presented : {Presented::sample, Presented::a, Presented::b}) at.feel(presented);
  at.answer(Presented::b);
  ASSERT_TRUE(test::wait_until([&] { return at.trial().number == 2; }));
  EXPECT_FALSE(at.trial().felt_sample || at.trial().felt_a || at.trial().felt_b);
  EXPECT_EQ(at.task->standing().answered, 1U);
  EXPECT_THAT(test::slurp(at.folder / TrialLog::kName), HasSubstr("\"answer\":\"B\""));
  for (const std::string& notice : at.frames.notices())
    EXPECT_THAT(notice, testing::Not(testing::AnyOf(HasSubstr("right"), HasSubstr("wrong")))) << "no feedback";
  at.live->stop();
  const Expected<std::shared_ptr<PerceptionTask>> again =
      PerceptionTask::make(at.settings, at.folder / TrialLog::kName);
  ASSERT_TRUE(again);
  EXPECT_EQ((*again)->show().number, 2U) << "the same command goes on";
}

TEST(PerceptionTask, OpensAnExperimentThatIsAtItsEnd) {
  const std::filesystem::path path = test::fresh_folder("task-end") / TrialLog::kName;
  const PerceptionSettings settings = *read_perception({});
  PerceptionExperiment experiment(settings, settings.seed);
  {
    Expected<TrialLog> log = TrialLog::open(path, settings, settings.seed, experiment);
    ASSERT_TRUE(log);
    while (experiment.current() != nullptr) {
      experiment.answer(Side::a);
      ASSERT_TRUE(log->append(experiment.answered().back(), 0.0));
    }
  }
  const Expected<std::shared_ptr<PerceptionTask>> task = PerceptionTask::make(settings, path);
  ASSERT_TRUE(task) << task.error().message();
  EXPECT_TRUE((*task)->standing().is_over);
  EXPECT_EQ((*task)->answered().size(), experiment.answered().size());
  EXPECT_TRUE((*task)->show().finished);
}

TEST(PerceptionTask, IsNoFreePlay) {
  TaskCase at("task-free");
  at.say(wire::ResetT{});
  ASSERT_TRUE(at.hears("that is not for an experiment"));
  wire::SetValueT set;
  set.key = "material.young";
  set.value = "1e5";
  at.say(set);
  wire::RecordT record;
  record.on = true;
  at.say(record);
  at.feel(Presented::a);
  EXPECT_EQ(at.frames.count(Payload::Body), 1U);
  EXPECT_FALSE(at.state().recording);
}

/// One that pushes back, absolute. It goes where it is told by 10 mm/s, and drifts across the experiment's direction
/// too.
class Machine final : public haptics::Device {
 public:
  static constexpr double kStep = 1e-5;  // m a tick

  explicit Machine(std::shared_ptr<std::atomic<double>> target) : target_(std::move(target)) {}
  [[nodiscard]] const haptics::DeviceTraits& traits() const override { return traits_; }
  haptics::Reading read(std::uint64_t) noexcept override {
    x_ += std::clamp(*target_ - x_, -kStep, kStep);
    return {.position = Vec3(0.1 + x_, 0.2 + 0.3 * x_, x_)};
  }
  void write(const Vec3&) noexcept override {}

 private:
  haptics::DeviceTraits traits_{.name = "machine", .what = "", .max_force = 8.9};
  std::shared_ptr<std::atomic<double>> target_;
  double x_ = 0.0;
};

TEST(PerceptionTask, BindsAMachineThatPushesBack) {
  const auto x = std::make_shared<std::atomic<double>>(0.0);
  TaskCase at("task-machine", [x](std::shared_ptr<haptics::HandPath>) -> Expected<std::unique_ptr<haptics::Device>> {
    return std::make_unique<Machine>(x);
  });
  EXPECT_FALSE(at.trial().shows_force) << "it is felt";
  const Vec3 along = at.settings.directions[at.first().direction].value;
  for (const Presented presented : {Presented::a, Presented::b}) {
    *x = 0.0;
    at.choose(presented);
    at.hold();
    at.wait_for_grip();  // which slips while it closes, and in which the machine goes back
    *x = -kPull;
    ASSERT_TRUE(test::wait_until(
        [&] { return vector_of(at.state().hand).norm() > 1e-4 && vector_of(at.state().force).norm() > 0.01; }));
    const Vec3 hand = vector_of(at.state().hand);
    EXPECT_NEAR((hand - along * along.dot(hand)).norm(), 0.0, 1e-15);
    at.say(wire::LetGoT{});  // the grip opens over some 50 ms, and the next plate waits for that
  }
}

TEST(PerceptionTask, IsNotForADeviceThatFollowsAScript) {
  PerceptionSettings settings = *read_perception({});
  session::LiveSettings live;
  live.task = *PerceptionTask::make(settings, test::fresh_folder("task-script") / TrialLog::kName);
  live.device = [](std::shared_ptr<haptics::HandPath>) -> Expected<std::unique_ptr<haptics::Device>> {
    struct Follower final : haptics::Device {
      haptics::DeviceTraits all{.name = "follower", .what = "", .follows_script = true};
      [[nodiscard]] const haptics::DeviceTraits& traits() const override { return all; }
      haptics::Reading read(std::uint64_t) noexcept override { return {}; }
      void write(const Vec3&) noexcept override {}
    };
    return std::make_unique<Follower>();
  };
  test::KeptFrames frames;
  EXPECT_THAT(session::LiveSession::open(std::move(live), frames).error().message(),
              HasSubstr("device 'follower' to do (a device that somebody holds)"));
}

}  // namespace
}  // namespace rhexis::studies
