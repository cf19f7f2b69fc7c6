// Makes the seeds of the formats that are ours alone:
//
//     build/fuzz/bin/rhexis_fuzz_seeds fuzz/corpus

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fuzz/record_parts.h"
#include "fuzz/recording_parts.h"
#include "record/store/record_reader.h"
#include "session/recording_head.h"
#include "session/recording_scene.h"
#include "wire/frame.h"

namespace {

using namespace rhexis;
using Bytes = std::vector<std::uint8_t>;

void write(const std::filesystem::path& path, const Bytes& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

Bytes read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Of each form of frame one that has all its fields: lists in lists, numbers, texts, nothing.
std::vector<wire::SharedMessage> frames() {
  wire::HelloT hello;
  hello.version = "1";
  hello.scenes = {"a.toml", "b.toml"};
  hello.declarations = "[]";
  wire::FrontT front;
  front.points = {{0.1, 0.0, 0.0}, {0.1, 0.1, 0.0}};
  wire::AdvanceT advance;
  advance.length = 0.1;
  advance.force_before = std::make_unique<wire::Vec3>(1.0, 0.0, 0.0);
  wire::BodyT body;
  body.scene = "a.toml";
  body.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  body.node = {0, 1, 2};
  body.faces = {0, 1, 2};
  body.fronts.push_back(std::make_unique<wire::FrontT>(front));
  body.advances.push_back(std::make_unique<wire::AdvanceT>(advance));
  wire::EditT edit;
  edit.topology = 1;
  edit.moved = {2};
  edit.moved_to = {0, 1, 1};
  edit.slots = {0};
  edit.faces = {0, 1, 2};
  edit.fronts.push_back(std::make_unique<wire::FrontT>(front));
  edit.advance = std::make_unique<wire::AdvanceT>(advance);
  wire::StateT state;
  state.displacement.assign(9, 0.5F);
  state.hand = std::make_unique<wire::Vec3>(0.1, 0.0, 0.0);
  state.rates = std::make_unique<wire::RatesT>();
  state.trace.assign(3, 1.0F);
  wire::NoticeT notice;
  notice.text = "words";
  wire::TimelineT timeline;
  timeline.marks = {1.0, 2.0};
  wire::SetValueT set_value;
  set_value.key = "material.young";
  set_value.value = "2e6";
  wire::TrialT trial;
  trial.title = "Angles";
  trial.point = std::make_unique<wire::Vec3>(0.1, 0.0, 0.0);
  trial.direction = std::make_unique<wire::Vec3>(-1.0, 0.0, 0.0);
  wire::AnswerT answer;
  answer.same = wire::Presented::b;
  wire::GraspT grasp;
  grasp.weights = std::make_unique<wire::Vec3>(0.5, 0.25, 0.25);
  return {wire::encode(std::move(hello)),     wire::encode(std::move(body)),   wire::encode(std::move(edit)),
          wire::encode(std::move(state)),     wire::encode(std::move(notice)), wire::encode(std::move(timeline)),
          wire::encode(std::move(set_value)), wire::encode(std::move(grasp)),  wire::encode(wire::ResetT()),
          wire::encode(std::move(trial)),     wire::encode(std::move(answer)), wire::encode(wire::FeelT())};
}

fuzz::RecordingParts recording() {
  fuzz::RecordingParts parts;
  const std::string settings = session::text_of({.version = "1", .device = "pointer"});
  parts.settings.assign(settings.begin(), settings.end());
  parts.ticks.resize(3);
  parts.steps.resize(2);
  const auto add = [&](std::vector<session::PieceRow>& table, std::uint64_t kind, const Bytes& bytes) {
    table.push_back({.at = 1, .kind = kind, .offset = parts.bytes.size(), .size = bytes.size()});
    parts.bytes.insert(parts.bytes.end(), bytes.begin(), bytes.end());
  };
  const auto mesh = std::make_shared<session::MeshBytes>(session::MeshBytes{.file = "a.msh", .bytes = "mesh"});
  add(parts.scenes, 0,
      session::bytes_of({.file = "a.toml", .text = "title = \"A\"", .overrides = {"a.b=1"}, .mesh = mesh}));
  for (const wire::SharedMessage& frame : frames()) {
    const bool is_command = frame->kind > wire::Payload::Pong && frame->kind != wire::Payload::Trial;
    add(is_command ? parts.commands : parts.frames, static_cast<std::uint64_t>(frame->kind), frame->bytes);
  }
  parts.flushes = {{.scenes = 1, .bytes = parts.scenes[0].size},
                   {parts.ticks.size(), parts.steps.size(), parts.commands.size(), parts.scenes.size(),
                    parts.frames.size(), parts.bytes.size()}};
  return parts;
}

/// A body before its one advance and after it, in three directions: two tets, three grasp points, four unknowns.
fuzz::RecordParts record_parts() {
  record::store::Parameters parameters;
  parameters.advances = 1;
  parameters.directions = 3;
  parameters.pull_directions = 4;
  fuzz::RecordParts parts;
  parts.advances = {parameters.advances};
  parts.pull_length = {parameters.pull_length};
  parts.directions = direction_angles(parameters);
  parts.lengths = parameters.lengths;
  parts.pull_directions = pull_angles(parameters);
  parts.frame = {0, 1, 0, 0, 0, 1, 1, 0, 0};
  parts.nodes = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  parts.tets = {0, 1, 2, 3, 1, 2, 3, 4};
  parts.points = {1, 2, 4};
  parts.edges = {0, 1, 1, 2};
  parts.dof = {3, 4, 5, 6};
  parts.start = {0, 2, 4, 5, 6};
  parts.row = {0, 2, 1, 3, 2, 3};
  const auto topologies = static_cast<std::size_t>(record::store::Numbering(parameters).count());
  parts.flags.assign(topologies, 0);
  parts.in_solve.assign(topologies * parts.points.size(), 1);
  parts.stiffness.assign(topologies * parts.points.size() * 6, 1e3);
  parts.compliance.assign(topologies * parts.edges.size() / 2 * 9, 1e-3);
  parts.rest.assign(topologies * parts.nodes.size(), 0.01);
  parts.factor.assign(topologies * parts.row.size(), 0.5);
  parts.moved_start = {0, 0, 1, 3, 3};
  parts.moved_node = {2, 1, 4};
  parts.moved_to.assign(3 * parts.moved_node.size(), 0.1);
  parts.gone_start = {0, 0, 0, 1, 1};
  parts.gone_tet = {1};
  parts.frozen_start = {0, 0, 0, 0, 1};
  parts.frozen_tet = {0};
  return parts;
}

/// A seed that is refused would reach nothing.
void check_record(const std::filesystem::path& path) {
  const Expected<record::store::RecordFile> file = record::store::RecordFile::open(path);
  RHEXIS_CHECK(file && file->read_record(), "{}", file ? "a list" : file.error().message());
  for (int t = 0; t < file->topologies(); ++t) RHEXIS_CHECK(file->read_topology(t).has_value(), "topology {}", t);
}

/// Writes a seed: `first` chooses how its target takes it.
void write_seed(const std::filesystem::path& path, std::uint8_t first, Bytes bytes) {
  bytes.insert(bytes.begin(), first);
  write(path, bytes);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::fputs("usage: rhexis_fuzz_seeds FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path corpus = words[1];
  for (const wire::SharedMessage& frame : frames())
    write(corpus / "frame" / wire::EnumNamePayload(frame->kind), frame->bytes);
  for (const char* folder : {"recording", "record"}) std::filesystem::create_directories(corpus / folder);
  std::filesystem::path file = corpus / "recording/file";
  fuzz::write_recording(file, recording());
  write_seed(file, 0, read(file));
  write_seed(corpus / "recording/parts", 1, fuzz::input_of(recording()));

  file = corpus / "record/file";
  fuzz::write_record(file, record_parts(), false);
  check_record(file);
  write_seed(file, 0, read(file));
  write_seed(corpus / "record/parts", 1, fuzz::input_of(record_parts()));
  write_seed(corpus / "record/parts_single", 3, fuzz::input_of(record_parts()));
  return 0;
}
