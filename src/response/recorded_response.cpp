#include "response/recorded_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

#include "base/check.h"
#include "base/clock.h"
#include "response/recorded_contact.h"

namespace rhexis::response {
namespace {

using record::store::Advanced;

/// Degrees that rounding may put a direction beyond the ends of a record.
constexpr double kAngleRounding = 1e-9;

/// From x of the frame, about z, in [-90, 270): so that what lies behind is nearer to that end of [0, 180] which is.
double angle_in(const record::store::Frame& frame, const Vec3& direction) {
  double angle = std::atan2(direction.dot(frame.y), direction.dot(frame.x)) * 180.0 / std::numbers::pi;
  if (angle < -90.0) angle += 360.0;
  if (std::abs(angle) < kAngleRounding) return 0.0;
  return std::abs(angle - 180.0) < kAngleRounding ? 180.0 : angle;
}

}  // namespace

RecordedResponse::RecordedResponse(const mesh::TornMesh& mesh, SharedRecord record, ElasticBody body,
                                   std::span<const CrackAdvance> advances)
    : mesh_(mesh),
      record_(std::move(record)),
      lookup_(record_->record()),
      model_(std::move(body), mesh.intact_node_count()) {
  RHEXIS_CHECK(record_->head().nodes.size() == 3 * mesh.mesh().node_count(), "{} nodes, {} in the record",
               mesh.mesh().node_count(), record_->head().nodes.size() / 3);
  for (const CrackAdvance& advance : advances) push(&advance);
  look_up();
  energy_at_first_ = energy_at_rest_;
}

void RecordedResponse::push(const CrackAdvance* advance) {
  counts_.push_back(advance != nullptr && advance->crack == 0 && !advance->started && before_first_ == 0);
  if (counts_.back()) advances_.push_back({angle_in(record_->head().frame, advance->direction), advance->length});
}

void RecordedResponse::grasp(std::span<const NodeId> nodes) {
  for (const NodeId node : nodes) {
    RHEXIS_CHECK(node.valid() && node.index() < mesh_.mesh().node_count(), "node {} of {}", node.value(),
                 mesh_.mesh().node_count());
  }
  held_.assign(nodes.begin(), nodes.end());
  solve_held();
}

FollowReport RecordedResponse::follow(const mesh::MeshEdit& edit, std::span<const Focus> /*focus*/,
                                      const CrackAdvance* advance) {
  RHEXIS_CHECK(edit.copied.empty(), "an edit with {} new nodes, which no record has", edit.copied.size());
  const Stopwatch watch;
  push(advance);
  look_up();
  FollowReport report;
  report.update_seconds = watch.seconds();
  return report;
}

void RecordedResponse::go_back(const mesh::MeshEdit& /*edit*/, std::span<const Focus> /*focus*/) {
  if (counts_.empty()) {
    ++before_first_;
  } else {
    if (counts_.back()) advances_.pop_back();
    counts_.pop_back();
  }
  look_up();
}

/// All that depends on the topology.
void RecordedResponse::look_up() {
  const record::store::Nearest nearest = lookup_.nearest(advances_);
  const bool has_others = advances_.size() < counts_.size() || before_first_ > 0;
  outside_ = nearest.outside || has_others;
  use_ = {.topology = nearest.topology, .outside = outside_, .past_last = nearest.past_last};
  const record::store::Numbering numbering(record_->head().parameters);
  constexpr unsigned kNotMade = record::store::opened_nothing | record::store::unstable;
  for (int k = nearest.topology; k > 0; k = numbering.parent(k))
    use_.not_made = use_.not_made || (record_->record().flags[static_cast<std::size_t>(k)] & kNotMade) != 0;
  in_solve_.assign(mesh_.mesh().node_count(), 0);
  for (std::size_t t = 0; t < mesh_.mesh().tet_count(); ++t) {
    if (!mesh_.is_solved(TetId(t))) continue;
    for (const NodeId node : mesh_.mesh().tets[t]) in_solve_[node.index()] = 1;
  }
  find_rest();
  solve_held();
}

/// The same sum as for the force, over the topologies that have the node.
void RecordedResponse::find_rest() {
  const std::size_t nodes = mesh_.mesh().node_count();
  rest_of_all_.setZero(static_cast<Eigen::Index>(3 * nodes));
  energy_at_rest_ = 0.0;
  if (!record_->head().has_loads) return;
  std::vector<double> weights(nodes, 0.0);
  lookup_.each_topology(advances_, [&](int topology, double weight) {
    const Eigen::Map<const VectorX> rest(record_->record().rest.data() + 3 * nodes * static_cast<std::size_t>(topology),
                                         rest_of_all_.size());
    rest_of_all_ += weight * rest;  // zero out of the solve
    for (std::size_t i = 0; i < nodes; ++i)
      weights[i] += record_->is_in_solve(topology, static_cast<std::int32_t>(i)) ? weight : 0.0;
  });
  for (std::size_t i = 0; i < nodes; ++i) {
    if (weights[i] > 0.0) rest_of_all_.segment<3>(static_cast<Eigen::Index>(3 * i)) /= weights[i];
  }
  fill_gaps(use_.topology, rest_of_all_);
  energy_at_rest_ = potential_energy(mesh_, model_, rest_of_all_);
}

/// What is held and the body still has, a topology of the record has too.
bool RecordedResponse::holds_in(int topology) const {
  return std::all_of(held_.begin(), held_.end(), [&](NodeId node) {
    return in_solve_[node.index()] == 0 || record_->is_in_solve(topology, node.value());
  });
}

/// By unit forces on the held nodes: the columns of L_rc, of which those of nodes out of the solve are zero.
Eigen::MatrixXd RecordedResponse::moves_of_held(int topology) const {
  const auto rows = static_cast<Eigen::Index>(3 * mesh_.mesh().node_count());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(3 * held_.size()));
  VectorX force = VectorX::Zero(rows);
  for (Eigen::Index column = 0; column < out.cols(); ++column) {
    const NodeId node = held_[static_cast<std::size_t>(column / 3)];
    if (in_solve_[node.index()] == 0 || !record_->is_in_solve(topology, node.value())) continue;
    const Eigen::Index dof = 3 * Eigen::Index{node.value()} + column % 3;
    force[dof] = 1.0;
    out.col(column) = record_->displacement_by(topology, force);
    force[dof] = 0.0;
  }
  return out;
}

/// Nodes of the body that a topology of the record has not get the mean of their neighbours, from where it has some.
void RecordedResponse::fill_gaps(int topology, Eigen::Ref<Eigen::MatrixXd> of_nodes) const {
  std::vector<NodeId> gaps;
  std::vector<bool> known(mesh_.mesh().node_count(), false);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (in_solve_[i] == 0) {
      of_nodes.middleRows<3>(static_cast<Eigen::Index>(3 * i)).setZero();
    } else if (record_->is_in_solve(topology, static_cast<std::int32_t>(i))) {
      known[i] = true;
    } else {
      gaps.emplace_back(i);
    }
  }
  while (!gaps.empty()) {
    std::vector<NodeId> filled;
    for (const NodeId node : gaps) {
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3, of_nodes.cols());
      int count = 0;
      for (const TetId tet : mesh_.tets_around(node)) {
        if (!mesh_.is_solved(tet)) continue;
        for (const NodeId other : mesh_.mesh().tet(tet)) {
          if (!known[other.index()]) continue;
          sum += of_nodes.middleRows<3>(3 * Eigen::Index{other.value()});
          ++count;
        }
      }
      if (count == 0) continue;
      of_nodes.middleRows<3>(3 * Eigen::Index{node.value()}) = sum / count;
      filled.push_back(node);
    }
    if (filled.empty()) return;  // a part that the record has not at all
    for (const NodeId node : filled) known[node.index()] = true;
    std::erase_if(gaps, [&](NodeId node) { return known[node.index()]; });
  }
}

/// u_c = C f with C between the topologies, and the nearest one takes that displacement: f' = L_cc^-1 u_c, u = L_rc f'.
void RecordedResponse::solve_held() {
  use_.outside = outside_;
  use_.torn_off = false;
  const auto columns = static_cast<Eigen::Index>(3 * held_.size());
  rest_.resize(columns);
  compliance_.setZero(columns, columns);
  for (std::size_t i = 0; i < held_.size(); ++i)
    rest_.segment<3>(static_cast<Eigen::Index>(3 * i)) = rest_of_all_.segment<3>(3 * Eigen::Index{held_[i].value()});

  // Where the nearest has lost what the body still holds, one that has not.
  const record::store::Numbering numbering(record_->head().parameters);
  int topology = use_.topology;
  while (!holds_in(topology) && topology > 0) topology = numbering.parent(topology);
  use_.torn_off = topology != use_.topology;
  moves_ = moves_of_held(topology);
  std::vector<Eigen::Index> free;      // columns that move
  std::vector<Eigen::Index> free_dof;  // of the body
  for (Eigen::Index column = 0; column < columns; ++column) {
    const Eigen::Index dof = 3 * Eigen::Index{held_[static_cast<std::size_t>(column / 3)].value()} + column % 3;
    if (!(moves_(dof, column) > 0.0)) continue;
    free.push_back(column);
    free_dof.push_back(dof);
  }
  const Eigen::MatrixXd L_cc = moves_(free_dof, free);
  const bool is_whole = static_cast<Eigen::Index>(free.size()) == columns;
  if (const auto contact = is_whole ? recorded_contact(*record_, lookup_, advances_, held_) : std::nullopt) {
    compliance_ = contact->compliance;
    use_.torn_off = use_.torn_off || contact->torn_off;
  } else {
    compliance_(free, free) = 0.5 * (L_cc + L_cc.transpose());
    use_.outside = use_.outside || is_whole;
  }
  if (!free.empty())
    moves_ = (moves_(Eigen::all, free) * L_cc.llt().solve(compliance_(free, Eigen::all).eval())).eval();
  fill_gaps(topology, moves_);
  for (std::size_t i = 0; i < held_.size(); ++i)
    moves_.middleRows<3>(3 * Eigen::Index{held_[i].value()}) =
        compliance_.middleRows<3>(static_cast<Eigen::Index>(3 * i));  // but for rounding
}

void RecordedResponse::displacement(std::span<const NodeId> nodes, const VectorX& held_forces, double loads,
                                    VectorX& out) {
  RHEXIS_CHECK(held_forces.size() == rest_.size(), "{} forces on {} held dofs", held_forces.size(), rest_.size());
  out.resize(static_cast<Eigen::Index>(3 * nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Index at = 3 * Eigen::Index{nodes[i].value()};
    out.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        moves_.middleRows<3>(at) * held_forces + loads * rest_of_all_.segment<3>(at);
  }
}

void RecordedResponse::whole_displacement(const VectorX& held_forces, double loads, VectorX& out) {
  RHEXIS_CHECK(held_forces.size() == rest_.size(), "{} forces on {} held dofs", held_forces.size(), rest_.size());
  out = moves_ * held_forces + loads * rest_of_all_;
}

double RecordedResponse::stored_energy(const VectorX& held_forces) {
  RHEXIS_CHECK(held_forces.size() == rest_.size(), "{} forces on {} held dofs", held_forces.size(), rest_.size());
  const double hand = held_forces.size() > 0 ? held_forces.dot(compliance_ * held_forces) : 0.0;
  return 0.5 * hand + energy_at_rest_ - energy_at_first_;
}

std::size_t RecordedResponse::memory_bytes() const {
  return record_->memory_bytes() + in_solve_.size() +
         sizeof(double) * static_cast<std::size_t>(moves_.size() + rest_of_all_.size());
}

}  // namespace rhexis::response
