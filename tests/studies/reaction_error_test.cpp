#include "studies/reaction_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/parallel.h"
#include "record/build/campaign.h"
#include "record/store/reaction.h"
#include "record/store/record_reader.h"
#include "studies/reaction_cell.h"
#include "studies/reaction_tally.h"
#include "studies/study_plate.h"
#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

/// The cell is solved by the factors that the record is made of, and averages are taken in another order.
constexpr double kRounding = 1e-12;

bool go_on(double, std::string_view) { return true; }

ReactionErrorOptions small() {
  ReactionErrorOptions options;
  options.nodes = 150;
  options.advances = {1};
  options.spacings = {90.0, 45.0};
  options.spacing = 45.0;
  options.step = 15;
  return options;
}

/// (4.8) and (4.27) as the record's look-up has them are the oracle of what a cell says.
TEST(ReactionCell, SaysWhatTheRecordSays) {
  const StudyPlate plate = *make_study_plate(150);
  record::build::CampaignRequest request;
  request.mesh = plate.mesh;
  request.elastic = plate.settings.body;
  request.crack = plate.cracks[0].line;
  request.parameters.directions = 3;  // every 90 degrees
  const record::build::Campaign campaign = *record::build::Campaign::plan(request);
  const std::filesystem::path file = test::fresh_folder("reaction_cell") / "plate.h5";
  ASSERT_TRUE(campaign.run(file, {}, nullptr));
  const record::store::Record record = *record::store::RecordFile::open(file)->read_record();
  const record::store::Lookup lookup(record);

  const record::build::Recorder recorder(plate.mesh, plate.settings.body, false);
  record::build::FactoredState first{*record::build::TornState::begin(plate.mesh, plate.settings.body, request.crack),
                                     record::build::OperatorFactor(recorder.layout())};
  ASSERT_TRUE(recorder.factor(first));
  const double length = request.parameters.lengths.front();
  const ReactionBody body{&plate.mesh, record.head.frame, length, &recorder, &first};
  int seen = 0;
  visit_cell(body, {{0.0, 90.0}, {90.0, 180.0}, {{30.0, 90.0}, {100.0, 180.0}}}, [&](const ReactionQuery& query) {
    ASSERT_EQ(query.samples.size() + static_cast<std::size_t>(query.torn_off), record.head.points.size());
    std::vector<record::store::Advanced> advances;
    for (const double angle : query.angles) advances.push_back({angle, length});
    const int nearest = lookup.nearest(advances).topology;
    for (const ReactionSample& sample : query.samples) {
      const auto point = static_cast<int>(sample.point);
      const double scale = kRounding * sample.exact.norm();
      EXPECT_LE((sample.nearest - record.stiffness_at(nearest, point)).norm(), scale);
      const Vec3 pull = request.parameters.pull_length * record.head.frame.direction(130.0);  // one that is recorded
      EXPECT_LE((sample.linear * pull - lookup.reaction(advances, point, pull).force).norm(), scale * pull.norm());
      if (query.angles[0] == 90.0 && query.angles[1] == 180.0) {
        EXPECT_LE((sample.exact - sample.nearest).norm(), scale);
      }
      ++seen;
    }
  });
  EXPECT_GT(seen, 400);
}

TEST(ReactionTally, MomentsAreThoseOfTheirNumbers) {
  Moments a;
  for (const double value : {1.0, 2.0, 6.0}) a.add(value);
  Moments b;
  b.add(3.0);
  a.merge(b);
  EXPECT_EQ(a.count, 4);
  EXPECT_DOUBLE_EQ(a.mean(), 3.0);
  EXPECT_DOUBLE_EQ(a.deviation(), std::sqrt(3.5));
  EXPECT_DOUBLE_EQ(a.largest, 6.0);
}

TEST(ReactionTally, CountsEveryPullOnceInEveryClass) {
  const record::store::Frame frame;
  const std::vector<Vec3> pulls = recorded_pulls(frame);
  ASSERT_EQ(pulls.size(), 36U);
  EXPECT_NEAR(pulls[9].y(), 0.12, 1e-15);
  ReactionQuery query{{30.0}, {Vec3::Zero(), Vec3(0.0, 0.1, 0.0)}, 1, {}};
  const Mat3 one = Mat3::Identity();
  query.samples.push_back({0, one, 1.5 * one, 1.25 * one, one});  // 0.5, 0.25 and 0 of the force
  query.samples.push_back({1, one, one, one, one});
  ReactionTally tally;
  count_errors(query, pulls, {Vec3(0.025, 0.05, 7.0), Vec3(0.0, 0.14, 0.0)}, frame, tally);
  EXPECT_EQ(tally.torn_off, 36);
  for (std::size_t way = 0; way < kReactionWays.size(); ++way) EXPECT_EQ(tally.all[way].error.count, 72);
  EXPECT_NEAR(tally.all[0].relative.mean(), 0.25, 1e-15);
  EXPECT_NEAR(tally.all[1].error.largest, 0.25 * 0.12, 1e-15);
  EXPECT_EQ(tally.all[1].better, 36);
  EXPECT_EQ(tally.all[1].tied, 36);
  ASSERT_EQ(tally.angle.size(), 1U);
  EXPECT_EQ(tally.angle.at(30.0)[2].better, 36);
  ASSERT_EQ(tally.distance.size(), 2U);  // 25 mm beside the crack, 40 mm ahead of it
  EXPECT_EQ(tally.distance.at(2)[0].error.count, 36);
  EXPECT_EQ(tally.distance.at(4)[0].error.count, 36);
}

TEST(ReactionError, EveryTableIsThere) {
  const std::filesystem::path folder = test::fresh_folder("reaction_error");
  double last = 0.0;
  const Expected<ordered_json> rows =
      run_reaction_error(small(), *StudyFolder::open(folder), [&](double fraction, std::string_view) {
        EXPECT_GE(fraction, last);
        last = fraction;
        return true;
      });
  ASSERT_TRUE(rows) << rows.error().message();
  EXPECT_NEAR(last, 1.0, 1e-12);
  ASSERT_EQ(rows->size(), kReactionWays.size());
  for (const ordered_json& row : *rows) EXPECT_EQ(row["patterns"].get<int>() % (12 * 36), 0);
  EXPECT_LT((*rows)[2]["mean_N"].get<double>(), (*rows)[1]["mean_N"].get<double>() / 3.0);
  EXPECT_GE((*rows)[1]["tied"].get<double>(), 4.0 / 12.0 - 1e-12);  // 45, 90, 135 and 180 degrees are recorded
  for (const char* name : {"", "-spacing", "-distance", "-angle", "-force"}) {
    for (const char* form : {"csv", "json"})
      EXPECT_TRUE(exists(folder / fmt::format("reaction-error{}.{}", name, form))) << name;
    EXPECT_EQ(exists(folder / fmt::format("reaction-error{}.svg", name)), *name != '\0') << name;
  }
}

TEST(ReactionError, TheNumbersDoNotDependOnTheThreads) {
  std::vector<ordered_json> rows;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    rows.push_back(
        *run_reaction_error(small(), *StudyFolder::open(test::fresh_folder("reaction_error_threads")), go_on));
  }
  set_thread_count(0);
  EXPECT_EQ(rows[0].dump(), rows[1].dump());
}

TEST(ReactionError, WhatCannotBeIsRefused) {
  const StudyFolder folder = *StudyFolder::open(test::fresh_folder("reaction_error_refused"));
  const auto error = [&](const auto& change) {
    ReactionErrorOptions options = small();
    change(options);
    const Expected<ordered_json> rows = run_reaction_error(options, folder, go_on);
    return rows ? std::string("accepted") : rows.error().message();
  };
  EXPECT_THAT(error([](auto& o) { o.advances = {3}; }), HasSubstr("1 or 2"));
  EXPECT_THAT(error([](auto& o) { o.spacing = 25.0; }), HasSubstr("divides 180"));
  EXPECT_THAT(error([](auto& o) { o.spacings = {-15.0}; }), HasSubstr("divides 180"));
  EXPECT_THAT(error([](auto& o) { o.step = 7; }), HasSubstr("divides 180"));
  EXPECT_THAT(error([](auto& o) { o.nodes = 2; }), HasSubstr("nodes"));
  EXPECT_THAT(error([](auto& o) { o.advances = {}, o.spacings = {}; }), HasSubstr("nothing to do"));
  const Expected<ordered_json> stopped =
      run_reaction_error(small(), folder, [](double, std::string_view) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_THAT(stopped.error().message(), HasSubstr("stopped"));
}

}  // namespace
}  // namespace rhexis::studies
