// response = "recorded" in a session, scripted and live, and the two responses side by side.

#include <gmock/gmock.h>

#include "record/build/campaign.h"
#include "session/replay_check.h"
#include "session/scene_record.h"
#include "tests/session/live_case.h"
#include "tests/support/measured.h"
#include "tests/support/replaced.h"

namespace rhexis::session {
namespace {

using test::payload;
using test::replaced;
using testing::HasSubstr;

const std::string kCoarse = replaced(test::kLivePlate, "nodes = 506", "nodes = 300");
const std::string kSection = "[interaction]\nresponse = \"recorded\"\nrecord = \"plate.h5\"\n";
const std::string kRecorded = kCoarse + kSection + "[record]\ndirections = 5\n";

Expected<scene::TearProblem> problem_of(const std::string& text, const std::string& file) {
  const Expected<scene::Scene> scene = scene::parse_scene(text, file);
  EXPECT_TRUE(scene.has_value()) << scene.error().message();
  return scene::build_tear_problem(*scene);
}

void make_record(const std::string& text, const std::filesystem::path& file) {
  const Expected<scene::TearProblem> problem = problem_of(text, (file.parent_path() / "plate.toml").string());
  const auto campaign = record::build::Campaign::plan(record_request(*problem, "rhexis test"));
  ASSERT_TRUE(campaign.has_value());
  ASSERT_TRUE(campaign->run(file, {}, {}).has_value());
}

/// A folder with plate.toml and its record, made once.
class RecordedSession : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TestFolder>("recorded-session");
    folder_->write("plate.toml", kRecorded);
    make_record(kRecorded, folder_->path() / "plate.h5");
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string scene() { return (folder_->path() / "plate.toml").string(); }
  static std::unique_ptr<TearSession> start(const std::string& text) {
    Expected<TearStart> start = start_tear(*problem_of(text, scene()));
    EXPECT_TRUE(start.has_value()) << start.error().message();
    return std::move(start->tear);
  }
  static std::unique_ptr<test::TestFolder> folder_;
};
std::unique_ptr<test::TestFolder> RecordedSession::folder_;

TEST_F(RecordedSession, FeelsTheExactForceAlongRecordedCracks) {
  double worst = 0.0;
  for (const auto& [first, second] : {std::pair(90.0, 90.0), std::pair(90.0, 135.0), std::pair(45.0, 90.0)}) {
    const auto exact = start(kCoarse);
    const auto recorded = start(kRecorded);
    ASSERT_TRUE(recorded->record_use().has_value());
    EXPECT_FALSE(exact->record_use().has_value());
    const Vec3 at(0.02, 0.0, 0.005);
    const Vec3 by(-0.01, 0.002, 0.003);
    ASSERT_TRUE(exact->grasp(at).has_value());
    ASSERT_TRUE(recorded->grasp(at).has_value());
    const auto compare = [&] {
      const Vec3 wanted = exact->hand().law().force(by);
      worst = std::max(worst, (recorded->hand().law().force(by) - wanted).norm() / wanted.norm());
      EXPECT_EQ(recorded->body().topology(), exact->body().topology());
    };
    compare();
    for (const double degrees : {first, second}) {
      const double radians = degrees * 3.14159265358979323846 / 180.0;
      const Vec3 direction(std::cos(radians), std::sin(radians), 0.0);
      exact->impose(0, direction, 0.0403);
      recorded->impose(0, direction, 0.0403);
      compare();
      EXPECT_FALSE(recorded->record_use()->outside || recorded->record_use()->past_last);
      EXPECT_EQ(recorded->advances().back().record->topology, recorded->record_use()->topology);
    }
    EXPECT_LT(worst, 1e-9);
    EXPECT_TRUE(recorded->undo());
    EXPECT_TRUE(exact->undo());
    compare();
  }
  EXPECT_LT(worst, 1e-9);
  rhexis::test::measured("recorded force along recorded cracks: off by {:.1e}", worst);
}

TEST_F(RecordedSession, SolvesTheLocalObjectByTheDisplacementOfItsBoundary) {
  const auto recorded = start(kRecorded);
  const auto exact = start(kCoarse);
  for (TearSession* tear : {recorded.get(), exact.get()}) {
    ASSERT_TRUE(tear->grasp({0.02, 0.0, 0.005}).has_value());
    static_cast<void>(tear->tick({-0.001, 0.0, 0.0}));
  }
  // At a recorded crack the boundary is the exact one, and so is what is solved inside.
  const VectorX& u = recorded->local_objects().front().displacement();
  const VectorX& wanted = exact->local_objects().front().displacement();
  EXPECT_GT(wanted.norm(), 0.0);
  EXPECT_LT((u - wanted).norm(), 1e-9 * wanted.norm());
  // Between recorded cracks it is in equilibrium with its boundary, though the nearest operator has another crack.
  recorded->impose(0, Vec3(0.25, 1.0, 0.0).normalized(), 0.03);
  static_cast<void>(recorded->tick({-0.001, 0.0, 0.0}));
  VectorX whole;
  recorded->displacement(whole);
  const fracture::LocalObject& local = recorded->local_objects().front();
  fracture::LocalObject again(recorded->body(), recorded->settings().body.elastic, local.tets(), recorded->supported(),
                              recorded->hand().nodes());
  VectorX boundary(static_cast<Eigen::Index>(3 * again.boundary().size()));
  for (std::size_t i = 0; i < again.boundary().size(); ++i)
    boundary.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        whole.segment<3>(3 * Eigen::Index{again.boundary()[i].value()});
  ASSERT_TRUE(again.solve(boundary));
  for (std::size_t i = 0; i < again.nodes().size(); ++i)
    EXPECT_LT((again.displacement().segment<3>(static_cast<Eigen::Index>(3 * i)) -
               whole.segment<3>(3 * Eigen::Index{again.nodes()[i].value()}))
                  .norm(),
              1e-12);
}

TEST_F(RecordedSession, TearsUnderItsScriptAndSaysWhatTheRecordDoesNotKnow) {
  const auto tear = start(kRecorded);
  ASSERT_TRUE(tear->grasp({0.10, 0.0, 0.005}).has_value());
  for (int k = 1; k <= 200; ++k) {
    const TickReport report = tear->tick(Vec3(-0.12, 0.0, 0.0) * (k / 200.0));
    EXPECT_EQ(report.trouble, "");
    EXPECT_TRUE(report.force.allFinite());
  }
  ASSERT_GE(tear->advances().size(), 4U);
  const response::RecordUse use = *tear->record_use();
  EXPECT_TRUE(use.past_last);
  EXPECT_THAT(remarks_on(use, {}), testing::Contains(HasSubstr("more often than the record knows")));
  EXPECT_TRUE(remarks_on(use, use).empty());
}

struct BadRecord {
  std::string what, text, message;
};

TEST_F(RecordedSession, ARecordOfSomethingElseIsNamedWithTheRemedy) {
  const std::string remedy =
      " (rhexis precompute " + scene() + " --out " + (folder_->path() / "plate.h5").string() + ")";
  const std::vector<BadRecord> table{
      {"mesh", replaced(kRecorded, "nodes = 300", "nodes = 310"), "the record of another mesh than the scene's"},
      {"crack", replaced(kRecorded, "to = [0.12, 0.06, 0.0]", "to = [0.13, 0.06, 0.0]"),
       "the record of another [[crack]]"},
      {"crack's length", replaced(kRecorded, "to = [0.12, 0.06, 0.0]", "to = [0.12, 0.05, 0.0]"),
       "the record of another material, [[support]], load or [[crack]], or of another version's method"},
      {"material", replaced(kRecorded, "young = 1.0e6", "young = 1.1e6"),
       "the record of another material, [[support]], load or [[crack]], or of another version's method"},
      {"support", replaced(kRecorded, "z = 0.0\n", "z = 0.001\n"),
       "the record of another material, [[support]], load or [[crack]], or of another version's method"}};
  for (const BadRecord& bad : table) {
    const Expected<TearStart> start = start_tear(*problem_of(bad.text, scene()));
    ASSERT_FALSE(start.has_value()) << bad.what;
    EXPECT_EQ(start.error().message(), (folder_->path() / "plate.h5").string() + ": " + bad.message + remedy);
  }
  // How many advances and directions there are, the file says.
  EXPECT_TRUE(start_tear(*problem_of(replaced(kRecorded, "directions = 5", "directions = 7"), scene())).has_value());
}

TEST_F(RecordedSession, AFileThatIsNotThereOrNotWholeIsNamed) {
  const auto message = [&](const std::string& file) {
    const Expected<TearStart> start =
        start_tear(*problem_of(replaced(kRecorded, "\"plate.h5\"", '"' + file + '"'), scene()));
    return start ? std::string("it started") : start.error().message();
  };
  EXPECT_EQ(message("none.h5"), (folder_->path() / "none.h5").string() + ": there is no such file (rhexis precompute " +
                                    scene() + " --out " + (folder_->path() / "none.h5").string() + ")");
  std::ifstream whole(folder_->path() / "plate.h5", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(whole)), {});
  folder_->write("short.h5", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(message("short.h5"), HasSubstr("short.h5: cannot be opened: cut short, or broken (rhexis precompute"));
  folder_->write("text.h5", "no record");
  EXPECT_THAT(message("text.h5"), HasSubstr("text.h5: not an HDF5 file (rhexis precompute"));
}

/// What an interaction says, kept.
struct Heard final : InteractionListener {
  void has_body(bool /*anew*/) override {}
  void has_torn(const AdvanceRecord& /*advance*/, const SurfaceChange& /*change*/) override {}
  void says(wire::Level /*level*/, const std::string& text) override { texts.push_back(text); }
  std::vector<std::string> texts;
};

struct Pulled {
  std::vector<StepOutcome> steps;
  std::vector<std::optional<Vec3>> compared;
  std::vector<std::string> texts;
};

/// The scene's pull in 300 ticks, held at the scene's point; `compares` from step `from` on.
Pulled pull(const std::string& text, const std::string& file, int from) {
  Pulled out;
  Heard heard;
  Expected<std::unique_ptr<OpenBody>> body = open_body({.file = file, .text = text, .overrides = {}});
  EXPECT_TRUE(body.has_value()) << body.error().message();
  Interaction interaction(
      std::move(*body), [](const std::string&) { return fail("none"); }, heard);
  wire::ScriptT script;
  script.on = true;
  interaction.carry_out(payload(script));
  std::uint64_t tick = 0;
  bool tore = false;
  for (int k = 0; k < 400; ++k) {
    if (k == from) {
      wire::CompareT compare;
      compare.on = true;
      interaction.carry_out(payload(compare));
    }
    haptics::HandState hand;
    hand.tick = tore ? tick : ++tick;
    hand.grasp = interaction.law().grasp;
    hand.flags = (interaction.law().flags & response::ForceSnapshot::is_held) != 0 ? haptics::HandState::holds : 0U;
    const Vec3 at = interaction.orders().hold != 0 ? interaction.orders().at(tick) : Vec3::Zero();
    hand.hand = {at[0], at[1], at[2]};
    out.steps.push_back(interaction.step(hand, true));
    tore = out.steps.back().advances > 0;
    out.compared.push_back(interaction.tear().compared_force());
  }
  out.texts = heard.texts;
  return out;
}

TEST_F(RecordedSession, TheOtherForceIsThereBesideAndHasNoPartInWhatHappens) {
  const Pulled alone = pull(kRecorded, scene(), -1);
  const Pulled beside = pull(kRecorded, scene(), 0);
  const Pulled later = pull(kRecorded, scene(), 330);
  ASSERT_GE(alone.steps.back().topology, 4U);
  double largest = 0.0;
  double apart = 0.0;
  for (std::size_t k = 0; k < alone.steps.size(); ++k) {
    EXPECT_FALSE(alone.compared[k].has_value());
    for (const Pulled* other : {&beside, &later}) {
      EXPECT_EQ(other->steps[k].law, alone.steps[k].law);
      EXPECT_EQ(other->steps[k].force, alone.steps[k].force);
      EXPECT_EQ(other->steps[k].fingerprint, alone.steps[k].fingerprint);
    }
    ASSERT_TRUE(beside.compared[k].has_value());
    largest = std::max(largest, beside.compared[k]->norm());
    const double off = (*beside.compared[k] - alone.steps[k].force).norm();
    if (alone.steps[k].topology <= 1) {
      EXPECT_LE(off, 1e-9 * beside.compared[k]->norm());
    }
    apart = std::max(apart, off);
    // Followed edit by edit, or made of the torn body: the same.
    if (later.compared[k]) {
      EXPECT_LT((*later.compared[k] - *beside.compared[k]).norm(), 1e-9 * largest);
    }
  }
  EXPECT_TRUE(later.compared.back().has_value());
  EXPECT_GT(largest, 0.01);
  EXPECT_GT(apart, 1e-6 * largest);
  EXPECT_THAT(alone.texts, testing::Contains(HasSubstr("more often than the record knows")));
  for (const std::string& text : alone.texts) EXPECT_EQ(std::count(alone.texts.begin(), alone.texts.end(), text), 1);
  rhexis::test::measured("recorded and exact force of a pulled plate: {:.3f} N apart of {:.3f} N", apart, largest);
}

TEST_F(RecordedSession, BesideTheExactForceIsThatOfTheScenesRecord) {
  const std::string exact = replaced(kRecorded, "\"recorded\"", "\"exact\"");
  const Pulled beside = pull(exact, scene(), 0);
  ASSERT_TRUE(beside.compared.back().has_value());
  for (std::size_t k = 0; k < beside.steps.size(); ++k) {
    if (beside.steps[k].topology <= 1) {
      EXPECT_LE((*beside.compared[k] - beside.steps[k].force).norm(), 1e-9 * beside.steps[k].force.norm());
    }
  }
  const Pulled none = pull(kCoarse, scene(), 0);
  EXPECT_FALSE(none.compared.back().has_value());
  EXPECT_THAT(none.texts, testing::Contains(HasSubstr("the scene names no record")));
}

TEST_F(RecordedSession, ARecordingIsCheckedBitForBitWithTheRecordItWasMadeWith) {
  test::LiveCase live("recorded-live");
  live.settings.scene = live.folder.write("plate.toml", kRecorded);
  std::filesystem::copy(folder_->path() / "plate.h5", live.folder.path() / "plate.h5");
  live.settings.recordings = live.folder.path() / "recordings";
  live.settings.records = true;
  live.start();
  wire::CompareT compare;
  compare.on = true;
  live.live->post(payload(compare));
  wire::ScriptT script;
  script.on = true;
  live.live->post(payload(script));
  ASSERT_TRUE(test::wait_until([&] { return live.frames.count(wire::Payload::Edit) >= 3; }));
  live.live->post(payload(wire::ResetT()));
  ASSERT_TRUE(test::wait_until([&] { return live.frames.count(wire::Payload::Body) >= 2; }));
  ASSERT_TRUE(test::wait_until([&] { return live.state().compared_force != nullptr; }));
  EXPECT_NE(live.state().record, nullptr);
  live.live->stop();
  const wire::PayloadUnion body = live.frames.last(wire::Payload::Body);
  EXPECT_EQ(body.AsBody()->response, "recorded");
  EXPECT_TRUE(body.AsBody()->has_record);

  const std::filesystem::path recording = live.folder.only_file("recordings");
  Expected<CheckReport> report = check_recording(recording);
  ASSERT_TRUE(report.has_value()) << report.error().message();
  EXPECT_EQ(report->difference, "");
  EXPECT_GE(report->advances, 3U);

  std::filesystem::remove(live.folder.path() / "plate.h5");
  report = check_recording(recording);
  ASSERT_FALSE(report.has_value());
  EXPECT_THAT(report.error().message(), HasSubstr("plate.h5: there is no such file (rhexis precompute"));
  make_record(replaced(kRecorded, "directions = 5", "directions = 3"), live.folder.path() / "plate.h5");
  report = check_recording(recording);
  ASSERT_FALSE(report.has_value());
  EXPECT_THAT(report.error().message(),
              HasSubstr("is what the forces were felt of (the record of that time in its place)"));
}

}  // namespace
}  // namespace rhexis::session
