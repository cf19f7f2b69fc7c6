#include "session/open_body.h"

#include <array>

#include "base/hash.h"
#include "base/parallel.h"
#include "record/store/record_reader.h"
#include "scene/body.h"
#include "session/scene_record.h"

namespace rhexis::session {
namespace {

template <class T>
void add(Hash& hash, const std::vector<T>& values) {
  const std::array<std::uint64_t, 1> count{values.size()};
  hash.add(std::span<const std::uint64_t>(count));
  hash.add(std::span<const T>(values));
}

void add(Hash& hash, const Vec3& v) { hash.add(std::span<const double>(v.data(), 3)); }

/// Positions and tets, and the supports, which the loads' bits follow from.
std::uint64_t fingerprint_of(const scene::TearProblem& problem) {
  Hash hash;
  for (const Vec3& position : problem.mesh.nodes) add(hash, position);
  add(hash, problem.mesh.tets);
  for (const model::PrescribedDof& support : problem.body.supports) {
    hash.add(std::span<const std::int32_t>(&support.dof, 1));
    hash.add(std::span<const double>(&support.value, 1));
  }
  return hash.value();
}

Expected<std::unique_ptr<OpenBody>> start_body(SceneChoice scene, scene::TearProblem problem,
                                               response::SharedRecord record) {
  Expected<TearStart> start = start_tear(problem, std::move(record), Pace::goes_along);
  if (!start) return fail(std::move(start.error()));
  SurfaceTracker surface(start->tear->body());
  const std::uint64_t intact = fingerprint_of(problem);
  auto body = std::make_unique<OpenBody>(OpenBody{.scene = std::move(scene),
                                                  .problem = std::move(problem),
                                                  .start = std::move(*start),
                                                  .surface = std::move(surface)});
  const TearSession& tear = body->tear();
  body->first_topology = tear.body().topology();
  body->advance_time.assign(tear.advances().size(), 0.0);
  body->fingerprint = intact;
  for (const mesh::MeshEdit& edit : tear.body().history())
    body->fingerprint = chained(body->fingerprint, edit, /*taken_back=*/false);
  return body;
}

/// `fingerprint`: that it has to have, or 0; then that it has.
Expected<response::SharedRecord> read_record_of(const scene::TearProblem& problem, std::uint64_t& fingerprint) {
  if (problem.interaction.response != "recorded") return nullptr;
  Expected<response::SharedRecord> record = load_record(problem);
  if (!record) return record;
  const std::uint64_t found = (*record)->head().fingerprint;
  if (fingerprint != 0 && fingerprint != found)
    return fail(fmt::format("record {:016x}, and {:016x} is what the forces were felt of", found, fingerprint),
                "the record of that time in its place", problem.interaction.record->lexically_normal().string());
  fingerprint = found;
  return record;
}

}  // namespace

Expected<SceneChoice> read_scene_choice(std::string file, std::vector<std::string> overrides) {
  Expected<std::string> text = scene::read_scene_text(file);
  if (!text) return fail(std::move(text.error()));
  SceneChoice choice{.file = std::move(file), .text = std::move(*text), .overrides = std::move(overrides)};
  const Expected<scene::Scene> scene = scene::parse_scene(choice.text, choice.file, choice.overrides);
  if (scene && scene->interaction.response == "recorded")
    choice.record =
        record::store::fingerprint_of(*scene->interaction.record).value_or(0);  // open_body says what is wrong
  const auto* source = scene ? std::get_if<scene::MeshFromFile>(&scene->mesh.source) : nullptr;
  if (source == nullptr) return choice;
  Expected<std::shared_ptr<const std::string>> bytes = scene::read_mesh_bytes(*scene);
  if (!bytes) return fail(std::move(bytes.error()));
  choice.mesh = std::make_shared<MeshBytes>(MeshBytes{.file = source->path, .bytes = **bytes});
  return choice;
}

Expected<std::unique_ptr<OpenBody>> open_body(SceneChoice choice) {
  Expected<scene::Scene> scene = scene::parse_scene(choice.text, choice.file, choice.overrides);
  if (!scene) return fail(std::move(scene.error()));
  if (auto* source = std::get_if<scene::MeshFromFile>(&scene->mesh.source)) {
    if (choice.mesh == nullptr || choice.mesh->file != source->path)
      return scene->mesh.place.fail(fmt::format("mesh file '{}' has not been read", source->path.string()),
                                    "the file that was read with the scene");
    source->bytes = {choice.mesh, &choice.mesh->bytes};
  }
  Expected<scene::TearProblem> problem = scene::build_tear_problem(*scene, scene::Puller::hand);
  if (!problem) return fail(std::move(problem.error()));
  set_thread_count(scene->solver.threads);
  Expected<response::SharedRecord> record = read_record_of(*problem, choice.record);
  if (!record) return fail(std::move(record.error()));
  return start_body(std::move(choice), std::move(*problem), std::move(*record));
}

Expected<std::unique_ptr<OpenBody>> reopen(const OpenBody& body) {
  return start_body(body.scene, body.problem, body.start.record);
}

std::uint64_t chained(std::uint64_t fingerprint, const mesh::MeshEdit& edit, bool taken_back) {
  Hash hash;
  const std::array<std::uint64_t, 2> before{fingerprint, taken_back ? 1U : 0U};
  hash.add(std::span<const std::uint64_t>(before));
  add(hash, edit.removed);
  add(hash, edit.frozen);
  for (const mesh::MovedNode& move : edit.moved) {
    hash.add(std::span<const NodeId>(&move.node, 1));
    add(hash, move.to);
  }
  add(hash, edit.copied);
  for (const mesh::RewiredTet& change : edit.rewired) {
    hash.add(std::span<const TetId>(&change.tet, 1));
    hash.add(std::span<const NodeId>(change.after));
  }
  return hash.value();
}

}  // namespace rhexis::session
