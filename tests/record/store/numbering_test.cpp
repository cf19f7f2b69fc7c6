#include <gmock/gmock.h>

#include "record/store/parameters.h"

namespace rhexis::record::store {
namespace {

using testing::ElementsAre;

Parameters parameters(int advances, int directions, std::vector<double> lengths) {
  Parameters out;
  out.advances = advances;
  out.directions = directions;
  out.lengths = std::move(lengths);
  return out;
}

TEST(Numbering, TheThesisHas183) {
  const Numbering numbering{Parameters{}};
  EXPECT_EQ(numbering.count(), 183);  // 13 + 13^2, and the body before
  EXPECT_EQ(Numbering::count_of(Parameters{}), 183);
  EXPECT_EQ(direction_angles(Parameters{}),
            (std::vector<double>{0, 15, 30, 45, 60, 75, 90, 105, 120, 135, 150, 165, 180}));
  EXPECT_EQ(pull_angles(Parameters{}).size(), 36U);
  EXPECT_EQ(pull_angles(Parameters{})[35], 350.0);
  EXPECT_THAT(direction_angles(parameters(1, 1, {0.1})), ElementsAre(90.0));
}

/// All histories, level by level, each level in the order of its first advance, then of its second, ...
TEST(Numbering, IsThatOfAListWrittenOut) {
  const Parameters all = parameters(3, 2, {0.1, 0.2, 0.3});
  const Numbering numbering(all);
  std::vector<std::vector<Choice>> written{{}};
  std::size_t level = 0;
  for (int advance = 0; advance < 3; ++advance) {
    const std::size_t end = written.size();
    for (std::size_t before = level; before < end; ++before) {
      for (int direction = 0; direction < 2; ++direction) {
        for (int length = 0; length < 3; ++length) {
          std::vector<Choice> next = written[before];
          next.push_back({direction, length});
          written.push_back(std::move(next));
        }
      }
    }
    level = end;
  }
  ASSERT_EQ(numbering.count(), 1 + 6 + 36 + 216);
  ASSERT_EQ(static_cast<int>(written.size()), numbering.count());
  for (int number = 0; number < numbering.count(); ++number) {
    const std::vector<Choice>& history = written[static_cast<std::size_t>(number)];
    EXPECT_EQ(numbering.number(history), number);
    EXPECT_EQ(numbering.choices(number), history);
    EXPECT_EQ(numbering.level(number), static_cast<int>(history.size()));
    if (history.empty()) {
      EXPECT_EQ(numbering.parent(number), -1);
      continue;
    }
    const std::vector<Choice> before(history.begin(), history.end() - 1);
    EXPECT_EQ(numbering.parent(number), numbering.number(before));
    EXPECT_EQ(numbering.child(numbering.parent(number), history.back()), number);
  }
}

TEST(Numbering, SaysWhenThereAreTooMany) {
  EXPECT_EQ(Numbering::count_of(parameters(8, 1441, {0.1})), kMostTopologies + 1);
  EXPECT_EQ(Numbering::count_of(parameters(8, 1, {0.1})), 9);
  // Also of those that no advance makes use of: Ncd Ncl is an int.
  EXPECT_EQ(Numbering::count_of(parameters(0, 100'000, std::vector<double>(50'000, 0.1))), kMostTopologies + 1);
  EXPECT_EQ(Numbering::count_of(parameters(0, 13, {0.1})), 1);
}

}  // namespace
}  // namespace rhexis::record::store
