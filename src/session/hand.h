#pragma once

/// The hand: what it holds, where it is, what it feels, and the work that it has done.

#include <optional>
#include <span>

#include "base/error.h"
#include "mesh/torn_mesh.h"
#include "response/contact.h"
#include "response/response.h"

namespace rhexis::session {

class Hand {
 public:
  explicit Hand(response::ContactRule rule) : rule_(rule) {}

  /// Takes hold of the surface point nearest to `at` (m, reference); the response is told. Errors, after which it holds
  /// nothing: no surface is left, or a support holds the point already.
  Expected<void> grasp(const mesh::TornMesh& body, const Vec3& at, response::ContactMode mode,
                       response::Response& response);
  void let_go(response::Response& response);
  /// The response has changed: the same place of the hand, another force.
  void follow(const response::Response& response);
  /// Displaced by `by` (m) from where it took hold; the body comes along, as far as it does.
  response::MoveReport move(const Vec3& by, response::Response& response);

  [[nodiscard]] bool holds() const { return point_.has_value(); }
  /// Only while it holds.
  [[nodiscard]] const response::SurfacePoint& point() const { return *point_; }
  [[nodiscard]] const response::ContactLaw& law() const { return law_; }
  /// None when it does not hold.
  [[nodiscard]] std::span<const NodeId> nodes() const;
  /// What another response says of the same point, held by the same rule.
  [[nodiscard]] response::ContactLaw law_by(const response::Response& response) const;
  /// N, on the hand where it is, by such a law.
  [[nodiscard]] Vec3 force_by(const response::ContactLaw& law) const;
  /// Some held node has no tet in the solve any more.
  [[nodiscard]] bool has_lost_hold(const mesh::TornMesh& body) const;
  /// N, on the hand.
  [[nodiscard]] Vec3 force() const;
  /// N, on the body, 3 per held node.
  [[nodiscard]] const VectorX& nodal_forces() const { return nodal_forces_; }
  /// J, on the body, since the beginning, by the mean of the forces before and after each move: exact for a linear body
  /// while it stays the same.
  [[nodiscard]] double work() const { return work_; }

 private:
  void update_forces();

  response::ContactRule rule_;
  response::ContactMode mode_ = response::ContactMode::hold;
  std::optional<response::SurfacePoint> point_;
  response::ContactLaw law_;
  Vec3 start_ = Vec3::Zero();  ///< displacement of the point when it was taken hold of: by the loads alone, m
  Vec3 at_ = Vec3::Zero();     ///< displacement of the hand from the point's reference position, m
  VectorX nodal_forces_;
  double work_ = 0.0;
};

}  // namespace rhexis::session
