#include <gmock/gmock.h>

#include "tests/scene/scene_text.h"

namespace rhexis::scene::test {
namespace {

using testing::ElementsAre;

Scene scene_with(const std::vector<std::string>& overrides) {
  Expected<Scene> scene = parse_scene(kGood, "s.toml", overrides);
  EXPECT_TRUE(scene) << scene.error().message();
  return scene ? std::move(*scene) : Scene{};
}

TEST(Override, ChangesNumbers) {
  EXPECT_EQ(scene_with({"model.beta=0"}).model.beta, 0.0);
  EXPECT_EQ(scene_with({"solver.steps=7"}).solver.options.steps, 7);
  EXPECT_EQ(scene_with({"gravity=[0, 1.5, 0]"}).gravity, Vec3(0.0, 1.5, 0.0));
  EXPECT_EQ(scene_with({"gravity.2=-1"}).gravity, Vec3(0.0, 0.0, -1.0));
  EXPECT_EQ(scene_with({" model.beta = 5 "}).model.beta, 5.0);
}

TEST(Override, TextNeedsNoQuotes) {
  EXPECT_EQ(std::get<Side>(scene_with({"sets.wall.side=+z"}).sets[0].choice).name, "+z");
  EXPECT_EQ(std::get<Side>(scene_with({"sets.wall.side=\"+z\""}).sets[0].choice).name, "+z");
  EXPECT_EQ(scene_with({"title=12 bars"}).title, "12 bars");
  EXPECT_EQ(scene_with({"title=12"}).title, "12");
  EXPECT_EQ(scene_with({"title=true"}).title, "true");
  EXPECT_EQ(scene_with({"model.beta=auto"}).model.beta, std::nullopt);
  EXPECT_EQ(scene_with({"title=a=b"}).title, "a=b");
}

TEST(Override, ReachesIntoLists) {
  const Scene scene = scene_with({"support.1.z=50%", "support.0.x=0.25"});
  EXPECT_TRUE(scene.supports[1].displacement[2]->relative);
  EXPECT_EQ(scene.supports[1].displacement[2]->value, 0.5);
  EXPECT_EQ(scene.supports[0].displacement[0]->value, 0.25);
}

TEST(Override, MakesWhatIsNotThere) {
  EXPECT_EQ(scene_with({"sets.far.side=+x"}).sets.back().name, "far");
  EXPECT_EQ(scene_with({"fracture.strength=4e5"}).fracture->strength, 4e5);
  EXPECT_EQ(scene_with({"sets.\"a.b\".side=+x"}).sets.back().name, "a.b");
}

TEST(Override, EmptyValueTakesOut) {
  EXPECT_EQ(scene_with({"model.beta="}).model.beta, std::nullopt);
  EXPECT_EQ(scene_with({"support.1="}).supports.size(), 1U);
  EXPECT_FALSE(scene_with({"fracture.strength="}).fracture);
  EXPECT_TRUE(scene_with({"sets.tip="}).sets.size() == 1U);
}

TEST(Override, WhatIsNotThereIsOutAlreadyAndWhatNoSceneHasIsAnError) {
  for (const char* out : {"fracture=", "pull.0=", "pull.0.by=", "support.7=", "sets.none=", "sets.none.side="})
    EXPECT_EQ(scene_with({out}).supports.size(), 2U) << out;
  const auto line = [](const std::string& override) { return message_of(kGood, {override}); };
  EXPECT_EQ(line("model.beat="), "--set model.beat=: unknown key 'model.beat' (did you mean 'beta'?)");
  EXPECT_EQ(line("dynamics.stpe="), "--set dynamics.stpe=: unknown key 'dynamics.stpe' (did you mean 'step'?)");
  EXPECT_EQ(line("support.0.w="), "--set support.0.w=: unknown key 'support.0.w' (known: set, x, y, z)");
  EXPECT_EQ(line("sets.far.sdie="), "--set sets.far.sdie=: unknown key 'sets.far.sdie' (did you mean 'side'?)");
  EXPECT_EQ(line("dynamcis="), "--set dynamcis=: unknown key 'dynamcis' (did you mean 'dynamics'?)");
}

TEST(Override, LaterOnesWin) { EXPECT_EQ(scene_with({"model.beta=1", "model.beta=2"}).model.beta, 2.0); }

TEST(Override, ErrorsNameIt) {
  const auto line = [](const std::string& override) { return message_of(kGood, {override}); };
  EXPECT_EQ(line("material.poisson=0.5"),
            "--set material.poisson=0.5: 'material.poisson' is 0.5 (give a number, more than -1 and less than 0.5)");
  EXPECT_EQ(line("model.beat=1"), "--set model.beat=1: unknown key 'model.beat' (did you mean 'beta'?)");
  EXPECT_EQ(line("materail.young=1"), "--set materail.young=1: unknown section 'materail' (did you mean 'material'?)");
  EXPECT_EQ(line("pull.0.seconds=1"), "--set pull.0.seconds=1: 'pull' has no entry '0' (it is empty)");
  EXPECT_EQ(line("support.2.x=1"), "--set support.2.x=1: 'support' has no entry '2' (support.0 to support.1)");
  EXPECT_EQ(line("support.first.x=1"),
            "--set support.first.x=1: 'support' has no entry 'first' (support.0 to support.1)");
  EXPECT_EQ(line("title.a=1"), "--set title.a=1: 'title' is text, it holds no 'a'");
  EXPECT_EQ(line("model.beta"), "--set model.beta: no '=' in it (--set key=value, as in --set model.beta=0)");
  EXPECT_EQ(line("=3"), "--set =3: not a key before the '=' (a dotted name, as in --set model.beta=0)");
  EXPECT_EQ(line("a b=3"), "--set a b=3: not a key before the '=' (a dotted name, as in --set model.beta=0)");
  EXPECT_EQ(line("model.beta=1e"), "--set model.beta=1e: 'model.beta' is '1e' (give \"auto\" or a number, 0 to 1e9)");
  EXPECT_EQ(line("mesh.file=a.msh"),
            "--set mesh.file=a.msh: 'mesh.file' and 'mesh.generate' are both given (give one of them)");
  EXPECT_EQ(line("model.beta=1\ntitle=2"),
            "--set model.beta=1?title=2: not a line of text in UTF-8 (--set key=value, as in --set model.beta=0)");
  EXPECT_EQ(line("title=\xff"),
            "--set title=\xff: not a line of text in UTF-8 (--set key=value, as in --set model.beta=0)");
  EXPECT_EQ(line("title=\x01"),
            "--set title=?: not a line of text in UTF-8 (--set key=value, as in --set model.beta=0)");
  EXPECT_EQ(line("material="),
            "s.toml: [material] is missing (a section with density, young, poisson, law, c1, c2, kappa)");
}

// No TOML, and yet no text.
TEST(Override, NumbersBeyond64BitsAreTooLarge) {
  const auto line = [](const std::string& override) { return message_of(kGood, {override}); };
  EXPECT_EQ(line("material.young=1e400"),
            "--set material.young=1e400: 'material.young' is 1e400, a number too large (give a number in Pa, 0.001 to "
            "1e15)");
  EXPECT_EQ(line("mesh.nodes=99999999999999999999"),
            "--set mesh.nodes=99999999999999999999: 'mesh.nodes' is 99999999999999999999, a number too large (give an "
            "integer, 4 to 4000000)");
  EXPECT_EQ(line("model.beta=1e400"),
            "--set model.beta=1e400: 'model.beta' is 1e400, a number too large (give \"auto\" or a number, 0 to 1e9)");
  EXPECT_EQ(
      line("support.1.z=-1e400"),
      "--set support.1.z=-1e400: 'support.1.z' is -1e400, a number too large (give a number in m, or a percentage "
      "of the body's box as \"50%\", -1000000 to 1000000)");
  EXPECT_EQ(line("material.young=soft"),
            "--set material.young=soft: 'material.young' is text (give a number in Pa, 0.001 to 1e15)");
  EXPECT_EQ(scene_with({"title=1e400"}).title, "1e400");
}

}  // namespace
}  // namespace rhexis::scene::test
