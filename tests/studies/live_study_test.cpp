#include "studies/live_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

constexpr std::int64_t kMillisecond = 1'000'000;

double value_of(const ordered_json& measures, const std::string& name) {
  for (const ordered_json& row : measures)
    if (row.at("measure") == name) return row.at("value").is_null() ? -1.0 : row.at("value").get<double>();
  ADD_FAILURE() << "no measure '" << name << "'";
  return -1.0;
}

std::uint64_t count_of(const ordered_json& histograms, const std::string& name) {
  std::uint64_t sum = 0;
  for (const ordered_json& bin : histograms)
    if (bin.at("histogram") == name) sum += bin.at("count").get<std::uint64_t>();
  return sum;
}

TEST(LiveStudy, ItsNumbersAgreeWithEachOther) {
  const std::filesystem::path path = test::fresh_folder("live-study");
  const Expected<StudyFolder> folder = StudyFolder::open(path);
  ASSERT_TRUE(folder);
  LiveOptions options;
  options.seconds = 2.0;
  options.nodes = 506;
  options.clients = 2;
  double told = 0.0;
  const Expected<ordered_json> measures = run_live_study(options, *folder, [&](double part, std::string_view) {
    told = part;
    return true;
  });
  ASSERT_TRUE(measures) << measures.error().message();
  EXPECT_GT(told, 0.4);

  const ordered_json histograms = ordered_json::parse(test::slurp(path / "live-histograms.json"));
  const double ticks = value_of(*measures, "ticks");
  EXPECT_GT(ticks, 100.0);
  EXPECT_EQ(static_cast<double>(count_of(histograms, "tick after its time")), ticks);
  EXPECT_GT(count_of(histograms, "law in force: its age"), 0U);
  EXPECT_LE(static_cast<double>(count_of(histograms, "law in force: its age")), ticks);
  EXPECT_GT(count_of(histograms, "hand to force"), 0U);
  EXPECT_EQ(count_of(histograms, "hand to force"), count_of(histograms, "hand to force at most"));
  EXPECT_LE(value_of(*measures, "hand to force, median"), value_of(*measures, "hand to force at most, median"));
  EXPECT_LE(value_of(*measures, "hand to picture, median"), value_of(*measures, "hand to picture, worst"));
  EXPECT_GT(value_of(*measures, "hand to picture, median"), 0.0);

  const ordered_json clients = ordered_json::parse(test::slurp(path / "live-clients.json"));
  ASSERT_EQ(clients.size(), 2U);
  for (const ordered_json& client : clients) {
    EXPECT_GT(client.at("states").get<int>(), 2);
    EXPECT_EQ(client.at("bodies"), clients[0].at("bodies"));
    EXPECT_EQ(client.at("edits").get<double>(), value_of(*measures, "advances of the crack"));
    const std::string name = "hand to picture, client " + std::to_string(client.at("client").get<int>());
    EXPECT_GT(count_of(histograms, name), 0U);
  }
  EXPECT_FALSE(std::filesystem::exists(path / "page"));
  for (const char* name : {"live.csv", "live.json", "live-histograms.csv", "live-clients.csv", "live-ticks.svg",
                           "live-latency.svg", "live-plate.toml"})
    EXPECT_TRUE(std::filesystem::exists(path / name)) << name;
}

TEST(LiveStudy, APictureIsWaitedForByAllTicksSinceTheOneBefore) {
  LiveRun run;
  for (int tick = 0; tick < 8; ++tick)
    run.marks.push_back(
        {.read = tick * kMillisecond, .written = tick * kMillisecond + 5000, .moved = tick != 4, .pushed = tick > 1});
  run.clients.resize(1);
  run.clients[0].states = {{.at = 3 * kMillisecond, .tick = 1}, {.at = 12 * kMillisecond, .tick = 5}};
  const Latencies found = latencies_of(run);
  EXPECT_EQ(found.to_picture.at(0), (std::vector<double>{10.0, 9.0, 7.0})) << "ticks 2, 3 and 5; 4 did not move";
  ASSERT_EQ(found.to_force.size(), 5U) << "ticks 2, 3, 5, 6, 7";
  EXPECT_DOUBLE_EQ(found.to_force[0], 0.005);
  EXPECT_DOUBLE_EQ(found.to_force_at_most[0], 1.005);
}

TEST(LiveStudy, ThePhysicsIsNamedByWhatWasUnderWay) {
  std::vector<PhysicsEvent> events;
  const auto add = [&](std::int64_t at, std::int64_t processor, wire::Payload kind, double milliseconds = 0.0) {
    events.push_back(
        {.at = at * kMillisecond, .processor = processor * kMillisecond, .kind = kind, .milliseconds = milliseconds});
  };
  add(10, 4, wire::Payload::State);
  add(70, 34, wire::Payload::Edit, 55.0);
  add(90, 44, wire::Payload::State);
  EXPECT_EQ(physics_between(events, 60 * kMillisecond, 69 * kMillisecond),
            "the physics: 1 advance of the crack (55.0 ms); 30.0 of 60.0 ms on a processor");
  EXPECT_EQ(physics_between(events, 69 * kMillisecond, 89 * kMillisecond),
            "the physics: 1 advance of the crack (55.0 ms), 1 State; 40.0 of 80.0 ms on a processor");
  EXPECT_EQ(physics_between(events, 80 * kMillisecond, 99 * kMillisecond),
            "the physics: 1 State; 10.0 of 20.0 ms on a processor");
  EXPECT_EQ(physics_between(events, 95 * kMillisecond, 99 * kMillisecond), "the physics sent nothing after it");
  EXPECT_EQ(physics_between(events, 0, 5 * kMillisecond), "the physics: 1 State");
}

TEST(LiveStudy, AnEmptyBinLiesOnTheGroundOfTheFigure) {
  const ordered_json bins = ordered_json::parse(R"([
    {"histogram": "tick", "from_ms": 0.0, "to_ms": 1.0, "count": 3, "part": 0.75},
    {"histogram": "tick", "from_ms": 4.0, "to_ms": 8.0, "count": 1, "part": 0.25},
    {"histogram": "hand", "from_ms": 0.0, "to_ms": 1.0, "count": 1, "part": 0.01}])");
  const result::Chart chart = live_chart(bins, "Ticks", {"tick"});
  ASSERT_EQ(chart.series.size(), 1U);
  EXPECT_EQ(chart.series[0].x, (std::vector<double>{0.5, 0.5, 1.0, 1.0, 4.0, 4.0, 8.0, 8.0}));
  EXPECT_EQ(chart.series[0].y, (std::vector<double>{0.125, 0.75, 0.75, 0.125, 0.125, 0.25, 0.25, 0.125}));
}

TEST(LiveStudy, WhatCannotRunIsRefused) {
  const Expected<StudyFolder> folder = StudyFolder::open(test::fresh_folder("live-refused"));
  const auto refused = [&](auto&& change) {
    LiveOptions options;
    options.nodes = 200;
    options.seconds = 0.5;
    change(options);
    return run_live(options, *folder, [](double, std::string_view) { return true; }).error().message();
  };
  EXPECT_THAT(refused([](LiveOptions& o) { o.device = "pointer"; }), HasSubstr("does not tear by itself"));
  EXPECT_THAT(refused([](LiveOptions& o) { o.device = "emulater"; }), HasSubstr("'emulator'"));
  EXPECT_THAT(refused([](LiveOptions& o) { o.clients = 0; }), HasSubstr("0 clients"));
  EXPECT_THAT(refused([](LiveOptions& o) { o.nodes = 3; }), HasSubstr("nodes"));
}

}  // namespace
}  // namespace rhexis::studies
