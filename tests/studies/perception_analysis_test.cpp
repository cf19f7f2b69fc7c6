#include "studies/perception_analysis.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "studies/published.h"

namespace rhexis::studies {
namespace {

TEST(CriticalValue, IsThatOfTheThesis) {
  const std::vector<DifferenceClass> classes = thesis_classes();
  ASSERT_EQ(classes.size(), 5U);
  for (std::size_t k = 0; k < classes.size(); ++k)
    EXPECT_EQ(classes[k].critical(), published_value(fmt::format("angle-perception.critical.{}", k + 1)));
}

/// In whole numbers: a row of Pascal's triangle, of which a tail is at most a twentieth.
TEST(CriticalValue, IsExact) {
  std::vector<std::uint64_t> row{1};
  for (int trials = 1; trials <= 55; ++trials) {
    row.push_back(0);
    for (std::size_t k = row.size() - 1; k > 0; --k) row[k] += row[k - 1];
    std::uint64_t tail = 0;
    int critical = trials + 1;
    while (critical > 0 && 20 * (tail + row[static_cast<std::size_t>(critical - 1)]) <= (std::uint64_t{1} << trials))
      tail += row[static_cast<std::size_t>(--critical)];
    EXPECT_EQ(critical_value(trials), critical) << trials;
  }
  EXPECT_EQ(critical_value(0), 1);
  EXPECT_EQ(critical_value(4), 5) << "four of four come by chance in one of sixteen cases";
}

TEST(Verdict, OfTheThesisIs15Degrees) {
  const std::vector<DifferenceClass> classes = thesis_classes();
  const std::vector<bool> told{false, true, true, true, true};
  for (std::size_t k = 0; k < classes.size(); ++k) EXPECT_EQ(classes[k].is_told(), told[k]) << k;
  EXPECT_EQ(told_from(classes), published_value("angle-perception.threshold"));
}

TEST(Verdict, NeedsEveryLargerClassThatHasTrials) {
  const std::vector<double> begins{0.0, 15.0, 30.0};
  using Answers = std::vector<AnswerCount>;
  const auto verdict = [&](const Answers& answers) { return told_from(classify(answers, begins)); };
  EXPECT_EQ(verdict({}), std::nullopt);
  EXPECT_EQ(verdict({{40.0, 10, 9}}), 30.0);
  EXPECT_EQ(verdict({{14.999, 10, 9}, {40.0, 10, 9}}), 0.0) << "an empty class between says nothing";
  EXPECT_EQ(verdict({{15.0, 10, 9}, {40.0, 10, 6}}), std::nullopt);
  EXPECT_EQ(verdict({{15.0, 5, 4}, {29.0, 5, 5}, {1.0, 10, 5}, {30.0, 10, 10}}), 15.0);
}

}  // namespace
}  // namespace rhexis::studies
