#include "session/hand.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace rhexis::session {
namespace {

/// A direction in which a node gives way by less than this part of its softest one is held by a support.
constexpr double kHeld = 1e-9;

/// Some node (3 rows each) cannot be moved in some direction.
bool is_supported(const Eigen::MatrixXd& compliance) {
  for (Eigen::Index node = 0; node < compliance.rows(); node += 3) {
    const Mat3 own = compliance.block<3, 3>(node, node);
    const Vec3 softness = Eigen::SelfAdjointEigenSolver<Mat3>(own, Eigen::EigenvaluesOnly).eigenvalues();
    if (!(softness[0] > kHeld * softness[2])) return true;
  }
  return false;
}

}  // namespace

Expected<void> Hand::grasp(const mesh::TornMesh& body, const Vec3& at, response::ContactMode mode,
                           response::Response& response) {
  point_ = response::nearest_surface_point(body, at);
  if (!point_) {
    let_go(response);
    return fail("nothing is left to hold: no piece of the body has a support");
  }
  mode_ = mode;
  response.hold(*point_, mode_);
  if (is_supported(response.compliance())) {
    let_go(response);
    return fail("a support holds the point that the hand takes hold of", "a point away from every [[support]]");
  }
  follow(response);
  start_ = at_ = law_.rest;
  update_forces();
  return {};
}

void Hand::let_go(response::Response& response) {
  point_.reset();
  response.grasp({});
  law_ = {};
  update_forces();
}

void Hand::follow(const response::Response& response) {
  if (point_) law_ = law_by(response);
  update_forces();
}

response::MoveReport Hand::move(const Vec3& by, response::Response& response) {
  const Vec3 from = at_;
  const Vec3 before = force();
  at_ = start_ + by;
  response::MoveReport report = response.move(at_);
  if (!response.is_linear() && point_) law_ = law_by(response);
  update_forces();
  work_ -= 0.5 * (before + force()).dot(at_ - from);
  return report;
}

std::span<const NodeId> Hand::nodes() const {
  if (!point_) return {};
  return {point_->node.data(), static_cast<std::size_t>(point_->count)};
}

bool Hand::has_lost_hold(const mesh::TornMesh& body) const {
  const auto held = nodes();
  return std::any_of(held.begin(), held.end(), [&](NodeId node) { return !body.is_solved(node); });
}

response::ContactLaw Hand::law_by(const response::Response& response) const {
  return response::make_contact_law(*point_, rule_, mode_, response.compliance(), response.rest());
}

Vec3 Hand::force() const { return force_by(law_); }

Vec3 Hand::force_by(const response::ContactLaw& law) const {
  return point_ ? Vec3(-law.force(at_)) : Vec3(Vec3::Zero());
}

void Hand::update_forces() {
  nodal_forces_ = point_ ? VectorX(law_.nodal_forces(at_).head(3 * point_->count)) : VectorX();
}

}  // namespace rhexis::session
