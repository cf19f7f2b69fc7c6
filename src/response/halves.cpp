#include "response/halves.h"

#include <algorithm>
#include <utility>

namespace rhexis::response {
namespace {

using linalg::ElementChange;
using linalg::FrontOutcome;
using linalg::FrontTree;
using Side = ElasticElements::Side;

void sort_unique(std::vector<TetId>& tets) {
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
}

std::vector<std::int32_t> numbers(const std::vector<TetId>& tets) {
  std::vector<std::int32_t> out;
  out.reserve(tets.size());
  for (const TetId tet : tets) out.push_back(tet.value());
  return out;
}

/// That there are fewer nodes than a tree knows it sees for itself.
std::vector<std::int32_t> copied_since(std::vector<std::int32_t> copied, const Followed& what) {
  copied.resize(copied.size() - std::min(copied.size(), what.dropped));
  copied.insert(copied.end(), what.copied.begin(), what.copied.end());
  return copied;
}

}  // namespace

bool Halves::is_stable() const {
  return outside->outcome() == FrontOutcome::ok && (!inside || inside->outcome() == FrontOutcome::ok);
}

void Followed::touch(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit) {
  touched.insert(touched.end(), edit.removed.begin(), edit.removed.end());
  touched.insert(touched.end(), edit.frozen.begin(), edit.frozen.end());
  for (const mesh::RewiredTet& change : edit.rewired) touched.push_back(change.tet);
  for (const mesh::MovedNode& moved : edit.moved) {
    const auto around = mesh.tets_around(moved.node);
    std::copy_if(around.begin(), around.end(), std::back_inserter(touched),
                 [&](TetId tet) { return mesh.is_solved(tet); });
  }
  sort_unique(touched);
}

void Followed::add(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit) {
  for (const NodeId parent : edit.copied) copied.push_back(parent.value());
  touch(mesh, edit);
}

void Followed::take_back(const mesh::TornMesh& mesh, const mesh::MeshEdit& edit) {
  dropped += edit.copied.size();
  touch(mesh, edit);
}

bool is_inside(const mesh::TornMesh& mesh, const Window& window, const Followed& what) {
  const auto is_beyond = [&](NodeId node) {
    const auto around = mesh.tets_around(node);
    return !window.is_on_rim(node) && std::any_of(around.begin(), around.end(),
                                                  [&](TetId tet) { return mesh.is_solved(tet) && !window.holds(tet); });
  };
  return std::all_of(what.touched.begin(), what.touched.end(), [&](TetId tet) {
    if (!window.holds(tet)) return false;
    const mesh::Tet& corners = mesh.mesh().tet(tet);
    return !mesh.is_solved(tet) || std::none_of(corners.begin(), corners.end(), is_beyond);
  });
}

Halves make_halves(const mesh::TornMesh& mesh, const ElasticModel& model) {
  Halves out;
  out.window = std::make_shared<const Window>();
  out.outside = FrontTree::make(ElasticElements(mesh, model, *out.window, Side::outside), {});
  return out;
}

Halves follow_inside(const mesh::TornMesh& mesh, const ElasticModel& model, const Halves& before,
                     const Followed& what) {
  Halves out = before;
  out.copied = copied_since(before.copied, what);
  const ElementChange change{what.copied, numbers(what.touched), before.window->rim()};
  out.inside = before.inside->updated(ElasticElements(mesh, model, *before.window, Side::inside), change);
  return out;
}

Halves move_window(const mesh::TornMesh& mesh, const ElasticModel& model, const Halves& before,
                   std::shared_ptr<const Window> window, const Followed& what) {
  std::vector<TetId> touched;
  for (const TetId tet : what.touched) {
    if (!before.window->holds(tet) || !window->holds(tet)) touched.push_back(tet);
  }
  // Of the others, those that change sides.
  for (const TetId tet : before.window->tets()) {
    if (!window->holds(tet)) touched.push_back(tet);
  }
  for (const TetId tet : window->tets()) {
    if (!before.window->holds(tet)) touched.push_back(tet);
  }
  sort_unique(touched);

  Halves out;
  out.window = std::move(window);
  out.outside = before.outside->updated(ElasticElements(mesh, model, *out.window, Side::outside),
                                        {copied_since(before.copied, what), numbers(touched), out.window->rim()});
  if (!out.window->is_empty()) {
    out.inside = FrontTree::make(ElasticElements(mesh, model, *out.window, Side::inside), out.window->rim());
  }
  return out;
}

}  // namespace rhexis::response
