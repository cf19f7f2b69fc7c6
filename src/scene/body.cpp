#include "scene/body.h"

#include <algorithm>

#include "mesh/generate.h"
#include "mesh/io/readers.h"
#include "mesh/surface.h"
#include "mesh/validate.h"
#include "scene/sets.h"

namespace rhexis::scene {
namespace {

/// An error of a lower room, placed where the scene asked for it unless it has a place of its own.
tl::unexpected<Error> placed(const Error& error, const Place& place) {
  return fail(error.at(place.file ? *place.file : std::string{}, place.line));
}

Expected<mesh::TetMesh> read(const Scene& scene, const MeshFromFile& source, std::vector<std::string>& notes) {
  std::shared_ptr<const std::string> bytes = source.bytes;
  if (bytes == nullptr) {
    Expected<std::shared_ptr<const std::string>> found = read_mesh_bytes(scene);
    if (!found) return fail(std::move(found.error()));
    bytes = std::move(*found);
  }
  Expected<mesh::MeshFile> file = mesh::io::parse_mesh(*bytes, source.path.string(), {.unit = source.unit});
  if (!file) return placed(file.error(), scene.mesh.place);
  notes.insert(notes.end(), file->notes.begin(), file->notes.end());
  return std::move(file->mesh);
}

Expected<mesh::TetMesh> make_mesh(const Scene& scene, std::vector<std::string>& notes) {
  const Place& place = scene.mesh.place;
  if (const auto* file = std::get_if<MeshFromFile>(&scene.mesh.source)) return read(scene, *file, notes);
  const auto generate = [&]() -> Expected<mesh::TetMesh> {
    if (const auto* tube = std::get_if<GeneratedTube>(&scene.mesh.source))
      return mesh::make_tube(tube->shape, tube->nodes);
    const auto& box = std::get<GeneratedBox>(scene.mesh.source);
    return box.plate ? mesh::make_plate(box.shape, box.nodes) : mesh::make_bar(box.shape, box.nodes);
  };
  Expected<mesh::TetMesh> made = generate();
  if (!made) return placed(made.error(), place);
  return made;
}

/// The first defect is told, the rest counted. A node without a tet is none here: it is held.
Expected<void> check_sound(const Scene& scene, const mesh::TetMesh& mesh) {
  if (mesh.tets.empty()) return scene.mesh.place.fail("the mesh has no tets", "a mesh of the body's volume");
  std::vector<mesh::Defect> defects = mesh::find_defects(mesh);
  std::erase_if(defects, [](const mesh::Defect& defect) { return defect.kind == mesh::DefectKind::unused_node; });
  if (defects.empty()) return {};
  if (const auto* file = std::get_if<MeshFromFile>(&scene.mesh.source)) {
    const std::string name = one_line(file->path.string(), 200);
    return fail(defects.front().what,
                fmt::format("`rhexis mesh info {}` lists {}", name,
                            defects.size() == 1 ? "it" : fmt::format("all {} defects", defects.size())),
                name);
  }
  return scene.mesh.place.fail("the generated mesh is no good: " + defects.front().what,
                               "a less extreme shape, or more nodes");
}

/// Needed before any set is looked for.
void measure(Body& body) {
  body.used.assign(body.mesh.node_count(), false);
  for (const mesh::Tet& tet : body.mesh.tets)
    for (const NodeId node : tet) body.used[node.index()] = true;
  const NodeId any = body.mesh.tets.front()[0];
  body.box = {body.mesh.node(any), body.mesh.node(any)};
  for (std::size_t i = 0; i < body.mesh.node_count(); ++i) {
    if (!body.used[i]) continue;
    body.box.from = body.box.from.cwiseMin(body.mesh.nodes[i]);
    body.box.to = body.box.to.cwiseMax(body.mesh.nodes[i]);
  }
  body.boundary = mesh::find_faces(body.mesh).boundary;
}

}  // namespace

Expected<std::shared_ptr<const std::string>> read_mesh_bytes(const Scene& scene) {
  const auto* source = std::get_if<MeshFromFile>(&scene.mesh.source);
  if (source == nullptr) return nullptr;
  std::error_code code;
  if (!std::filesystem::exists(source->path, code))
    return scene.mesh.place.fail("there is no mesh file " + in_quotes(source->path.string()),
                                 "a path relative to the scene");
  Expected<std::string> bytes = mesh::read_mesh_bytes(source->path);
  if (!bytes) return placed(bytes.error(), scene.mesh.place);
  return std::make_shared<const std::string>(std::move(*bytes));
}

Expected<Body> make_body(const Scene& scene, std::vector<std::string>& notes) {
  Expected<mesh::TetMesh> mesh = make_mesh(scene, notes);
  if (!mesh) return fail(std::move(mesh.error()));
  if (Expected<void> sound = check_sound(scene, *mesh); !sound) return fail(std::move(sound.error()));
  Body body;
  body.mesh = std::move(*mesh);
  measure(body);
  if (Expected<void> added = add_sets(scene, body, notes); !added) return fail(std::move(added.error()));
  return body;
}

}  // namespace rhexis::scene
