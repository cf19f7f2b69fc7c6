#pragma once

/// The body in two halves that meet at the rim of a window, each condensed onto it. Both follow the edits as versions:
/// one that is made leaves those before as they are.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "linalg/front_tree.h"
#include "mesh/torn_mesh.h"
#include "response/elastic_elements.h"
#include "response/window.h"

namespace rhexis::response {

/// Of one topology.
struct Halves {
  std::shared_ptr<const Window> window;
  std::shared_ptr<const linalg::FrontTree> outside;
  std::shared_ptr<const linalg::FrontTree> inside;  ///< null when the window is empty
  /// Parents of the nodes that were appended since `outside` was made: it knows none of them.
  std::vector<std::int32_t> copied;

  [[nodiscard]] bool is_stable() const;
};

/// What edits did to a body: several that were made after each other, or one that was taken back.
struct Followed {
  std::size_t dropped = 0;           ///< nodes that went with the edit that was taken back
  std::vector<std::int32_t> copied;  ///< parent of each appended node
  std::vector<TetId> touched;        ///< ascending, each once

  /// `mesh`: after the edit, or after it was taken back.
  void add(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit);
  void take_back(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit);

 private:
  void touch(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit);
};

/// All that was touched is inside, and no tet there has come to a node that only the outside knows.
[[nodiscard]] bool is_inside(const mesh::TornMesh& mesh, const Window& window, const Followed& what);

/// Without a window. Everything is factored: the slow one.
[[nodiscard]] Halves make_halves(const mesh::TornMesh& mesh, const ElasticModel& model);
/// For what is_inside: the fast one.
[[nodiscard]] Halves follow_inside(const mesh::TornMesh& mesh, const ElasticModel& model, const Halves& before,
                                   const Followed& what);
/// Another window, for whatever was touched.
[[nodiscard]] Halves move_window(const mesh::TornMesh& mesh, const ElasticModel& model, const Halves& before,
                                 std::shared_ptr<const Window> window, const Followed& what);

}  // namespace rhexis::response
