#include "scene/sets.h"

#include <algorithm>
#include <limits>

#include "scene/value_of.h"

namespace rhexis::scene {
namespace {

bool is_on_side(const Body& body, NodeId node, const Side& side) {
  const double plane = side.upper ? body.box.to[side.axis] : body.box.from[side.axis];
  return std::abs(body.mesh.node(node)[side.axis] - plane) <= kSideTolerance * body.box.size().maxCoeff();
}

template <class Holds>
std::vector<NodeId> used_nodes_where(const Body& body, const Holds& holds) {
  std::vector<NodeId> nodes;
  for (std::size_t i = 0; i < body.mesh.node_count(); ++i)
    if (body.used[i] && holds(NodeId(i))) nodes.emplace_back(i);
  return nodes;
}

std::vector<NodeId> nodes_in_box(const Body& body, const Box& box) {
  const auto slack = kBoxTolerance * Vec3::Ones();
  return used_nodes_where(body, [&](NodeId node) {
    const Vec3 fraction = (body.mesh.node(node) - body.box.from).cwiseQuotient(body.box.size());
    return (fraction.array() >= (box.from - slack).array()).all() &&
           (fraction.array() <= (box.to + slack).array()).all();
  });
}

/// The first of the nearest.
std::vector<NodeId> nearest_node(const Body& body, const Vec3& point) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<NodeId> nearest;
  for (std::size_t i = 0; i < body.mesh.node_count(); ++i) {
    const double distance = (body.mesh.nodes[i] - point).norm();
    if (body.used[i] && distance < least) {
      least = distance;
      nearest = {NodeId(i)};
    }
  }
  return nearest;
}

Expected<std::vector<NodeId>> numbered_nodes(const Body& body, const std::vector<std::int64_t>& numbers,
                                             const Place& place) {
  std::vector<NodeId> nodes;
  for (const std::int64_t number : numbers) {
    if (number >= static_cast<std::int64_t>(body.mesh.node_count()))
      return place.fail(fmt::format("there is no node {}", number), fmt::format("0 to {}", body.mesh.node_count() - 1));
    nodes.emplace_back(static_cast<std::int32_t>(number));
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

Expected<std::vector<NodeId>> choose(const Body& body, const SetSettings& set) {
  if (const auto* side = std::get_if<Side>(&set.choice)) return nodes_on_side(body, *side);
  if (const auto* box = std::get_if<Box>(&set.choice)) return nodes_in_box(body, *box);
  if (const auto* point = std::get_if<Vec3>(&set.choice)) return nearest_node(body, *point);
  return numbered_nodes(body, std::get<std::vector<std::int64_t>>(set.choice), set.place);
}

bool any_used(const Body& body, const std::vector<NodeId>& nodes) {
  return std::any_of(nodes.begin(), nodes.end(), [&](NodeId node) { return body.used[node.index()]; });
}

std::string empty_hint(const SetSettings& set) {
  if (std::holds_alternative<Box>(set.choice)) return "a larger box, in fractions of the bounding box";
  if (std::holds_alternative<std::vector<std::int64_t>>(set.choice)) return "numbers of nodes that a tet has";
  return "another choice of nodes";
}

template <class Sets>
std::vector<std::string> names_of(const Sets& sets) {
  std::vector<std::string> names;
  for (const auto& set : sets) names.push_back(set.name);
  return names;
}

}  // namespace

std::vector<NodeId> nodes_on_side(const Body& body, const Side& side) {
  return used_nodes_where(body, [&](NodeId node) { return is_on_side(body, node, side); });
}

std::vector<mesh::TetFace> faces_on_side(const Body& body, const Side& side) {
  std::vector<mesh::TetFace> faces;
  for (const mesh::TetFace face : body.boundary) {
    const std::array<NodeId, 3> nodes = mesh::face_nodes(body.mesh, face);
    if (std::all_of(nodes.begin(), nodes.end(), [&](NodeId node) { return is_on_side(body, node, side); }))
      faces.push_back(face);
  }
  return faces;
}

Expected<void> add_sets(const Scene& scene, Body& body, std::vector<std::string>& notes) {
  mesh::TetMesh& mesh = body.mesh;
  for (const SetSettings& set : scene.sets) {
    Expected<std::vector<NodeId>> nodes = choose(body, set);
    if (!nodes) return fail(std::move(nodes.error()));
    if (!any_used(body, *nodes))
      return set.place.fail("set " + in_quotes(set.name) + " holds no node", empty_hint(set));
    const auto same_name = [&](const auto& other) { return other.name == set.name; };
    if (std::erase_if(mesh.node_sets, same_name) + std::erase_if(mesh.face_sets, same_name) > 0)
      notes.push_back(fmt::format("set {} of the scene stands in for the one of the mesh", in_quotes(set.name)));
    mesh.node_sets.push_back({set.name, std::move(*nodes)});
    if (const auto* side = std::get_if<Side>(&set.choice))
      if (std::vector<mesh::TetFace> faces = faces_on_side(body, *side); !faces.empty())
        mesh.face_sets.push_back({set.name, std::move(faces)});
  }
  return {};
}

Expected<std::vector<NodeId>> nodes_of(const Body& body, const std::string& set, const Place& place) {
  const mesh::NodeSet* found = body.mesh.find_node_set(set);
  if (found == nullptr)
    return place.fail("there is no set " + in_quotes(set), suggest(set, names_of(body.mesh.node_sets)));
  if (!any_used(body, found->nodes))
    return place.fail("set " + in_quotes(set) + " holds no node", "a set with nodes that a tet has");
  return found->nodes;
}

Expected<std::vector<mesh::TetFace>> faces_of(const Body& body, const FaceChoice& choice) {
  if (const auto* side = std::get_if<Side>(&choice.set)) {
    std::vector<mesh::TetFace> faces = faces_on_side(body, *side);
    if (faces.empty())
      return choice.place.fail("side " + in_quotes(side->name) + " has no faces: the body is not flat there",
                               "a surface of the mesh");
    return faces;
  }
  const std::string& name = std::get<std::string>(choice.set);
  const mesh::FaceSet* found = body.mesh.find_face_set(name);
  if (found != nullptr && !found->faces.empty()) return found->faces;
  if (found != nullptr || body.mesh.find_node_set(name) != nullptr)
    return choice.place.fail("set " + in_quotes(name) + " has no faces",
                             "a surface of the mesh, or a set by side where the body is flat");
  return choice.place.fail("there is no face set " + in_quotes(name), suggest(name, names_of(body.mesh.face_sets)));
}

}  // namespace rhexis::scene
