// Real vessels and organs, torn: meshes of others, with tets that no generator of ours makes.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/clock.h"
#include "mesh/io/mesh_file.h"
#include "mesh/quality.h"
#include "session/tear_session.h"
#include "tests/session/interaction_case.h"
#include "tests/support/measured.h"
#include "tests/support/shared_data.h"
#include "tests/support/solved_tets.h"
#include "tests/support/torn_body_oracle.h"

namespace rhexis::session {
namespace {

struct RealBody {
  std::string name;
  std::vector<std::string> held = {};  ///< node sets; empty: the lowest tenth of the body's largest side
  std::string grip = {};               ///< the node set in whose middle the hand takes hold; empty: `at`
  Vec3 at = Vec3::Zero();              ///< in parts of the body's box
  std::vector<Vec3> crack = {};        ///< from and to, or none, in parts of the box; through the body along z
  double along = 0.0;                  ///< away from the body's middle, in parts of the box's diagonal
  double around = 0.0;                 ///< and then across that
  double strength = 0.0;               ///< Pa
  int ticks = 20;                      ///< for each of the two ways
  int most = 16;                       ///< advances
};

void PrintTo(const RealBody& body, std::ostream* out) { *out << body.name; }

class RealBodies : public testing::TestWithParam<std::tuple<RealBody, fracture::IncisionMethod>> {
 protected:
  [[nodiscard]] const RealBody& real() const { return std::get<0>(GetParam()); }

  static Vec3 middle_of(const mesh::TetMesh& mesh, const std::string& set) {
    Vec3 sum = Vec3::Zero();
    const std::vector<NodeId>& nodes = mesh.find_node_set(set)->nodes;
    for (const NodeId node : nodes) sum += mesh.node(node) / static_cast<double>(nodes.size());
    return sum;
  }

  void hold(const mesh::TetMesh& mesh) {
    const mesh::BoundingBox box = mesh::bounding_box(mesh);
    Eigen::Index axis = 0;
    box.size().maxCoeff(&axis);
    std::vector<std::uint8_t> held(mesh.node_count(), 0);
    for (const std::string& set : real().held)
      for (const NodeId node : mesh.find_node_set(set)->nodes) held[node.index()] = 1;
    for (std::size_t node = 0; node < held.size(); ++node) {
      if (real().held.empty() && mesh.nodes[node][axis] < box.from[axis] + 0.1 * box.size()[axis]) held[node] = 1;
      for (int c = 0; c < 3 && held[node] != 0; ++c)
        settings.body.supports.push_back({static_cast<std::int32_t>(3 * node) + c, 0.0});
    }
  }

  /// No tet that the last edit touched is flatter than allowed, or inside out.
  void check_edit() const {
    const mesh::TornMesh& body = tear->body();
    const mesh::MeshEdit& edit = body.history().back();
    const auto check = [&](TetId tet) {
      ASSERT_GT(mesh::signed_volume(body.mesh(), tet), 0.0) << tet.value();
      EXPECT_GE(mesh::radius_ratio(mesh::corners(body.mesh(), tet)),
                (1.0 - 1e-9) * fracture::kFlattestTet * least_ratio)
          << tet.value();
    };
    for (const mesh::MovedNode& move : edit.moved)
      for (const TetId tet : body.tets_around(move.node)) check(tet);
    for (const mesh::RewiredTet& tet : edit.rewired) check(tet.tet);
  }

  void check_force(const Mat3& start) {
    test::TornBodyOracle oracle(tear->body(), settings.body);
    ASSERT_TRUE(oracle.is_stable());
    const auto held = tear->hand().nodes();
    const std::vector<NodeId> nodes(held.begin(), held.end());
    const response::ContactLaw law = response::make_contact_law(
        tear->hand().point(), settings.contact, tear->hand().law().mode, oracle.compliance(nodes), oracle.rest(nodes));
    const double error = (tear->hand().law().stiffness - law.stiffness).norm() / start.norm();
    EXPECT_LT(error, 1e-8) << "topology " << tear->body().topology();
    worst = std::max(worst, error);
    ++checked;
  }

  TearSettings settings;
  std::unique_ptr<TearSession> tear;
  double least_ratio = 0.0;
  double worst = 0.0;
  int checked = 0;
};

TEST_P(RealBodies, TearAlongAndAroundWithTheForceOfTheTornBody) {
  const std::filesystem::path file = test::shared_dir() / "data" / (real().name + ".msh.gz");
  RHEXIS_SKIP_WITHOUT(file);
  const Expected<mesh::MeshFile> read = mesh::read_mesh_file(file);
  ASSERT_TRUE(read.has_value()) << read.error().message();
  const mesh::TetMesh& mesh = read->mesh;
  const Stopwatch watch;
  least_ratio = mesh::measure_quality(mesh).radius_ratio.min;
  const mesh::BoundingBox box = mesh::bounding_box(mesh);
  const auto place = [&](const Vec3& part) { return Vec3(box.from + part.cwiseProduct(box.size())); };
  hold(mesh);
  settings.body.elastic = {1.0e6, 0.45};
  settings.criterion = "maximum-hoop";
  settings.strength = real().strength;
  settings.advance_threshold = 0.5 * real().strength;
  settings.incision = std::get<1>(GetParam());
  std::vector<scene::CrackSettings> cracks;
  if (!real().crack.empty()) cracks.push_back({{place(real().crack[0]), place(real().crack[1]), Vec3::UnitZ()}});
  Expected<std::unique_ptr<TearSession>> made = TearSession::make(mesh, settings, cracks);
  ASSERT_TRUE(made.has_value()) << made.error().message();
  tear = std::move(*made);
  const Vec3 at = real().grip.empty() ? place(real().at) : middle_of(mesh, real().grip);
  const Expected<void> holds = tear->grasp(at);
  ASSERT_TRUE(holds.has_value()) << holds.error().message();
  const Mat3 start = tear->hand().law().stiffness;
  check_force(start);

  int advances = 0;
  bool over = false;
  const Vec3 out = box.size().norm() * (at - place(Vec3::Constant(0.5))).normalized();
  const Vec3 across = out.norm() * out.unitOrthogonal();
  for (int tick = 1; tick <= 2 * real().ticks && !over; ++tick) {
    const double along = std::min(1.0, static_cast<double>(tick) / real().ticks);
    const double around = std::max(0.0, static_cast<double>(tick) / real().ticks - 1.0);
    const TickReport report =
        tear->tick(along * real().along * out + around * real().around * across, [&](const AdvanceRecord& advance) {
          ++advances;
          check_edit();
          EXPECT_TRUE(advance.force_after.allFinite());
          if (tear->hand().holds() && checked < 3 && advances % 4 == 1) check_force(start);
        });
    EXPECT_EQ(report.trouble, "") << tick;
    EXPECT_TRUE(report.force.allFinite());
    over = report.let_go || advances >= real().most;
  }
  EXPECT_GE(advances, 3);
  EXPECT_GE(checked, 2);
  test::measured("{}: {} tets, {} advances, {} pieces, {} topologies, stiffness {:.1e} at worst, {:.1f} s", real().name,
                 mesh.tet_count(), advances, tear->pieces(), checked, worst, watch.seconds());
}

// The aorta is held at its lower end, with its branches, and pulled at its upper one; organs are held at an end.
const std::vector<std::string> kHeld{"aorta_inferior", "renal_left", "renal_right"};
const RealBody kBodies[] = {
    {.name = "vessel_solid_3k",
     .held = kHeld,
     .grip = "aorta_superior",
     .along = 0.5,
     .around = 0.3,
     .strength = 0.2e6},
    {.name = "vessel_wall_30k",
     .held = kHeld,
     .grip = "aorta_superior",
     .along = 0.1,
     .around = 0.1,
     .strength = 0.3e6,
     .ticks = 4,
     .most = 4},
    {.name = "kidney_5k",
     .at = Vec3(0.4, 1.0, 0.5),
     .crack = {Vec3(-0.2, 0.5, 0.5), Vec3(0.4, 0.5, 0.5)},
     .along = 0.3,
     .around = 0.2,
     .strength = 0.2e6},
    {.name = "liver_5k",
     .at = Vec3(1.0, 0.5, 0.5),
     .crack = {Vec3(0.5, -0.2, 0.5), Vec3(0.5, 0.5, 0.5)},
     .along = 0.5,
     .around = 0.3,
     .strength = 0.1e6},
};

INSTANTIATE_TEST_SUITE_P(Both, RealBodies,
                         testing::Combine(testing::ValuesIn(kBodies),
                                          testing::Values(fracture::IncisionMethod::keep_nodes,
                                                          fracture::IncisionMethod::split)),
                         [](const auto& test) {
                           const bool split = std::get<1>(test.param) == fracture::IncisionMethod::split;
                           return std::get<0>(test.param).name + (split ? "_split" : "_keep_nodes");
                         });

struct SoftBody {
  std::string scene;
  std::string mesh;
};

void PrintTo(const SoftBody& body, std::ostream* out) { *out << body.scene; }

class SoftRealBodies : public testing::TestWithParam<SoftBody> {
 protected:
  /// The scene as it lies in scenes/real, on the mesh of shared_dir(), with a pull that takes 200 frames.
  static SceneChoice choose(const std::filesystem::path& mesh) {
    const auto scene = std::filesystem::path(RHEXIS_SOURCE_DIR) / "scenes/real" / (GetParam().scene + ".toml");
    Expected<SceneChoice> choice =
        read_scene_choice(scene.string(), {"mesh.file=" + mesh.string(), "pull.0.seconds=0.2"});
    EXPECT_TRUE(choice.has_value()) << choice.error().message();
    return std::move(*choice);
  }

  /// Nothing is NaN; and where the law has an answer only for what is not inside out, no tet is. `least`: J so far.
  static void check_state(TearSession& tear, double& least) {
    VectorX u;
    tear.displacement(u);
    ASSERT_TRUE(u.allFinite());
    least = std::min(least, test::least_volume_ratio(tear.body(), u));
    if (tear.model_name() == "hyperelastic") {
      ASSERT_GT(least, 0.0);
    }
  }
};

TEST_P(SoftRealBodies, AreTornInEveryModelSwitchedWhileTheyAreHeldAndComeToRest) {
  const std::filesystem::path mesh = test::shared_dir() / "data" / GetParam().mesh;
  RHEXIS_SKIP_WITHOUT(mesh);
  test::InteractionCase live(choose(mesh));
  for (const char* model : {"corotated", "geometrically-nonlinear", "linear", "hyperelastic"}) {
    const Stopwatch watch;
    live.begin_script();
    for (int k = 0; k < 10; ++k) live.step();
    ASSERT_TRUE(live.interaction.tear().hand().holds()) << model;
    live.set("model.kind", model);
    TearSession& tear = live.interaction.tear();
    ASSERT_EQ(tear.model_name(), model);
    live.heard.topologies.clear();
    live.begin_script();
    double least = 1.0;
    double most = 0.0;
    int steps = 0;
    do {
      const StepOutcome step = live.step();
      ASSERT_TRUE(step.force.allFinite()) << model;
      most = std::max(most, step.force.norm());
      if (step.advances > 0) check_state(tear, least);
      ASSERT_FALSE(testing::Test::HasFatalFailure()) << model;
    } while (live.interaction.is_scripted() && ++steps < 2000);
    EXPECT_GE(live.heard.topologies.size(), 1U) << model;

    tear.let_go();
    TickReport report;
    for (int k = 0; k < 600 && !(k > 0 && report.at_rest); ++k) report = tear.tick(Vec3::Zero(), {}, 1);
    EXPECT_TRUE(report.at_rest) << model << ' ' << report.late;
    check_state(tear, least);
    test::measured("{}, {}: {} advances, at most {:.2f} N, least J {:.3f}, {:.1f} s", GetParam().scene, model,
                   live.heard.topologies.size(), most, least, watch.seconds());
  }
}

const SoftBody kSoftBodies[] = {
    {"aorta", "vessel_solid_401.msh"}, {"kidney", "kidney_1k.msh"}, {"liver", "liver_1k.msh"}};

INSTANTIATE_TEST_SUITE_P(Torn, SoftRealBodies, testing::ValuesIn(kSoftBodies),
                         [](const auto& test) { return test.param.scene; });

}  // namespace
}  // namespace rhexis::session
