#include "fracture/local_object.h"

#include <gtest/gtest.h>

#include <random>

#include "fracture/path_start.h"
#include "tests/fracture/cracked_plate.h"
#include "tests/fracture/cut_support.h"
#include "tests/fracture/stress_fields.h"

namespace rhexis::fracture::test {
namespace {

/// The thesis's plate, cut from the middle of y = 0 as its scene has it, held and pulled somehow.
struct Torn {
  explicit Torn(int nodes = 506) : cut(*mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, nodes)) {
    const auto start = make_crack(Vec3(0.12, 0.0, 0.0), Vec3(0.12, 0.06, 0.0), Vec3::UnitZ(), cut.surroundings);
    EXPECT_TRUE(start);
    cut.hold([](const Vec3& x) { return x[1] > 0.24 - 1e-9; });
    cut.cut(start->surface);
    crack = start->cracks.at(0);
    problem.elastic = {.young = 1.0e6, .poisson = 0.4};
    problem.body_force = Vec3(0.0, -300.0, -9810.0);
    for (const NodeId node : cut.body.mesh().find_node_set("+y")->nodes)
      for (int i = 0; i < 3; ++i) problem.given[3 * node.value() + i] = 0.0;
    for (const NodeId node : cut.body.mesh().find_node_set("-y")->nodes)
      problem.force[3 * node.value()] = cut.body.mesh().node(node)[0] < 0.12 ? -0.2 : 0.3;
    node_force.assign(cut.body.mesh().node_count(), Vec3::Zero());
    for (const auto& [dof, value] : problem.force) node_force[static_cast<std::size_t>(dof / 3)][dof % 3] += value;
    supported.assign(cut.body.mesh().node_count(), 0);
    for (const auto& [dof, value] : problem.given) supported[static_cast<std::size_t>(dof / 3)] = 1;
    u = solve_whole(cut.body, problem);
  }
  std::vector<TetId> tets(double edges) const {
    return cut.surroundings.tets_near(cut.body, crack, edges * cut.surroundings.mean_edge());
  }
  LocalObject local(std::vector<TetId> of, std::vector<NodeId> hand = {}) const {
    return {cut.body,      problem.elastic,
            std::move(of), supported,
            hand,          {.body_force = problem.body_force, .node_force = node_force}};
  }
  VectorX at(const std::vector<NodeId>& nodes) const {
    VectorX out(3 * static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i)
      out.segment<3>(3 * static_cast<Eigen::Index>(i)) = u.segment<3>(3 * nodes[i].value());
    return out;
  }

  CutBody cut;
  Crack crack;
  WholeProblem problem;
  std::vector<Vec3> node_force;
  std::vector<std::uint8_t> supported;
  VectorX u;
};

TEST(LocalObject, IsTheWholeBodyWhenItsBoundaryIsGiven) {
  const Torn torn;
  // Two solves of condition about 1e5 each: their difference is rounding times that.
  const double scale = torn.u.cwiseAbs().maxCoeff();
  ASSERT_GT(scale, 1e-4);
  for (const double edges : {1.5, 4.0, 8.0, 40.0}) {
    LocalObject local = torn.local(torn.tets(edges));
    ASSERT_FALSE(local.interior().empty());
    ASSERT_TRUE(local.solve(torn.at(local.boundary())));
    EXPECT_LT((local.displacement() - torn.at(local.nodes())).cwiseAbs().maxCoeff(), 1e-10 * scale);
    LocalObject taken = torn.local(torn.tets(edges));
    taken.take(torn.at(taken.nodes()));
    EXPECT_EQ(taken.displacement(), torn.at(local.nodes()));
    double stress_scale = 0.0;
    double worst = 0.0;
    for (const TetStress& here : local.stresses()) {
      const TetStress whole = stress_of(torn.cut.body, torn.problem.elastic, here.tet, torn.u);
      stress_scale = std::max(stress_scale, whole.stress.cwiseAbs().maxCoeff());
      worst = std::max(worst, (here.stress - whole.stress).cwiseAbs().maxCoeff());
      EXPECT_EQ(taken.stresses()[static_cast<std::size_t>(&here - local.stresses().data())].stress, whole.stress);
      EXPECT_EQ(here.centroid, whole.centroid);
      EXPECT_EQ(here.volume, whole.volume);
    }
    EXPECT_GT(stress_scale, 10.0);
    EXPECT_LT(worst, 1e-9 * stress_scale);
    if (edges == 40.0) {  // all of the plate
      EXPECT_EQ(local.boundary(), torn.cut.body.mesh().find_node_set("+y")->nodes);
    }
  }
}

TEST(LocalObject, GivesTheGradientOfItsStress) {
  const Torn torn;
  LocalObject local = torn.local(torn.tets(4.0));
  ASSERT_TRUE(local.solve(torn.at(local.boundary())));
  for (std::size_t i = 0; i < local.tets().size(); ++i) {
    const Mat3 again = element::small_strain_stress(torn.problem.elastic, local.gradients()[i]);
    EXPECT_EQ(again, local.stresses()[i].stress);
    EXPECT_EQ(local.stresses()[i].tet, local.tets()[i]);
  }
}

TEST(LocalObject, LoadsItsInteriorMatter) {
  const Torn torn;
  LocalObject without(torn.cut.body, torn.problem.elastic, torn.tets(4.0), torn.supported, {});
  ASSERT_TRUE(without.solve(torn.at(without.boundary())));
  EXPECT_GT((without.displacement() - torn.at(without.nodes())).cwiseAbs().maxCoeff(),
            1e-6 * torn.u.cwiseAbs().maxCoeff());
}

TEST(LocalObject, HeldAndSupportedNodesAreBoundary) {
  const Torn torn;
  const LocalObject free = torn.local(torn.tets(4.0));
  const NodeId held = free.interior().at(free.interior().size() / 2);
  const LocalObject local = torn.local(torn.tets(4.0), {held});
  EXPECT_EQ(local.interior().size() + 1, free.interior().size());
  EXPECT_TRUE(std::binary_search(local.boundary().begin(), local.boundary().end(), held));
  int at_hand = 0;
  for (const TetStress& stress : local.stresses()) {
    const mesh::Tet& tet = torn.cut.body.mesh().tet(stress.tet);
    EXPECT_EQ(stress.at_hand, std::find(tet.begin(), tet.end(), held) != tet.end());
    at_hand += stress.at_hand ? 1 : 0;
  }
  EXPECT_GT(at_hand, 0);
}

TEST(LocalObject, SolvesAgainAndAgain) {
  const Torn torn;
  LocalObject local = torn.local(torn.tets(4.0));
  const VectorX given = torn.at(local.boundary());
  ASSERT_TRUE(local.solve(given));
  const VectorX first = local.displacement();
  ASSERT_TRUE(local.solve(VectorX(2.0 * given)));
  EXPECT_GT((local.displacement() - first).norm(), 0.1 * first.norm());
  ASSERT_TRUE(local.solve(given));
  EXPECT_EQ(local.displacement(), first);
}

TEST(LocalObject, MayHaveNoInterior) {
  const Torn torn;
  LocalObject local = torn.local({torn.tets(4.0).front()});
  EXPECT_TRUE(local.interior().empty());
  ASSERT_TRUE(local.solve(torn.at(local.boundary())));
  EXPECT_GT(local.stresses()[0].stress.norm(), 0.0);
  LocalObject none = torn.local({});
  ASSERT_TRUE(none.solve(VectorX()));
  EXPECT_TRUE(none.stresses().empty());
}

TEST(LocalObject, SaysWhenItHangsOnNothing) {
  // A whole body without a support has no boundary, and its stiffness three translations and three turns too many.
  const mesh::TornMesh body(*mesh::make_bar({Vec3(0.01, 0.01, 0.03)}, 60));
  std::vector<TetId> all;
  for (std::size_t tet = 0; tet < body.mesh().tet_count(); ++tet) all.emplace_back(tet);
  const std::vector<std::uint8_t> supported(body.mesh().node_count(), 0);
  LocalObject local(body, {.young = 1e6, .poisson = 0.4}, all, supported, {});
  EXPECT_FALSE(local.factor());
  EXPECT_FALSE(local.solve(VectorX()));
}

}  // namespace
}  // namespace rhexis::fracture::test
