#pragma once

/// What every mesh reader is held to: any bytes either read to a mesh that keeps the promises of mesh/io/mesh_file.h,
/// or are refused with an error that names the file and says what is wrong.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/check.h"
#include "mesh/io/readers.h"

namespace rhexis::fuzz {

inline void check_mesh(const Expected<mesh::MeshFile>& read) {
  if (!read) {
    RHEXIS_CHECK(!read.error().what.empty() && !read.error().file.empty() && read.error().line >= 0,
                 "an error without a place");
    return;
  }
  const mesh::TetMesh& body = read->mesh;
  RHEXIS_CHECK(body.tet_count() > 0, "a mesh without tets");
  for (const Vec3& x : body.nodes) RHEXIS_CHECK(x.allFinite(), "a node that is nowhere");
  for (const mesh::Tet& tet : body.tets) {
    for (const NodeId node : tet)
      RHEXIS_CHECK(node.valid() && node.index() < body.node_count(), "a node that does not exist");
  }
  for (const mesh::NodeSet& set : body.node_sets) {
    RHEXIS_CHECK(!set.nodes.empty() && set.nodes.back().index() < body.node_count(), "a bad node set");
    for (std::size_t i = 1; i < set.nodes.size(); ++i)
      RHEXIS_CHECK(set.nodes[i - 1] < set.nodes[i], "an unordered set");
  }
  for (const mesh::FaceSet& set : body.face_sets) {
    RHEXIS_CHECK(body.find_node_set(set.name) != nullptr, "a face set without its node set");
    for (const mesh::TetFace face : set.faces) RHEXIS_CHECK(face.tet.index() < body.tet_count(), "a face of no tet");
  }
  for (const mesh::Field& field : read->fields) {
    const std::size_t entities = field.centering == mesh::Centering::point ? body.node_count() : body.tet_count();
    RHEXIS_CHECK(field.components > 0 && field.values.size() == entities * static_cast<std::size_t>(field.components),
                 "a bad field");
  }
}

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace rhexis::fuzz
