// Scenes that meet their mesh: sets, supports, loads, and the mistakes that only then show.

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "mesh/generate.h"
#include "mesh/io/mesh_file.h"
#include "mesh/surface.h"
#include "model/stabilisation.h"
#include "scene/problem.h"
#include "scene/tear_problem.h"
#include "tests/scene/scene_text.h"

namespace rhexis::scene::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Problem build(const std::string& text, const std::string& file = "s.toml") {
  const Expected<Scene> scene = parse_scene(text, file);
  EXPECT_TRUE(scene) << scene.error().message();
  if (!scene) return {};
  Expected<Problem> problem = build_problem(*scene);
  EXPECT_TRUE(problem) << problem.error().message();
  return problem ? std::move(*problem) : Problem{};
}

std::string build_message(const std::string& text, const std::vector<std::string>& overrides = {},
                          const std::string& file = "s.toml") {
  const Expected<Scene> scene = parse_scene(text, file, overrides);
  if (!scene) return scene.error().message();
  const Expected<Problem> problem = build_problem(*scene);
  return problem ? "good" : problem.error().message();
}

std::vector<Vec3> positions(const Problem& problem, const std::string& set) {
  std::vector<Vec3> out;
  const mesh::NodeSet* nodes = problem.mesh.find_node_set(set);
  EXPECT_NE(nodes, nullptr) << set;
  if (nodes != nullptr)
    for (const NodeId node : nodes->nodes) out.push_back(problem.mesh.node(node));
  return out;
}

TEST(Problem, OfTheGoodScene) {
  const Problem problem = build(kGood);
  EXPECT_EQ(problem.title, "Bar");
  EXPECT_NEAR(static_cast<double>(problem.mesh.node_count()), 200.0, 4.0);
  EXPECT_EQ(problem.model->name(), "hyperelastic");
  EXPECT_EQ(problem.settings.beta, 100.0);
  EXPECT_EQ(problem.options.steps, 4);

  // Every component of the wall at 0, the tip's z by -10% of the height of 0.01 m.
  const std::size_t wall = problem.mesh.find_node_set("wall")->nodes.size();
  const NodeId tip = problem.mesh.find_node_set("tip")->nodes.at(0);
  EXPECT_EQ(problem.mesh.node(tip), Vec3(0.04, 0.0, 0.0));
  ASSERT_EQ(problem.loading.supports.size(), 3 * wall + 1);
  for (std::size_t i = 1; i < problem.loading.supports.size(); ++i)
    EXPECT_LT(problem.loading.supports[i - 1].dof, problem.loading.supports[i].dof);
  for (const model::PrescribedDof& dof : problem.loading.supports)
    EXPECT_EQ(dof.value, dof.dof == 3 * tip.value() + 2 ? -0.001 : 0.0);

  // The weight of 4 cm3 of water, to the rounding of a sum over the nodes.
  Vec3 weight = Vec3::Zero();
  for (Eigen::Index i = 0; i < problem.loading.dead_force.size(); i += 3)
    weight += problem.loading.dead_force.segment<3>(i);
  EXPECT_NEAR(weight[2], -1000.0 * 9.81 * 4e-6, 1e-14);
  EXPECT_NEAR(weight.head<2>().norm(), 0.0, 1e-17);
}

TEST(Problem, SetsHoldWhatTheirWordsSay) {
  const std::string sets = R"([sets.middle]
box = { from = [0.5, 0.0, 0.0], to = [1.0, 1.0, 1.0] }
[sets.all]
box = { from = [0, 0, 0], to = [1, 1, 1] }
[sets.listed]
nodes = [5, 3, 5]
[sets.far]
side = "+x"
)";
  const Problem problem = build(spoil("[material]", sets + "[material]"));
  for (const Vec3& x : positions(problem, "wall")) EXPECT_EQ(x[0], 0.0);
  EXPECT_EQ(positions(problem, "wall").size(), positions(problem, "-x").size());
  for (const Vec3& x : positions(problem, "far")) EXPECT_EQ(x[0], 0.04);
  EXPECT_EQ(positions(problem, "all").size(), problem.mesh.node_count());
  std::size_t beyond = 0;
  for (const Vec3& x : problem.mesh.nodes) beyond += x[0] >= 0.02 - 1e-12 ? 1 : 0;
  EXPECT_EQ(positions(problem, "middle").size(), beyond);
  EXPECT_GT(beyond, 0U);
  EXPECT_LT(beyond, problem.mesh.node_count());
  EXPECT_THAT(problem.mesh.find_node_set("listed")->nodes, ElementsAre(NodeId(3), NodeId(5)));

  // A side is a face set too, its area that of the side.
  double area = 0.0;
  for (const mesh::TetFace face : problem.mesh.find_face_set("far")->faces) area += mesh::face_area(problem.mesh, face);
  EXPECT_NEAR(area, 1e-4, 1e-18);
  EXPECT_EQ(problem.mesh.find_face_set("middle"), nullptr);
}

TEST(Problem, ASetOfTheSceneStandsInForTheMeshs) {
  const Problem problem =
      build(spoil("[sets.wall]\nside = \"-x\"", "[sets.wall]\nside = \"-x\"\n[sets.\"+x\"]\nnodes = [7]"));
  EXPECT_THAT(problem.mesh.find_node_set("+x")->nodes, ElementsAre(NodeId(7)));
  EXPECT_EQ(problem.mesh.find_face_set("+x"), nullptr);
  EXPECT_THAT(problem.notes, testing::Contains("set '+x' of the scene stands in for the one of the mesh"));
}

TEST(Problem, LoadsOnFaces) {
  const Problem problem =
      build(spoil("", "[[traction]]\nside = \"+x\"\nforce = [1, 2, 3]\n[[pressure]]\nset = \"+z\"\nvalue = 500\n",
                  spoil("gravity = [0.0, 0.0, -9.81]", "")));
  Vec3 force = Vec3::Zero();
  for (Eigen::Index i = 0; i < problem.loading.dead_force.size(); i += 3) {
    const Vec3 at_node = problem.loading.dead_force.segment<3>(i);
    force += at_node;
    const bool on_side = problem.mesh.nodes[static_cast<std::size_t>(i) / 3][0] == 0.04;
    EXPECT_EQ(at_node.norm() > 0.0, on_side);
  }
  EXPECT_NEAR((force - Vec3(1, 2, 3)).norm(), 0.0, 1e-14);
  ASSERT_EQ(problem.loading.pressures.size(), 1U);
  EXPECT_EQ(problem.loading.pressures[0].pressure, 500.0);
  EXPECT_EQ(problem.loading.pressures[0].triangles.size(), 3 * problem.mesh.find_face_set("+z")->faces.size());
}

TEST(Problem, QuadraticElementsHoldTheMiddlesOfEdges) {
  const Problem p1 = build(kGood);
  const Problem p2 = build(spoil("\"hyperelastic\"\nbeta = 100.0", "\"taylor-hood\""));
  const model::DisplacementSpace& space = p2.model->space();
  EXPECT_EQ(space.order, 2);
  std::size_t on_wall = 0;
  for (const Vec3& x : space.nodes) on_wall += x[0] == 0.0 ? 1 : 0;
  EXPECT_EQ(p2.loading.supports.size(), 3 * on_wall + 1);
  EXPECT_GT(on_wall, p1.mesh.find_node_set("wall")->nodes.size());
  EXPECT_EQ(p2.loading.dead_force.size(), static_cast<Eigen::Index>(space.dof_count()));
}

TEST(Problem, EveryModelIsMade) {
  for (const std::string_view kind : model::kModelNames) {
    const Problem problem = build(spoil("\"hyperelastic\"\nbeta = 100.0", '"' + std::string(kind) + '"'));
    ASSERT_NE(problem.model, nullptr);
    EXPECT_EQ(problem.model->name(), kind);
  }
}

TEST(Problem, AutoBetaIsResolvedAndSaid) {
  const Problem problem = build(spoil("beta = 100.0", "beta = \"auto\""));
  EXPECT_EQ(problem.settings.beta, model::auto_beta(problem.settings.law));
  EXPECT_THAT(problem.notes, testing::Contains(testing::StartsWith("beta = ")));
}

TEST(Problem, SmoothingBeyondTheBodyIsWarnedOf) {
  EXPECT_THAT(build(spoil("beta = 100.0", "beta = 1e4")).warnings,
              ElementsAre(AllOf(HasSubstr("beta = 1e+04 smooths lambda over"),
                                HasSubstr("(a smaller beta or a finer mesh would resolve more)"))));
  // What "auto" chose locks when it is made smaller.
  EXPECT_THAT(build(spoil("nodes = 200", "nodes = 20",
                          spoil("beta = 100.0", "beta = \"auto\"", spoil("poisson = 0.45", "poisson = 0.4999"))))
                  .warnings,
              ElementsAre(HasSubstr("(a finer mesh would resolve more)")));
  EXPECT_THAT(build(spoil("beta = 100.0", "beta = 1e-4")).warnings, IsEmpty());
  EXPECT_THAT(build(spoil("beta = 100.0", "beta = 0")).warnings, IsEmpty());
}

TEST(Problem, NothingActingIsWarnedOf) {
  const std::string idle =
      spoil("z = \"-10%\"", "z = 0", spoil("gravity = [0.0, 0.0, -9.81]", "", spoil("beta = 100.0", "beta = 0")));
  EXPECT_THAT(build(idle).warnings, ElementsAre("s.toml: nothing acts on the body: no load, and no support moves"));
  EXPECT_THAT(build(idle + "[[pull]]\nat = [0, 0, 0]\nby = [0, 0, 1]\n").warnings,
              ElementsAre("s.toml:34: 'pull' is not read by `rhexis solve` (`rhexis tear` reads it)"));
}

TEST(Problem, WhatIsSaidOfTearingIsNotRead) {
  const std::string crack = "[[crack]]\nfrom = [0, 0, 0]\nto = [0.01, 0, 0]\n";
  const std::string pull = "[[pull]]\nat = [0, 0, 0]\nby = [0, 0, 1]\n";
  const std::string text = spoil("beta = 100.0", "beta = 0") + "[fracture]\nstrength = 1e5\n" + crack + crack +
                           "[dynamics]\n[interaction]\nmax_force = 3.0\n" + pull + pull;
  EXPECT_THAT(build(text).warnings,
              ElementsAre("s.toml:42: 'dynamics' is not read by `rhexis solve` (`rhexis tear` reads it)",
                          "s.toml:34: 'fracture' is not read by `rhexis solve` (`rhexis tear` reads it)",
                          "s.toml:36: 'crack' is not read by `rhexis solve` (`rhexis tear` reads it)",
                          "s.toml:43: 'interaction' is not read by `rhexis solve` (`rhexis tear` reads it)",
                          "s.toml:45: 'pull' is not read by `rhexis solve` (`rhexis tear` reads it)"));
}

TEST(Problem, AFreeRimUnderPressureTakesTheDirectSolver) {
  const auto with = [](const std::string& linear, const std::string& side) {
    return build_message(spoil("steps = 4", "linear = \"" + linear + '"') + "[[pressure]]\nside = \"" + side +
                         "\"\nvalue = 500\n");
  };
  for (const std::string linear : {"cg", "minres"}) {
    EXPECT_EQ(with(linear, "+z"),
              "s.toml:35: a follower pressure on a surface with a free rim makes the tangent non-symmetric, which '" +
                  linear + "' cannot solve (linear = \"direct\", or hold the rim)");
    EXPECT_EQ(with(linear, "-x"), "good");  // held as a whole, its rim too
  }
  EXPECT_EQ(with("direct", "+z"), "good");
}

struct Broken {
  std::string name;
  std::string old;
  std::string with;
  std::string line;
};
class BrokenProblem : public testing::TestWithParam<Broken> {};
TEST_P(BrokenProblem, PrintsItsLine) {
  const Broken& broken = GetParam();
  EXPECT_EQ(build_message(spoil(broken.old, broken.with)), broken.line);
}

const std::vector<Broken> kBroken{
    {"unknown_set", "set = \"wall\"", "set = \"wal\"", "s.toml:24: there is no set 'wal' (did you mean 'wall'?)"},
    {"unknown_set_far_off", "set = \"wall\"", "set = \"aorta\"",
     "s.toml:24: there is no set 'aorta' (known: -x, +x, -y, +y, -z, +z, wall, tip)"},
    {"empty_box", "side = \"-x\"", "box = { from = [0.01, 0.01, 0.01], to = [0.011, 0.011, 0.011] }",
     "s.toml:10: set 'wall' holds no node (a larger box, in fractions of the bounding box)"},
    {"no_such_node", "side = \"-x\"", "nodes = [1, 100000]", "s.toml:10: there is no node 100000 (0 to 199)"},
    {"empty_list", "side = \"-x\"", "nodes = []",
     "s.toml:10: set 'wall' holds no node (numbers of nodes that a tet has)"},
    {"fixed_twice", "set = \"tip\"\nz = \"-10%\"", "set = \"-x\"\nz = 0.5",
     "s.toml:30: z of node 0 (set '-x') is fixed at 0.5 m, but at 0 m by line 27 (set 'wall') (one value for each "
     "component of a node)"},
    {"fixed_twice_by_percentage", "set = \"tip\"\nz = \"-10%\"", "set = \"-x\"\ny = \"50%\"",
     "s.toml:30: y of node 0 (set '-x') is fixed at 0.005 m, but at 0 m by line 26 (set 'wall') (one value for each "
     "component of a node)"},
    {"fixed_twice_nearly", "z = 0.0\n[[support]]\nset = \"tip\"\nz = \"-10%\"",
     "z = 1e-3\n[[support]]\nset = \"-x\"\nz = 1.00000001e-3",
     "s.toml:30: z of node 0 (set '-x') is fixed at 0.00100000001 m, but at 0.001 m by line 27 (set 'wall') (one value "
     "for "
     "each component of a node)"},
    {"no_face_set", "", "[[traction]]\nset = \"outlet\"\nforce = [0, 0, 1]\n",
     "s.toml:35: there is no face set 'outlet' (known: -x, +x, -y, +y, -z, +z, wall)"},
    {"no_face_set_near", "", "[[pressure]]\nset = \"wal\"\nvalue = 1\n",
     "s.toml:35: there is no face set 'wal' (did you mean 'wall'?)"},
    {"set_without_faces", "", "[[pressure]]\nset = \"tip\"\nvalue = 1\n",
     "s.toml:35: set 'tip' has no faces (a surface of the mesh, or a set by side where the body is flat)"},
    {"nothing_holds",
     "[[support]]\nset = \"wall\"\nx = 0.0\ny = 0.0\nz = 0.0\n[[support]]\nset = \"tip\"\nz = \"-10%\"\n", "",
     "s.toml: nothing holds the body (add a [[support]])"},
    {"slides", "x = 0.0\ny = 0.0\nz = 0.0\n", "x = 0.0\nz = 0.0\n",
     "s.toml:23: the supports leave the body a free rigid motion: translation along y (hold another component, or more "
     "nodes)"},
    {"rolls", "x = 0.0\ny = 0.0\nz = 0.0\n", "x = 0.0\n",
     "s.toml:23: the supports leave the body a free rigid motion: translation along y, rotation about an axis along x "
     "through "
     "(0.02, 0, 0.005) m (hold another component, or more nodes)"},
    {"no_mesh_file", "generate = \"bar\"", "file = \"none.msh\"",
     "s.toml:5: there is no mesh file 'none.msh' (a path relative to the scene)"},
};
std::string name_of(const testing::TestParamInfo<Broken>& broken) { return broken.param.name; }
INSTANTIATE_TEST_SUITE_P(Table, BrokenProblem, testing::ValuesIn(kBroken), name_of);

TEST(BrokenProblem, OverridesAreNamedInIt) {
  EXPECT_EQ(build_message(kGood, {"support.1.set=-x"}),
            "s.toml:30: z of node 0 (set '-x') is fixed at -0.001 m, but at 0 m by line 27 (set 'wall') (one value for "
            "each component of a node)");
  EXPECT_EQ(build_message(spoil("set = \"tip\"", "set = \"-x\""), {"support.0.z=0.25"}),
            "s.toml:30: z of node 0 (set '-x') is fixed at -0.001 m, but at 0.25 m by --set support.0.z=0.25 (set "
            "'wall') (one value "
            "for each component of a node)");
  EXPECT_EQ(build_message(kGood, {"support.0.set=tipp"}),
            "--set support.0.set=tipp: there is no set 'tipp' (did you mean 'tip'?)");
}

TEST(BrokenProblem, AnEdgeIsAHinge) {
  const std::string edge = spoil("side = \"-x\"", "box = { from = [0, 0, 0], to = [0, 1, 0] }");
  EXPECT_EQ(build_message(spoil("set = \"tip\"\nz = \"-10%\"", "set = \"wall\"\nz = 0.0", edge)),
            "s.toml:23: the supports leave the body a free rigid motion: rotation about an axis along y through (0, "
            "0.005, 0) m "
            "(hold another component, or more nodes)");
}

TEST(BrokenProblem, TheSameValueTwiceIsNone) {
  EXPECT_EQ(build_message(spoil("", "[[support]]\nset = \"+x\"\nz = -0.001\n")), "good");  // the tip's -10% of 0.01 m
}

class FromFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const mesh::TetMesh& mesh) {
    EXPECT_TRUE(mesh::write_mesh_file(folder_ / "body.msh", mesh));
    return spoil("generate = \"bar\"\nsize = [0.04, 0.01, 0.01]\nnodes = 200", "file = \"body.msh\"\nunit = \"mm\"");
  }
  std::string scene_file() const { return (folder_ / "s.toml").string(); }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("rhexis_scene_test" + std::to_string(::getpid()));
};

TEST_F(FromFile, UnitsAndSetsComeWithIt) {
  const mesh::TetMesh mesh = mesh::make_structured_box({40.0, 10.0, 10.0}, {8, 2, 2});
  std::string text = spoil("set = \"wall\"", "set = \"-x\"", write(mesh));
  text = spoil("[sets.wall]\nside = \"-x\"\n", "", text);
  const Problem problem = build(text, scene_file());
  EXPECT_EQ(problem.mesh.node_count(), mesh.node_count());
  EXPECT_NEAR(mesh::total_volume(problem.mesh), 4e-6, 1e-18);
}

TEST_F(FromFile, DefectsNameTheTet) {
  mesh::TetMesh mesh = mesh::make_structured_box({40.0, 10.0, 10.0}, {4, 1, 1});
  mesh.tets.push_back(mesh.tets[3]);
  mesh.tets.push_back(mesh.tets[3]);
  const std::string text = write(mesh);
  const std::string name = (folder_ / "body.msh").string();
  EXPECT_EQ(build_message(text, {}, scene_file()),
            name + ": tet 20 has the same nodes as tet 3 (`rhexis mesh info " + name + "` lists all 2 defects)");
}

TEST_F(FromFile, NodesWithoutATetAreHeld) {
  mesh::TetMesh mesh = mesh::make_structured_box({40.0, 10.0, 10.0}, {4, 1, 1});
  mesh.nodes.emplace_back(500.0, 0.0, 0.0);  // far off: not part of the box either
  const std::string text = write(mesh);
  const Expected<mesh::MeshFile> read = mesh::read_mesh_file(folder_ / "body.msh");
  ASSERT_TRUE(read);
  if (read->mesh.node_count() != mesh.node_count()) GTEST_SKIP() << "the reader leaves such nodes out";
  const Problem problem = build(text, scene_file());
  const auto stray = static_cast<std::int32_t>(3 * (mesh.node_count() - 1));
  ASSERT_GE(problem.loading.supports.size(), 3U);
  for (int axis = 0; axis < 3; ++axis) {
    const model::PrescribedDof& dof =
        problem.loading.supports[problem.loading.supports.size() - 3 + static_cast<std::size_t>(axis)];
    EXPECT_EQ(dof.dof, stray + axis);
    EXPECT_EQ(dof.value, 0.0);
  }
  EXPECT_EQ(problem.mesh.node(problem.mesh.find_node_set("tip")->nodes[0])[0], 0.04);
}

TEST_F(FromFile, EndlessWeight) {
  const std::string text = write(mesh::make_structured_box({4e104, 1e104, 1e104}, {4, 1, 1}));  // 4e303 m3, 1e6 kg/m3
  EXPECT_EQ(
      build_message(spoil("density = 1000.0", "density = 1e6", spoil("\"-10%\"", "0.0", text)), {}, scene_file()),
      scene_file() + ": the loads are too large for a computer's numbers (a smaller density, gravity or traction)");
}

TEST_F(FromFile, ErrorsInTheFileNameIt) {
  std::ofstream(folder_ / "body.msh") << "not a mesh\n";
  const std::string line = build_message(spoil("generate = \"bar\"", "file = \"body.msh\""), {}, scene_file());
  EXPECT_THAT(line, testing::StartsWith((folder_ / "body.msh").string()));
}

class ShippedScene : public testing::TestWithParam<std::string> {};
TEST_P(ShippedScene, IsGoodForEveryModel) {
  const std::filesystem::path path = std::filesystem::path(RHEXIS_SOURCE_DIR) / "scenes" / GetParam();
  const Expected<Scene> scene = read_scene(path);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_FALSE(scene->title.empty());
  EXPECT_THAT(scene->warnings, IsEmpty());
  for (const std::string_view kind : model::kModelNames) {
    const Expected<Scene> other = read_scene(path, {"model.kind=" + std::string(kind)});
    ASSERT_TRUE(other) << other.error().message();
    const Expected<Problem> problem = build_problem(*other);
    EXPECT_TRUE(problem) << problem.error().message();
  }
  // The head says what it shows and how to run it.
  std::ifstream file(path);
  std::string head(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(head[0], '#');
  const std::string command = is_for_tearing(*scene) ? "tear" : "solve";
  EXPECT_THAT(head, HasSubstr("#   rhexis " + command + " scenes/" + GetParam()));
}

std::vector<std::string> shipped() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(RHEXIS_SOURCE_DIR) / "scenes"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}
std::string name_of_scene(const testing::TestParamInfo<std::string>& shipped_scene) {
  std::string name = shipped_scene.param.substr(0, shipped_scene.param.find('.'));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shipped()), name_of_scene);

TEST(ShippedScenes, VesselIsThePapers) {
  const Expected<Scene> scene = read_scene(std::filesystem::path(RHEXIS_SOURCE_DIR) / "scenes/vessel.toml");
  ASSERT_TRUE(scene) << scene.error().message();
  const Expected<Problem> problem = build_problem(*scene);
  ASSERT_TRUE(problem) << problem.error().message();
  EXPECT_NEAR(static_cast<double>(problem->mesh.node_count()), 401.0, 8.0);
  EXPECT_NEAR((mesh::bounding_box(problem->mesh).size() - Vec3(0.01, 0.01, 0.04)).norm(), 0.0, 2e-4);
  EXPECT_EQ(scene->material.law.c1, 8.395e4);
  EXPECT_EQ(scene->material.law.kappa, 4.167e6);
  EXPECT_EQ(problem->settings.beta, 100.0);
  EXPECT_EQ(problem->settings.initial_lambda, 300.0);
}

}  // namespace
}  // namespace rhexis::scene::test
