#include "session/surface_tracker.h"

#include <algorithm>

namespace rhexis::session {
namespace {

constexpr std::int32_t kNone = -1;

std::size_t number_of(mesh::TetFace face) { return 4 * face.tet.index() + static_cast<std::size_t>(face.vertex); }

/// Tets that an edit may have given other faces on the surface: those it names, and all around their nodes.
std::vector<TetId> touched_tets(const mesh::TornMesh& body, const mesh::MeshEdit& edit) {
  std::vector<NodeId> nodes;
  std::vector<TetId> tets = edit.removed;
  for (const TetId tet : edit.removed)
    nodes.insert(nodes.end(), body.mesh().tet(tet).begin(), body.mesh().tet(tet).end());
  for (const mesh::RewiredTet& change : edit.rewired) {
    nodes.insert(nodes.end(), change.before.begin(), change.before.end());
    nodes.insert(nodes.end(), change.after.begin(), change.after.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const NodeId node : nodes) {
    const auto around = body.tets_around(node);
    tets.insert(tets.end(), around.begin(), around.end());
  }
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  return tets;
}

}  // namespace

bool is_on_surface(const mesh::TornMesh& body, mesh::TetFace face) {
  if (!body.is_alive(face.tet)) return false;
  const std::array<NodeId, 3> corner = mesh::face_nodes(body.mesh(), face);
  const auto around = body.tets_around(corner[0]);
  return std::none_of(around.begin(), around.end(), [&](TetId other) {
    if (other == face.tet) return false;
    const mesh::Tet& nodes = body.mesh().tet(other);
    return std::find(nodes.begin(), nodes.end(), corner[1]) != nodes.end() &&
           std::find(nodes.begin(), nodes.end(), corner[2]) != nodes.end();
  });
}

SurfaceTracker::SurfaceTracker(const mesh::TornMesh& body)
    : vertex_(body.mesh().node_count(), kNone), slot_(4 * body.mesh().tet_count(), kNone) {
  std::vector<mesh::TetFace> faces;
  for (std::size_t tet = 0; tet < body.mesh().tet_count(); ++tet) {
    for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
      const mesh::TetFace face{TetId(tet), vertex};
      if (!is_on_surface(body, face)) continue;
      faces.push_back(face);
      for (const NodeId node : mesh::face_nodes(body.mesh(), face)) vertex_[node.index()] = 0;
    }
  }
  for (std::size_t node = 0; node < vertex_.size(); ++node) {
    if (vertex_[node] == kNone) continue;
    vertex_[node] = static_cast<std::int32_t>(node_.size());
    node_.emplace_back(node);
  }
  tet_.resize(faces.size());
  faces_.resize(faces.size());
  for (std::uint32_t slot = 0; slot < faces.size(); ++slot) fill(slot, body, faces[slot]);
}

SurfaceChange SurfaceTracker::follow(const mesh::TornMesh& body, const mesh::MeshEdit& edit) {
  SurfaceChange change;
  change.first_new = static_cast<std::uint32_t>(node_.size());
  vertex_.resize(body.mesh().node_count(), kNone);
  for (const mesh::MovedNode& move : edit.moved) {
    if (const auto vertex = vertex_of(move.node)) change.moved.push_back(*vertex);
  }

  std::vector<mesh::TetFace> appeared;
  std::vector<std::uint32_t> emptied;
  for (const TetId tet : touched_tets(body, edit)) {
    for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
      const mesh::TetFace face{tet, vertex};
      std::int32_t& slot = slot_[number_of(face)];
      if (!is_on_surface(body, face)) {
        if (slot != kNone) emptied.push_back(static_cast<std::uint32_t>(slot));
        slot = kNone;
      } else if (slot == kNone) {
        appeared.push_back(face);
      } else {
        const std::array<std::uint32_t, 3> before = faces_[static_cast<std::size_t>(slot)];
        fill(static_cast<std::uint32_t>(slot), body, face);
        if (faces_[static_cast<std::size_t>(slot)] != before) change.filled.push_back(static_cast<std::uint32_t>(slot));
      }
    }
  }
  for (const std::uint32_t slot : emptied) {
    tet_[slot] = {};
    faces_[slot] = {};
    free_.push_back(slot);
  }
  for (const mesh::TetFace& face : appeared) {
    std::uint32_t slot = static_cast<std::uint32_t>(faces_.size());
    if (free_.empty()) {
      tet_.emplace_back();
      faces_.emplace_back();
    } else {
      slot = free_.back();
      free_.pop_back();
    }
    fill(slot, body, face);
    change.filled.push_back(slot);
  }
  for (const std::uint32_t slot : emptied) {
    if (is_empty(slot)) change.gone.push_back(slot);
  }
  return change;
}

std::optional<std::uint32_t> SurfaceTracker::slot_of(mesh::TetFace face) const {
  const std::int32_t slot = slot_[number_of(face)];
  return slot == kNone ? std::nullopt : std::optional(static_cast<std::uint32_t>(slot));
}

std::optional<std::uint32_t> SurfaceTracker::vertex_of(NodeId node) const {
  const std::int32_t vertex = vertex_[node.index()];
  return vertex == kNone ? std::nullopt : std::optional(static_cast<std::uint32_t>(vertex));
}

void SurfaceTracker::add_slots_of(std::span<const TetId> tets, std::vector<std::uint32_t>& slots) const {
  for (const TetId tet : tets) {
    for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
      if (const auto slot = slot_of({tet, vertex})) slots.push_back(*slot);
    }
  }
}

std::uint32_t SurfaceTracker::vertex_for(NodeId node) {
  std::int32_t& vertex = vertex_[node.index()];
  if (vertex == kNone) {
    vertex = static_cast<std::int32_t>(node_.size());
    node_.push_back(node);
  }
  return static_cast<std::uint32_t>(vertex);
}

void SurfaceTracker::fill(std::uint32_t slot, const mesh::TornMesh& body, mesh::TetFace face) {
  tet_[slot] = face;
  slot_[number_of(face)] = static_cast<std::int32_t>(slot);
  const std::array<NodeId, 3> corner = mesh::face_nodes(body.mesh(), face);
  for (std::size_t k = 0; k < 3; ++k) faces_[slot][k] = vertex_for(corner[k]);
}

}  // namespace rhexis::session
