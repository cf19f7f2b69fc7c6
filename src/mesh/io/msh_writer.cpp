#include <algorithm>
#include <iterator>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "mesh/io/writers.h"

namespace rhexis::mesh::io {
namespace {

/// One physical group to be written: faces of a face set, or nodes as points, or all tets.
struct Group {
  int dimension;
  std::string name;
  std::vector<std::array<NodeId, 3>> triangles;
  std::vector<NodeId> points;
};

std::vector<NodeId> nodes_of_tets(const TetMesh& mesh) {
  std::vector<bool> used(mesh.node_count(), false);
  for (const Tet& tet : mesh.tets) {
    for (const NodeId node : tet) used[node.index()] = true;
  }
  std::vector<NodeId> nodes;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) nodes.emplace_back(i);
  }
  return nodes;
}

Group surface_group(const TetMesh& mesh, const FaceSet& set) {
  Group group{2, set.name, {}, {}};
  for (const TetFace face : set.faces) group.triangles.push_back(face_nodes(mesh, face));
  return group;
}

/// The nodes of a set that its surface of the same name does not have.
std::vector<NodeId> nodes_beyond(const NodeSet& set, const std::vector<std::array<NodeId, 3>>& triangles) {
  std::vector<NodeId> covered;
  for (const auto& triangle : triangles) covered.insert(covered.end(), triangle.begin(), triangle.end());
  std::sort(covered.begin(), covered.end());
  std::vector<NodeId> rest;
  std::copy_if(set.nodes.begin(), set.nodes.end(), std::back_inserter(rest),
               [&](NodeId node) { return !std::binary_search(covered.begin(), covered.end(), node); });
  return rest;
}

/// Surfaces from face sets. Of the node sets, the first that is all of the body becomes its volume; others whose nodes
/// are not those of the surface of their name become points. Reading gives the same sets again.
std::vector<Group> make_groups(const TetMesh& mesh) {
  std::vector<Group> groups;
  const std::vector<NodeId> body = nodes_of_tets(mesh);
  bool has_volume = false;
  for (const NodeSet& set : mesh.node_sets) {
    const FaceSet* faces = mesh.find_face_set(set.name);
    std::vector<NodeId> rest = set.nodes;
    if (faces != nullptr) {
      groups.push_back(surface_group(mesh, *faces));
      rest = nodes_beyond(set, groups.back().triangles);
    } else if (!has_volume && set.nodes == body) {
      groups.push_back({3, set.name, {}, {}});
      has_volume = true;
      continue;
    }
    if (!rest.empty()) groups.push_back({0, set.name, {}, std::move(rest)});
  }
  for (const FaceSet& set : mesh.face_sets) {
    if (mesh.find_node_set(set.name) == nullptr) groups.push_back(surface_group(mesh, set));
  }
  return groups;
}

/// What a name between quotes on one line can hold.
std::string one_line(std::string_view name) {
  std::string out(name);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c == '"' || c == '\n' || c == '\r'; }, '_');
  return out;
}

}  // namespace

std::string format_msh(const TetMesh& mesh) {
  const std::vector<Group> groups = make_groups(mesh);
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const auto put = [&text]<class... Args>(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
  };
  std::size_t elements = mesh.tet_count();
  std::size_t volume_tag = 0;
  if (!groups.empty()) put("$PhysicalNames\n{}\n", groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) {
    put("{} {} \"{}\"\n", groups[i].dimension, i + 1, one_line(groups[i].name));
    elements += groups[i].triangles.size() + groups[i].points.size();
    if (groups[i].dimension == 3) volume_tag = i + 1;
  }
  if (!groups.empty()) text += "$EndPhysicalNames\n";

  put("$Nodes\n{}\n", mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    const Vec3& x = mesh.nodes[i];
    put("{} {} {} {}\n", i + 1, x[0], x[1], x[2]);  // fmt's shortest form reads back to the same bits
  }
  put("$EndNodes\n$Elements\n{}\n", elements);
  std::size_t number = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    // Two tags: the physical group, and an elementary entity, which is the group's number again.
    for (const NodeId node : groups[i].points) put("{} 15 2 {} {} {}\n", ++number, i + 1, i + 1, node.value() + 1);
    for (const auto& t : groups[i].triangles) {
      put("{} 2 2 {} {} {} {} {}\n", ++number, i + 1, i + 1, t[0].value() + 1, t[1].value() + 1, t[2].value() + 1);
    }
  }
  for (const Tet& t : mesh.tets) {
    put("{} 4 2 {} 1 {} {} {} {}\n", ++number, volume_tag, t[0].value() + 1, t[1].value() + 1, t[2].value() + 1,
        t[3].value() + 1);
  }
  return text + "$EndElements\n";
}

}  // namespace rhexis::mesh::io
