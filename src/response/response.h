#pragma once

/// How a body answers the point that is held, topology after topology. Of small strains, `exact` solves the torn body
/// and `recorded` (the thesis) takes what was recorded of cracks like those of the body: linear, they answer any force.
/// A body of large strain (LiveResponse) has one state, which `move` brings to where the hand is; what it is asked for
/// then is of that state. All are followed by the same calls.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/vec.h"
#include "mesh/torn_mesh.h"
#include "model/model.h"
#include "response/contact.h"

namespace rhexis::response {

/// Where the next edits will be: the tets within `radius` of a front. A response may make ready for them.
struct Focus {
  Vec3 centre = Vec3::Zero();     ///< m, middle of the front
  Vec3 direction = Vec3::Zero();  ///< where it runs; zero when unknown
  double half_length = 0.0;       ///< m, half the extent of the front along itself
  double radius = 0.0;            ///< m, of the local object
  Vec3 tangent = Vec3::Zero();    ///< along the front; zero when unknown
};

/// The advance of a crack that an edit made.
struct CrackAdvance {
  std::size_t crack = 0;          ///< its number; the scene's own crack is 0
  bool started = false;           ///< it begins here
  Vec3 direction = Vec3::Zero();  ///< unit, reference: mean over its front
  double length = 0.0;            ///< m, as it was asked for: what it runs on until an edge is cut does not count
};

/// Which part of a record answers, and what it does not know.
struct RecordUse {
  int topology = 0;        ///< the nearest, (4.8), (4.9)
  bool outside = false;    ///< some angle or length lies beyond the record, or some crack is none of it
  bool past_last = false;  ///< more advances than the record has: the first of them count
  bool torn_off = false;   ///< what is held has come off in a recorded topology that counts
  /// An advance of the nearest opened nothing when it was recorded, or would have left a part that can move freely: its
  /// answers are those of the body before that.
  bool not_made = false;

  /// Whatever one of the two does not know; the topology stays.
  void add(const RecordUse& other) {
    outside = outside || other.outside;
    past_last = past_last || other.past_last;
    torn_off = torn_off || other.torn_off;
    not_made = not_made || other.not_made;
  }
};

/// What following an edit took.
struct FollowReport {
  bool ok = true;  ///< false: the torn body is not stable (a free motion is left); answers are those of before
  double update_seconds = 0.0;  ///< on the calling thread, all included
  double wait_seconds = 0.0;    ///< of that, waiting for work in the background
  bool refreshed = false;       ///< what was made in the background was taken up
  std::string why = {};         ///< not ok: one line, where it is something else than a free motion
};

/// How far a body has come to where the hand is.
struct MoveReport {
  bool near = true;       ///< near enough to equilibrium for its stress to be judged
  bool at_rest = true;    ///< the same place of the hand again would change nothing
  std::string late = {};  ///< one line where the body cannot follow, empty where it does, be it a few frames behind
};

/// A tet of a body of large strain.
struct DeformedTet {
  Mat3 F = Mat3::Identity();  ///< deformation gradient
  model::TetState state;
};

class Response {
 public:
  virtual ~Response() = default;

  /// The nodes that the hand holds from now on (none: it lets go). Their forces are the columns of what follows.
  virtual void grasp(std::span<const NodeId> nodes) = 0;
  /// The same for the nodes of a point, which the hand holds or pushes at.
  virtual void hold(const SurfacePoint& point, ContactMode /*mode*/) {
    grasp({point.node.data(), static_cast<std::size_t>(point.count)});
  }
  /// Time goes on, s: a body with mass moves by it in the moves that follow.
  virtual void pass(double /*seconds*/) {}
  /// The point is to be at `hand` (m, displacement from its reference position), or the body at rest without a hand.
  virtual MoveReport move(const Vec3& /*hand*/) { return {}; }
  /// False: displacement and energy are those of the state of the last move, whatever the forces; with loads as they
  /// are (1).
  [[nodiscard]] virtual bool is_linear() const { return true; }
  /// Of a tet in the solve, of a body that is not linear: RHEXIS_CHECK.
  [[nodiscard]] virtual DeformedTet deformed(TetId tet) const;

  /// After the body has taken an edit. `focus`: one per crack that still runs. `advance`: what made the edit; null: no
  /// crack did.
  virtual FollowReport follow(const mesh::MeshEdit& edit, std::span<const Focus> focus,
                              const CrackAdvance* advance = nullptr) = 0;
  /// After the body has given an edit back.
  virtual void go_back(const mesh::MeshEdit& edit, std::span<const Focus> focus) = 0;

  /// L_cc of the held nodes, m/N, 3 per node squared. Rows and columns of a component that a support holds are zero,
  /// and so are those of a node that has no tet in the solve any more. Of a body that is not linear: N^T-weighted so
  /// that the point N u has the compliance of the last tangent, zero where some node has a support.
  [[nodiscard]] virtual const Eigen::MatrixXd& compliance() const = 0;
  /// Displacement of the held nodes by the loads alone, m, 3 per node: to first order from the present state for a body
  /// that is not linear.
  [[nodiscard]] virtual const VectorX& rest() const = 0;
  /// Displacement (m, 3 per node of `nodes`; zero out of the solve) by `loads` times the loads, moved supports among
  /// them, and by forces on the held nodes (N, 3 per held node). Nodes within the focus of the last call are cheap.
  virtual void displacement(std::span<const NodeId> nodes, const VectorX& held_forces, double loads, VectorX& out) = 0;
  /// The same of every node of the body.
  virtual void whole_displacement(const VectorX& held_forces, double loads, VectorX& out) = 0;
  /// True: the displacement is that of the torn body, inside a local object too. False: it is good at the boundary of
  /// one, which then has to be solved.
  [[nodiscard]] virtual bool is_of_torn_body() const { return true; }
  /// Empty for a response without a record.
  [[nodiscard]] virtual std::optional<RecordUse> record_use() const { return std::nullopt; }
  /// Potential energy of the body and its loads, the hand's forces aside, with forces on the held nodes, J; relative to
  /// the equilibrium under the loads alone when the response was made. What is frozen takes its energy along.
  [[nodiscard]] virtual double stored_energy(const VectorX& held_forces) = 0;
  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
};

}  // namespace rhexis::response
