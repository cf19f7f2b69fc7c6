#include "response/window.h"

#include <algorithm>
#include <cmath>

namespace rhexis::response {
namespace {

Vec3 centroid(const mesh::TetMesh& mesh, TetId tet) {
  const auto x = mesh::corners(mesh, tet);
  return 0.25 * (x[0] + x[1] + x[2] + x[3]);
}

}  // namespace

double Window::Capsule::distance(const Vec3& x) const {
  const Vec3 along = to - from;
  const double length = along.squaredNorm();
  const double t = length > 0.0 ? std::clamp((x - from).dot(along) / length, 0.0, 1.0) : 0.0;
  return (x - from - t * along).norm();
}

Window::Window(const mesh::TornMesh& body, std::span<const Focus> focus, const WindowShape& shape) : edit_(shape.edit) {
  for (const Focus& each : focus) {
    const double side = std::hypot(shape.side * each.radius, each.half_length);
    capsules_.push_back({each.centre - shape.behind * each.radius * each.direction,
                         each.centre + shape.ahead * each.radius * each.direction, side, each.centre});
  }
  const mesh::TetMesh& mesh = body.mesh();
  holds_.assign(mesh.tet_count(), 0);
  std::size_t solved = 0;
  std::size_t solved_inside = 0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const TetId tet(t);
    if (body.is_solved(tet)) ++solved;
    const Vec3 at = centroid(mesh, tet);
    if (std::none_of(capsules_.begin(), capsules_.end(), [&](const Capsule& c) { return c.distance(at) <= c.radius; }))
      continue;
    holds_[t] = 1;
    tets_.push_back(tet);
    if (body.is_solved(tet)) ++solved_inside;
  }
  if (solved_inside == 0 || static_cast<double>(solved_inside) > shape.largest_part * static_cast<double>(solved)) {
    tets_.clear();
    capsules_.clear();
    holds_.clear();
    return;
  }

  std::vector<std::uint8_t> inside(mesh.node_count(), 0);
  on_rim_.assign(mesh.node_count(), 0);
  // Tets out of the solve count: they come back when an edit is taken back.
  for (const TetId tet : tets_) {
    for (const NodeId node : mesh.tet(tet)) inside[node.index()] = 1;
  }
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    if (holds_[t] != 0 || !body.is_solved(TetId(t))) continue;
    for (const NodeId node : mesh.tets[t]) on_rim_[node.index()] = inside[node.index()];
  }
  for (std::size_t node = 0; node < on_rim_.size(); ++node) {
    if (on_rim_[node] != 0) rim_.push_back(static_cast<std::int32_t>(node));
  }
}

const Window::Capsule* Window::capsule_of(const Focus& focus) const {
  const double reach = std::hypot(edit_ * focus.radius, focus.half_length);
  const auto found = std::find_if(capsules_.begin(), capsules_.end(),
                                  [&](const Capsule& c) { return c.distance(focus.centre) + reach <= c.radius; });
  return found == capsules_.end() ? nullptr : &*found;
}

bool Window::has_room(const Focus& focus) const { return is_empty() || capsule_of(focus) != nullptr; }

bool Window::is_half_way(const Focus& focus) const {
  if (is_empty()) return false;
  const Capsule* capsule = capsule_of(focus);
  if (capsule == nullptr) return true;
  return (focus.centre - capsule->front).norm() > 0.5 * (capsule->to - capsule->front).norm();
}

std::size_t Window::memory_bytes() const {
  return holds_.capacity() + on_rim_.capacity() + sizeof(TetId) * tets_.capacity() +
         sizeof(std::int32_t) * rim_.capacity();
}

}  // namespace rhexis::response
