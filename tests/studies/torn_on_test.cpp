#include "studies/torn_on.h"

#include <gtest/gtest.h>

namespace rhexis::studies {
namespace {

TEST(StudyPlate, IsThatOfTheThesis) {
  const StudyPlate plate = *make_study_plate(506);
  EXPECT_EQ(plate.mesh.node_count(), 506U);
  const Vec3 size = mesh::bounding_box(plate.mesh).size();
  EXPECT_NEAR((size - Vec3(0.24, 0.24, 0.01)).norm(), 0.0, 1e-12);
  EXPECT_EQ(plate.settings.body.supports.size(), 3 * plate.mesh.find_node_set("+x")->nodes.size());
  EXPECT_FALSE(make_study_plate(3));
}

TEST(TornOn, ImposedAdvancesAreThoseOfTheThesis) {
  Expected<TornOn> torn = TornOn::start(*make_study_plate(300), TearMode::imposed, true);
  ASSERT_TRUE(torn);
  EXPECT_TRUE(torn->advances().empty());
  torn->tear_on(1);
  EXPECT_EQ(torn->advances().size(), 1U);
  EXPECT_FALSE(torn->at_end());
  EXPECT_DOUBLE_EQ(torn->part_done(), 0.5);
  torn->tear_on(5);
  EXPECT_TRUE(torn->at_end());
  EXPECT_DOUBLE_EQ(torn->part_done(), 1.0);
  ASSERT_EQ(torn->advances().size(), 2U);
  double y = 0.06;
  for (const TimedAdvance& advance : torn->advances()) {
    EXPECT_NEAR(advance.record.length, kImposedLength, 1e-12);
    EXPECT_NEAR(advance.record.angle, 90.0, 1e-9);
    y += kImposedLength;
    EXPECT_NEAR(advance.record.front_after.front().y(), y, 1e-12);
    EXPECT_NEAR(advance.record.front_after.front().x(), 0.12, 1e-12);
    EXPECT_DOUBLE_EQ(torn->local_radius(advance.record), kImposedLength);
  }
  EXPECT_EQ(torn->body().topology(), 3U);
}

TEST(TornOn, ASlowPullGivesManyShortAdvances) {
  Expected<TornOn> torn = TornOn::start(*make_study_plate(506), TearMode::slow_pull, true);
  ASSERT_TRUE(torn);
  while (!torn->at_end()) torn->tear_on(2);
  ASSERT_GE(torn->advances().size(), 5U);
  EXPECT_EQ(torn->body().topology(), torn->advances().size() + 1);
  for (const TimedAdvance& advance : torn->advances()) {
    EXPECT_GT(advance.record.length, 0.0);
    EXPECT_LT(advance.record.length, 3.0 * 17.5e-3);  // m, mean edge of that plate
    // The parts are within the whole; clocks are read apart.
    EXPECT_GE(advance.seconds,
              advance.record.remesh_seconds + advance.record.local_seconds + advance.record.update_seconds - 1e-5);
  }
}

}  // namespace
}  // namespace rhexis::studies
