#include "response/exact_response.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/clock.h"

namespace rhexis::response {
namespace {

/// What a force has beyond the directions that are known, below this part of it, is rounding.
constexpr double kSameDirection = 1e-14;

const linalg::FrontTree::Forward* known(const linalg::FrontTree::Forward& forward) {
  return forward.gram.cols() > 0 ? &forward : nullptr;
}

}  // namespace

/// The next window, made beside the caller from a copy of the mesh, since the caller edits his.
struct ExactResponse::Preparation {
  explicit Preparation(const mesh::TornMesh& mesh) : mirror(mesh) {}

  mesh::TornMesh mirror;              ///< as the mesh was when the work began, while it is under way; else as it is
  std::vector<mesh::MeshEdit> edits;  ///< since the work began
  Halves made;
  BackgroundTask task;

  void follow(const mesh::MeshEdit& edit) {
    if (task.under_way()) {
      edits.push_back(edit);
    } else {
      mirror.apply(edit);
    }
  }

  /// Waits, and brings the mirror to the present.
  Halves finish() {
    task.wait();
    for (mesh::MeshEdit& edit : edits) mirror.apply(std::move(edit));
    edits.clear();
    return std::exchange(made, {});
  }
};

ExactResponse::ExactResponse(const mesh::TornMesh& mesh, ExactSettings settings)
    : mesh_(mesh), settings_(std::move(settings)), model_(settings_.body, mesh.intact_node_count()) {}

ExactResponse::~ExactResponse() = default;

std::unique_ptr<ExactResponse> ExactResponse::make(const mesh::TornMesh& mesh, ExactSettings settings,
                                                   std::span<const Focus> focus) {
  std::unique_ptr<ExactResponse> out(new ExactResponse(mesh, std::move(settings)));
  Halves halves = make_halves(mesh, out->model_);
  out->whole_flops_ = halves.outside->flops_made();
  const auto window = std::make_shared<const Window>(out->place_window(focus, mesh));
  if (!window->is_empty() && halves.is_stable()) halves = move_window(mesh, out->model_, halves, window, {});
  if (!out->adopt(std::move(halves))) return nullptr;
  out->energy_at_first_ = out->potential_energy({});
  if (out->settings_.in_background && out->whole_flops_ >= out->settings_.window.fewest_flops)
    out->preparation_ = std::make_unique<Preparation>(mesh);
  return out;
}

void ExactResponse::grasp(std::span<const NodeId> nodes) {
  for (const NodeId node : nodes) {
    RHEXIS_CHECK(node.valid() && node.index() < mesh_.mesh().node_count(), "node {} of {}", node.value(),
                 mesh_.mesh().node_count());
  }
  held_ = solve_held_nodes(mesh_, model_, halves_, rim_, {nodes.begin(), nodes.end()}, held_);
  known_.any = false;
}

Window ExactResponse::place_window(std::span<const Focus> focus, const mesh::TornMesh& mesh) const {
  return whole_flops_ < settings_.window.fewest_flops ? Window() : Window(mesh, focus, settings_.window);
}

FollowReport ExactResponse::follow(const mesh::MeshEdit& edit, std::span<const Focus> focus) {
  const Stopwatch watch;
  Followed what;
  what.add(mesh_, edit);
  FollowReport report;
  Halves next;
  if (!take_up(edit, focus, next, report)) report.refreshed = make_next(what, focus, next);
  report.ok = adopt(std::move(next));
  if (report.ok && preparation_) {
    preparation_->follow(edit);
    prepare(focus);
  }
  report.held = held_.in_solve;
  report.update_seconds = watch.seconds();
  return report;
}

FollowReport ExactResponse::go_back(const mesh::MeshEdit& edit, std::span<const Focus> focus) {
  const Stopwatch watch;
  FollowReport report;
  if (preparation_) {
    const ScopedTimer timer(report.wait_seconds);
    preparation_->finish();
    preparation_->mirror.undo();
  }
  Followed what;
  what.take_back(mesh_, edit);
  Halves next;
  report.refreshed = make_next(what, focus, next);
  report.ok = adopt(std::move(next));
  RHEXIS_CHECK(report.ok, "the body before the edit was stable");
  report.held = held_.in_solve;
  report.update_seconds = watch.seconds();
  return report;
}

/// True when the window moved.
bool ExactResponse::make_next(const Followed& what, std::span<const Focus> focus, Halves& next) const {
  const Window& present = *halves_.window;
  const bool has_room =
      std::all_of(focus.begin(), focus.end(), [&](const Focus& each) { return present.has_room(each); });
  if (!present.is_empty() && has_room && is_inside(mesh_, present, what)) {
    next = follow_inside(mesh_, model_, halves_, what);
    return false;
  }
  auto window = std::make_shared<const Window>(place_window(focus, mesh_));
  const bool moved = !window->is_empty() || !present.is_empty();
  next = move_window(mesh_, model_, halves_, std::move(window), what);
  return moved;
}

/// The window that was made in the background, when it is due, or earlier when the present one will not do.
bool ExactResponse::take_up(const mesh::MeshEdit& edit, std::span<const Focus> focus, Halves& next,
                            FollowReport& report) {
  if (!preparation_ || !preparation_->task.under_way()) return false;
  Followed since;
  for (const mesh::MeshEdit& each : preparation_->edits) since.add(mesh_, each);
  const bool is_due = static_cast<int>(preparation_->edits.size()) + 1 >= settings_.take_up_after;
  Followed now;
  now.add(mesh_, edit);
  const auto holds = [&](const Window& window, const Followed& what) {
    return is_inside(mesh_, window, what) &&
           std::all_of(focus.begin(), focus.end(), [&](const Focus& each) { return window.has_room(each); });
  };
  if (!is_due && holds(*halves_.window, now)) return false;
  since.add(mesh_, edit);
  Halves made;
  {
    const ScopedTimer timer(report.wait_seconds);
    made = preparation_->finish();
  }
  if (made.window->is_empty() || !holds(*made.window, since)) return false;
  next = follow_inside(mesh_, model_, made, since);
  report.refreshed = true;
  return true;
}

void ExactResponse::prepare(std::span<const Focus> focus) {
  const bool is_half_way =
      std::any_of(focus.begin(), focus.end(), [&](const Focus& each) { return halves_.window->is_half_way(each); });
  if (preparation_->task.under_way() || !is_half_way) return;
  const auto work = [this, before = halves_, where = std::vector<Focus>(focus.begin(), focus.end())] {
    const mesh::TornMesh& mirror = preparation_->mirror;
    auto window = std::make_shared<const Window>(place_window(where, mirror));
    preparation_->made = move_window(mirror, model_, before, std::move(window), {});
  };
  preparation_->task.start(work);
}

/// False, and nothing changes, when the body has a free motion.
bool ExactResponse::adopt(Halves next) {
  if (!next.is_stable()) return false;
  if (!next_rim_.factor(*next.outside, next.inside.get())) return false;
  halves_ = std::move(next);
  std::swap(rim_, next_rim_);
  held_ = solve_held_nodes(mesh_, model_, halves_, rim_, held_.nodes, held_);
  known_.any = false;
  return true;
}

VectorX ExactResponse::solve_rim(const VectorX& held_forces, double loads) const {
  VectorX x = loads * rim_.load();
  x.noalias() += held_.at_rim * held_forces;
  rim_.backward(x);
  return x;
}

bool ExactResponse::is_solved_inside(NodeId node) const {
  const auto around = mesh_.tets_around(node);
  return std::any_of(around.begin(), around.end(),
                     [&](TetId tet) { return mesh_.is_solved(tet) && halves_.window->holds(tet); });
}

bool ExactResponse::is_in_solve(NodeId node) const {
  const auto around = mesh_.tets_around(node);
  return std::any_of(around.begin(), around.end(), [&](TetId tet) { return mesh_.is_solved(tet); });
}

/// Without what is prescribed, which the trees leave at zero.
void ExactResponse::solve_at(std::span<const NodeId> nodes, const VectorX& held_forces, double loads, VectorX& out) {
  const VectorX x_rim = solve_rim(held_forces, loads);
  std::vector<std::int32_t> inside;
  std::vector<std::int32_t> outside;
  for (const NodeId node : nodes) {
    if (is_in_solve(node)) (is_solved_inside(node) ? inside : outside).push_back(node.value());
  }
  if (!inside.empty()) {
    halves_.inside->backward_at(inside, rim_.at_inside(x_rim), known(held_.inside), held_forces, loads, x_inside_);
  }
  if (!outside.empty()) {
    halves_.outside->backward_at(outside, rim_.at_outside(x_rim), known(held_.outside), held_forces, loads, x_outside_);
  }
  out.setZero(static_cast<Eigen::Index>(3 * nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!is_in_solve(nodes[i])) continue;
    const VectorX& x = is_solved_inside(nodes[i]) ? x_inside_ : x_outside_;
    out.segment<3>(static_cast<Eigen::Index>(3 * i)) = x.segment<3>(3 * Eigen::Index{nodes[i].value()});
  }
}

void ExactResponse::displacement(std::span<const NodeId> nodes, const VectorX& held_forces, VectorX& out) {
  RHEXIS_CHECK(held_forces.size() == held_.rest.size(), "{} forces on {} held dofs", held_forces.size(),
               held_.rest.size());
  const auto dofs = static_cast<Eigen::Index>(3 * nodes.size());
  if (!known_.any || !std::equal(nodes.begin(), nodes.end(), known_.nodes.begin(), known_.nodes.end())) {
    known_.nodes.assign(nodes.begin(), nodes.end());
    known_.force.resize(held_forces.size(), 0);
    known_.moved.resize(dofs, 0);
    solve_at(nodes, VectorX::Zero(held_forces.size()), 1.0, known_.rest);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (is_in_solve(nodes[i])) known_.rest.segment<3>(static_cast<Eigen::Index>(3 * i)) += prescribed(nodes[i]);
    }
    known_.any = true;
  }
  out = known_.rest;
  VectorX left = held_forces;
  const auto use = [&](Eigen::Index column, double part) {
    left -= part * known_.force.col(column);
    out += part * known_.moved.col(column);
  };
  for (Eigen::Index column = 0; column < known_.force.cols(); ++column) use(column, known_.force.col(column).dot(left));
  // What is left by rounding alone is no new direction: it would only be noise.
  if (!(left.norm() > kSameDirection * held_forces.norm())) return;
  VectorX moved;
  const VectorX direction = left.normalized();
  solve_at(nodes, direction, 0.0, moved);
  const Eigen::Index column = known_.force.cols();
  known_.force.conservativeResize(Eigen::NoChange, column + 1);
  known_.moved.conservativeResize(Eigen::NoChange, column + 1);
  known_.force.col(column) = direction;
  known_.moved.col(column) = moved;
  use(column, left.norm());
}

void ExactResponse::whole_displacement(const VectorX& held_forces, VectorX& out) {
  RHEXIS_CHECK(held_forces.size() == held_.rest.size(), "{} forces on {} held dofs", held_forces.size(),
               held_.rest.size());
  const VectorX x_rim = solve_rim(held_forces, 1.0);
  halves_.outside->backward(rim_.at_outside(x_rim), known(held_.outside), held_forces, 1.0, x_outside_);
  if (halves_.inside) {
    halves_.inside->backward(rim_.at_inside(x_rim), known(held_.inside), held_forces, 1.0, x_inside_);
  }
  out.setZero(static_cast<Eigen::Index>(3 * mesh_.mesh().node_count()));
  for (std::size_t i = 0; i < mesh_.mesh().node_count(); ++i) {
    const NodeId node(i);
    if (!is_in_solve(node)) continue;
    const auto at = static_cast<Eigen::Index>(3 * i);
    out.segment<3>(at) = (is_solved_inside(node) ? x_inside_ : x_outside_).segment<3>(at) + prescribed(node);
  }
}

Vec3 ExactResponse::prescribed(NodeId node) const {
  return model_.value.segment<3>(3 * Eigen::Index{mesh_.original(node).value()});
}

/// With b what the loads leave to the free dofs and P the held nodes: u = K^-1 (b + P a), and
/// 1/2 u K u - b u = 1/2 a L_cc a - 1/2 b K^-1 b, where b K^-1 b is the square of the loads' forward solution.
double ExactResponse::potential_energy(const VectorX& held_forces) const {
  double loads = halves_.outside->load_energy() + rim_.load().squaredNorm();
  if (halves_.inside) loads += halves_.inside->load_energy();
  const double hand = held_forces.size() > 0 ? held_forces.dot(held_.compliance * held_forces) : 0.0;
  return 0.5 * (hand - loads) + support_energy(mesh_, model_);
}

double ExactResponse::stored_energy(const VectorX& held_forces) {
  return potential_energy(held_forces) - energy_at_first_;
}

std::size_t ExactResponse::memory_bytes() const {
  std::size_t bytes =
      halves_.outside->memory_bytes() + rim_.memory_bytes() + next_rim_.memory_bytes() + halves_.window->memory_bytes();
  if (halves_.inside) bytes += halves_.inside->memory_bytes();
  for (const linalg::FrontTree::Forward* forward : {&held_.outside, &held_.inside}) {
    for (const Eigen::MatrixXd& y : forward->y) bytes += sizeof(double) * static_cast<std::size_t>(y.size());
  }
  return bytes + sizeof(double) * static_cast<std::size_t>(x_inside_.size() + x_outside_.size() + known_.moved.size());
}

}  // namespace rhexis::response
