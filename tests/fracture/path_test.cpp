#include "fracture/path.h"

#include <gtest/gtest.h>

#include <numbers>

#include "fracture/energy_release.h"
#include "fracture/path_start.h"
#include "tests/fracture/cracked_plate.h"
#include "tests/fracture/cut_support.h"
#include "tests/fracture/stress_fields.h"

namespace rhexis::fracture::test {
namespace {

Judgement towards(const Vec3& direction, double length) {
  Judgement judgement;
  judgement.met = true;
  judgement.value = 5.0;
  judgement.direction = direction.normalized();
  judgement.length = length;
  return judgement;
}

mesh::TetMesh plate(int nodes = 506) { return *mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, nodes); }

/// A straight front across the bar of 0.1 x 0.1 x 0.3 at height z, y = `depth`, that runs to +y.
Crack across_bar(const Surroundings& bar, double depth, double z = 0.15) {
  const auto start = make_crack(Vec3(0.05, 0.0, z), Vec3(0.05, depth, z), Vec3::UnitX(), bar);
  EXPECT_TRUE(start);
  return start->cracks.at(0);
}

/// What a front has to be after any advance.
void expect_regular(const Crack& crack, const Surroundings& surroundings) {
  ASSERT_GE(crack.front.size(), 2u);
  double shortest = 1e9;
  double longest = 0.0;
  for (std::size_t i = 0; i < crack.front.size(); ++i) {
    const FrontPoint& point = crack.front[i];
    EXPECT_TRUE(point.position.allFinite());
    EXPECT_NEAR(point.direction.norm(), 1.0, 1e-12);
    EXPECT_NEAR(point.tangent.norm(), 1.0, 1e-12);
    EXPECT_NEAR(point.direction.dot(point.tangent), 0.0, 1e-12);
    if (i == 0) continue;
    const double length = (point.position - crack.front[i - 1].position).norm();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    EXPECT_GT((point.position - crack.front[i - 1].position).dot(point.tangent), 0.0);
  }
  if (crack.front.size() > 2) {
    EXPECT_GT(shortest, 0.4 * surroundings.mean_edge());  // equal along the polyline; chords of its corners are shorter
    EXPECT_LT(longest, 1.6 * surroundings.mean_edge());
  }
  for (const Vec3& end : {crack.front.front().position, crack.front.back().position})
    EXPECT_LT((surroundings.nearest_on_surface(end) - end).norm(), 1e-5 * surroundings.mean_edge());
}

TEST(PlanAdvance, NeedsThatTheCriterionIsMet) {
  const Surroundings body(plate());
  const Crack crack = front_at(0.06, 0.12, 0.01);
  Judgement no = towards(Vec3::UnitX(), 0.03);
  no.met = false;
  EXPECT_FALSE(plan_advance(crack, std::vector{no}, body));
  EXPECT_FALSE(plan_advance(crack, {}, body));
}

TEST(PlanAdvance, OfAPlateIsOneStep) {
  const Surroundings body(plate());
  const Crack crack = front_at(0.06, 0.12, 0.01);
  const auto advance = plan_advance(crack, std::vector{towards(Vec3(1.0, 1.0, 0.0), 0.03)}, body);
  ASSERT_TRUE(advance);
  EXPECT_NEAR(advance->length, 0.03, 1e-15);
  EXPECT_NEAR(advance->angle, std::numbers::pi / 4.0, 1e-15);
  EXPECT_NEAR(advance->turn, std::numbers::pi / 4.0, 1e-15);
  EXPECT_EQ(advance->value, 5.0);
  EXPECT_EQ(advance->step[0], advance->step[1]);
  const auto none_above = plan_advance(crack, std::vector{towards(Vec3::UnitX(), 0.0)}, body);
  EXPECT_NEAR(none_above->length, body.mean_edge(), 1e-15);
}

TEST(Sweep, IsTheParallelogramAndALittleMore) {
  const Surroundings body(plate());
  const Crack crack = front_at(0.06, 0.12, 0.01);
  const auto advance = plan_advance(crack, std::vector{towards(Vec3(1.0, 1.0, 0.0), 0.03)}, body);
  const CutSurface surface = sweep(crack, *advance, 0.002);
  double area = 0.0;
  double lowest = 1.0;
  double highest = -1.0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 normal = (b - a).cross(c - a);
    area += 0.5 * normal.norm();
    EXPECT_GT(normal.dot(crack.front[0].normal()), 0.0);  // upper flank above
    for (const Vec3& x : {a, b, c}) {
      lowest = std::min(lowest, x[2]);
      highest = std::max(highest, x[2]);
    }
  }
  EXPECT_NEAR(area, 0.03 * 0.014, 1e-15);
  EXPECT_NEAR(lowest, -0.002, 1e-15);
  EXPECT_NEAR(highest, 0.012, 1e-15);
}

TEST(CutAlong, GoesOnUntilAnEdgeIsCut) {
  CutBody cut(plate());
  const Crack crack = front_at(0.0601, 0.1199, 0.01);
  auto advance = plan_advance(crack, std::vector{towards(Vec3::UnitX(), 1e-7)}, cut.surroundings);
  ASSERT_EQ(cut.incise(sweep(crack, *advance, 0.001)).edges_cut, 0);
  const Incision incision = cut_along(cut.body, cut.surroundings, crack, *advance, cut.settings);
  EXPECT_GT(incision.edges_cut, 0);
  EXPECT_GT(advance->length, 1e-7);
  EXPECT_LT(advance->length, 1.5 * cut.surroundings.mean_edge());
  EXPECT_NEAR(advance->step[0].norm(), advance->length, 1e-15);
}

// By splitting, an edge that is met opens nothing before a node is behind the front.
TEST(CutAlong, GoesOnUntilSomethingOpens) {
  for (const double x : {0.0601, 0.0655, 0.0702, 0.0755}) {
    CutBody cut(plate(), IncisionMethod::split);
    Crack crack = front_at(x, 0.1199, 0.01);
    cut.cut(make_crack(Vec3(0.0, 0.1199, 0.0), Vec3(x, 0.1199, 0.0), Vec3::UnitZ(), cut.surroundings)->surface);
    for (int step = 0; step < 20; ++step) {
      auto advance = plan_advance(crack, std::vector{towards(Vec3::UnitX(), 0.002)}, cut.surroundings);
      const Incision incision = cut_along(cut.body, cut.surroundings, crack, *advance, cut.settings);
      if (incision.edit.empty()) break;
      EXPECT_GT(incision.edges_cut, 0);
      EXPECT_FALSE(incision.edit.copied.empty());
      cut.apply(incision.edit);
      crack = advanced(crack, *advance, cut.surroundings, cut.body).at(0);
    }
    EXPECT_TRUE(crack.finished || crack.front[0].position[0] > 0.2);
    EXPECT_EQ(find_pieces(cut.body, cut.held).count(), 2U);
  }
}

// A crack that runs into the gap of another one and along it has nothing to open: no advance, no area.
TEST(CutAlong, OpensNothingInTheGapOfAnotherCrack) {
  CutBody cut(plate(), IncisionMethod::split);
  cut.cut(make_crack(Vec3(0.0, 0.12, 0.0), Vec3(0.2, 0.12, 0.0), Vec3::UnitZ(), cut.surroundings)->surface);
  const Crack crack = front_at(0.03, 0.12, 0.01);
  for (const double length : {0.002, 0.03, 0.094}) {
    auto advance = plan_advance(crack, std::vector{towards(Vec3::UnitX(), length)}, cut.surroundings);
    EXPECT_TRUE(cut_along(cut.body, cut.surroundings, crack, *advance, cut.settings).edit.empty()) << length;
  }
}

/// Tets in the solve of which all corners lie beyond `limit` along the axis.
std::vector<TetId> tets_beyond(const CutBody& cut, int axis, double limit) {
  std::vector<TetId> tets;
  for (std::size_t t = 0; t < cut.body.mesh().tet_count(); ++t) {
    const auto x = mesh::corners(cut.body.mesh(), TetId(t));
    if (cut.body.is_solved(TetId(t)) && std::all_of(x.begin(), x.end(), [&](const Vec3& v) { return v[axis] > limit; }))
      tets.emplace_back(t);
  }
  return tets;
}

/// Runs a crack straight on until it is finished; the body beyond `flank` has to stay as it is.
void expect_end_at(CutBody& cut, Crack crack, const Vec3& way, int axis, double flank) {
  const double edge = cut.surroundings.mean_edge();
  const std::vector<TetId> beyond = tets_beyond(cut, axis, flank + edge);
  ASSERT_FALSE(beyond.empty());
  int steps = 0;
  for (; !crack.finished && steps < 20; ++steps) {
    auto advance = plan_advance(crack, std::vector(crack.uniform ? 1 : crack.front.size(), towards(way, 1.7 * edge)),
                                cut.surroundings);
    ASSERT_TRUE(advance);
    const Incision incision = cut_along(cut.body, cut.surroundings, crack, *advance, cut.settings);
    if (incision.edit.empty()) break;
    cut.apply(incision.edit);
    const std::vector<Crack> after = advanced(crack, *advance, cut.surroundings, cut.body);
    ASSERT_EQ(after.size(), 1u);
    crack = after[0];
  }
  EXPECT_TRUE(crack.finished);
  EXPECT_GT(steps, 1);
  for (const FrontPoint& point : crack.front) {
    EXPECT_GE(point.position[axis], flank - edge);
    EXPECT_LE(point.position[axis], flank + (kIntoFlank + 1e-9) * edge);
  }
  EXPECT_EQ(tets_beyond(cut, axis, flank + edge), beyond);
}

TEST(CutAlong, EndsAtTheFlankOfAnOlderCrackOfAPlate) {
  for (const IncisionMethod method : {IncisionMethod::keep_nodes, IncisionMethod::split})
    for (const double slant : {0.0, 0.02}) {
      CutBody cut(plate(), method);
      cut.cut(make_crack(Vec3(0.15 - slant, 0.04, 0.0), Vec3(0.15 + slant, 0.2, 0.0), Vec3::UnitZ(), cut.surroundings)
                  ->surface);
      expect_end_at(cut, front_at(0.04, 0.12, 0.01), Vec3::UnitX(), 0, 0.15);
    }
}

TEST(CutAlong, EndsAtTheFlankOfAnOlderCrackOfABar) {
  for (const IncisionMethod method : {IncisionMethod::keep_nodes, IncisionMethod::split}) {
    CutBody cut(*mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 3000), method);
    cut.cut(make_crack(Vec3(0.05, 0.06, 0.07), Vec3(0.05, 0.06, 0.23), Vec3::UnitX(), cut.surroundings)->surface);
    expect_end_at(cut, across_bar(cut.surroundings, 0.01), Vec3::UnitY(), 1, 0.06);
  }
}

// Beside the older crack it goes on.
TEST(CutAlong, PassesAnOlderCrackThatIsNotInItsWay) {
  CutBody cut(plate());
  cut.cut(make_crack(Vec3(0.1, 0.04, 0.0), Vec3(0.15, 0.04, 0.0), Vec3::UnitZ(), cut.surroundings)->surface);
  Crack crack = front_at(0.04, 0.12, 0.01);
  for (int step = 0; step < 4; ++step) {
    auto advance = plan_advance(crack, std::vector{towards(Vec3::UnitX(), 0.03)}, cut.surroundings);
    cut.apply(cut_along(cut.body, cut.surroundings, crack, *advance, cut.settings).edit);
    EXPECT_FALSE(advance->stopped);
    crack = advanced(crack, *advance, cut.surroundings, cut.body).at(0);
  }
  EXPECT_FALSE(crack.finished);
  EXPECT_GT(crack.front[0].position[0], 0.15);
}

TEST(CutAlong, EndsWhereTheBodyEnds) {
  CutBody cut(plate());
  const Crack crack = front_at(0.2395, 0.1199, 0.01);
  auto advance = plan_advance(crack, std::vector{towards(Vec3::UnitX(), 0.001)}, cut.surroundings);
  const Incision incision = cut_along(cut.body, cut.surroundings, crack, *advance, cut.settings);
  if (!incision.edit.empty()) cut.apply(incision.edit);
  const std::vector<Crack> after = advanced(crack, *advance, cut.surroundings, cut.body);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_TRUE(after[0].finished);
  EXPECT_NEAR(after[0].area, 0.0005 * 0.01, 1e-3 * 0.0005 * 0.01);  // what lies inside; the rest swept air
}

/// Runs the plate's crack by maximum hoop and toughness 0 until it has come through; positions of the front.
std::vector<Vec3> run_through(const mesh::TetMesh& mesh, const WholeProblem& problem, const Vec3& from,
                              const Vec3& to) {
  CutBody cut(mesh);
  cut.hold([](const Vec3& x) { return x[1] < 1e-9 || x[1] > 0.24 - 1e-9; });
  const auto start = make_crack(from, to, Vec3::UnitZ(), cut.surroundings);
  EXPECT_TRUE(start);
  cut.cut(start->surface);
  std::vector<Crack> cracks = start->cracks;
  EXPECT_EQ(cracks.size(), 1u);
  const double edge = cut.surroundings.mean_edge();
  const auto criterion = make_criterion(
      "maximum-hoop", {.strength = 1.0, .advance_threshold = 1.0, .ahead_only = true, .mean_edge = edge});
  std::vector<Vec3> path{cracks[0].front[0].position};
  for (int step = 0; step < 60 && !cracks[0].finished; ++step) {
    const VectorX u = solve_whole(cut.body, problem);
    const LocalObject local = local_fields(cut.body, cut.surroundings, cracks[0], problem, u);
    std::vector<Judgement> judged = judge_front(**criterion, cracks[0], edge, local.stresses());
    judged[0] = by_toughness(judged[0], 1.0, 0.0, edge);
    auto advance = plan_advance(cracks[0], judged, cut.surroundings);
    if (!advance) break;
    cut.apply(cut_along(cut.body, cut.surroundings, cracks[0], *advance, cut.settings).edit);
    cracks = advanced(cracks[0], *advance, cut.surroundings, cut.body);
    EXPECT_EQ(cracks.size(), 1u);
    path.push_back(cracks[0].front[0].position);
    if (find_pieces(cut.body, cut.held).count() > 1) break;
  }
  return path;
}

TEST(Path, OfAPlatePulledOpenStaysInItsMiddle) {
  const mesh::TetMesh mesh = plate(1270);
  const std::vector<Vec3> path =
      run_through(mesh, pulled_plate(mesh, Mode::opening), Vec3(0.0, 0.12, 0.0), Vec3(0.06, 0.12, 0.0));
  EXPECT_GT(path.back()[0], 0.2);
  for (const Vec3& at : path) EXPECT_NEAR(at[1], 0.12, 0.005);  // 3 degrees over the 180 mm would be 9 mm
}

TEST(Path, MirrorsWithTheMesh) {
  const mesh::TetMesh mesh = plate(506);
  mesh::TetMesh mirrored = mesh;
  for (Vec3& x : mirrored.nodes) x[1] = 0.24 - x[1];
  for (mesh::Tet& tet : mirrored.tets) std::swap(tet[0], tet[1]);
  WholeProblem problem = pulled_plate(mesh, Mode::shear);
  WholeProblem problem_mirrored = problem;
  for (const auto& [dof, value] : problem.given)
    if (dof % 3 == 1) problem_mirrored.given[dof] = -value;
  // Off the mesh's own lines, where a node lies on the plane and belongs to the upper side whichever that is.
  const std::vector<Vec3> one = run_through(mesh, problem, Vec3(0.0, 0.1313, 0.0), Vec3(0.0611, 0.1313, 0.0));
  const std::vector<Vec3> other =
      run_through(mirrored, problem_mirrored, Vec3(0.0, 0.24 - 0.1313, 0.0), Vec3(0.0611, 0.24 - 0.1313, 0.0));
  ASSERT_EQ(one.size(), other.size());
  ASSERT_GT(one.size(), 4u);
  // Incision, solve and fit with signs changed: rounding, of which a flat maximum makes its root, 1e-8 radians an
  // advance. The normal of a crack mirrors with it (make_crack), and so do nodes that lie on its plane.
  for (std::size_t i = 0; i < one.size(); ++i)
    EXPECT_LT(std::hypot(one[i][0] - other[i][0], one[i][1] - (0.24 - other[i][1])), 1e-7) << i;
}

TEST(Advanced, FrontsOfABarStayRegularAndOnItsSurface) {
  const Surroundings bar(*mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 1500));
  const mesh::TornMesh body(*mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 1500));
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Crack> cracks{across_bar(bar, 0.02)};
    for (int step = 0; step < 12 && !cracks[0].finished; ++step) {
      const Crack& crack = cracks[0];
      ASSERT_FALSE(crack.uniform);
      expect_regular(crack, bar);
      std::vector<Judgement> judgements;
      for (const FrontPoint& point : crack.front) {  // wild: up to 60 degrees either way, a third of the points not met
        const double angle = (2.0 * uniform(random) - 1.0) * 60.0 * kDegree;
        judgements.push_back(
            towards(std::cos(angle) * point.direction + std::sin(angle) * point.normal(), 0.03 * uniform(random)));
        judgements.back().met = uniform(random) > 0.3;
      }
      const auto advance = plan_advance(crack, judgements, bar);
      if (!advance) continue;
      const double before = crack.area;
      cracks = advanced(crack, *advance, bar, body);
      if (cracks[0].finished)
        EXPECT_GE(cracks[0].area, before);  // what it left the body by may lie outside
      else
        EXPECT_GT(cracks[0].area, before);
      EXPECT_LT(cracks[0].area, 0.05);
    }
    for (const Crack& crack : cracks) {
      if (!crack.finished) expect_regular(crack, bar);
    }
  }
}

TEST(Advanced, FrontsOfATubeEndOnItsWalls) {
  const mesh::TetMesh mesh = *mesh::make_tube({.radius = 0.005, .length = 0.03, .wall = 0.002, .bend = 30.0}, 3000);
  const Surroundings tube(mesh);
  const mesh::TornMesh body(mesh);
  std::mt19937_64 random(8);
  int advances = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const double z = 0.004 + 0.004 * uniform(random);
    const auto start =
        make_crack(Vec3(0.0, 0.007, z), Vec3(0.0, 0.006 * uniform(random) - 0.002, z), Vec3::UnitX(), tube);
    if (!start) continue;
    std::vector<Crack> cracks = start->cracks;
    for (int step = 0; step < 30 && !cracks.empty(); ++step) {
      const Crack crack = cracks.back();
      cracks.pop_back();
      if (crack.finished) continue;
      std::vector<Judgement> judgements;
      for (const FrontPoint& point : crack.front) {
        const double angle = (2.0 * uniform(random) - 1.0) * 90.0 * kDegree;
        judgements.push_back(towards(std::cos(angle) * point.direction + std::sin(angle) * point.normal(),
                                     4.0 * tube.mean_edge() * uniform(random)));
      }
      const auto advance = plan_advance(crack, judgements, tube);
      ASSERT_TRUE(advance);
      ASSERT_TRUE(std::isfinite(advance->length));
      for (const Crack& after : advanced(crack, *advance, tube, body)) {
        for (const FrontPoint& point : after.front) {
          ASSERT_TRUE(point.position.allFinite() && point.direction.allFinite());
          if (after.finished) continue;
          EXPECT_NEAR(point.direction.norm(), 1.0, 1e-12);
          EXPECT_NEAR(point.direction.dot(point.tangent), 0.0, 1e-12);
        }
        if (!after.finished) cracks.push_back(after);
      }
      ++advances;
    }
  }
  EXPECT_GT(advances, 50);
}

TEST(Advanced, KeepsTheUpperFlank) {
  const mesh::TetMesh mesh = *mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 1500);
  const Surroundings bar(mesh);
  const Crack crack = across_bar(bar, 0.03);
  const std::vector<Judgement> judgements(crack.front.size(), towards(Vec3::UnitY(), 0.02));
  const auto advance = plan_advance(crack, judgements, bar);
  const Crack after = advanced(crack, *advance, bar, mesh::TornMesh(mesh)).at(0);
  EXPECT_EQ(after.front.size(), crack.front.size());
  for (const FrontPoint& point : after.front) {
    EXPECT_NEAR(point.position[1], 0.05, 1e-9);
    EXPECT_GT(point.normal().dot(crack.front[0].normal()), 1.0 - 1e-9);
  }
  EXPECT_NEAR(after.area, 0.1 * 0.02, 1e-6 * 0.1 * 0.02);  // the interval of a line in the body knows 1e-7 of an edge
}

TEST(Advanced, AFrontThatMeetsTheHoleOfATubeComesApart) {
  const mesh::TetMesh mesh = *mesh::make_tube({.radius = 0.005, .length = 0.04, .wall = 0.0015, .bend = 0.0}, 4000);
  const Surroundings tube(mesh);
  // Above the hole (radius 3.5 mm), then down into it.
  const auto start = make_crack(Vec3(0.0, 0.006, 0.02), Vec3(0.0, 0.0041, 0.02), Vec3::UnitX(), tube);
  ASSERT_TRUE(start);
  ASSERT_EQ(start->cracks.size(), 1u);
  const Crack& crack = start->cracks[0];
  const auto advance =
      plan_advance(crack, std::vector<Judgement>(crack.front.size(), towards(-Vec3::UnitY(), 0.0025)), tube);
  const std::vector<Crack> after = advanced(crack, *advance, tube, mesh::TornMesh(mesh));
  ASSERT_EQ(after.size(), 2u);
  for (const Crack& one : after) {
    EXPECT_FALSE(one.finished);
    expect_regular(one, tube);
  }
  EXPECT_LT(after[0].front.back().position[0] * after[1].front.front().position[0], 0.0);  // on either side of the hole
  EXPECT_EQ(after[1].area, 0.0);
}

TEST(Advanced, IsFinishedWithNothingInTheSolveAhead) {
  CutBody cut(plate());
  const Crack crack = front_at(0.12, 0.12, 0.01);
  const auto advance = plan_advance(crack, std::vector{towards(Vec3::UnitX(), 0.02)}, cut.surroundings);
  EXPECT_FALSE(advanced(crack, *advance, cut.surroundings, cut.body).at(0).finished);
  mesh::MeshEdit edit;  // all that lies ahead comes off
  for (std::size_t tet = 0; tet < cut.body.mesh().tet_count(); ++tet) {
    double x = 0.0;
    for (const NodeId node : cut.body.mesh().tets[tet]) x += 0.25 * cut.body.mesh().node(node)[0];
    if (x > 0.14) edit.frozen.emplace_back(tet);
  }
  cut.apply(edit);
  EXPECT_TRUE(advanced(crack, *advance, cut.surroundings, cut.body).at(0).finished);
  EXPECT_TRUE(judge_front(*make_criterion("von-mises", {1.0, 1.0, true, 0.01}).value(),
                          advanced(crack, *advance, cut.surroundings, cut.body)[0], 0.01, {})
                  .empty());
}

TEST(FrontSections, CoverTheFrontWithAMeanEdgeAtLeast) {
  const Surroundings bar(*mesh::make_bar({Vec3(0.1, 0.1, 0.3)}, 1500));
  const Crack crack = across_bar(bar, 0.03);
  const auto sections = front_sections(crack, bar.mean_edge());
  ASSERT_EQ(sections.size(), crack.front.size());
  for (const FrontSection& section : sections) EXPECT_GE(section.half_width, bar.mean_edge());
  EXPECT_EQ(front_sections(front_at(0.06, 0.12, 0.01), 0.01).size(), 1u);
}

}  // namespace
}  // namespace rhexis::fracture::test
