#include "session/tear_session.h"

#include <algorithm>

#include "base/check.h"
#include "response/exact_response.h"
#include "response/live_response.h"
#include "response/recorded_response.h"

namespace rhexis::session {
namespace {

/// Of the local object where the scene gives none, in mean edge lengths.
constexpr double kLocalRadius = 4.0;

std::vector<std::int32_t> held_dofs(const std::vector<model::PrescribedDof>& supports) {
  std::vector<std::int32_t> dofs;
  for (const model::PrescribedDof& support : supports) dofs.push_back(support.dof);
  return dofs;
}

}  // namespace

TearSession::TearSession(const mesh::TetMesh& mesh, TearSettings settings)
    : settings_(std::move(settings)),
      torn_(mesh, held_dofs(settings_.body.supports), settings_.incision),
      hand_(settings_.contact) {
  // A toughness reads a ring around the front, which a smaller local object would cut off.
  if (settings_.local_radius <= 0.0 || settings_.toughness)
    settings_.local_radius = std::max(settings_.local_radius, kLocalRadius * mean_edge());
  if (settings_.criterion.empty())
    settings_.criterion = torn_.surroundings().is_plate() ? "maximum-principal" : "maximum-hoop";
  body_force_ = settings_.body.density * settings_.body.gravity;
  const VectorX& force = settings_.body.dead_force;
  if (force.size() > 0 && !force.isZero(0.0)) {
    node_force_.resize(mesh.node_count());
    for (std::size_t node = 0; node < node_force_.size(); ++node)
      node_force_[node] = force.segment<3>(3 * static_cast<Eigen::Index>(node));
  }
}

Expected<std::unique_ptr<TearSession>> TearSession::make(const mesh::TetMesh& mesh, TearSettings settings,
                                                         const std::vector<scene::CrackSettings>& cracks) {
  std::unique_ptr<TearSession> session(new TearSession(mesh, std::move(settings)));
  const TearSettings& all = session->settings_;
  // Where energy decides whether, any positive strength serves to ask for the direction.
  Expected<std::unique_ptr<fracture::Criterion>> criterion =
      fracture::make_criterion(all.criterion, {.strength = all.strength.value_or(1.0),
                                               .advance_threshold = all.strength ? all.advance_threshold : 1.0,
                                               .ahead_only = all.ahead_only,
                                               .mean_edge = session->mean_edge()});
  if (!criterion) return fail(std::move(criterion.error()));
  session->criterion_ = std::move(*criterion);
  if (all.toughness && cracks.empty())
    return fail("a toughness says when a crack runs on, not where one starts", "add a [[crack]], or give a strength");
  for (const scene::CrackSettings& crack : cracks)
    if (Expected<void> done = session->open(crack); !done) return fail(std::move(done.error()));

  if (all.large_strain) {
    Expected<std::unique_ptr<response::LiveResponse>> live =
        response::LiveResponse::make(session->body(), {.body = {all.body, *all.large_strain, all.pressures},
                                                       .live = all.live,
                                                       .frames = all.frames,
                                                       .solver = all.solver,
                                                       .dynamics = all.dynamics});
    if (!live) return fail(std::move(live.error()));
    session->response_ = std::move(*live);
  } else {
    session->response_ = session->make_response(all.record);
  }
  if (!session->response_)
    return fail("the cracked body is not stable: a part of it can move freely", "hold it by another [[support]]");
  session->make_local_objects();
  return session;
}

std::unique_ptr<response::Response> TearSession::make_response(const response::SharedRecord& record) const {
  if (record) return std::make_unique<response::RecordedResponse>(body(), record, settings_.body, made_);
  response::ExactSettings exact;
  exact.body = settings_.body;
  exact.in_background = settings_.background;
  return response::ExactResponse::make(body(), std::move(exact), foci());
}

bool TearSession::compare(const response::SharedRecord& record) {
  comparison_.reset();
  if (!is_linear()) return false;
  std::unique_ptr<response::Response> other = make_response(record);
  if (!other) return false;
  comparison_.emplace(std::move(other));
  comparison_->grasp(hand_);
  return true;
}

std::optional<Vec3> TearSession::compared_force() const {
  return comparison_ ? std::optional<Vec3>(comparison_->force(hand_)) : std::nullopt;
}

Expected<void> TearSession::open(const scene::CrackSettings& crack) {
  Expected<fracture::FirstCut> cut =
      fracture::cut_initial(body(), crack.line, torn_.surroundings(), torn_.incision_settings(hand_.nodes()));
  if (!cut) return crack.place.fail(cut.error().what, cut.error().remedy);
  TickReport report;
  take(beginning(std::move(cut->start.cracks), std::move(cut->incision)), report, {});
  return {};
}

Expected<void> TearSession::grasp(const Vec3& at, response::ContactMode mode) {
  Expected<void> holds = hand_.grasp(body(), at, mode, *response_);
  if (comparison_) comparison_->grasp(hand_);
  round_ = {};
  make_local_objects();
  return holds;
}

void TearSession::let_go() {
  hand_.let_go(*response_);
  if (comparison_) comparison_->grasp(hand_);
  round_ = {};
  make_local_objects();
}

bool TearSession::undo() {
  if (cracks_before_.empty()) return false;
  const std::size_t remaining = body().mesh().node_count() - body().history().back().copied.size();
  const auto held = hand_.nodes();
  if (std::any_of(held.begin(), held.end(), [&](NodeId node) { return node.index() >= remaining; }))
    hand_.let_go(*response_);
  const mesh::MeshEdit edit = take_back(cracks_before_.back());
  cracks_before_.pop_back();
  advances_.pop_back();
  if (!made_.empty()) made_.pop_back();
  response_->go_back(edit, foci());
  hand_.follow(*response_);
  if (comparison_) comparison_->go_back(edit, foci(), hand_);
  round_ = {};
  make_local_objects();
  return true;
}

mesh::MeshEdit TearSession::take_back(const std::vector<fracture::Crack>& cracks) {
  mesh::MeshEdit edit = torn_.undo();
  cracks_ = cracks;
  reach_.resize(cracks_.size(), 0.0);
  follow_nodes();
  return edit;
}

void TearSession::follow_nodes() {
  if (!node_force_.empty()) node_force_.resize(body().mesh().node_count(), Vec3::Zero());
}

void TearSession::make_local_objects() {
  if (!response_) return;  // the first cracks are still being cut
  running_.clear();
  local_.clear();
  solved_alone_.clear();
  for (std::size_t crack = 0; crack < cracks_.size(); ++crack) {
    if (cracks_[crack].finished) continue;
    running_.push_back(crack);
    local_.emplace_back(body(), settings_.body.elastic,
                        torn_.surroundings().tets_near(body(), cracks_[crack], radius_of(crack)), supported(),
                        hand_.nodes(), fracture::LocalLoads{body_force_, node_force_});
    solved_alone_.push_back(!response_->is_of_torn_body() && local_.back().factor());
  }
  local_basis_.assign(local_.size(), {});
  solve_local_objects();
  surface_tets_.clear();
  surface_basis_.clear();
  if (!running_.empty()) return;
  for (const mesh::TetFace& face : mesh::solved_surface(body())) {
    if (surface_tets_.empty() || surface_tets_.back() != face.tet) surface_tets_.push_back(face.tet);
  }
}

void TearSession::solve_local_objects() {
  VectorX u;
  for (std::size_t k = 0; k < local_.size(); ++k) {
    const std::vector<NodeId>& nodes = solved_alone_[k] ? local_[k].boundary() : local_[k].nodes();
    const auto solve = [&](const VectorX& forces, double loads, VectorX& out) {
      response_->displacement(nodes, forces, loads, out);
    };
    by_basis(local_basis_[k], solve, u);
    if (!is_linear()) {
      local_[k].take(u, [this](fracture::TetStress& tet) { set_own_stress(tet); });
    } else if (solved_alone_[k]) {
      RHEXIS_CHECK(local_[k].solve(u), "local object {} has been factored", k);
    } else {
      local_[k].take(u);
    }
  }
}

void TearSession::by_basis(response::ForceBasis& basis, const response::ForceBasis::Solve& solve, VectorX& u) const {
  if (is_linear()) {
    basis.displacement(hand_.nodal_forces(), solve, u);
  } else {
    solve(hand_.nodal_forces(), 1.0, u);
  }
}

void TearSession::set_own_stress(fracture::TetStress& tet) const {
  const response::DeformedTet deformed = response_->deformed(tet.tet);
  fracture::set_turned_back(tet, deformed.F, deformed.state.stress);
}

Mat3 TearSession::stress(TetId tet, const VectorX& u) const {
  return is_linear() ? fracture::stress_of(body(), settings_.body.elastic, tet, u).stress
                     : response_->deformed(tet).state.stress;
}

void TearSession::add_local_objects(VectorX& u) const {
  for (std::size_t k = 0; k < local_.size() && settings_.tears; ++k) {
    if (!solved_alone_[k]) continue;
    const std::vector<NodeId>& nodes = local_[k].nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      u.segment<3>(3 * Eigen::Index{nodes[i].value()}) =
          local_[k].displacement().segment<3>(static_cast<Eigen::Index>(3 * i));
  }
}

std::vector<fracture::TetStress> TearSession::surface_stresses(const VectorX& u) const {
  std::vector<std::uint8_t> at_hand(body().mesh().tet_count(), 0);
  for (const NodeId node : hand_.nodes()) {
    for (const TetId tet : body().tets_around(node)) at_hand[tet.index()] = 1;
  }
  std::vector<fracture::TetStress> out;
  for (const TetId tet : surface_tets_) {
    out.push_back(fracture::stress_of(body(), settings_.body.elastic, tet, u));
    if (!is_linear()) set_own_stress(out.back());
    out.back().at_hand = at_hand[tet.index()] != 0;
  }
  return out;
}

double TearSession::radius_of(std::size_t crack) const { return std::max(settings_.local_radius, reach_[crack]); }

std::vector<response::Focus> TearSession::foci() const {
  std::vector<response::Focus> out;
  for (std::size_t crack = 0; crack < cracks_.size(); ++crack) {
    if (cracks_[crack].finished) continue;
    const std::vector<fracture::FrontPoint>& front = cracks_[crack].front;
    response::Focus focus;
    Vec3 direction = Vec3::Zero();
    for (const fracture::FrontPoint& point : front) {
      focus.centre += point.position / static_cast<double>(front.size());
      direction += point.direction;
    }
    if (direction.norm() > 0.0) focus.direction = direction.normalized();
    for (const fracture::FrontPoint& point : front)
      focus.half_length = std::max(focus.half_length, (point.position - focus.centre).norm());
    const Vec3 along = front.back().position - front.front().position;
    if (along.norm() > 0.0) focus.tangent = along.normalized();
    focus.radius = radius_of(crack);
    out.push_back(focus);
  }
  return out;
}

double TearSession::crack_area() const {
  double sum = 0.0;
  for (const fracture::Crack& crack : cracks_) sum += crack.area;
  return sum;
}

double TearSession::stored_energy() { return response_->stored_energy(hand_.nodal_forces()); }

void TearSession::displacement(VectorX& u) {
  response_->whole_displacement(hand_.nodal_forces(), 1.0, u);
  add_local_objects(u);
}

void TearSession::displacement(response::ForceBasis& basis, VectorX& u) {
  const auto solve = [&](const VectorX& forces, double loads, VectorX& out) {
    response_->whole_displacement(forces, loads, out);
  };
  by_basis(basis, solve, u);
  add_local_objects(u);
}

}  // namespace rhexis::session
