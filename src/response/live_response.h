#pragma once

/// The answer of a body of large strain (`corotated`, `geometrically-nonlinear`, `hyperelastic`) that is led by a hand
/// and torn: one state, kept near equilibrium by warm Newton corrections (solver/live_equilibrium.h), carried on when a
/// crack runs through its reference configuration (carried_state.h). Between moves the contact answers by the tangent.
/// No clock: what is made beside the caller is taken up by counts, the same bits from run to run. A body with mass
/// moves in steps of fixed length as time passes, one a move at most: where moves take longer it moves slower than
/// life. It follows the hand step by step; between two steps the contact's law goes on with the point.

#include <memory>
#include <vector>

#include "base/error.h"
#include "response/response.h"
#include "response/torn_model.h"
#include "solver/live_equilibrium.h"
#include "solver/options.h"

namespace rhexis::response {

struct LiveResponseSettings {
  LiveBody body;
  solver::LiveOptions live = {};  ///< of a frame
  int frames = 1;                 ///< of a move at most: one for a hand that does not wait, many for a script that may
  solver::Options solver = {};    ///< by which the equilibrium under the loads alone is found, from which it starts
  std::optional<solver::Dynamics> dynamics =
      std::nullopt;  ///< empty: it has no mass, and is where it is in equilibrium
};

class LiveResponse final : public Response {
 public:
  /// Under its loads, without a hand. `mesh` outlives the response, and takes its edits before the response follows
  /// them. Errors: no equilibrium is found.
  [[nodiscard]] static Expected<std::unique_ptr<LiveResponse>> make(const mesh::TornMesh& mesh,
                                                                    LiveResponseSettings settings);

  void hold(const SurfacePoint& point, ContactMode mode) override;
  /// A body of large strain is held at a point: none is the only set of nodes that it takes.
  void grasp(std::span<const NodeId> nodes) override;
  void pass(double seconds) override;
  MoveReport move(const Vec3& hand) override;
  [[nodiscard]] bool is_linear() const override { return false; }
  [[nodiscard]] const VectorX& rest() const override { return rest_; }
  [[nodiscard]] const Eigen::MatrixXd& compliance() const override { return compliance_; }

  [[nodiscard]] DeformedTet deformed(TetId tet) const override;
  [[nodiscard]] double stored_energy(const VectorX& held_forces) override;
  /// Pieces out of the solve stay where they came off.
  void whole_displacement(const VectorX& held_forces, double loads, VectorX& out) override;
  void displacement(std::span<const NodeId> nodes, const VectorX& held_forces, double loads, VectorX& out) override;

  /// Not ok where the cut would turn a tet inside out in the deformed body; nothing is followed then.
  FollowReport follow(const mesh::MeshEdit& edit, std::span<const Focus> focus,
                      const CrackAdvance* advance = nullptr) override;
  /// To the state in which the edit was made, to the last bit.
  void go_back(const mesh::MeshEdit& edit, std::span<const Focus> focus) override;
  [[nodiscard]] std::size_t memory_bytes() const override;

  [[nodiscard]] const model::State& state() const { return live_->state(); }
  [[nodiscard]] double residual() const { return live_->residual(); }  ///< relative
  /// Of a body with mass: RHEXIS_CHECK.
  [[nodiscard]] const solver::Inertia& inertia() const { return live_->inertia(); }

 private:
  LiveResponse(const mesh::TornMesh& mesh, LiveResponseSettings settings)
      : mesh_(mesh), settings_(std::move(settings)) {}
  void make_model();
  void make_live(model::State state);
  void take_hold();
  void let_go();
  [[nodiscard]] Vec3 way_back() const;
  [[nodiscard]] Vec3 released() const;
  [[nodiscard]] Expected<model::State> equilibrium_from_rest() const;
  void begin_again();
  bool begin_step();
  void update_contact();
  [[nodiscard]] Vec3 target(const Vec3& hand) const;
  [[nodiscard]] double potential_energy() const;

  const mesh::TornMesh& mesh_;
  LiveResponseSettings settings_;
  std::vector<std::uint8_t> left_out_;  ///< per tet
  std::shared_ptr<const model::Model> model_;
  std::unique_ptr<solver::LiveEquilibrium> live_;
  /// Of each edit that was followed: the state in which it was made, by what it was held, and how it moved.
  struct Before {
    model::State state;
    std::optional<SurfacePoint> point;
    solver::Motion motion;  ///< empty of a body without mass
  };
  std::vector<Before> before_;
  double energy_at_first_ = 0.0;

  std::optional<SurfacePoint> point_;    ///< that the hand holds
  std::optional<SurfacePoint> leaving_;  ///< that it held: led to where no force is, and only then let go
  double size_ = 0.0;                    ///< m, of the body
  int given_up_ = 0;            ///< frames without a hand that gave up, or were inside out, since it was at rest
  int inverted_from_rest_ = 0;  ///< tets, that are inside out where it came to rest from the undeformed body
  double owed_ = 0.0;           ///< s, that have passed and that the body has not moved by
  Vec3 led_to_ = Vec3::Zero();  ///< m, the hand as the body follows it: with mass that of when the time step began
  ContactMode mode_ = ContactMode::hold;
  bool supported_ = false;  ///< the point: nothing holds it then
  Eigen::MatrixXd compliance_;
  VectorX rest_;
};

}  // namespace rhexis::response
