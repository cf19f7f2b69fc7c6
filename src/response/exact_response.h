#pragma once

/// The answer of the torn body itself, for small strains: after each edit the numbers are those of a full reassembly
/// and refactorisation, and only what the edit touched is factored again (docs/exact-response.md).
///
/// The body is cut at the rim of a window about the crack fronts. Outside and inside are condensed onto the rim, each
/// by a FrontTree; an edit changes the inside alone. When a front comes to the end of its window the window moves on,
/// which changes the outside as well, and can be made ready beside the caller before it is needed.

#include <memory>
#include <vector>

#include "base/background.h"
#include "response/halves.h"
#include "response/held_nodes.h"
#include "response/response.h"
#include "response/rim_system.h"

namespace rhexis::response {

struct ExactSettings {
  ElasticBody body;
  WindowShape window;
  /// Make the next window ready beside the caller once a front has used half of the present one. The result is the
  /// same to the bit from run to run, but not the same as without.
  bool in_background = false;
  /// Edits after which what was begun in the background is taken up: fixed, so that timing decides nothing.
  int take_up_after = 2;
};

class ExactResponse final : public Response {
 public:
  /// Factors the body as it stands. nullptr: it has a free motion. `mesh` outlives the response, and takes its edits
  /// before the response follows them.
  [[nodiscard]] static std::unique_ptr<ExactResponse> make(const mesh::TornMesh& mesh, ExactSettings settings,
                                                           std::span<const Focus> focus);
  ~ExactResponse() override;

  void grasp(std::span<const NodeId> nodes) override;
  /// When the torn body is not stable nothing is followed: the caller takes the edit back from the mesh, and may apply
  /// it anew with the loose pieces frozen.
  FollowReport follow(const mesh::MeshEdit& edit, std::span<const Focus> focus) override;
  FollowReport go_back(const mesh::MeshEdit& edit, std::span<const Focus> focus) override;

  [[nodiscard]] const Eigen::MatrixXd& compliance() const override { return held_.compliance; }
  [[nodiscard]] const VectorX& rest() const override { return held_.rest; }
  void displacement(std::span<const NodeId> nodes, const VectorX& held_forces, VectorX& out) override;
  void whole_displacement(const VectorX& held_forces, VectorX& out) override;
  [[nodiscard]] double stored_energy(const VectorX& held_forces) override;
  [[nodiscard]] std::size_t memory_bytes() const override;

  [[nodiscard]] const Window& window() const { return *halves_.window; }

 private:
  struct Preparation;
  ExactResponse(const mesh::TornMesh& mesh, ExactSettings settings);

  bool make_next(const Followed& what, std::span<const Focus> focus, Halves& next) const;
  bool take_up(const mesh::MeshEdit& edit, std::span<const Focus> focus, Halves& next, FollowReport& report);
  void prepare(std::span<const Focus> focus);
  bool adopt(Halves next);
  [[nodiscard]] Window place_window(std::span<const Focus> focus, const mesh::TornMesh& mesh) const;
  [[nodiscard]] VectorX solve_rim(const VectorX& held_forces, double loads) const;
  void solve_at(std::span<const NodeId> nodes, const VectorX& held_forces, double loads, VectorX& out);
  [[nodiscard]] bool is_solved_inside(NodeId node) const;
  [[nodiscard]] bool is_in_solve(NodeId node) const;
  [[nodiscard]] Vec3 prescribed(NodeId node) const;
  [[nodiscard]] double potential_energy(const VectorX& held_forces) const;

  const mesh::TornMesh& mesh_;
  ExactSettings settings_;
  ElasticModel model_;
  Halves halves_;
  RimSystem rim_;
  RimSystem next_rim_;  ///< of the version before, whose memory the next one takes
  HeldNodes held_;
  double energy_at_first_ = 0.0;
  /// What some nodes do under the loads and under forces on the held nodes, as far as it has been asked for: in one
  /// topology everything is linear, and the forces of a contact have three dimensions at most.
  struct Known {
    std::vector<NodeId> nodes;
    VectorX rest;           ///< m, 3 per node
    Eigen::MatrixXd force;  ///< columns of length 1
    Eigen::MatrixXd moved;  ///< m/N, by each of them
    bool any = false;
  };
  Known known_;
  double whole_flops_ = 0.0;                  ///< of the first factor
  VectorX x_inside_, x_outside_;              ///< work
  std::unique_ptr<Preparation> preparation_;  ///< null without background; last, so that it ends first
};

}  // namespace rhexis::response
