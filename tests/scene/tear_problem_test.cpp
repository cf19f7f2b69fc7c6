#include "scene/tear_problem.h"

#include <gmock/gmock.h>

#include "model/stabilisation.h"
#include "tests/scene/scene_text.h"
#include "tests/support/replaced.h"

namespace rhexis::scene {
namespace {

const std::string kPlate = R"(gravity = [0.0, 0.0, -9.81]
[mesh]
generate = "plate"
size = [0.24, 0.24, 0.01]
nodes = 200
[material]
density = 1000.0
young = 1.0e6
poisson = 0.4
[model]
kind = "linear"
[[support]]
set = "+x"
x = 0.0
y = 0.0
z = 0.0
[[traction]]
side = "-x"
force = [-0.5, 0.0, 0.0]
[fracture]
strength = 0.4e6
[[crack]]
from = [0.12, 0.0, 0.0]
to = [0.12, 0.06, 0.0]
[[pull]]
at = [0.10, 0.0, 0.005]
by = [-0.12, 0.0, 0.0]
)";

Expected<TearProblem> build(const std::string& text) {
  const Expected<Scene> scene = parse_scene(text, "s.toml");
  EXPECT_TRUE(scene.has_value()) << scene.error().message();
  return build_tear_problem(*scene);
}

using rhexis::test::replaced;

TEST(TearProblem, HoldsWhatAnInteractionNeeds) {
  const Expected<TearProblem> problem = build(kPlate);
  ASSERT_TRUE(problem.has_value()) << problem.error().message();
  EXPECT_EQ(problem->body.density, 1000.0);
  EXPECT_EQ(problem->body.gravity, Vec3(0.0, 0.0, -9.81));
  EXPECT_EQ(problem->fracture.advance_threshold, 0.2e6);
  ASSERT_EQ(problem->pulls.size(), 1U);
  EXPECT_FALSE(problem->pulls[0].push);
  EXPECT_FALSE(problem->body.supports.empty());
  // The traction alone: the weight goes with the tets, which may be torn off.
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index node = 0; node < problem->body.dead_force.size() / 3; ++node)
    sum += problem->body.dead_force.segment<3>(3 * node);
  EXPECT_LT((sum - Vec3(-0.5, 0.0, 0.0)).norm(), 1e-14);  // a few hundred sums of 2^-53
}

struct BadScene {
  std::string from, to, message;
};

TEST(TearProblem, SaysWhatIsMissingOrCannotBe) {
  const std::vector<BadScene> table{
      {"[fracture]\nstrength = 0.4e6\n", "",
       "s.toml: the scene does not say when the body tears (add a [fracture] with 'strength' or 'toughness')"},
      {"[[pull]]\nat = [0.10, 0.0, 0.005]\nby = [-0.12, 0.0, 0.0]\n", "",
       "s.toml: nothing pulls at the body (add a [[pull]])"},
      {"\"linear\"", "\"taylor-hood\"",
       "s.toml:11: a body with model 'taylor-hood' cannot be torn (\"linear\", \"corotated\", "
       "\"geometrically-nonlinear\" or \"hyperelastic\")"},
      {"[fracture]", "[[pressure]]\nside = \"-x\"\nvalue = 10.0\n[fracture]",
       "s.toml:21: a pressure follows the surface, which the linear model cannot (a [[traction]] in a fixed "
       "direction)"},
      {"[fracture]", "[interaction]\nresponse = \"recorded\"\nrecord = \"a.h5\"\n[fracture]\nincision = \"split\"",
       "s.toml:23: incision 'split' adds nodes, and a record needs operators of one size (incision = \"keep-nodes\")"},
      {"[[support]]\nset = \"+x\"\nx = 0.0\ny = 0.0\nz = 0.0\n", "",
       "s.toml: nothing holds the body (add a [[support]])"}};
  for (const BadScene& bad : table) {
    const Expected<Scene> scene = parse_scene(replaced(kPlate, bad.from, bad.to), "s.toml");
    ASSERT_TRUE(scene.has_value()) << scene.error().message();
    const Expected<TearProblem> problem = build_tear_problem(*scene);
    ASSERT_FALSE(problem.has_value()) << bad.message;
    EXPECT_EQ(problem.error().message(), bad.message);
  }
}

Expected<TearProblem> build_for_hand(const std::string& text) {
  const Expected<Scene> scene = parse_scene(text, "s.toml");
  EXPECT_TRUE(scene.has_value()) << scene.error().message();
  return build_tear_problem(*scene, Puller::hand);
}

TEST(TearProblem, AHandOpensWhatAScriptCannotAndSaysWhatIsOtherThanWritten) {
  const std::string no_fracture = replaced(kPlate, "[fracture]\nstrength = 0.4e6\n", "");
  const std::string nothing = replaced(no_fracture, "[[pull]]\nat = [0.10, 0.0, 0.005]\nby = [-0.12, 0.0, 0.0]\n", "");
  const Expected<TearProblem> bends = build_for_hand(replaced(nothing, "\"linear\"", "\"taylor-hood\""));
  ASSERT_TRUE(bends.has_value()) << bends.error().message();
  EXPECT_FALSE(bends->tears);
  EXPECT_TRUE(bends->pulls.empty());
  EXPECT_THAT(bends->warnings,
              testing::ElementsAre("s.toml: the body bends and does not tear: there is no [fracture]",
                                   "s.toml:11: model 'taylor-hood' is not live: the body is opened as 'linear'"));
  EXPECT_EQ(bends->model.kind, model::ModelKind::linear);
  const Expected<TearProblem> tears = build_for_hand(kPlate);
  ASSERT_TRUE(tears.has_value()) << tears.error().message();
  EXPECT_TRUE(tears->tears);
  EXPECT_TRUE(tears->warnings.empty());
}

TEST(TearProblem, APressurePushesOnTheSurfaceAtRestForAHand) {
  const Expected<TearProblem> problem =
      build_for_hand(replaced(kPlate, "[fracture]", "[[pressure]]\nside = \"-x\"\nvalue = 10.0\n[fracture]"));
  ASSERT_TRUE(problem.has_value()) << problem.error().message();
  EXPECT_THAT(problem->warnings,
              testing::ElementsAre(testing::HasSubstr("s.toml:21: the pressure acts on the surface")));
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index node = 0; node < problem->body.dead_force.size() / 3; ++node)
    sum += problem->body.dead_force.segment<3>(3 * node);
  // The traction, and 10 Pa against the outward normal -x of 0.24 m x 0.01 m.
  EXPECT_LT((sum - Vec3(-0.5 + 0.024, 0.0, 0.0)).norm(), 1e-14) << sum.transpose();
}

TEST(TearProblem, ABodyOfLargeStrainIsTakenAsItIsWithWhatFollowsItsSurface) {
  const std::string pressed = replaced(kPlate, "[fracture]", "[[pressure]]\nside = \"-x\"\nvalue = 10.0\n[fracture]");
  const Expected<TearProblem> problem = build(replaced(pressed, "\"linear\"", "\"hyperelastic\""));
  ASSERT_TRUE(problem.has_value()) << problem.error().message();
  EXPECT_EQ(problem->model.kind, model::ModelKind::hyperelastic);
  EXPECT_EQ(problem->model.beta, model::auto_beta(problem->model.law));
  ASSERT_EQ(problem->pressures.size(), 1U);
  EXPECT_EQ(problem->pressures[0].value, 10.0);
  EXPECT_FALSE(problem->pressures[0].faces.empty());
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index node = 0; node < problem->body.dead_force.size() / 3; ++node)
    sum += problem->body.dead_force.segment<3>(3 * node);
  EXPECT_LT((sum - Vec3(-0.5, 0.0, 0.0)).norm(), 1e-14);  // the traction alone
}

TEST(TearProblem, DynamicsAreOfABodyOfLargeStrainThatHasAMass) {
  const std::string moving = replaced(kPlate, "[fracture]", "[dynamics]\nstep = 0.01\nmass_damping = 2.0\n[fracture]");
  const std::string corotated = replaced(moving, "\"linear\"", "\"corotated\"");
  const Expected<TearProblem> problem = build(corotated);
  ASSERT_TRUE(problem.has_value()) << problem.error().message();
  ASSERT_TRUE(problem->dynamics);
  EXPECT_EQ(problem->dynamics->density, 1000.0);
  EXPECT_EQ(problem->dynamics->step, 0.01);
  EXPECT_EQ(problem->dynamics->mass_damping, 2.0);
  EXPECT_EQ(problem->dynamics->stiffness_damping, 0.0);
  EXPECT_FALSE(build(kPlate)->dynamics);

  const std::string weightless = replaced(corotated, "gravity = [0.0, 0.0, -9.81]", "");
  const Expected<Scene> scene = parse_scene(replaced(weightless, "density = 1000.0", ""), "s.toml");
  ASSERT_TRUE(scene.has_value()) << scene.error().message();
  for (const Puller puller : {Puller::script, Puller::hand}) {
    const Expected<TearProblem> bad = build_tear_problem(*scene, puller);
    ASSERT_FALSE(bad.has_value());
    EXPECT_EQ(bad.error().message(),
              "s.toml:20: dynamics need a mass, and 'material.density' is 0 (a density in kg/m3, more than 0)");
  }
}

TEST(TearProblem, DynamicsOfABodyOfSmallStrainsAreNotReadAndItSaysSo) {
  for (const char* density : {"density = 1000.0", "density = 0.0"}) {
    const std::string text =
        replaced(replaced(replaced(kPlate, "[fracture]", "[dynamics]\n[fracture]"), "gravity = [0.0, 0.0, -9.81]", ""),
                 "density = 1000.0", density);
    for (const std::string kind : {"linear", "mass-spring", "taylor-hood"}) {
      const Expected<Scene> scene = parse_scene(replaced(text, "\"linear\"", '"' + kind + '"'), "s.toml");
      ASSERT_TRUE(scene.has_value()) << scene.error().message();
      const Expected<TearProblem> problem = build_tear_problem(*scene, Puller::hand);
      ASSERT_TRUE(problem.has_value()) << problem.error().message();
      EXPECT_FALSE(problem->dynamics);
      EXPECT_THAT(problem->warnings, testing::Contains("s.toml:20: 'dynamics' is not read by model '" + kind +
                                                       "', which has no mass (kind = \"corotated\", "
                                                       "\"geometrically-nonlinear\" or \"hyperelastic\")"));
    }
    EXPECT_TRUE(build(text)->warnings.size() == 1U);
  }
}

/// The plate of 0.24 m and 0.01 m, 1 MPa: its slowest swing takes 1.1 s. A stiff one is at rest at once.
TEST(TearProblem, DynamicsThatLeaveNothingOfASwingAreWarnedOf) {
  const auto warnings = [](const std::string& dynamics, const std::string& young = "1.0e6") {
    const std::string text = replaced(replaced(kPlate, "\"linear\"", "\"corotated\""), "[fracture]",
                                      "[dynamics]\n" + dynamics + "[fracture]");
    const Expected<TearProblem> problem = build(replaced(text, "1.0e6", young));
    EXPECT_TRUE(problem.has_value()) << problem.error().message();
    return problem->warnings;
  };
  EXPECT_THAT(warnings(""), testing::IsEmpty());
  EXPECT_THAT(warnings("step = 0.2\nstiffness_damping = 1.0\nmass_damping = 50.0\n"), testing::IsEmpty());
  EXPECT_THAT(warnings("step = 1.0\n"),
              testing::ElementsAre("s.toml:20: a time step of 1 s is long beside the slowest swing of this body, about "
                                   "1.1 s: it comes to rest without one (step = 0.06 shows it)"));
  EXPECT_THAT(
      warnings("stiffness_damping = 1000.0\n"),
      testing::ElementsAre("s.toml:20: with stiffness_damping = 1e+03 s this body creeps back for several times "
                           "that, and does not swing (less than 0.4 s for a swing of about 1.1 s)"));
  EXPECT_THAT(warnings("mass_damping = 1e4\n"),
              testing::ElementsAre("s.toml:20: with mass_damping = 1e+04 1/s this body creeps back in about 3.2e+02 s, "
                                   "and does not swing (less than 1e+01 1/s for a swing of about 1.1 s)"));
  EXPECT_THAT(warnings("", "1.0e15"),
              testing::ElementsAre("s.toml:20: a time step of 0.016 s is long beside the slowest swing of this body, "
                                   "about 3.6e-05 s: it comes to rest without one (it is at rest sooner than can be "
                                   "seen: leave [dynamics] out)"));
}

TEST(TearProblem, ABodyOfLargeStrainSaysWhatItDoesNotHave) {
  const std::string corotated = replaced(kPlate, "\"linear\"", "\"corotated\"");
  const std::vector<BadScene> table{
      {"[[crack]]", "[interaction]\ncontact = \"blend\"\n[[crack]]",
       "s.toml:22: contact \"blend\" adds up reactions, which model 'corotated' does not allow (contact = "
       "\"consistent\")"}};
  for (const BadScene& bad : table) {
    const Expected<Scene> scene = parse_scene(replaced(corotated, bad.from, bad.to), "s.toml");
    ASSERT_TRUE(scene.has_value()) << scene.error().message();
    for (const Puller puller : {Puller::script, Puller::hand}) {
      const Expected<TearProblem> problem = build_tear_problem(*scene, puller);
      ASSERT_FALSE(problem.has_value()) << bad.message;
      EXPECT_EQ(problem.error().message(), bad.message);
    }
  }
}

TEST(TearProblem, AHandIsHeldToWhatIsWrongForAll) {
  const Expected<TearProblem> free =
      build_for_hand(replaced(kPlate, "[[support]]\nset = \"+x\"\nx = 0.0\ny = 0.0\nz = 0.0\n", ""));
  ASSERT_FALSE(free.has_value());
  EXPECT_EQ(free.error().message(), "s.toml: nothing holds the body (add a [[support]])");
  const std::string of_a_record = "[interaction]\nresponse = \"recorded\"\nrecord = \"a.h5\"\n";
  EXPECT_TRUE(build_for_hand(replaced(kPlate, "[[crack]]", of_a_record + "[[crack]]")).has_value());
  const Expected<TearProblem> corotated =
      build_for_hand(replaced(replaced(kPlate, "\"linear\"", "\"corotated\""), "[[crack]]", of_a_record + "[[crack]]"));
  ASSERT_FALSE(corotated.has_value());
  EXPECT_EQ(corotated.error().message(),
            "s.toml:11: a record is of a body of small strains, not of model 'corotated' (kind = \"linear\")");
}

TEST(TearProblem, PushAndBlendAreRead) {
  const Expected<TearProblem> problem =
      build(replaced(replaced(kPlate, "[[crack]]", "[interaction]\ncontact = \"blend\"\n[[crack]]"), "[[pull]]",
                     "[[pull]]\nmode = \"push\""));
  ASSERT_TRUE(problem.has_value()) << problem.error().message();
  EXPECT_TRUE(problem->interaction.blend_contact);
  EXPECT_TRUE(problem->pulls[0].push);
}

}  // namespace
}  // namespace rhexis::scene
