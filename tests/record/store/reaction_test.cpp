#include "record/store/reaction.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "record/store/axis.h"
#include "tests/record/store/some_record.h"
#include "tests/support/counted_allocations.h"

namespace rhexis::record::store {
namespace {

Parameters parameters() {
  Parameters out;
  out.advances = 2;
  out.directions = 5;
  out.lengths = {0.02, 0.03, 0.05};
  out.pull_directions = 8;
  return out;
}

Vec3 pull_at(const Frame& frame, double degrees, double length) { return length * frame.direction(degrees); }

/// (4.22) as it stands in the thesis: five sums of two.
Vec3 written_out(const Record& record, const Lookup& lookup, const std::array<Advanced, 2>& advances, int point,
                 double degrees, double length) {
  const std::vector<double> angles = direction_angles(record.head.parameters);
  const std::vector<double> pulls = pull_angles(record.head.parameters);
  const std::vector<double>& lengths = record.head.parameters.lengths;
  const Numbering numbering(record.head.parameters);
  std::array<Neighbours, 2> w;
  std::array<Neighbours, 2> u;
  for (std::size_t i = 0; i < 2; ++i) {
    w[i] = neighbours_on(angles, advances[i].angle);
    u[i] = neighbours_on(lengths, advances[i].length);
  }
  const Neighbours v = neighbours_around(pulls, degrees);
  Vec3 sum = Vec3::Zero();
  for (std::size_t e = 0; e < 2; ++e)
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b)
        for (std::size_t c = 0; c < 2; ++c)
          for (std::size_t d = 0; d < 2; ++d) {
            const std::vector<Choice> history{{w[0].index[a], u[0].index[b]}, {w[1].index[c], u[1].index[d]}};
            sum += v.weight[e] * w[0].weight[a] * u[0].weight[b] * w[1].weight[c] * u[1].weight[d] *
                   lookup.recorded(numbering.number(history), point, v.index[e]);
          }
  return length / record.head.parameters.pull_length * sum;
}

TEST(Reaction, IsTheSumOfTheThesisToTheLetter) {
  const Record record = test::some_record(parameters(), false, false).record();
  const Lookup lookup(record);
  for (const auto& [first, second, degrees] : {std::tuple(Advanced{12.0, 0.021}, Advanced{100.0, 0.044}, 17.0),
                                               std::tuple(Advanced{45.0, 0.03}, Advanced{179.0, 0.05}, 350.0),
                                               std::tuple(Advanced{90.0, 0.02}, Advanced{0.0, 0.025}, 90.0)}) {
    const std::array<Advanced, 2> advances{first, second};
    for (int point = 0; point < 3; ++point) {
      const Reaction is = lookup.reaction(advances, point, pull_at(record.head.frame, degrees, 0.05));
      const Vec3 wanted = written_out(record, lookup, advances, point, degrees, 0.05);
      EXPECT_LT((is.force - wanted).norm(), 1e-13 * wanted.norm());  // 32 terms in another order
      EXPECT_FALSE(is.outside || is.past_last || is.out_of_plane);
    }
  }
}

TEST(Reaction, AtARecordedPointIsWhatWasRecorded) {
  const Record record = test::some_record(parameters(), false, false).record();
  const Lookup lookup(record);
  const std::array<Advanced, 1> advances{Advanced{45.0, 0.03}};
  const int topology = Numbering(parameters()).number(std::vector<Choice>{{1, 1}});
  EXPECT_EQ(lookup.nearest(advances).topology, topology);
  const double length = parameters().pull_length;
  const Vec3 is = lookup.reaction(advances, 2, pull_at(record.head.frame, 45.0, length)).force;
  EXPECT_LT((is - record.stiffness_at(topology, 2) * pull_at(record.head.frame, 45.0, length)).norm(), 1e-14);
  EXPECT_EQ(lookup.reaction({}, 0, Vec3::Zero()).force, Vec3(Vec3::Zero()));
}

TEST(Reaction, SaysWhatLiesOutside) {
  const Record record = test::some_record(parameters(), false, false).record();
  const Lookup lookup(record);
  const Vec3 pull = pull_at(record.head.frame, 20.0, 0.1);
  const std::array<Advanced, 3> three{Advanced{45.0, 0.03}, Advanced{90.0, 0.05}, Advanced{1.0, 1.0}};
  const Reaction held = lookup.reaction(three, 0, pull);
  EXPECT_TRUE(held.past_last);
  EXPECT_FALSE(held.outside);  // the third does not count
  EXPECT_EQ(held.force, lookup.reaction(std::span(three).first(2), 0, pull).force);
  EXPECT_TRUE(lookup.nearest(three).past_last);

  const std::array<Advanced, 1> beyond{Advanced{200.0, 0.01}};
  const std::array<Advanced, 1> end{Advanced{180.0, 0.02}};
  EXPECT_TRUE(lookup.reaction(beyond, 0, pull).outside);
  EXPECT_TRUE(lookup.nearest(beyond).outside);
  EXPECT_EQ(lookup.reaction(beyond, 0, pull).force, lookup.reaction(end, 0, pull).force);

  EXPECT_TRUE(lookup.reaction(end, 0, pull + 0.01 * record.head.frame.z).out_of_plane);
  const std::array<Advanced, 1> fourth{Advanced{45.0, 0.02}};  // topology 4 has lost point 1
  EXPECT_TRUE(lookup.reaction(fourth, 1, pull).torn_off);
  EXPECT_FALSE(lookup.reaction(fourth, 0, pull).torn_off);
}

TEST(Reaction, NearestIsTheLeastDifferenceInEveryDimension) {
  const Record record = test::some_record(parameters(), false, false).record();
  const Lookup lookup(record);
  const std::vector<double> angles = direction_angles(parameters());
  const std::vector<double>& lengths = record.head.parameters.lengths;
  const Numbering numbering(parameters());
  const auto nearest = [](const std::vector<double>& axis, double value) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < axis.size(); ++k)
      if (std::abs(axis[k] - value) < std::abs(axis[best] - value)) best = k;
    return static_cast<int>(best);
  };
  for (double angle = 1.0; angle < 180.0; angle += 7.0) {
    for (double length = 0.021; length < 0.05; length += 0.0037) {
      const std::array<Advanced, 2> advances{Advanced{angle, length}, Advanced{180.0 - angle, 0.07 - length}};
      std::vector<Choice> history;
      for (const Advanced& one : advances)
        history.push_back({nearest(angles, one.angle), nearest(lengths, one.length)});
      EXPECT_EQ(lookup.nearest(advances).topology, numbering.number(history)) << angle << ' ' << length;
    }
  }
}

TEST(Reaction, IsThatOfTheStiffnessForPullsInTheDirectionsOfTheRecord) {
  const Record record = test::some_record(parameters(), false, false).record();
  const Lookup lookup(record);
  const std::array<Advanced, 3> advances{Advanced{12.0, 0.021}, Advanced{100.0, 0.09}, Advanced{80.0, 0.03}};
  for (std::size_t n = 0; n <= 3; ++n) {
    const std::span<const Advanced> so_far = std::span(advances).first(n);
    double weights = 0.0;
    lookup.each_topology(so_far, [&](int /*topology*/, double weight) { weights += weight; });
    EXPECT_NEAR(weights, 1.0, 1e-15);
    for (int point = 0; point < 3; ++point) {
      const Stiffness stiffness = lookup.stiffness(so_far, point);
      for (const double angle : pull_angles(record.head.parameters)) {
        const Vec3 pull = pull_at(record.head.frame, angle, 0.05);
        const Reaction reaction = lookup.reaction(so_far, point, pull);
        EXPECT_LT((stiffness.value * pull - reaction.force).norm(), 1e-13 * reaction.force.norm());
        EXPECT_EQ(stiffness.outside, reaction.outside);
        EXPECT_EQ(stiffness.past_last, reaction.past_last);
        EXPECT_EQ(stiffness.torn_off, reaction.torn_off);
      }
      // In between, (4.14) takes the chord of two recorded reactions: short by no more than 1 - cos of half their
      // angle, and by what the stiffness makes of the pull that is left out.
      const Vec3 between = pull_at(record.head.frame, 22.5, 0.05);
      EXPECT_NE(stiffness.value * between, lookup.reaction(so_far, point, between).force);
    }
  }
}

TEST(Reaction, AsksForNoMemory) {
#ifndef RHEXIS_COUNTS_MALLOC
  GTEST_SKIP() << "the sanitizer has its own malloc";
#endif
  Parameters three = parameters();
  three.advances = 3;
  const Record record = test::some_record(three, false, false).record();
  const Lookup lookup(record);
  const std::array<Advanced, 3> advances{Advanced{12.0, 0.021}, Advanced{100.0, 0.044}, Advanced{80.0, 0.03}};
  const Vec3 pull = pull_at(record.head.frame, 33.0, 0.05);
  Vec3 sum = Vec3::Zero();
  const long before = rhexis::test::allocations;
  for (std::size_t n = 0; n <= 3; ++n) {
    sum += lookup.reaction(std::span(advances).first(n), 0, pull).force;
    sum += lookup.stiffness(std::span(advances).first(n), 0).value * pull;
    sum[0] += lookup.nearest(std::span(advances).first(n)).topology;
  }
  EXPECT_EQ(rhexis::test::allocations, before);
  EXPECT_GT(sum.norm(), 0.0);
}

}  // namespace
}  // namespace rhexis::record::store
