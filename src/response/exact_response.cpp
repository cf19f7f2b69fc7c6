#include "response/exact_response.h"

#include <algorithm>
#include <utility>

#include "base/background.h"
#include "base/check.h"
#include "base/clock.h"
#include "response/corridor.h"
#include "response/followed.h"

namespace rhexis::response {

/// A new factor, made beside the caller from a copy of the mesh, since the caller edits his.
struct ExactResponse::Preparation {
  explicit Preparation(const mesh::TornMesh& mesh) : mirror(mesh) {}

  mesh::TornMesh mirror;              ///< as the mesh was when the work began, while it is under way; else as it is
  std::vector<mesh::MeshEdit> edits;  ///< since the work began
  double spent_flops = 0.0;           ///< by the caller since the work began
  Tree made;
  BackgroundTask task;

  void follow(const mesh::MeshEdit& edit) {
    if (task.under_way()) {
      edits.push_back(edit);
    } else {
      mirror.apply(edit);
    }
  }

  /// Waits, and brings the mirror to the present.
  Tree finish() {
    task.wait();
    for (mesh::MeshEdit& edit : edits) mirror.apply(std::move(edit));
    edits.clear();
    return std::exchange(made, nullptr);
  }
};

ExactResponse::ExactResponse(const mesh::TornMesh& mesh, ExactSettings settings)
    : mesh_(mesh), settings_(std::move(settings)), model_(settings_.body, mesh.intact_node_count()) {}

ExactResponse::~ExactResponse() = default;

std::unique_ptr<ExactResponse> ExactResponse::make(const mesh::TornMesh& mesh, ExactSettings settings,
                                                   std::span<const Focus> focus) {
  std::unique_ptr<ExactResponse> out(new ExactResponse(mesh, std::move(settings)));
  Tree tree = linalg::FrontTree::make(ElasticElements(mesh, out->model_), {}, separator_weights(mesh, focus),
                                      nodes_ahead(mesh, focus));
  out->whole_flops_ = tree->flops_made();
  if (!out->adopt(std::move(tree))) return nullptr;
  out->energy_at_first_ = out->potential_energy({});
  if (out->settings_.in_background && out->whole_flops_ >= out->settings_.fewest_flops)
    out->preparation_ = std::make_unique<Preparation>(mesh);
  return out;
}

void ExactResponse::grasp(std::span<const NodeId> nodes) {
  for (const NodeId node : nodes) {
    RHEXIS_CHECK(node.valid() && node.index() < mesh_.mesh().node_count(), "node {} of {}", node.value(),
                 mesh_.mesh().node_count());
  }
  held_.assign(nodes.begin(), nodes.end());
  solve_held();
}

FollowReport ExactResponse::follow(const mesh::MeshEdit& edit, std::span<const Focus> focus,
                                   const CrackAdvance* /*advance*/) {
  const Stopwatch watch;
  FollowReport report;
  Tree next = take_up(edit, focus, report);
  if (!next) {
    linalg::ElementChange change;
    change.next = nodes_ahead(mesh_, focus);
    add_applied(mesh_, edit, change);
    next = tree_->updated(ElasticElements(mesh_, model_), change);
  }
  const double flops = next->flops_made();
  report.ok = adopt(std::move(next));
  if (report.ok) {
    spent_flops_ = (report.refreshed ? 0.0 : spent_flops_) + flops;
    if (preparation_) {
      preparation_->follow(edit);
      preparation_->spent_flops += flops;
      prepare(focus);
    }
  }
  report.update_seconds = watch.seconds();
  return report;
}

void ExactResponse::go_back(const mesh::MeshEdit& edit, std::span<const Focus> focus) {
  if (preparation_) {
    preparation_->finish();
    preparation_->mirror.undo();
  }
  linalg::ElementChange change;
  change.next = nodes_ahead(mesh_, focus);
  add_taken_back(mesh_, edit, change);
  const bool stable = adopt(tree_->updated(ElasticElements(mesh_, model_), change));
  RHEXIS_CHECK(stable, "the body before the edit was stable");
}

/// The factor that was made in the background, with the edits since. It is due when the caller has done as many
/// operations in the meantime: by then it is ready, mostly.
ExactResponse::Tree ExactResponse::take_up(const mesh::MeshEdit& edit, std::span<const Focus> focus,
                                           FollowReport& report) {
  if (!preparation_ || !preparation_->task.under_way() ||
      preparation_->spent_flops < settings_.refresh_after * whole_flops_)
    return nullptr;
  linalg::ElementChange since;
  since.next = nodes_ahead(mesh_, focus);
  for (const mesh::MeshEdit& each : preparation_->edits) add_applied(mesh_, each, since);
  add_applied(mesh_, edit, since);
  Tree made;
  {
    const ScopedTimer timer(report.wait_seconds);
    made = preparation_->finish();
  }
  if (made->outcome() != linalg::FrontOutcome::ok) return nullptr;
  report.refreshed = true;
  return made->updated(ElasticElements(mesh_, model_), since);
}

void ExactResponse::prepare(std::span<const Focus> focus) {
  if (preparation_->task.under_way() || focus.empty()) return;
  if (spent_flops_ < settings_.refresh_after * whole_flops_) return;
  preparation_->spent_flops = 0.0;
  preparation_->task.start([this, where = std::vector<Focus>(focus.begin(), focus.end())] {
    const mesh::TornMesh& mirror = preparation_->mirror;
    preparation_->made = linalg::FrontTree::make(ElasticElements(mirror, model_), {}, separator_weights(mirror, where),
                                                 nodes_ahead(mirror, where));
  });
}

/// False, and nothing changes, when the body has a free motion.
bool ExactResponse::adopt(Tree next) {
  if (next->outcome() != linalg::FrontOutcome::ok) return false;
  tree_ = std::move(next);
  solve_held();
  return true;
}

/// L_cc = y^T y of the forward solutions L y = e of unit forces, and u_c by the loads = y^T (that of the loads).
void ExactResponse::solve_held() {
  const auto columns = static_cast<Eigen::Index>(3 * held_.size());
  VectorX given = VectorX::Zero(columns);
  std::vector<std::int32_t> dof;
  std::vector<Eigen::Index> column_of;
  for (Eigen::Index column = 0; column < columns; ++column) {
    const NodeId node = held_[static_cast<std::size_t>(column / 3)];
    const auto component = static_cast<std::int32_t>(column % 3);
    if (!mesh_.is_solved(node)) continue;
    if (model_.held[3 * mesh_.original(node).index() + static_cast<std::size_t>(component)] != 0) {
      given[column] = prescribed(node)[component];
    } else {
      dof.push_back(3 * node.value() + component);
      column_of.push_back(column);
    }
  }
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(dof.size()), columns);
  for (std::size_t i = 0; i < dof.size(); ++i) rows(static_cast<Eigen::Index>(i), column_of[i]) = 1.0;
  forward_ = tree_->forward(dof, rows);
  compliance_ = forward_.gram;
  rest_ = forward_.with_load + given;
}

Vec3 ExactResponse::prescribed(NodeId node) const {
  return model_.value.segment<3>(3 * Eigen::Index{mesh_.original(node).value()});
}

void ExactResponse::check_forces(const VectorX& held_forces) const {
  RHEXIS_CHECK(held_forces.size() == rest_.size(), "{} forces on {} held dofs", held_forces.size(), rest_.size());
}

/// y . y = 0: no load, and no support that moves.
bool ExactResponse::is_pushed(const VectorX& held_forces, double loads) const {
  return !held_forces.isZero(0.0) || (loads != 0.0 && tree_->load_energy() > 0.0);
}

void ExactResponse::displacement(std::span<const NodeId> nodes, const VectorX& held_forces, double loads,
                                 VectorX& out) {
  check_forces(held_forces);
  std::vector<std::int32_t> some;
  for (const NodeId node : nodes) {
    if (mesh_.is_solved(node)) some.push_back(node.value());
  }
  const bool pushed = is_pushed(held_forces, loads);
  if (pushed) tree_->backward_at(some, {}, &forward_, held_forces, loads, x_);
  out.setZero(static_cast<Eigen::Index>(3 * nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!mesh_.is_solved(nodes[i])) continue;
    auto u = out.segment<3>(static_cast<Eigen::Index>(3 * i));
    u = loads * prescribed(nodes[i]);  // which the tree leaves at zero
    if (pushed) u += x_.segment<3>(3 * Eigen::Index{nodes[i].value()});
  }
}

void ExactResponse::whole_displacement(const VectorX& held_forces, double loads, VectorX& out) {
  check_forces(held_forces);
  if (is_pushed(held_forces, loads)) {
    tree_->backward({}, &forward_, held_forces, loads, out);
  } else {
    out.setZero(3 * static_cast<Eigen::Index>(mesh_.mesh().node_count()));
  }
  for (std::size_t i = 0; i < mesh_.mesh().node_count() && model_.moves_supports; ++i) {
    const NodeId node(i);
    if (mesh_.is_solved(node)) out.segment<3>(static_cast<Eigen::Index>(3 * i)) += loads * prescribed(node);
  }
}

/// With b what the loads leave to the free dofs and P the held nodes: u = K^-1 (b + P a), and
/// 1/2 u K u - b u = 1/2 a L_cc a - 1/2 b K^-1 b, where b K^-1 b is the square of the loads' forward solution.
double ExactResponse::potential_energy(const VectorX& held_forces) const {
  const double hand = held_forces.size() > 0 ? held_forces.dot(compliance_ * held_forces) : 0.0;
  return 0.5 * (hand - tree_->load_energy()) + support_energy(mesh_, model_);
}

double ExactResponse::stored_energy(const VectorX& held_forces) {
  check_forces(held_forces);
  return potential_energy(held_forces) - energy_at_first_;
}

std::size_t ExactResponse::memory_bytes() const {
  std::size_t doubles = static_cast<std::size_t>(x_.size());
  for (const Eigen::MatrixXd& y : forward_.y) doubles += static_cast<std::size_t>(y.size());
  return tree_->memory_bytes() + sizeof(double) * doubles;
}

}  // namespace rhexis::response
