#include "session/tear_session.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "mesh/generate.h"
#include "model/stabilisation.h"
#include "tests/support/measured.h"
#include "tests/support/model_names.h"

namespace rhexis::session {
namespace {

/// The plate of scenes/plate-tear.toml.
struct PlateCase {
  mesh::TetMesh mesh = *mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, 506);
  TearSettings settings;
  std::vector<scene::CrackSettings> cracks{{{Vec3(0.12, 0.0, 0.0), Vec3(0.12, 0.06, 0.0), Vec3::UnitZ()}}};
  Vec3 at{0.10, 0.0, 0.005};
  Vec3 by{-0.12, 0.0, 0.0};

  explicit PlateCase(const std::string& held = "+x") {
    settings.body.elastic = {1.0e6, 0.4};
    for (const NodeId node : mesh.find_node_set(held)->nodes) {
      for (int c = 0; c < 3; ++c) settings.body.supports.push_back({3 * node.value() + c, 0.0});
    }
    settings.criterion = "maximum-principal";
    settings.strength = 0.4e6;
    settings.advance_threshold = 0.2e6;
  }
  [[nodiscard]] std::unique_ptr<TearSession> make() const {
    Expected<std::unique_ptr<TearSession>> made = TearSession::make(mesh, settings, cracks);
    EXPECT_TRUE(made.has_value()) << made.error().message();
    return std::move(*made);
  }
};

struct Trace {
  std::vector<Vec3> force;         ///< N, per tick
  std::vector<double> dissipated;  ///< J, work of the hand minus stored energy, per tick
};

Trace pull(TearSession& tear, const PlateCase& plate, int ticks = 200) {
  Trace out;
  EXPECT_TRUE(tear.grasp(plate.at).has_value());
  for (int k = 1; k <= ticks; ++k) {
    const TickReport report = tear.tick(plate.by * (static_cast<double>(k) / ticks));
    EXPECT_EQ(report.trouble, "");
    out.force.push_back(report.force);
    out.dissipated.push_back(tear.hand().work() - tear.stored_energy());
  }
  return out;
}

TEST(TearSession, ThePlateTearsAndItsForceDrops) {
  const PlateCase plate;
  const auto tear = plate.make();
  const Trace trace = pull(*tear, plate);
  ASSERT_GE(tear->advances().size(), 6U);  // the scene's crack, and at least 5 advances
  EXPECT_TRUE(tear->advances().front().started);
  for (const AdvanceRecord& advance : tear->advances()) {
    if (advance.started) continue;
    // An incision lowers the stiffness: at the same place the hand does less work.
    EXPECT_LT(advance.force_after.dot(-plate.by), advance.force_before.dot(-plate.by));
    EXPECT_GE(advance.value, 0.4e6);
    EXPECT_LE(std::abs(advance.turn), 90.0 + 1e-9);
    EXPECT_GT(advance.tets_removed, 0);
    EXPECT_GT(advance.edges_cut, 0);
  }
  EXPECT_EQ(tear->body().mesh().node_count(), plate.mesh.node_count());
  EXPECT_GT(trace.force.front().norm(), 0.0);
}

TEST(TearSession, TheForceOfAHeldPointGrowsInLineUntilItTears) {
  const PlateCase plate;
  const auto tear = plate.make();
  const Trace trace = pull(*tear, plate);
  const std::size_t first = static_cast<std::size_t>(tear->advances()[1].tick) - 1;
  ASSERT_GT(first, 10U);
  for (std::size_t k = 0; k < first; ++k) {
    const Vec3 expected = trace.force[0] * static_cast<double>(k + 1);
    EXPECT_LT((trace.force[k] - expected).norm(), 1e-12 * expected.norm() + 1e-15) << k;
    // No energy goes anywhere while nothing tears.
    EXPECT_NEAR(trace.dissipated[k], 0.0, 1e-11 * tear->hand().work()) << k;
  }
}

TEST(TearSession, SplitLosesNoVolumeAndNoEnergyComesFromTearing) {
  PlateCase plate;
  plate.settings.incision = fracture::IncisionMethod::split;
  plate.settings.strength = 0.2e6;
  plate.settings.advance_threshold = 0.15e6;
  const auto tear = plate.make();
  const Trace trace = pull(*tear, plate);
  ASSERT_GE(tear->advances().size(), 3U);
  EXPECT_GT(tear->body().mesh().node_count(), plate.mesh.node_count());
  for (const AdvanceRecord& advance : tear->advances()) EXPECT_EQ(advance.tets_removed, 0);
  // Where no node is moved an incision can only set energy free. Snapping moves some, with the energy of the tets
  // around them: up to a hundredth of what is stored here.
  for (std::size_t k = 1; k < trace.dissipated.size(); ++k)
    EXPECT_GE(trace.dissipated[k], trace.dissipated[k - 1] - 0.01 * tear->hand().work()) << k;
  EXPECT_GT(trace.dissipated.back(), 0.0);
}

TEST(TearSession, UndoGivesBackTheForceOfEveryTopology) {
  const PlateCase plate;
  const auto tear = plate.make();
  pull(*tear, plate);
  while (tear->advances().size() > 1) {
    const Vec3 before = tear->advances().back().force_before;
    const std::size_t tick = static_cast<std::size_t>(tear->advances().back().tick);
    ASSERT_TRUE(tear->undo());
    // force_before was felt at the hand of that tick; the law is linear in the hand.
    const Vec3 now =
        -tear->hand().law().force(tear->hand().law().rest + plate.by * (static_cast<double>(tick) / 200.0));
    EXPECT_LT((now - before).norm(), 1e-9 * before.norm()) << tear->advances().size();
  }
  EXPECT_TRUE(tear->undo());  // the scene's crack
  EXPECT_FALSE(tear->undo());
  EXPECT_NEAR(tear->body().volume(), mesh::total_volume(plate.mesh), 1e-18);
}

TEST(TearSession, AnImposedAdvanceIsTheOneThatTheCriterionWouldMake) {
  const PlateCase plate;
  const auto judged = plate.make();
  pull(*judged, plate, 50);
  ASSERT_GE(judged->advances().size(), 3U);
  const auto imposed = plate.make();
  ASSERT_TRUE(imposed->grasp(plate.at).has_value());
  for (std::size_t k = 1; k < judged->advances().size(); ++k) {
    const AdvanceRecord& asked = judged->advances()[k];
    const Vec3 step = asked.front_after.front() - asked.front_before.front();
    const TickReport report = imposed->impose(0, step.normalized(), step.norm());
    EXPECT_EQ(report.trouble, "");
    EXPECT_EQ(report.advances, 1);
    const AdvanceRecord& made = imposed->advances()[k];
    EXPECT_NEAR(made.length, asked.length, 1e-12);
    EXPECT_NEAR(made.angle, asked.angle, 1e-9);
    EXPECT_EQ(imposed->body().history().back().removed, judged->body().history()[k].removed);
  }
}

TEST(TearSession, UndoTakesTheHandOffNodesThatGo) {
  PlateCase plate;
  plate.settings.incision = fracture::IncisionMethod::split;
  plate.settings.strength = 1.0e12;
  const auto tear = plate.make();
  ASSERT_TRUE(tear->body().mesh().node_count() > plate.mesh.node_count());
  // The two flanks lie on each other: one of the two nodes there is a copy, and a point beside it holds it.
  int let_go = 0;
  for (const double aside : {-1e-4, 1e-4}) {
    const auto one = plate.make();
    ASSERT_TRUE(one->grasp(Vec3(0.12 + aside, 0.0, 0.0)).has_value());
    ASSERT_TRUE(one->undo());
    if (!one->hand().holds()) ++let_go;
    const TickReport report = one->tick(Vec3(-1e-4, 0.0, 0.0));
    EXPECT_TRUE(report.force.allFinite());
  }
  EXPECT_EQ(let_go, 1);
}

/// The mirror image in x, with the numbering kept.
PlateCase mirrored(PlateCase plate) {
  const auto flip = [](const Vec3& x) { return Vec3(0.24 - x.x(), x.y(), x.z()); };
  for (Vec3& node : plate.mesh.nodes) node = flip(node);
  for (mesh::Tet& tet : plate.mesh.tets) std::swap(tet[2], tet[3]);
  for (auto& [line, place] : plate.cracks) line = {flip(line.from), flip(line.to), line.through};
  plate.at = flip(plate.at);
  plate.by.x() = -plate.by.x();
  return plate;
}

class EveryCriterion : public testing::TestWithParam<std::string> {};

TEST_P(EveryCriterion, TheCrackMirrorsWithTheBody) {
  PlateCase plate;
  plate.settings.criterion = GetParam();
  plate.settings.strength = 0.1e6;
  plate.settings.advance_threshold = 0.05e6;
  // Off the middle, where no node lies on the crack: one that does belongs to a side by rule, which does not mirror.
  plate.cracks = {{{Vec3(0.1213, 0.0, 0.0), Vec3(0.1207, 0.06, 0.0), Vec3::UnitZ()}}};
  const auto one = plate.make();
  const PlateCase other_plate = mirrored(plate);
  const auto other = other_plate.make();
  const Trace trace = pull(*one, plate, 50);
  const Trace other_trace = pull(*other, other_plate, 50);
  ASSERT_EQ(one->advances().size(), other->advances().size());
  EXPECT_GT(one->advances().size(), 2U);
  for (std::size_t k = 1; k < one->advances().size(); ++k) {
    const Vec3& a = one->advances()[k].front_after.front();
    const Vec3& b = other->advances()[k].front_after.front();
    // Rounding of the solve, through directions of stress, onto lengths of a tenth of a metre, and from there into the
    // shapes that the next advance is judged by.
    EXPECT_LT((Vec3(0.24 - b.x(), b.y(), b.z()) - a).head<2>().norm(), 5e-9) << k;
  }
  // Nodes apart by some 1e-9 m, of edges of 1e-2 m, change shapes and with them forces by no more than their ratio.
  double most = 0.0;
  for (const Vec3& force : trace.force) most = std::max(most, force.norm());
  for (std::size_t k = 0; k < trace.force.size(); ++k) {
    const Vec3 back(-other_trace.force[k].x(), other_trace.force[k].y(), other_trace.force[k].z());
    EXPECT_LT((back - trace.force[k]).norm(), 1e-7 * most) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryCriterion,
                         testing::Values("maximum-principal", "maximum-shear", "von-mises", "maximum-hoop"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(TearSession, OneAdvanceATimeIsOneLongTickInParts) {
  PlateCase plate;
  plate.cracks = {{{Vec3(0.091, 0.0, 0.0), Vec3(0.09, 0.04, 0.0), Vec3::UnitZ()}},
                  {{Vec3(0.159, 0.0, 0.0), Vec3(0.16, 0.04, 0.0), Vec3::UnitZ()}}};
  plate.settings.strength = 0.1e6;
  plate.settings.advance_threshold = 0.05e6;
  const auto whole = plate.make();
  const auto parts = plate.make();
  ASSERT_TRUE(whole->grasp(plate.at).has_value());
  ASSERT_TRUE(parts->grasp(plate.at).has_value());
  int most = 0;
  for (int k = 1; k <= 20; ++k) {
    const Vec3 hand = plate.by * (k / 20.0);
    const TickReport all = whole->tick(hand);
    most = std::max(most, all.advances);
    TickReport part;
    for (int n = 0; n <= all.advances; ++n) {
      part = parts->tick(hand, {}, 1);
      EXPECT_EQ(part.advances, n < all.advances ? 1 : 0);
    }
    EXPECT_EQ(part.force, all.force) << k;
  }
  EXPECT_GT(most, 2);
  ASSERT_EQ(whole->advances().size(), parts->advances().size());
  bool right = false;
  for (std::size_t k = 0; k < whole->advances().size(); ++k) {
    EXPECT_EQ(whole->advances()[k].front_after, parts->advances()[k].front_after) << k;
    right = right || (k > 1 && whole->advances()[k].front_after.front().x() > 0.125);
  }
  EXPECT_TRUE(right) << "one of the cracks alone has run";
}

TEST(TearSession, ABasisKnowsTheDisplacementOfEveryNode) {
  PlateCase plate;
  plate.settings.body.density = 1000.0;
  plate.settings.body.gravity = {0.0, -0.2, 0.1};
  const auto tear = plate.make();
  ASSERT_TRUE(tear->grasp(plate.at).has_value());
  response::ForceBasis basis;
  int advances = 0;
  for (int k = 1; k <= 100; ++k) {
    const int tore = tear->tick(plate.by * (k / 100.0) + Vec3(0.0, 0.01 * std::sin(0.3 * k), 1e-4 * k)).advances;
    if (tore > 0) basis.clear();
    advances += tore;
    VectorX by_basis;
    VectorX solved;
    tear->displacement(basis, by_basis);
    tear->displacement(solved);
    // A few sums, of solutions with the same factor.
    EXPECT_LT((by_basis - solved).norm(), 1e-12 * solved.norm()) << k;
  }
  EXPECT_GT(advances, 3);
}

TEST(TearSession, TheSameBitsWhateverTheThreads) {
  const PlateCase plate;
  std::vector<Trace> traces;
  for (const int threads : {1, 2, 2}) {
    set_thread_count(threads);
    traces.push_back(pull(*plate.make(), plate));
  }
  set_thread_count(0);
  for (std::size_t k = 0; k < traces[0].force.size(); ++k) {
    EXPECT_EQ(traces[0].force[k], traces[1].force[k]) << k;
    EXPECT_EQ(traces[0].force[k], traces[2].force[k]) << k;
  }
}

TEST(TearSession, GoesOnUntilTheBodyIsInPiecesAndTheHandLetsGo) {
  PlateCase plate;
  plate.settings.strength = 0.02e6;
  plate.settings.advance_threshold = 0.02e6;
  plate.settings.criterion = "maximum-hoop";
  const auto tear = plate.make();
  ASSERT_TRUE(tear->grasp(plate.at).has_value());
  bool let_go = false;
  for (int k = 1; k <= 400 && !let_go; ++k) let_go = tear->tick(plate.by * (k / 400.0)).let_go;
  EXPECT_TRUE(let_go);
  EXPECT_GE(tear->pieces(), 2);
  EXPECT_FALSE(tear->hand().holds());
  EXPECT_EQ(tear->hand().force(), Vec3(0.0, 0.0, 0.0));
  EXPECT_GT(tear->advances().back().tets_frozen, 0);
  VectorX u;
  tear->displacement(u);
  EXPECT_LT(u.norm(), 1e-12);  // what is left is held, and nothing pulls at it
}

class EveryIncision : public testing::TestWithParam<fracture::IncisionMethod> {};

TEST_P(EveryIncision, TearsABodyWithoutACrackWhereItYields) {
  PlateCase plate;
  plate.settings.incision = GetParam();
  plate.cracks.clear();
  plate.settings.strength = 0.05e6;
  plate.settings.advance_threshold = 0.03e6;
  const auto tear = plate.make();
  EXPECT_TRUE(tear->cracks().empty());
  pull(*tear, plate, 40);
  ASSERT_FALSE(tear->advances().empty());
  EXPECT_TRUE(tear->advances().front().started);
  EXPECT_FALSE(tear->cracks().empty());
}

INSTANTIATE_TEST_SUITE_P(Both, EveryIncision,
                         testing::Values(fracture::IncisionMethod::keep_nodes, fracture::IncisionMethod::split),
                         [](const auto& test) {
                           return test.param == fracture::IncisionMethod::split ? "split" : "keep_nodes";
                         });

TEST(TearSession, ToughnessTearsWhereTheEnergyReleaseReachesIt) {
  PlateCase plate;
  plate.settings.strength.reset();
  plate.settings.toughness = 300.0;
  plate.settings.criterion = "maximum-hoop";
  const auto tear = plate.make();
  pull(*tear, plate);
  ASSERT_GE(tear->advances().size(), 2U);
  for (std::size_t k = 1; k < tear->advances().size(); ++k) EXPECT_GE(tear->advances()[k].value, 300.0);
  // The hand's work is stored or went into the crack: about the toughness times its area. The domain integral at this
  // mesh, advances of finite length, and what the removed tets take, make the rest.
  const double per_area = (tear->hand().work() - tear->stored_energy()) / tear->crack_area();
  EXPECT_GT(per_area, 150.0);
  EXPECT_LT(per_area, 900.0);
}

class SoftToughness : public testing::TestWithParam<model::ModelKind> {};

TEST_P(SoftToughness, TearsWhereTheEnergyReleaseOfLargeStrainReachesIt) {
  PlateCase plate;
  plate.settings.body.elastic = {1.0e5, 0.45};
  model::ModelSettings soft;
  soft.kind = GetParam();
  soft.elastic = plate.settings.body.elastic;
  soft.law = material::to_mooney_rivlin(soft.elastic);
  soft.beta = model::auto_beta(soft.law);
  plate.settings.large_strain = soft;
  plate.settings.live.tolerance = 1e-6;
  plate.settings.frames = 60;
  plate.settings.strength.reset();
  plate.settings.toughness = 100.0;
  plate.settings.criterion = "maximum-hoop";
  plate.settings.incision = fracture::IncisionMethod::split;  // no tet takes its energy along
  const auto tear = plate.make();
  pull(*tear, plate, 40);
  ASSERT_GE(tear->advances().size(), 4U);
  for (std::size_t k = 1; k < tear->advances().size(); ++k) EXPECT_GE(tear->advances()[k].value, 100.0);
  // The hand's work is stored or went into the crack: the toughness times its area, within what G falls by while the
  // front goes on by a mean edge, a third of the crack that it began with.
  const double grown = tear->crack_area() - tear->advances().front().crack_area;
  const double per_area = (tear->hand().work() - tear->stored_energy()) / grown;
  test::measured("{} by toughness 100 N/m: {} advances, {:.1f} N/m",
                 model::kModelNames[static_cast<std::size_t>(soft.kind)], tear->advances().size() - 1, per_area);
  EXPECT_GT(per_area, 75.0);
  EXPECT_LT(per_area, 125.0);
}

INSTANTIATE_TEST_SUITE_P(Live, SoftToughness,
                         testing::Values(model::ModelKind::corotated, model::ModelKind::geometrically_nonlinear,
                                         model::ModelKind::hyperelastic),
                         test::model_case_name);

TEST(TearSession, APushedPointFeelsPressureAndNoFriction) {
  PlateCase plate;
  plate.settings.strength = 1.0e12;
  const auto tear = plate.make();
  ASSERT_TRUE(tear->grasp(Vec3(0.06, 0.12, 0.01), response::ContactMode::push).has_value());
  const Vec3 in = tear->tick(Vec3(0.0, 0.0, -1e-3)).force;
  EXPECT_GT(in.z(), 0.0);
  EXPECT_LT(in.head<2>().norm(), 1e-12 * in.norm());
  const Vec3 aslant = tear->tick(Vec3(2e-3, -1e-3, -1e-3)).force;
  EXPECT_LT((aslant - in).norm(), 1e-9 * in.norm());  // sliding along changes nothing
  EXPECT_EQ(tear->tick(Vec3(0.0, 0.0, 1e-3)).force, Vec3(0.0, 0.0, 0.0));
  // Back where it began, all work has been given back.
  tear->tick(Vec3::Zero());
  EXPECT_NEAR(tear->stored_energy(), 0.0, 1e-15);
}

TEST(TearSession, AHeldPointThatASupportHoldsIsRefused) {
  const PlateCase plate;
  const auto tear = plate.make();
  const Expected<void> held = tear->grasp(Vec3(0.24, 0.1, 0.005));
  ASSERT_FALSE(held.has_value());
  EXPECT_EQ(held.error().message(),
            "a support holds the point that the hand takes hold of (a point away from every [[support]])");
  EXPECT_FALSE(tear->hand().holds());
  EXPECT_TRUE(tear->grasp(plate.at).has_value());
}

TEST(TearSession, SaysWhatIsWrongWithACrack) {
  PlateCase plate;
  plate.cracks = {{{Vec3(0.5, 0.0, 0.0), Vec3(0.5, 0.06, 0.0), Vec3::UnitZ()}}};
  EXPECT_FALSE(TearSession::make(plate.mesh, plate.settings, plate.cracks).has_value());
  plate.cracks.clear();
  plate.settings.strength.reset();
  plate.settings.toughness = 100.0;
  const auto made = TearSession::make(plate.mesh, plate.settings, plate.cracks);
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().message(),
            "a toughness says when a crack runs on, not where one starts (add a [[crack]], or give a strength)");
}

}  // namespace
}  // namespace rhexis::session
