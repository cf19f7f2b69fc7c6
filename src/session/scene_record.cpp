#include "session/scene_record.h"

#include <algorithm>
#include <utility>

namespace rhexis::session {
namespace {

bool is_mesh_of(const record::store::RecordHead& head, const mesh::TetMesh& mesh) {
  if (head.nodes.size() != 3 * mesh.node_count() || head.tets.size() != 4 * mesh.tet_count()) return false;
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    if (!std::equal(head.nodes.begin() + static_cast<std::ptrdiff_t>(3 * i),
                    head.nodes.begin() + static_cast<std::ptrdiff_t>(3 * i + 3), mesh.nodes[i].data()))
      return false;
  }
  for (std::size_t k = 0; k < head.tets.size(); ++k)
    if (head.tets[k] != mesh.tets[k / 4][k % 4].value()) return false;
  return true;
}

}  // namespace

record::build::CampaignRequest record_request(const scene::TearProblem& problem, std::string program) {
  const scene::CrackSettings& crack = problem.cracks.front();
  return {.mesh = problem.mesh,
          .elastic = problem.body,
          .crack = crack.line,
          .parameters = problem.record.parameters,
          .single_precision = problem.record.single_precision,
          .program = std::move(program),
          .title = problem.title};
}

Expected<response::SharedRecord> load_record(const scene::TearProblem& problem) {
  const std::optional<std::filesystem::path>& named = problem.interaction.record;
  if (!named) return fail("the scene names no record", "'record' in [interaction]");
  if (problem.cracks.size() != 1)
    return fail(fmt::format("{} cracks, of which a record follows one", problem.cracks.size()), "one [[crack]]");
  if (problem.fracture.incision == "split")
    return fail("incision \"split\" adds nodes, which no record has", "incision = \"keep-nodes\"");
  const std::string file = named->lexically_normal().string();
  const scene::Place& place = problem.cracks.front().place;
  const std::string remedy = fmt::format("rhexis precompute {} --out {}", place.file ? *place.file : "SCENE", file);
  const auto wrong = [&](std::string what) { return fail(std::move(what), remedy, file); };
  Expected<response::SharedRecord> record = record::store::LoadedRecord::read(file);
  if (!record) return wrong(record.error().what);
  const record::store::RecordHead& head = (*record)->head();
  if (!is_mesh_of(head, problem.mesh)) return wrong("the record of another mesh than the scene's");
  record::build::CampaignRequest request = record_request(problem, head.program);
  if (head.frame != record::build::frame_of(request.crack)) return wrong("the record of another [[crack]]");
  request.parameters = head.parameters;
  request.single_precision = head.single_precision;
  if (record::build::fingerprint_of(request) != head.fingerprint)
    return wrong("the record of another material, [[support]], load or [[crack]], or of another version's method");
  return record;
}

std::vector<std::string> remarks_on(const response::RecordUse& use, const response::RecordUse& before) {
  std::vector<std::string> out;
  if (use.outside && !before.outside)
    out.push_back(
        fmt::format("the crack is outside the record: the nearest of it, topology {}, answers", use.topology));
  if (use.past_last && !before.past_last)
    out.push_back(
        fmt::format("the crack has run on more often than the record knows: topology {} stays", use.topology));
  if (use.torn_off && !before.torn_off)
    out.push_back("what is held has come off in the record: its force is that of topologies that have it");
  if (use.not_made && !before.not_made)
    out.push_back(fmt::format(
        "an advance of topology {} could not be made when it was recorded: the body before it answers", use.topology));
  return out;
}

}  // namespace rhexis::session
