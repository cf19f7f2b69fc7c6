#include "response/corridor.h"

#include <gtest/gtest.h>

#include "response/followed.h"
#include "tests/response/torn_case.h"
#include "tests/support/measured.h"

namespace rhexis::response::test {
namespace {

TEST(Corridor, IsASlabInThePlaneOfTheFront) {
  const TornCase body = plate_case(3000);
  const double half = kCorridorEdges * body.edge();
  Focus focus{{0.117, 0.06, 0.005}, Vec3::UnitY(), 0.005, 4.0 * body.edge(), Vec3::UnitZ()};
  const std::vector<std::int32_t> weight = separator_weights(body.cut.body, std::span(&focus, 1));
  int inside = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const Vec3& x = body.cut.body.mesh().nodes[i];
    // The mean over edges as often as tets have them is not quite the mean over edges.
    const double off = std::abs(x[0] - 0.117) / half;
    if (off < 0.95) {
      EXPECT_EQ(weight[i], kCorridorWeight);
      ++inside;
    } else if (off > 1.05) {
      EXPECT_EQ(weight[i], 1);
    }
  }
  EXPECT_GT(inside, 50);
}

TEST(Corridor, IsARodWhereThePlaneIsNotKnownAndNothingWithoutADirection) {
  const TornCase body = bar_case(1800);
  const auto heavy = [&](const Focus& focus) {
    const std::vector<std::int32_t> weight = separator_weights(body.cut.body, std::span(&focus, 1));
    return std::count(weight.begin(), weight.end(), kCorridorWeight);
  };
  Focus focus{{0.043, 0.0, 0.02}, Vec3::UnitY(), 0.0, 2.0 * body.edge()};
  const auto rod = heavy(focus);
  EXPECT_GT(rod, 0);
  focus.half_length = 0.02;
  focus.tangent = Vec3::UnitZ();
  EXPECT_GT(heavy(focus), 0);
  focus.direction.setZero();
  EXPECT_EQ(heavy(focus), 0);
}

TEST(Corridor, AheadOfTheFrontComesTheNextEdit) {
  const TornCase body = plate_case(3000);
  const mesh::TornMesh& mesh = body.cut.body;
  Focus focus{{0.117, 0.06, 0.005}, Vec3::UnitY(), 0.005, 4.0 * body.edge(), Vec3::UnitZ()};
  const std::vector<std::int32_t> ahead = nodes_ahead(mesh, std::span(&focus, 1));
  ASSERT_GT(ahead.size(), 5U);
  for (std::size_t i = 0; i < mesh.mesh().node_count(); ++i) {
    const Vec3 from = mesh.mesh().nodes[i] - focus.centre;
    EXPECT_EQ(std::binary_search(ahead.begin(), ahead.end(), static_cast<std::int32_t>(i)),
              from.y() > 0.0 && from.head<2>().norm() <= 2.0 * body.edge())
        << i;
  }
  focus.direction.setZero();
  EXPECT_TRUE(nodes_ahead(mesh, std::span(&focus, 1)).empty());
}

TEST(Corridor, MakesTheUpdatesOfACrackThatRunsStraightCheaper) {
  const auto flops = [](bool known) {
    TornCase body = plate_case(6000);
    const Focus focus = body.focus(4.0);
    const ElasticModel model(body.elastic, body.cut.body.intact_node_count());
    const std::span<const Focus> foci(&focus, known ? 1 : 0);
    auto tree =
        linalg::FrontTree::make(ElasticElements(body.cut.body, model), {}, separator_weights(body.cut.body, foci));
    double sum = 0.0;
    for (int step = 0; step < 20; ++step) {
      linalg::ElementChange change;
      const mesh::MeshEdit edit = body.step(1.0);
      add_applied(body.cut.body, edit, change);
      tree = tree->updated(ElasticElements(body.cut.body, model), change);
      sum += tree->flops_made();
    }
    return sum;
  };
  const double with = flops(true);
  const double without = flops(false);
  // The crack runs down the middle, where nested dissection likes to cut.
  EXPECT_LT(with, 0.7 * without);
  rhexis::test::measured("plate of 6000 nodes: {:.1f} million operations an advance, {:.1f} where the way is not known",
                         1e-6 * with / 20.0, 1e-6 * without / 20.0);
}

}  // namespace
}  // namespace rhexis::response::test
