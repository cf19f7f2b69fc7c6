#include "mesh/torn_mesh.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace rhexis::mesh {
namespace {

void insert_sorted(std::vector<TetId>& tets, TetId tet) {
  tets.insert(std::lower_bound(tets.begin(), tets.end(), tet), tet);
}

void erase_sorted(std::vector<TetId>& tets, TetId tet) {
  const auto at = std::lower_bound(tets.begin(), tets.end(), tet);
  RHEXIS_CHECK(at != tets.end() && *at == tet, "tet {} is not around its node", tet.value());
  tets.erase(at);
}

}  // namespace

TornMesh::TornMesh(TetMesh intact)
    : mesh_(std::move(intact)),
      intact_nodes_(mesh_.node_count()),
      alive_(mesh_.tet_count(), 1),
      frozen_(mesh_.tet_count(), 0),
      around_(mesh_.node_count()) {
  original_.reserve(mesh_.node_count());
  for (std::size_t node = 0; node < mesh_.node_count(); ++node) original_.emplace_back(node);
  for (std::size_t tet = 0; tet < mesh_.tet_count(); ++tet) {
    for (const NodeId node : mesh_.tets[tet]) around_[node.index()].emplace_back(tet);
  }
}

bool TornMesh::is_solved(NodeId node) const {
  const std::span<const TetId> around = tets_around(node);
  return std::any_of(around.begin(), around.end(), [&](TetId tet) { return is_solved(tet); });
}

double TornMesh::volume() const {
  double sum = 0.0;
  for (std::size_t tet = 0; tet < mesh_.tet_count(); ++tet) {
    if (alive_[tet] != 0) sum += signed_volume(mesh_, TetId(tet));
  }
  return sum;
}

void TornMesh::apply(MeshEdit edit) {
  for (const MovedNode& move : edit.moved) {
    Vec3& position = mesh_.nodes[move.node.index()];
    RHEXIS_CHECK(position == move.from, "node {} is not where the edit found it", move.node.value());
    position = move.to;
  }
  for (const NodeId parent : edit.copied) {
    mesh_.nodes.push_back(mesh_.node(parent));
    original_.push_back(original_[parent.index()]);
    around_.emplace_back();
  }
  for (const TetId tet : edit.removed) {
    RHEXIS_CHECK(is_alive(tet), "tet {} is removed twice", tet.value());
    alive_[tet.index()] = 0;
    for (const NodeId node : mesh_.tet(tet)) erase_sorted(around_[node.index()], tet);
  }
  for (const RewiredTet& change : edit.rewired) {
    RHEXIS_CHECK(is_alive(change.tet) && mesh_.tet(change.tet) == change.before, "tet {} is not as the edit found it",
                 change.tet.value());
    for (const NodeId node : change.before) erase_sorted(around_[node.index()], change.tet);
    for (const NodeId node : change.after) insert_sorted(around_[node.index()], change.tet);
    mesh_.tets[change.tet.index()] = change.after;
  }
  for (const TetId tet : edit.frozen) {
    RHEXIS_CHECK(is_solved(tet), "tet {} is frozen and out of the solve already", tet.value());
    frozen_[tet.index()] = 1;
  }
  history_.push_back(std::move(edit));
}

MeshEdit TornMesh::undo() {
  RHEXIS_CHECK(!history_.empty(), "there is no edit to take back");
  MeshEdit edit = std::move(history_.back());
  history_.pop_back();
  for (const TetId tet : edit.frozen) frozen_[tet.index()] = 0;
  for (const RewiredTet& change : edit.rewired) {
    for (const NodeId node : change.after) erase_sorted(around_[node.index()], change.tet);
    for (const NodeId node : change.before) insert_sorted(around_[node.index()], change.tet);
    mesh_.tets[change.tet.index()] = change.before;
  }
  for (const TetId tet : edit.removed) {
    alive_[tet.index()] = 1;
    for (const NodeId node : mesh_.tet(tet)) insert_sorted(around_[node.index()], tet);
  }
  const std::size_t nodes = mesh_.node_count() - edit.copied.size();
  mesh_.nodes.resize(nodes);
  original_.resize(nodes);
  around_.resize(nodes);
  for (const MovedNode& move : edit.moved) mesh_.nodes[move.node.index()] = move.from;
  return edit;
}

bool is_on_solved_surface(const TornMesh& body, TetFace face) {
  const std::array<NodeId, 3> corner = face_nodes(body.mesh(), face);
  const auto around = body.tets_around(corner[0]);
  return std::none_of(around.begin(), around.end(), [&](TetId other) {
    if (other == face.tet || !body.is_solved(other)) return false;
    const Tet& nodes = body.mesh().tet(other);
    return std::find(nodes.begin(), nodes.end(), corner[1]) != nodes.end() &&
           std::find(nodes.begin(), nodes.end(), corner[2]) != nodes.end();
  });
}

std::vector<TetFace> solved_surface(const TornMesh& body) {
  std::vector<TetFace> out;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    if (!body.is_solved(TetId(t))) continue;
    for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
      if (is_on_solved_surface(body, {TetId(t), vertex})) out.push_back({TetId(t), vertex});
    }
  }
  return out;
}

}  // namespace rhexis::mesh
