// Scenes that are right, and every value that they come to.

#include <gmock/gmock.h>

#include "tests/scene/scene_text.h"

namespace rhexis::scene::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Scene scene_of(const std::string& text) {
  Expected<Scene> scene = parse_scene(text, "folder/s.toml");
  EXPECT_TRUE(scene) << scene.error().message();
  return scene ? std::move(*scene) : Scene{};
}

const std::string kEverything = R"(
title = "Vessel"
gravity = [0.0, 0.0, -9.81]
[mesh]
file = "vessel.msh"
unit = "mm"
[sets.top]
side = "+z"
[sets.belt]
box = { from = [0.0, 0.0, 0.45], to = [0.5, 1.0, 0.55] }
[sets.tip]
nearest = [0.0, 0.0, 0.04]
[sets.picked]
nodes = [3, 17, 42]
[material]
density = 510.0
young = 1.0e6
poisson = 0.49
law = "mooney-rivlin"
c1 = 8.395e4
c2 = 8.395e4
kappa = 4.167e6
[model]
kind = "hyperelastic"
beta = 100.0
initial_lambda = 300.0
[[support]]
set = "top"
x = 0.0
y = 1
z = "-30%"
[[support]]
set = "belt"
x = " +50 % "
[[traction]]
set = "cut"
force = [0.0, 50.0, 0.0]
[[traction]]
side = "+x"
force = [1, 2, 3]
[[pressure]]
set = "inner"
value = 1.0e4
[solver]
linear = "minres"
tolerance = 1e-6
steps = 3
max_iterations = 31
max_cuts = 5
threads = 2
[fracture]
criterion = "von-mises"
strength = 0.4e6
advance_threshold = 0.2e6
ahead_only = false
local_radius = 0.04
incision = "split"
[[crack]]
from = [0.12, 0.0, 0.0]
to = [0.12, 0.06, 0.0]
through = [0.0, 0.0, 1.0]
[interaction]
response = "recorded"
record = "plate.h5"
max_force = 4
[[pull]]
at = [0.10, 0.0, 0.005]
by = [-0.12, 0.0, 0.0]
seconds = 2.0
hold = 0.5
wait = 0.25
)";

TEST(GoodScene, EverythingIsRead) {
  const Scene scene = scene_of(kEverything);
  EXPECT_EQ(scene.file, "folder/s.toml");
  EXPECT_EQ(scene.title, "Vessel");
  EXPECT_EQ(scene.gravity, Vec3(0.0, 0.0, -9.81));
  const auto& mesh = std::get<MeshFromFile>(scene.mesh.source);
  EXPECT_EQ(mesh.path, "folder/vessel.msh");
  EXPECT_EQ(mesh.unit, 1e-3);
  EXPECT_EQ(scene.mesh.place.line, 5);

  ASSERT_EQ(scene.sets.size(), 4U);
  EXPECT_EQ(scene.sets[0].name, "top");
  EXPECT_EQ(std::get<Side>(scene.sets[0].choice).axis, 2);
  EXPECT_TRUE(std::get<Side>(scene.sets[0].choice).upper);
  EXPECT_EQ(scene.sets[0].place.line, 8);
  EXPECT_EQ(std::get<Box>(scene.sets[1].choice).from, Vec3(0.0, 0.0, 0.45));
  EXPECT_EQ(std::get<Box>(scene.sets[1].choice).to, Vec3(0.5, 1.0, 0.55));
  EXPECT_EQ(std::get<Vec3>(scene.sets[2].choice), Vec3(0.0, 0.0, 0.04));
  EXPECT_THAT(std::get<std::vector<std::int64_t>>(scene.sets[3].choice), ElementsAre(3, 17, 42));

  EXPECT_EQ(scene.material.density, 510.0);
  EXPECT_EQ(scene.material.elastic.young, 1e6);
  EXPECT_EQ(scene.material.elastic.poisson, 0.49);
  EXPECT_EQ(scene.material.law.c1, 8.395e4);
  EXPECT_EQ(scene.material.law.c2, 8.395e4);
  EXPECT_EQ(scene.material.law.kappa, 4.167e6);
  EXPECT_EQ(scene.model.kind, model::ModelKind::hyperelastic);
  EXPECT_EQ(scene.model.beta, 100.0);
  EXPECT_EQ(scene.model.initial_lambda, 300.0);

  ASSERT_EQ(scene.supports.size(), 2U);
  EXPECT_EQ(scene.supports[0].set, "top");
  EXPECT_EQ(scene.supports[0].place.line, 27);
  EXPECT_EQ(scene.supports[0].displacement[0]->value, 0.0);
  EXPECT_EQ(scene.supports[0].displacement[1]->value, 1.0);
  EXPECT_FALSE(scene.supports[0].displacement[1]->relative);
  EXPECT_EQ(scene.supports[0].displacement[2]->value, -0.3);
  EXPECT_TRUE(scene.supports[0].displacement[2]->relative);
  EXPECT_EQ(scene.supports[0].displacement_place[2].line, 31);
  EXPECT_EQ(scene.supports[1].displacement[0]->value, 0.5);
  EXPECT_FALSE(scene.supports[1].displacement[1]);
  EXPECT_FALSE(scene.supports[1].displacement[2]);

  ASSERT_EQ(scene.tractions.size(), 2U);
  EXPECT_EQ(std::get<std::string>(scene.tractions[0].faces.set), "cut");
  EXPECT_EQ(scene.tractions[0].force, Vec3(0.0, 50.0, 0.0));
  EXPECT_EQ(std::get<Side>(scene.tractions[1].faces.set).name, "+x");
  EXPECT_EQ(scene.tractions[1].force, Vec3(1.0, 2.0, 3.0));
  ASSERT_EQ(scene.pressures.size(), 1U);
  EXPECT_EQ(scene.pressures[0].value, 1e4);

  EXPECT_EQ(scene.solver.options.linear, "minres");
  EXPECT_EQ(scene.solver.options.tolerance, 1e-6);
  EXPECT_EQ(scene.solver.options.steps, 3);
  EXPECT_EQ(scene.solver.options.max_iterations, 31);
  EXPECT_EQ(scene.solver.options.max_cuts, 5);
  EXPECT_EQ(scene.solver.threads, 2);

  ASSERT_TRUE(scene.fracture);
  EXPECT_EQ(scene.fracture->criterion, "von-mises");
  EXPECT_EQ(scene.fracture->strength, 0.4e6);
  EXPECT_EQ(scene.fracture->advance_threshold, 0.2e6);
  EXPECT_FALSE(scene.fracture->toughness);
  EXPECT_FALSE(scene.fracture->ahead_only);
  EXPECT_EQ(scene.fracture->local_radius, 0.04);
  EXPECT_EQ(scene.fracture->incision, "split");
  ASSERT_EQ(scene.cracks.size(), 1U);
  EXPECT_EQ(scene.cracks[0].line.to, Vec3(0.12, 0.06, 0.0));
  EXPECT_EQ(scene.interaction.response, "recorded");
  EXPECT_EQ(scene.interaction.record, "folder/plate.h5");
  EXPECT_EQ(scene.interaction.max_force, 4.0);
  ASSERT_EQ(scene.pulls.size(), 1U);
  EXPECT_EQ(scene.pulls[0].by, Vec3(-0.12, 0.0, 0.0));
  EXPECT_EQ(scene.pulls[0].seconds, 2.0);
  EXPECT_EQ(scene.pulls[0].hold, 0.5);
  EXPECT_EQ(scene.pulls[0].wait, 0.25);

  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(scene.notes, IsEmpty());
}

const std::string kLeast = R"(
[mesh]
generate = "cube"
size = [1, 1, 1]
nodes = 100
[material]
young = 1
poisson = 0
)";

TEST(GoodScene, DefaultsAreThoseOfTheRooms) {
  const Scene scene = scene_of(kLeast);
  const solver::Options options;
  EXPECT_EQ(scene.solver.options.linear, options.linear);
  EXPECT_EQ(scene.solver.options.tolerance, options.tolerance);
  EXPECT_EQ(scene.solver.options.steps, options.steps);
  EXPECT_EQ(scene.solver.options.max_iterations, options.max_iterations);
  EXPECT_EQ(scene.solver.options.max_cuts, options.max_cuts);
  const model::ModelSettings model;
  EXPECT_EQ(scene.model.kind, model.kind);
  EXPECT_EQ(scene.model.beta, std::nullopt);
  EXPECT_EQ(scene.model.initial_lambda, model.initial_lambda);
  EXPECT_EQ(scene.model.corotated_tangent, model.corotated_tangent);
  const mesh::TubeShape tube;
  const Scene tubular = scene_of(
      "[mesh]\ngenerate = \"tube\"\nradius = 1\nlength = 5\nnodes = 400\n[material]\nyoung = 1\npoisson = 0\n");
  EXPECT_EQ(std::get<GeneratedTube>(tubular.mesh.source).shape.wall, tube.wall);
  EXPECT_EQ(std::get<GeneratedTube>(tubular.mesh.source).shape.bend, tube.bend);
  EXPECT_EQ(scene.gravity, Vec3::Zero());
  EXPECT_EQ(scene.material.density, 0.0);
  EXPECT_FALSE(scene.fracture);
  EXPECT_EQ(scene.interaction.response, "exact");
  EXPECT_EQ(scene.interaction.max_force, 8.9);
}

TEST(GoodScene, TubeBySizeOrByRadius) {
  const auto tube = [](const std::string& keys) {
    const Scene scene =
        scene_of("[mesh]\ngenerate = \"tube\"\nnodes = 400\n" + keys + "[material]\nyoung = 1\npoisson = 0\n");
    return std::get<GeneratedTube>(scene.mesh.source);
  };
  const GeneratedTube by_radius = tube("radius = 0.005\nlength = 0.04\nwall = 0.001\nbend = 30\n");
  EXPECT_EQ(by_radius.shape.radius, 0.005);
  EXPECT_EQ(by_radius.shape.length, 0.04);
  EXPECT_EQ(by_radius.shape.wall, 0.001);
  EXPECT_EQ(by_radius.shape.bend, 30.0);
  EXPECT_EQ(by_radius.nodes, 400);
  const GeneratedTube by_size = tube("size = [0.01, 0.01, 0.04]\n");
  EXPECT_EQ(by_size.shape.radius, 0.005);
  EXPECT_EQ(by_size.shape.length, 0.04);
  EXPECT_EQ(by_size.shape.wall, 0.0);
}

TEST(GoodScene, ModelsByName) {
  for (std::size_t i = 0; i < model::kModelNames.size(); ++i) {
    const std::string name(model::kModelNames[i]);
    EXPECT_EQ(scene_of(kLeast + "[model]\nkind = \"" + name + "\"\n").model.kind, static_cast<model::ModelKind>(i));
  }
  EXPECT_EQ(scene_of(kLeast + "[model]\nkind = \"corotated\"\ncorotated_tangent = \"warped\"").model.corotated_tangent,
            model::CorotatedTangent::warped);
}

TEST(GoodScene, UnitsOfTheMesh) {
  const auto unit = [](const std::string& name) {
    const Scene scene =
        scene_of("[mesh]\nfile = \"/a.vtu\"\nunit = \"" + name + "\"\n[material]\nyoung = 1\npoisson = 0\n");
    EXPECT_EQ(std::get<MeshFromFile>(scene.mesh.source).path, "/a.vtu");
    return std::get<MeshFromFile>(scene.mesh.source).unit;
  };
  EXPECT_EQ(unit("m"), 1.0);
  EXPECT_EQ(unit("dm"), 0.1);
  EXPECT_EQ(unit("cm"), 0.01);
  EXPECT_EQ(unit("mm"), 0.001);
  EXPECT_EQ(unit("um"), 1e-6);
  EXPECT_EQ(unit("in"), 0.0254);
}

TEST(GoodScene, TheFormOfTheMaterialThatIsReadIsConverted) {
  const std::string mesh = "[mesh]\ngenerate = \"cube\"\nsize = [1, 1, 1]\nnodes = 100\n";
  // E = 1 MPa, nu = 0.49: c1 + c2 = E / (4 (1 + nu)), kappa = E / (3 (1 - 2 nu)).
  const std::string elastic = "[material]\nyoung = 1e6\npoisson = 0.49\n";
  const Scene mooney = scene_of(mesh + elastic);
  EXPECT_DOUBLE_EQ(mooney.material.law.c1, 1e6 / (8.0 * 1.49));
  EXPECT_DOUBLE_EQ(mooney.material.law.c2, 1e6 / (8.0 * 1.49));
  EXPECT_NEAR(mooney.material.law.kappa, 1e6 / 0.06, 1e-3);
  EXPECT_THAT(mooney.notes,
              ElementsAre("c1 = 83892.6 Pa, c2 = 83892.6 Pa, kappa = 1.66667e+07 Pa converted from young and poisson"));
  const Scene neo_hookean = scene_of(mesh + elastic + "law = \"neo-hookean\"\n");
  EXPECT_DOUBLE_EQ(neo_hookean.material.law.c1, 1e6 / (4.0 * 1.49));
  EXPECT_EQ(neo_hookean.material.law.c2, 0.0);
  EXPECT_THAT(scene_of(mesh + elastic + "[model]\nkind = \"linear\"\n").notes, IsEmpty());

  const std::string law = "[material]\nc1 = 8.395e4\nc2 = 8.395e4\nkappa = 4.167e6\n";
  const Scene linear = scene_of(mesh + law + "[model]\nkind = \"linear\"\n");
  // The paper's constants: E 0.981 MPa, nu 0.461.
  EXPECT_NEAR(linear.material.elastic.young, 0.981e6, 0.5e3);
  EXPECT_NEAR(linear.material.elastic.poisson, 0.461, 0.5e-3);
  ASSERT_EQ(linear.notes.size(), 1U);
  EXPECT_THAT(linear.notes[0], testing::EndsWith("converted from c1, c2 and kappa"));
  EXPECT_THAT(scene_of(mesh + law).notes, IsEmpty());
}

TEST(GoodScene, WhatIsGivenInVainIsSaid) {
  const Scene linear = scene_of(spoil("\"hyperelastic\"", "\"linear\"\ninitial_lambda = 300"));
  EXPECT_THAT(linear.warnings, ElementsAre("folder/s.toml:22: 'model.beta' is not read by 'linear'",
                                           "folder/s.toml:21: 'model.initial_lambda' is not read by 'linear'"));
  EXPECT_THAT(scene_of(spoil("beta = 100.0", "corotated_tangent = \"warped\"")).warnings,
              ElementsAre("folder/s.toml:21: 'model.corotated_tangent' is not read by 'hyperelastic'"));
  EXPECT_THAT(scene_of(spoil("nodes = 200", "nodes = 200\nunit = \"mm\"\nwall = 0.1")).warnings,
              ElementsAre("folder/s.toml:8: 'mesh.unit' is not read by a generated mesh, which is in metres",
                          "folder/s.toml:9: 'mesh.wall' is not read by generate = \"bar\""));
  EXPECT_THAT(scene_of(spoil("generate = \"bar\"", "file = \"a.msh\"")).warnings,
              ElementsAre("folder/s.toml:6: 'mesh.size' is not read by a mesh from a file",
                          "folder/s.toml:7: 'mesh.nodes' is not read by a mesh from a file"));
  EXPECT_THAT(scene_of(spoil("", "[interaction]\nrecord = \"a.h5\"\n")).warnings, IsEmpty());  // `play` compares
  EXPECT_THAT(scene_of(spoil("", "[fracture]\ntoughness = 300.0\nadvance_threshold = 1e5\n")).warnings,
              ElementsAre("folder/s.toml:36: 'fracture.advance_threshold' is not read by a toughness"));
  EXPECT_THAT(scene_of(spoil("", "[fracture]\nstrength = 2e5\nadvance_threshold = 1e5\n")).warnings, IsEmpty());
  EXPECT_THAT(
      scene_of(spoil("\"hyperelastic\"\nbeta = 100.0", "\"mass-spring\"")).warnings,
      ElementsAre(
          "folder/s.toml: 'mass-spring' has a Poisson's ratio of 1/4, not 0.45: springs on the edges have no other"));
}

TEST(GoodScene, TheRecordIsThatOfTheThesisUnlessItSaysOtherwise) {
  const Scene thesis = *parse_scene(kGood, "s.toml");
  EXPECT_TRUE(thesis.record.parameters == record::store::Parameters{});
  EXPECT_FALSE(thesis.record.single_precision);
  const Scene scene = *parse_scene(kGood + R"([record]
advances = 3
directions = 25
lengths = [0.02, 3e-2]
pull_directions = 72
pull_length = 0.1
precision = "single"
)",
                                   "s.toml");
  EXPECT_TRUE(
      (scene.record.parameters ==
       record::store::Parameters{
           .advances = 3, .directions = 25, .lengths = {0.02, 0.03}, .pull_directions = 72, .pull_length = 0.1}));
  EXPECT_TRUE(scene.record.single_precision);
}

}  // namespace
}  // namespace rhexis::scene::test
