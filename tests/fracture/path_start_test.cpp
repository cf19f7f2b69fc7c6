#include "fracture/path_start.h"

#include <gtest/gtest.h>

#include "fracture/local_object.h"
#include "fracture/path.h"
#include "mesh/surface.h"
#include "tests/fracture/cracked_plate.h"
#include "tests/fracture/cut_support.h"
#include "tests/fracture/stress_fields.h"
#include "tests/support/measured.h"

namespace rhexis::fracture::test {
namespace {

mesh::TetMesh plate() { return *mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, 506); }
mesh::TetMesh bar() { return *mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 1500); }
mesh::TetMesh tube() { return *mesh::make_tube({.radius = 0.005, .length = 0.03, .wall = 0.0015, .bend = 0.0}, 3000); }

TEST(MakeCrack, IsTheThesisCrackOfAPlate) {
  CutBody cut(plate());
  const auto start = make_crack(Vec3(0.12, 0.0, 0.0), Vec3(0.12, 0.06, 0.0), Vec3(0.0, 0.0, 2.0), cut.surroundings);
  ASSERT_TRUE(start);
  ASSERT_EQ(start->cracks.size(), 1u);
  const Crack& crack = start->cracks[0];
  EXPECT_TRUE(crack.uniform);
  ASSERT_EQ(crack.front.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT((crack.front[k].position - Vec3(0.12, 0.06, k == 0 ? 0.0 : 0.01)).norm(), 1e-8);  // 1e-7 of an edge
    EXPECT_EQ(crack.front[k].direction, Vec3(Vec3::UnitY()));
    EXPECT_EQ(crack.front[k].tangent, Vec3(Vec3::UnitZ()));
  }
  for (const auto& [a, b, c] : start->surface.triangles)
    EXPECT_GT((b - a).cross(c - a).dot(crack.front[0].normal()), 0.0);
  EXPECT_GT(cut.cut(start->surface).edges_cut, 10);
}

TEST(MakeCrack, InsideThePlateHasTwoTips) {
  const Surroundings body(plate());
  const auto start = make_crack(Vec3(0.1, 0.12, 0.0), Vec3(0.14, 0.12, 0.0), Vec3::UnitZ(), body);
  ASSERT_TRUE(start);
  ASSERT_EQ(start->cracks.size(), 2u);
  EXPECT_EQ(start->cracks[0].front[0].direction, Vec3(Vec3::UnitX()));
  EXPECT_EQ(start->cracks[1].front[0].direction, Vec3(-Vec3::UnitX()));
  EXPECT_LT((start->cracks[0].front[0].normal() - start->cracks[1].front[0].normal()).norm(), 1e-15);
  double area = 0.0;
  for (const auto& [a, b, c] : start->surface.triangles) {
    EXPECT_GT((b - a).cross(c - a).dot(start->cracks[0].front[0].normal()), 0.0);
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  EXPECT_NEAR(area, 0.04 * (0.01 + 2.0 * kCutMargin * body.mean_edge()), 1e-12);  // from tip to tip, no further
}

TEST(MakeCrack, ThroughATubeStandsInBothWalls) {
  const Surroundings body(tube());
  const auto start = make_crack(Vec3(0.0, 0.006, 0.015), Vec3(0.0, 0.0, 0.015), Vec3::UnitX(), body);
  ASSERT_TRUE(start);
  ASSERT_EQ(start->cracks.size(), 2u);
  for (const Crack& crack : start->cracks) {
    EXPECT_FALSE(crack.uniform);
    const double width = (crack.front.back().position - crack.front.front().position).norm();
    EXPECT_NEAR(width, 0.0015, 1e-4);
  }
}

TEST(MakeCrack, ReachesFromFarAway) {
  CutBody cut(bar());
  const Vec3 to(0.05, 0.04, 0.15);
  const auto near = make_crack(Vec3(0.05, -1.0, 0.15), to, Vec3::UnitX(), cut.surroundings);
  ASSERT_TRUE(near);
  for (const double far : {1e6, 1e12}) {
    // Behind the body, and along the front: the same crack.
    for (const auto& [from, end] :
         {std::pair{Vec3(0.05, -far, 0.15), to}, {Vec3(far, -1.0, 0.15), Vec3(-far, 0.04, 0.15)}}) {
      const auto start = make_crack(from, end, Vec3::UnitX(), cut.surroundings);
      ASSERT_TRUE(start) << far;
      EXPECT_EQ(start->cracks.size(), 1u);
      EXPECT_EQ(start->cracks[0].front.size(), near->cracks[0].front.size());
      EXPECT_EQ(cut.incise(start->surface).edit.removed, cut.incise(near->surface).edit.removed);
    }
    // Ahead of the body, or past it: no front in it.
    for (const Vec3& end : {Vec3(0.05, far, 0.15), Vec3(0.05, 0.04, far), Vec3(far, far, far)})
      EXPECT_FALSE(make_crack(Vec3(0.05, 0.0, 0.15), end, Vec3::UnitX(), cut.surroundings)) << far;
  }
}

TEST(MakeCrack, SaysWhatIsWrong) {
  const Surroundings body(plate());
  const auto message = [&](const Vec3& from, const Vec3& to, const Vec3& through) {
    const auto made = make_crack(from, to, through, body);
    return made ? std::string("made") : made.error().message();
  };
  EXPECT_EQ(message(Vec3::Zero(), Vec3::UnitX(), Vec3::Zero()),
            "the crack goes through the body along no direction ('through' is not zero)");
  EXPECT_EQ(message(Vec3::Zero(), Vec3(0.1, 0.1, 0.0), Vec3::UnitX()),
            "the crack of a plate does not go through its thickness (through = [0, 0, 1])");
  EXPECT_EQ(message(Vec3(0.1, 0.1, 0.0), Vec3(0.1, 0.1, 0.2), Vec3::UnitZ()),
            "the crack has no length ('from' and 'to' lie apart, not only along 'through')");
  EXPECT_EQ(message(Vec3(0.1, 0.1, 0.0), Vec3(0.1, 0.4, 0.0), Vec3::UnitZ()),
            "the front of the crack does not pass through the body (the line through 'to' along 'through' meets it)");
}

/// Stresses of all tets: `low`, and `high` at the tet with a surface face that is nearest to `at`.
std::vector<TetStress> stressed(const mesh::TornMesh& body, const Mat3& low, const Vec3& at, const Mat3& high) {
  std::vector<TetStress> tets;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    TetStress& tet = tets.emplace_back();
    tet.tet = TetId(t);
    for (const NodeId node : body.mesh().tets[t]) tet.centroid += 0.25 * body.mesh().node(node);
    tet.volume = mesh::signed_volume(body.mesh(), TetId(t));
    tet.stress = low;
  }
  std::size_t nearest = 0;
  double least = 1e9;
  for (const mesh::TetFace& face : mesh::find_faces(body.mesh()).boundary) {
    const double distance = (tets[face.tet.index()].centroid - at).norm();
    if (distance < least) nearest = face.tet.index();
    least = std::min(least, distance);
  }
  tets[nearest].stress = high;
  return tets;
}

TEST(StartCrack, NeedsTheStrength) {
  const mesh::TornMesh body(plate());
  const Surroundings surroundings(body.mesh());
  const auto tets = stressed(body, in_plane(10.0, 0.0, 0.0), Vec3(0.12, 0.0, 0.005), in_plane(20.0, 0.0, 0.0));
  EXPECT_FALSE(start_crack(body, tets, 20.1, surroundings));
  EXPECT_TRUE(start_crack(body, tets, 20.0, surroundings));
  std::vector<TetStress> held = tets;
  for (TetStress& tet : held) tet.at_hand = true;
  EXPECT_FALSE(start_crack(body, held, 1.0, surroundings));
  EXPECT_FALSE(start_crack(body, {}, 1.0, surroundings));
}

TEST(StartCrack, RunsIntoAPlateFromItsRim) {
  CutBody cut(plate());
  const auto tets = stressed(cut.body, in_plane(10.0, 0.0, 0.0), Vec3(0.12, 0.0, 0.005), in_plane(20.0, 0.0, 0.0));
  const auto start = start_crack(cut.body, tets, 15.0, cut.surroundings);
  ASSERT_TRUE(start);
  ASSERT_EQ(start->cracks.size(), 1u);
  const FrontPoint& tip = start->cracks[0].front[0];
  EXPECT_LT((tip.direction - Vec3::UnitY()).norm(), 1e-12);  // across the tension along x, inward
  EXPECT_NEAR(tip.position[1], cut.surroundings.mean_edge(), 1e-12);
  EXPECT_NEAR(tip.position[0], 0.12, cut.surroundings.mean_edge());
  EXPECT_GT(cut.cut(start->surface).edges_cut, 0);
}

TEST(StartCrack, OpensASlitWithinAPlate) {
  CutBody cut(plate());
  const auto tets = stressed(cut.body, in_plane(1.0, 0.0, 0.0), Vec3(0.12, 0.12, 0.005), in_plane(0.0, 20.0, 0.0));
  const auto start = start_crack(cut.body, tets, 15.0, cut.surroundings);
  ASSERT_TRUE(start);
  ASSERT_EQ(start->cracks.size(), 2u);
  EXPECT_NEAR(std::abs(start->cracks[0].front[0].direction[0]), 1.0, 1e-12);
  EXPECT_GT(cut.cut(start->surface).edges_cut, 0);
}

TEST(StartCrack, IsHalfADiscInABar) {
  CutBody cut(bar());
  const Mat3 pull = 20.0 * Vec3::UnitZ() * Vec3::UnitZ().transpose();
  const auto tets = stressed(cut.body, 0.5 * pull, Vec3(0.0, 0.05, 0.15), pull);
  const auto start = start_crack(cut.body, tets, 15.0, cut.surroundings);
  ASSERT_TRUE(start);
  ASSERT_EQ(start->cracks.size(), 1u);
  const Crack& crack = start->cracks[0];
  ASSERT_GE(crack.front.size(), 4u);
  EXPECT_FALSE(crack.uniform);
  const double edge = cut.surroundings.mean_edge();
  for (const FrontPoint& point : crack.front) {
    EXPECT_NEAR(std::abs(point.normal()[2]), 1.0, 1e-9);  // in the plane across the pull
    EXPECT_NEAR(point.position[2], crack.front[0].position[2], 1e-9);
    EXPECT_LT(point.position[0], 1.6 * edge);
  }
  for (const FrontPoint& end : {crack.front.front(), crack.front.back()}) EXPECT_NEAR(end.position[0], 0.0, 1e-6);
  EXPECT_GT(crack.front[crack.front.size() / 2].direction[0], 0.8);  // inward
  for (const auto& [a, b, c] : start->surface.triangles)
    EXPECT_GE((b - a).cross(c - a).dot(crack.front[0].normal()), -1e-20);
  EXPECT_GT(cut.cut(start->surface).edges_cut, 0);
}

// Wherever a body would tear, and whichever way, its first crack opens something; no larger than it has to be.
TEST(CutFirst, OpensSomethingByBothMethods) {
  for (const IncisionMethod method : {IncisionMethod::keep_nodes, IncisionMethod::split}) {
    for (const mesh::TetMesh& mesh : {plate(), bar(), tube()}) {
      const CutBody cut(mesh, method);
      const auto boundary = mesh::find_faces(mesh).boundary;
      Dice dice(5);
      int none = 0;
      int larger = 0;
      for (int trial = 0; trial < 30; ++trial) {
        const auto face = static_cast<std::size_t>(dice.between(0.0, static_cast<double>(boundary.size())));
        const std::array<Vec3, 4> x = mesh::corners(mesh, boundary[face].tet);
        const Vec3 pulled = dice.direction();
        TetStress stress;
        stress.tet = boundary[face].tet;
        stress.centroid = 0.25 * (x[0] + x[1] + x[2] + x[3]);
        stress.stress = 2.0 * pulled * pulled.transpose();
        const auto first = cut_first(cut.body, std::span(&stress, 1), 1.0, cut.surroundings, cut.settings);
        EXPECT_FALSE(cut_first(cut.body, std::span(&stress, 1), 3.0, cut.surroundings, cut.settings));
        if (!first) {
          ++none;
          continue;
        }
        EXPECT_FALSE(first->incision.edit.empty());
        EXPECT_FALSE(first->start.cracks.empty());
        const auto usual = start_crack(cut.body, std::span(&stress, 1), 1.0, cut.surroundings);
        if (!usual || cut.incise(usual->surface).edit.empty()) {
          ++larger;
        } else {
          EXPECT_EQ(first->start.surface.triangles[0].c, usual->surface.triangles[0].c);
        }
      }
      rhexis::test::measured("first cracks: {} of 30 larger, {} none", larger, none);
      EXPECT_LE(none, 3);  // a pull straight away from the surface, a corner that one side of the disc misses
    }
  }
}

/// Pulls a body apart from its first crack on, by the sections' own judgement; the number of advances, or -1.
int tear_apart(CutBody& cut, std::vector<Crack> cracks, const WholeProblem& problem, int most) {
  const double edge = cut.surroundings.mean_edge();
  const auto criterion = make_criterion(
      "maximum-hoop", {.strength = 1e-6, .advance_threshold = 1e-6, .ahead_only = true, .mean_edge = edge});
  for (int advances = 0; advances < most; ++advances) {
    if (find_pieces(cut.body, cut.held).count() > 1) return advances;
    const auto running = std::find_if(cracks.begin(), cracks.end(), [](const Crack& crack) { return !crack.finished; });
    if (running == cracks.end()) return -1;
    const VectorX u = solve_whole(cut.body, problem);
    const LocalObject local = local_fields(cut.body, cut.surroundings, *running, problem, u);
    std::vector<Judgement> judged = judge_front(**criterion, *running, edge, local.stresses());
    for (Judgement& one : judged) one.length = std::min(one.length, edge);
    auto advance = plan_advance(*running, judged, cut.surroundings);
    if (!advance) return -1;
    cut.apply(cut_along(cut.body, cut.surroundings, *running, *advance, cut.settings).edit);
    std::vector<Crack> after = advanced(*running, *advance, cut.surroundings, cut.body);
    *running = after[0];
    cracks.insert(cracks.end(), after.begin() + 1, after.end());
    for (const Crack& crack : cracks)
      for (const FrontPoint& point : crack.front) EXPECT_TRUE(point.position.allFinite());
  }
  return -1;
}

TEST(StartCrack, ABarPulledComesApart) {
  for (const IncisionMethod method : {IncisionMethod::keep_nodes, IncisionMethod::split}) {
    CutBody cut(bar(), method);
    const auto at_end = [](const Vec3& x) { return x[2] < 1e-9 || x[2] > 0.3 - 1e-9; };
    cut.hold(at_end);
    WholeProblem problem;
    problem.elastic = {.young = 1e6, .poisson = 0.4};
    for (int i = 0; i < 3; ++i) {
      problem.hold(cut.body.mesh(), "-z", i, 0.0);
      problem.hold(cut.body.mesh(), "+z", i, i == 2 ? 0.01 : 0.0);
    }
    const Mat3 pull = 20.0 * Vec3::UnitZ() * Vec3::UnitZ().transpose();
    const auto start =
        start_crack(cut.body, stressed(cut.body, 0.5 * pull, Vec3(0.0, 0.05, 0.15), pull), 15.0, cut.surroundings);
    ASSERT_TRUE(start);
    cut.cut(start->surface);
    const int advances = tear_apart(cut, start->cracks, problem, 60);
    EXPECT_GT(advances, 2);
  }
}

TEST(StartCrack, ATubePulledComesApart) {
  CutBody cut(tube());
  cut.hold([](const Vec3& x) { return x[2] < 1e-9 || x[2] > 0.03 - 1e-9; });
  WholeProblem problem;
  problem.elastic = {.young = 1e6, .poisson = 0.4};
  for (int i = 0; i < 3; ++i) {
    problem.hold(cut.body.mesh(), "bottom", i, 0.0);
    problem.hold(cut.body.mesh(), "top", i, i == 2 ? 0.001 : 0.0);
  }
  const auto start = make_crack(Vec3(0.0, 0.006, 0.015), Vec3(0.0, 0.003, 0.015), Vec3::UnitX(), cut.surroundings);
  ASSERT_TRUE(start);
  cut.cut(start->surface);
  EXPECT_GT(tear_apart(cut, start->cracks, problem, 100), 2);
}

}  // namespace
}  // namespace rhexis::fracture::test
