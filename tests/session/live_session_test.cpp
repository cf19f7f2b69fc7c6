#include "session/live_session.h"

#include <gmock/gmock.h>

#include "mesh/generate.h"
#include "mesh/io/mesh_file.h"
#include "session/recording_file.h"
#include "session/replay_check.h"
#include "tests/session/live_case.h"

namespace rhexis::session {
namespace {

using test::LiveCase;
using test::payload;
using test::wait_until;

TEST(LiveSession, SendsABodyFirstAndThenStatesOfIt) {
  LiveCase at("live-first");
  at.start();
  ASSERT_TRUE(wait_until([&] { return at.frames.count(wire::Payload::State) >= 5; }));
  at.live->stop();
  const std::vector<wire::PayloadUnion> all = at.frames.all();
  ASSERT_EQ(all.front().type, wire::Payload::Body);
  const wire::BodyT& body = *all.front().AsBody();
  EXPECT_EQ(body.title, "Plate");
  EXPECT_EQ(body.model, "linear");
  EXPECT_EQ(body.positions.size(), 3 * body.node.size());
  EXPECT_EQ(body.advances.size(), 1U);  // the scene's crack
  EXPECT_EQ(body.script, 0.5);
  EXPECT_FALSE(body.held.empty());
  EXPECT_FALSE(body.local.empty());
  const wire::StateT state = at.state();
  EXPECT_EQ(state.epoch, body.epoch);
  EXPECT_EQ(state.displacement.size(), body.positions.size());
  EXPECT_EQ(state.topology, body.topology);
  EXPECT_GT(state.tick, 0U);
}

TEST(LiveSession, AScriptTearsThePlateAndEveryEditArrivesInOrder) {
  LiveCase at("live-script");
  at.start();
  wire::ScriptT on;
  on.on = true;
  at.live->post(payload(on));
  ASSERT_TRUE(wait_until([&] {
    const auto notices = at.frames.notices();
    return std::find(notices.begin(), notices.end(), "the script has come to its end") != notices.end() ||
           (at.state().advances > 5 && !at.state().scripted);
  }));
  at.live->stop();
  std::uint32_t topology = 0;
  std::uint32_t edits = 0;
  for (const wire::PayloadUnion& frame : at.frames.all()) {
    if (frame.type == wire::Payload::Body) topology = frame.AsBody()->topology;
    if (frame.type != wire::Payload::Edit) continue;
    EXPECT_EQ(frame.AsEdit()->topology, topology + 1);
    EXPECT_EQ(frame.AsEdit()->faces.size(), 3 * frame.AsEdit()->slots.size());
    topology = frame.AsEdit()->topology;
    ++edits;
  }
  EXPECT_GE(edits, 2U);  // a physics that is late tears further at once
  EXPECT_EQ(topology, at.state().topology);
  EXPECT_EQ(edits + 1, at.state().advances);  // the scene's crack is the first
}

TEST(LiveSession, AHandHoldsPullsTearsLetsGoAndTakesItsTearsBack) {
  LiveCase at("live-hand");
  at.start();
  ASSERT_TRUE(wait_until([&] { return at.frames.count(wire::Payload::State) > 0; }));
  at.live->post(at.grasp_near({0.10, 0.0, 0.005}));
  ASSERT_TRUE(wait_until([&] { return at.state().held; }));
  at.live->post(test::move_to(-0.005, 0.0, 0.0));
  ASSERT_TRUE(wait_until([&] { return at.state().body_force != nullptr && at.state().body_force->x() > 0.0; }));
  // No faster than a picture shows the hand there: a physics that is late would tear all the way at once.
  for (int k = 1; k <= 30 && at.state().advances < 3; ++k) {
    at.live->post(test::move_to(-0.005 * k, 0.0, 0.0));
    ASSERT_TRUE(wait_until([&] { return at.state().hand->x() < -0.005 * k + 0.001; }));
  }
  ASSERT_GE(at.state().advances, 3U);
  at.live->post(payload(wire::LetGoT()));  // held on, it would tear further
  ASSERT_TRUE(wait_until([&] { return !at.state().held; }));
  const std::uint32_t advances = at.state().advances;
  at.live->post(payload(wire::UndoT()));
  ASSERT_TRUE(wait_until([&] { return at.state().advances == advances - 1; }));
  at.live->post(payload(wire::ResetT()));
  ASSERT_TRUE(wait_until([&] { return at.state().advances == 1; }));
  at.live->post(payload(wire::UndoT()));
  EXPECT_TRUE(at.hears("there is no tear to take back"));
  EXPECT_EQ(at.state().advances, 1U);
}

TEST(LiveSession, FieldsHaveAValueAVertexAndNoneIsNone) {
  LiveCase at("live-field");
  at.start();
  ASSERT_TRUE(wait_until([&] { return at.frames.count(wire::Payload::State) > 0; }));
  EXPECT_TRUE(at.state().values.empty());
  at.live->post(at.grasp_near({0.10, 0.0, 0.005}));
  at.live->post(test::move_to(-0.002, 0.0, 0.0));
  ASSERT_TRUE(wait_until([&] { return at.state().body_force != nullptr && at.state().body_force->x() > 0.0; }));
  for (const wire::Field field :
       {wire::Field::von_mises, wire::Field::principal_max, wire::Field::mean_stress, wire::Field::displacement}) {
    wire::ShowFieldT show;
    show.field = field;
    at.live->post(payload(show));
    ASSERT_TRUE(wait_until([&] { return at.state().field == field; }));
    const wire::StateT state = at.state();
    ASSERT_EQ(3 * state.values.size(), state.displacement.size());
    EXPECT_GT(*std::max_element(state.values.begin(), state.values.end()), 0.0F);
  }
}

TEST(LiveSession, WhatIsWrongIsSaidAndTheOldBodyStays) {
  LiveCase at("live-wrong");
  const std::string other = at.folder.write("other.toml", test::kLivePlate + "[typo]\n");
  at.settings.scenes = {at.settings.scene, other};
  at.start();
  wire::OpenSceneT open;
  open.file = "/etc/passwd";
  at.live->post(payload(open));
  EXPECT_TRUE(at.hears("/etc/passwd: not one of the scenes that can be opened here"));
  open.file = other;
  at.live->post(payload(open));
  EXPECT_TRUE(at.hears("unknown section 'typo'"));
  wire::SetValueT set;
  set.key = "material.young";
  set.value = "-1";
  at.live->post(payload(set));
  EXPECT_TRUE(at.hears("--set material.young=-1: 'material.young' is -1"));
  wire::GraspT grasp;
  grasp.face = 4'000'000'000U;
  at.live->post(payload(std::move(grasp)));
  EXPECT_TRUE(at.hears("there is no surface any more"));
  EXPECT_EQ(at.frames.count(wire::Payload::Body), 1U);
  set.value = "2e6";
  at.live->post(payload(set));
  EXPECT_TRUE(wait_until([&] { return at.frames.count(wire::Payload::Body) == 2; }));
  EXPECT_THAT(at.frames.last(wire::Payload::Body).AsBody()->values, testing::HasSubstr("\"material.young\":2000000.0"));
}

TEST(LiveSession, APauseStopsTheScriptAndAStepMovesItOnByItsTicks) {
  LiveCase at("live-pause");
  at.start();
  wire::PauseT pause;
  pause.on = true;
  at.live->post(payload(pause));
  ASSERT_TRUE(wait_until([&] { return at.state().paused; }));
  wire::ScriptT script;
  script.on = true;
  at.live->post(payload(script));
  ASSERT_TRUE(wait_until([&] { return at.state().scripted; }));
  EXPECT_FALSE(at.state().held);
  wire::StepT step;
  step.ticks = 20;
  at.live->post(payload(step));
  ASSERT_TRUE(wait_until([&] { return at.state().held && at.state().hand->x() < 0.0; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  // 20 of 500 ticks of 0.12 m, and as many as the two loops are apart.
  const double moved = -at.state().hand->x();
  EXPECT_GT(moved, 0.12 * 5 / 500);
  EXPECT_LT(moved, 0.12 * 60 / 500);
}

TEST(LiveSession, WhatWasRecordedComesOutTheSameToTheLastBit) {
  LiveCase at("live-record");
  at.settings.recordings = at.folder.path() / "recordings";
  at.start();
  ASSERT_TRUE(wait_until([&] { return at.frames.count(wire::Payload::State) > 0; }));
  wire::RecordT record;
  record.on = true;
  at.live->post(payload(record));
  ASSERT_TRUE(wait_until([&] { return at.state().recording; }));
  at.live->post(at.grasp_near({0.10, 0.0, 0.005}));
  ASSERT_TRUE(wait_until([&] { return at.state().held; }));
  for (int k = 1; k <= 20; ++k) {
    at.live->post(test::move_to(-0.004 * k, 0.001 * (k % 3), 0.0005 * k));
    std::this_thread::sleep_for(std::chrono::milliseconds(15));
  }
  at.live->post(payload(wire::UndoT()));
  wire::SetValueT set;
  set.key = "fracture.incision";
  set.value = "split";
  at.live->post(payload(set));
  ASSERT_TRUE(wait_until(
      [&] { return at.frames.last(wire::Payload::Body).AsBody()->values.find("\"split\"") != std::string::npos; }));
  const std::size_t edits = at.frames.count(wire::Payload::Edit);
  wire::ScriptT script;
  script.on = true;
  at.live->post(payload(script));
  ASSERT_TRUE(wait_until([&] { return at.frames.count(wire::Payload::Edit) >= edits + 1; }));
  wire::OpenSceneT open;
  open.file = at.settings.scene;
  const std::size_t bodies = at.frames.count(wire::Payload::Body);
  at.live->post(payload(open));
  ASSERT_TRUE(wait_until([&] { return at.frames.count(wire::Payload::Body) > bodies; }));
  record.on = false;
  at.live->post(payload(record));
  ASSERT_TRUE(wait_until([&] { return at.frames.count(wire::Payload::Recorded) == 1; }));
  at.live->stop();
  const auto path = at.folder.only_file("recordings");
  EXPECT_EQ(at.frames.last(wire::Payload::Recorded).AsRecorded()->file, path.filename().string());
  EXPECT_EQ(at.frames.last(wire::Payload::Recorded).AsRecorded()->bytes, std::filesystem::file_size(path));

  const Expected<CheckReport> report = check_recording(path);
  ASSERT_TRUE(report.has_value()) << report.error().message();
  EXPECT_EQ(report->difference, "");
  EXPECT_GT(report->steps, 50U);  // how many is a matter of the machine's speed; that all of them are checked is not
  EXPECT_GT(report->ticks, 300U);
  const Expected<RecordingFile> file = RecordingFile::open(path);
  ASSERT_TRUE(file.has_value()) << file.error().message();
  EXPECT_EQ(report->steps, file->count().steps);
  EXPECT_EQ(report->ticks, file->count().ticks);
  EXPECT_GE(report->advances, 3U);
  EXPECT_EQ(report->bodies, 3U);
}

/// kLivePlate with its mesh in a file of the folder.
std::string write_plate(const test::TestFolder& folder, const std::string& mesh_file, int nodes) {
  const Expected<mesh::TetMesh> plate = mesh::make_plate({.size = {0.24, 0.24, 0.01}}, nodes);
  EXPECT_TRUE(plate && mesh::write_mesh_file(folder.path() / mesh_file, *plate));
  std::string text = test::kLivePlate;
  const std::size_t begin = text.find("generate");
  text.replace(begin, text.find("[material]") - begin, "file = \"" + mesh_file + "\"\n");
  return folder.write(mesh_file + ".toml", text);
}

TEST(LiveSession, ARecordingNeedsNoMeshFile) {
  LiveCase at("live-mesh");
  at.settings.scene = write_plate(at.folder, "first.msh", 506);
  const std::string second = write_plate(at.folder, "second.msh.gz", 700);
  at.settings.scenes = {second};
  at.settings.recordings = at.folder.path() / "recordings";
  at.settings.records = true;
  at.start();
  const auto count = [&](wire::Payload kind) { return at.frames.count(kind); };
  const auto tears = [&] {
    const std::size_t edits = count(wire::Payload::Edit);
    wire::ScriptT script;
    script.on = true;
    at.live->post(payload(script));
    return wait_until([&] { return count(wire::Payload::Edit) > edits; });
  };
  const auto opens = [&](wire::PayloadUnion command) {
    const std::size_t bodies = count(wire::Payload::Body);
    at.live->post(std::move(command));
    return wait_until([&] { return count(wire::Payload::Body) > bodies; });
  };
  EXPECT_TRUE(tears());
  // From here on the file is another one; the body stays that of the scene as it was opened.
  at.folder.write("first.msh", "nonsense");
  wire::SetValueT set;
  set.key = "material.young";
  set.value = "2e6";
  EXPECT_TRUE(opens(payload(set)));
  EXPECT_TRUE(tears());
  set.key = "mesh.file";
  set.value = "second.msh.gz";
  at.live->post(payload(set));
  EXPECT_TRUE(at.hears("second.msh.gz' has not been read"));
  wire::OpenSceneT open;
  open.file = second;
  EXPECT_TRUE(opens(payload(open)));
  EXPECT_TRUE(tears());
  at.live->stop();

  std::filesystem::remove(at.folder.path() / "first.msh");
  std::filesystem::remove(at.folder.path() / "second.msh.gz");
  const Expected<CheckReport> report = check_recording(at.folder.only_file("recordings"));
  ASSERT_TRUE(report.has_value()) << report.error().message();
  EXPECT_EQ(report->difference, "");
  EXPECT_GE(report->advances, 3U);
  EXPECT_EQ(report->bodies, 3U);
}

}  // namespace
}  // namespace rhexis::session
