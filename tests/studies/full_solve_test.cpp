#include "studies/full_solve.h"

#include <gtest/gtest.h>

#include "studies/study_plate.h"

namespace rhexis::studies {
namespace {

TEST(FullSolve, TakesTimeForEveryPart) {
  const StudyPlate plate = *make_study_plate(150);
  const mesh::TornMesh body(plate.mesh);
  const std::optional<FullSolveSeconds> sparse = time_sparse_factor(body, plate.settings.body);
  ASSERT_TRUE(sparse);
  EXPECT_GT(sparse->assembly, 0.0);
  EXPECT_GT(sparse->analysis, 0.0);
  EXPECT_GT(sparse->factor, 0.0);
  EXPECT_DOUBLE_EQ(sparse->total(), sparse->assembly + sparse->analysis + sparse->factor);
  const std::optional<FullSolveSeconds> dense = time_dense_inverse(body, plate.settings.body);
  ASSERT_TRUE(dense);
  EXPECT_GT(dense->assembly, 0.0);
  EXPECT_EQ(dense->analysis, 0.0);
  EXPECT_GT(dense->factor, 0.0);
}

// Both see the present topology: without supports, or with a part that nothing holds, there is no factor; with that
// part out of the solve there is.
TEST(FullSolve, SeesWhatHoldsTheTornBody) {
  const StudyPlate plate = *make_study_plate(150);
  response::ElasticBody loose = plate.settings.body;
  loose.supports.clear();
  mesh::TornMesh body(plate.mesh);
  EXPECT_FALSE(time_sparse_factor(body, loose));
  EXPECT_FALSE(time_dense_inverse(body, loose));

  // A band of tets goes from the middle.
  mesh::MeshEdit cut;
  mesh::MeshEdit frozen;
  for (std::size_t t = 0; t < plate.mesh.tet_count(); ++t) {
    double least = 1.0;
    double most = 0.0;
    for (const NodeId node : plate.mesh.tets[t]) {
      least = std::min(least, plate.mesh.node(node).x());
      most = std::max(most, plate.mesh.node(node).x());
    }
    if (least <= 0.12 && most > 0.12) cut.removed.emplace_back(t);
    if (most <= 0.12) frozen.frozen.emplace_back(t);
  }
  ASSERT_FALSE(cut.removed.empty());
  ASSERT_FALSE(frozen.frozen.empty());
  body.apply(cut);
  EXPECT_FALSE(time_sparse_factor(body, plate.settings.body));
  EXPECT_FALSE(time_dense_inverse(body, plate.settings.body));
  body.apply(frozen);
  EXPECT_TRUE(time_sparse_factor(body, plate.settings.body));
  EXPECT_TRUE(time_dense_inverse(body, plate.settings.body));
}

}  // namespace
}  // namespace rhexis::studies
