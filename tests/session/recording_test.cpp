#include "session/recorder.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstring>
#include <random>

#include "session/live_session.h"
#include "session/recording_file.h"
#include "session/replay_check.h"
#include "session/replay_source.h"
#include "tests/session/live_case.h"
#include "tests/support/replaced.h"

namespace rhexis::session {
namespace {

using test::payload;
using test::wait_until;

/// Records the scripted plate into `folder`/recordings, again and again from the start, until `ends` says so.
void record_plate(const std::filesystem::path& folder, test::KeptFrames& frames, const std::function<bool()>& ends,
                  const std::string& scene = test::kLivePlate) {
  LiveSettings settings;
  settings.scene = (folder / "plate.toml").string();
  std::ofstream(settings.scene) << scene;
  settings.recordings = folder / "recordings";
  settings.records = true;
  settings.version = "test";
  settings.priority = 0;
  Expected<std::unique_ptr<LiveSession>> live = LiveSession::open(settings, frames);
  ASSERT_TRUE(live.has_value()) << live.error().message();
  ASSERT_TRUE((*live)->start().has_value());
  wire::ScriptT script;
  script.on = true;
  while (!ends()) {
    (*live)->post(payload(script));
    for (int k = 0; k < 350 && !ends(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    (*live)->post(payload(wire::ResetT()));
  }
  (*live)->stop();
}

/// A recording of about a second with some advances.
class RecordedPlate : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TestFolder>("recorded");
    frames_ = std::make_unique<test::KeptFrames>();
    record_plate(folder_->path(), *frames_, [] { return frames_->count(wire::Payload::Edit) >= 8; });
  }
  static void TearDownTestSuite() {
    folder_.reset();
    frames_.reset();
  }
  [[nodiscard]] static std::filesystem::path recording() { return folder_->only_file("recordings"); }

  /// A copy in which the bytes `before` (there once) are `after`.
  static std::filesystem::path changed(const std::string& before, const std::string& after) {
    std::ifstream in(recording(), std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const std::size_t at = bytes.find(before);
    EXPECT_NE(at, std::string::npos);
    EXPECT_EQ(bytes.find(before, at + 1), std::string::npos);
    bytes.replace(at, before.size(), after);
    return folder_->write("changed.h5", bytes);
  }

  static std::unique_ptr<test::TestFolder> folder_;
  static std::unique_ptr<test::KeptFrames> frames_;
};
std::unique_ptr<test::TestFolder> RecordedPlate::folder_;
std::unique_ptr<test::KeptFrames> RecordedPlate::frames_;

template <class Row>
std::string bytes_of(const Row& row) {
  return {reinterpret_cast<const char*>(&row), sizeof(row)};
}

TEST_F(RecordedPlate, IsComputedAgainToTheSameBits) {
  const Expected<CheckReport> report = check_recording(recording());
  ASSERT_TRUE(report.has_value()) << report.error().message();
  EXPECT_EQ(report->difference, "");
  EXPECT_GE(report->advances, 8U);
  const Expected<RecordingFile> file = RecordingFile::open(recording());
  ASSERT_TRUE(file.has_value());
  EXPECT_EQ(report->steps, file->count().steps);
  EXPECT_EQ(report->ticks, file->count().ticks);
  EXPECT_GT(report->ticks, 300U);
}

/// Frames behind the hand, factors made beside it, time steps of a body with mass: all of that is counted, so that it
/// comes out the same.
TEST(Recording, ABodyOfLargeStrainIsComputedAgainToTheSameBits) {
  for (const std::string model : {"kind = \"hyperelastic\"", "kind = \"hyperelastic\"\n[dynamics]"}) {
    test::TestFolder folder("recorded-psh");
    test::KeptFrames frames;
    record_plate(
        folder.path(), frames, [&] { return frames.count(wire::Payload::Edit) >= 6; },
        test::replaced(test::kLivePlate, "kind = \"linear\"", model));
    const Expected<CheckReport> report = check_recording(folder.only_file("recordings"));
    ASSERT_TRUE(report.has_value()) << report.error().message();
    EXPECT_EQ(report->difference, "");
    EXPECT_GE(report->advances, 6U);
  }
}

TEST_F(RecordedPlate, OneBitOfInputMakesTheCheckFailAndNameTheTick) {
  const Expected<RecordingFile> file = RecordingFile::open(recording());
  ASSERT_TRUE(file.has_value());
  std::vector<TickRow> rows(file->count().ticks);
  ASSERT_TRUE(file->read(0, rows).has_value());
  const auto row = std::find_if(rows.begin() + 200, rows.end(), [](const TickRow& r) { return r.position[0] != 0.0; });
  ASSERT_NE(row, rows.end());
  TickRow other = *row;
  reinterpret_cast<std::uint64_t&>(other.position[0]) ^= 1U;
  const Expected<CheckReport> report = check_recording(changed(bytes_of(*row), bytes_of(other)));
  ASSERT_TRUE(report.has_value()) << report.error().message();
  EXPECT_THAT(report->difference, testing::StartsWith(fmt::format("tick {}: place of the hand / m is ", row->tick)));
}

TEST_F(RecordedPlate, OneBitOfAForceOrACommandMakesTheCheckFailToo) {
  const Expected<RecordingFile> file = RecordingFile::open(recording());
  ASSERT_TRUE(file.has_value());
  std::vector<StepRow> rows(file->count().steps);
  ASSERT_TRUE(file->read(0, rows).has_value());
  const auto row = std::find_if(rows.begin(), rows.end(), [](const StepRow& r) { return r.force[0] != 0.0; });
  ASSERT_NE(row, rows.end());
  StepRow other = *row;
  reinterpret_cast<std::uint64_t&>(other.force[0]) ^= 1U;
  Expected<CheckReport> report = check_recording(changed(bytes_of(*row), bytes_of(other)));
  ASSERT_TRUE(report.has_value()) << report.error().message();
  EXPECT_THAT(report->difference, testing::HasSubstr(fmt::format("step {} (tick {}): force of the body / N is ",
                                                                 row->number, row->hand.tick)));

  const Expected<std::vector<PieceRow>> commands = file->commands();
  ASSERT_TRUE(commands.has_value());
  ASSERT_GE(commands->size(), 1U);
  PieceRow later = commands->front();
  ++later.at;
  report = check_recording(changed(bytes_of(commands->front()), bytes_of(later)));
  ASSERT_TRUE(report.has_value()) << report.error().message();
  EXPECT_NE(report->difference, "");
}

struct BrokenRow {
  const char* what;
  std::function<void(PieceRow&)> breaks;
};

TEST_F(RecordedPlate, PlacesAndCountsThatAreNotThereAreRefusedByName) {
  const Expected<RecordingFile> file = RecordingFile::open(recording());
  ASSERT_TRUE(file.has_value());
  const PieceRow scene = file->scenes()->front();
  const std::vector<BrokenRow> table{
      {"its scenes lies behind the end of 'bytes'", [](PieceRow& row) { row.offset = std::uint64_t{1} << 60; }},
      {"its scenes lies behind the end of 'bytes'", [](PieceRow& row) { row.size = ~std::uint64_t{0}; }},
      {"a scene in it cannot be read", [](PieceRow& row) { row.size -= 1; }},
  };
  for (const BrokenRow& broken : table) {
    PieceRow other = scene;
    broken.breaks(other);
    const std::filesystem::path path = changed(bytes_of(scene), bytes_of(other));
    const Expected<CheckReport> report = check_recording(path);
    ASSERT_FALSE(report.has_value()) << broken.what;
    EXPECT_THAT(report.error().message(), testing::HasSubstr(broken.what));
    EXPECT_THAT(report.error().message(), testing::StartsWith(path.string()));
  }
}

TEST_F(RecordedPlate, FilesThatAreNoneAreRefusedAndACutOneDoesNotCrash) {
  const auto message = [](const std::filesystem::path& path) {
    const Expected<RecordingFile> file = RecordingFile::open(path);
    return file ? "good" : file.error().message();
  };
  EXPECT_THAT(message(folder_->path() / "none.h5"), testing::HasSubstr("there is no such file"));
  EXPECT_THAT(message(folder_->path()), testing::HasSubstr("not a file"));
  EXPECT_THAT(message(folder_->write("text.h5", "text")), testing::HasSubstr("not an HDF5 file"));
  std::ifstream in(recording(), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  EXPECT_THAT(message(folder_->write("cut.h5", bytes.substr(0, bytes.size() / 2))),
              testing::HasSubstr("cannot be opened"));
}

TEST_F(RecordedPlate, AGarbledFileIsRefusedAtOnce) {
  std::ifstream in(recording(), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  constexpr std::size_t kChecksum = 44;  // of the superblock
  bytes[kChecksum] ^= 1;
  const auto begin = std::chrono::steady_clock::now();
  const Expected<RecordingFile> file = RecordingFile::open(folder_->write("garbled.h5", bytes));
  ASSERT_FALSE(file.has_value());
  EXPECT_THAT(file.error().message(), testing::HasSubstr("cannot be opened"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST_F(RecordedPlate, IsPlayedAsItWasSeenAndSoughtBothWays) {
  test::KeptFrames shown;
  Expected<std::unique_ptr<ReplaySource>> source = ReplaySource::open(recording(), shown);
  ASSERT_TRUE(source.has_value()) << source.error().message();
  (*source)->start();
  ASSERT_TRUE(wait_until([&] { return shown.count(wire::Payload::Timeline) > 0; }));
  EXPECT_EQ(shown.all().front().type, wire::Payload::Body);
  const wire::TimelineT begin = *shown.last(wire::Payload::Timeline).AsTimeline();
  EXPECT_FALSE(begin.playing);
  EXPECT_EQ(begin.duration, (*source)->duration());
  EXPECT_EQ(begin.marks.size(), frames_->count(wire::Payload::Edit));

  // All of it, fast.
  wire::PlayT play;
  play.on = true;
  play.speed = 20.0;
  (*source)->post(payload(play));
  ASSERT_TRUE(wait_until([&] {
    const auto last = shown.last(wire::Payload::Timeline);
    return !last.AsTimeline()->playing && last.AsTimeline()->time == begin.duration;
  }));
  EXPECT_EQ(shown.count(wire::Payload::Edit), frames_->count(wire::Payload::Edit));

  // Back to before the last advance, and forward again: the topology is that of then.
  const auto topology_at = [&](double time) {
    const std::size_t before = shown.count(wire::Payload::Timeline);
    wire::SeekT seek;
    seek.time = time;
    (*source)->post(payload(seek));
    EXPECT_TRUE(wait_until([&] {
      return shown.count(wire::Payload::Timeline) > before &&
             shown.last(wire::Payload::Timeline).AsTimeline()->time == time;
    }));
    std::uint32_t topology = 0;
    for (const wire::PayloadUnion& frame : shown.all()) {
      if (frame.type == wire::Payload::Body) topology = frame.AsBody()->topology;
      if (frame.type == wire::Payload::Edit) {
        EXPECT_EQ(frame.AsEdit()->topology, topology + 1);
        topology = frame.AsEdit()->topology;
      }
    }
    return topology;
  };
  const std::uint32_t second = topology_at(begin.marks[1]);
  EXPECT_LT(topology_at(begin.marks[0] - 0.002), second);
  EXPECT_EQ(topology_at(begin.marks[1]), second);
  EXPECT_EQ(topology_at(0.0), 1U);
  (*source)->post(payload(wire::ResetT()));
  EXPECT_TRUE(wait_until([&] { return shown.count(wire::Payload::Notice) > 0; }));
  (*source)->stop();
}

/// The physics may be some ticks on before it shows the state of a body that it has sent.
TEST(Replay, BeginsWithTheFirstStateOfTheBodyHoweverLateItIs) {
  const test::TestFolder folder("late-state");
  const std::filesystem::path path = folder.path() / "late.h5";
  Expected<std::unique_ptr<Recorder>> recorder = Recorder::create(path, RecordingHead());
  ASSERT_TRUE(recorder.has_value()) << recorder.error().message();
  const auto add_state = [&](std::uint64_t tick, std::uint32_t epoch) {
    wire::StateT state;
    state.epoch = epoch;
    (*recorder)->add_frame(tick, wire::encode(std::move(state)));
  };
  (*recorder)->add_frame(0, wire::encode(wire::BodyT()));
  add_state(7, 1);
  add_state(40, 2);
  (*recorder)->add_frame(50, wire::encode(wire::BodyT()));
  (*recorder)->add_frame(90, wire::encode(wire::BodyT()));
  add_state(95, 3);
  (*recorder)->add_scene(1, {.file = "a.toml", .text = "", .overrides = {}, .mesh = nullptr});
  (*recorder)->close();

  test::KeptFrames shown;
  Expected<std::unique_ptr<ReplaySource>> source = ReplaySource::open(path, shown);
  ASSERT_TRUE(source.has_value()) << source.error().message();
  (*source)->start();
  ASSERT_TRUE(wait_until([&] { return shown.count(wire::Payload::Timeline) > 0; }));
  ASSERT_EQ(shown.count(wire::Payload::State), 1U);
  EXPECT_EQ(shown.last(wire::Payload::State).AsState()->epoch, 1U);
  // Of a body without a state there is none to show; that of the last one comes with it.
  const auto states_after = [&](double time) {
    const std::size_t timelines = shown.count(wire::Payload::Timeline);
    wire::SeekT seek;
    seek.time = time;
    (*source)->post(payload(seek));
    EXPECT_TRUE(wait_until([&] {
      return shown.count(wire::Payload::Timeline) > timelines &&
             shown.last(wire::Payload::Timeline).AsTimeline()->time == time;
    }));
    return shown.count(wire::Payload::State);
  };
  EXPECT_EQ(states_after(0.060), 1U);
  EXPECT_EQ(states_after(0.091), 2U);
  EXPECT_EQ(shown.last(wire::Payload::State).AsState()->epoch, 3U);
  (*source)->stop();
}

/// What the kill test starts: records until it is killed, or a minute is over.
TEST(RecordingKill, DISABLED_Victim) {
  const char* folder = std::getenv("RHEXIS_KILL_FOLDER");
  ASSERT_NE(folder, nullptr);
  test::KeptFrames frames;
  const auto begin = std::chrono::steady_clock::now();
  record_plate(folder, frames, [&] { return std::chrono::steady_clock::now() - begin > std::chrono::seconds(60); });
}

TEST(RecordingKill, WhatAKillLeavesBehindOpensAndIsTheSameUpToItsLastFlush) {
  std::mt19937_64 random(7);
  std::uint64_t most_steps = 0;
  for (int kill_number = 0; kill_number < 6; ++kill_number) {
    const test::TestFolder folder(fmt::format("killed{}-", kill_number));
    ::setenv("RHEXIS_KILL_FOLDER", folder.path().c_str(), 1);
    std::array<std::string, 3> words{"victim", "--gtest_filter=RecordingKill.DISABLED_Victim",
                                     "--gtest_also_run_disabled_tests"};
    std::array<char*, 4> arguments{words[0].data(), words[1].data(), words[2].data(), nullptr};
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    ASSERT_EQ(::posix_spawn(&child, "/proc/self/exe", &quiet, nullptr, arguments.data(), environ), 0);
    posix_spawn_file_actions_destroy(&quiet);
    // Not before its first flush, which may be any time after the file is there.
    const bool began = wait_until([&] {
      std::error_code code;
      return std::filesystem::exists(folder.path() / "recordings", code) && !folder.only_file("recordings").empty() &&
             RecordingFile::open(folder.only_file("recordings")).has_value();
    });
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 900'000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(began);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);

    const Expected<CheckReport> report = check_recording(folder.only_file("recordings"));
    ASSERT_TRUE(report.has_value()) << report.error().message();
    EXPECT_EQ(report->difference, "");
    const Expected<RecordingFile> file = RecordingFile::open(folder.only_file("recordings"));
    ASSERT_TRUE(file.has_value()) << file.error().message();
    EXPECT_EQ(report->steps, file->count().steps);
    EXPECT_EQ(report->ticks, file->count().ticks);
    most_steps = std::max(most_steps, report->steps);
    test::KeptFrames shown;
    EXPECT_TRUE(ReplaySource::open(folder.only_file("recordings"), shown).has_value());
  }
  EXPECT_GT(most_steps, 20U);
}

TEST(Recorder, EndsWhenItsQueueIsFullAndSaysSo) {
  const test::TestFolder folder("full");
  Expected<std::unique_ptr<Recorder>> recorder = Recorder::create(folder.path() / "full.h5", RecordingHead());
  ASSERT_TRUE(recorder.has_value()) << recorder.error().message();
  auto large = std::make_shared<wire::Message>();
  large->bytes.resize(Recorder::kMostWaiting / 4);
  large->kind = wire::Payload::Edit;
  for (int k = 0; k < 400 && (*recorder)->trouble().empty(); ++k) (*recorder)->add_frame(0, large);
  EXPECT_EQ((*recorder)->trouble(), "the disk is too slow for the recording: it has ended");
  EXPECT_GT((*recorder)->close(), 0U);
}

TEST(Recorder, TakesASceneOfAnySizeThatCanBeReadAgain) {
  const test::TestFolder folder("scenes");
  const std::filesystem::path path = folder.path() / "scenes.h5";
  Expected<std::unique_ptr<Recorder>> recorder = Recorder::create(path, RecordingHead());
  ASSERT_TRUE(recorder.has_value()) << recorder.error().message();
  auto mesh = std::make_shared<MeshBytes>(MeshBytes{.file = "a.msh", .bytes = std::string()});
  mesh->bytes.assign(Recorder::kMostWaiting + 1, 'm');
  (*recorder)->add_scene(1, {.file = "a.toml", .text = "", .overrides = {}, .mesh = mesh});
  (*recorder)->add(TickRow());
  EXPECT_EQ((*recorder)->trouble(), "");
  auto too_large = std::make_shared<MeshBytes>(MeshBytes{.file = "a.msh", .bytes = std::string()});
  too_large->bytes.assign(kMostMeshBytes + 1, 'm');
  (*recorder)->add_scene(2, {.file = "a.toml", .text = "", .overrides = {}, .mesh = too_large});
  EXPECT_THAT((*recorder)->trouble(), testing::HasSubstr("larger than 128 MiB"));
  (*recorder)->close();

  const Expected<RecordingFile> file = RecordingFile::open(path);
  ASSERT_TRUE(file.has_value()) << file.error().message();
  ASSERT_EQ(file->count().scenes, 1U);
  EXPECT_EQ(file->count().ticks, 1U);
  const Expected<SceneChoice> scene = file->scene(file->scenes()->front());
  ASSERT_TRUE(scene.has_value()) << scene.error().message();
  EXPECT_EQ(scene->mesh->bytes, mesh->bytes);
}

TEST(Recorder, DoesNotWriteOverAnything) {
  const test::TestFolder folder("there");
  folder.write("there.h5", "mine");
  const auto recorder = Recorder::create(folder.path() / "there.h5", RecordingHead());
  ASSERT_FALSE(recorder.has_value());
  EXPECT_THAT(recorder.error().message(), testing::HasSubstr("cannot be made"));
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "there.h5"), 4U);
}

}  // namespace
}  // namespace rhexis::session
