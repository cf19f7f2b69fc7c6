#pragma once

/// The answer of the torn body itself, for small strains: after each edit the numbers are those of a full reassembly
/// and refactorisation, and only what depends on the edit is factored again (docs/exact-response.md).
///
/// That is the way in the elimination tree from what the edit touched to the last front (Herholz and Sorkine-Hornung
/// 2020), which lies where the last edit was, in a tree whose large separators keep out of the way of the cracks. A
/// crack that leaves the way that was foreseen makes the updates dearer, not wrong; once they have cost as much as a
/// new factor, one for the way it takes now is made beside the caller.

#include <memory>
#include <span>
#include <vector>

#include "linalg/front_tree.h"
#include "response/elastic_elements.h"
#include "response/response.h"

namespace rhexis::response {

struct ExactSettings {
  ElasticBody body;
  /// Make new factors beside the caller. When one is begun and when it is taken up is decided by counted operations,
  /// never by the clock: the same bits from run to run.
  bool in_background = false;
  /// Operations of a whole factor below which a new one is not worth its while.
  double fewest_flops = 1e9;
  /// In whole factors: what updates have cost when a new factor is begun, and from then until it is taken up.
  double refresh_after = 1.0;
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
  FollowReport follow(const mesh::MeshEdit& edit, std::span<const Focus> focus,
                      const CrackAdvance* advance = nullptr) override;
  void go_back(const mesh::MeshEdit& edit, std::span<const Focus> focus) override;

  [[nodiscard]] const Eigen::MatrixXd& compliance() const override { return compliance_; }
  [[nodiscard]] const VectorX& rest() const override { return rest_; }
  void displacement(std::span<const NodeId> nodes, const VectorX& held_forces, double loads, VectorX& out) override;
  void whole_displacement(const VectorX& held_forces, double loads, VectorX& out) override;
  [[nodiscard]] double stored_energy(const VectorX& held_forces) override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  struct Preparation;
  using Tree = std::shared_ptr<const linalg::FrontTree>;
  ExactResponse(const mesh::TornMesh& mesh, ExactSettings settings);
  Tree take_up(const mesh::MeshEdit& edit, std::span<const Focus> focus, FollowReport& report);
  void prepare(std::span<const Focus> focus);
  bool adopt(Tree next);
  void solve_held();
  void check_forces(const VectorX& held_forces) const;
  [[nodiscard]] bool is_pushed(const VectorX& held_forces, double loads) const;
  [[nodiscard]] Vec3 prescribed(NodeId node) const;
  [[nodiscard]] double potential_energy(const VectorX& held_forces) const;

  const mesh::TornMesh& mesh_;
  ExactSettings settings_;
  ElasticModel model_;
  Tree tree_;
  double whole_flops_ = 0.0;  ///< of the first factor
  double spent_flops_ = 0.0;  ///< by updates since the present tree was cut
  double energy_at_first_ = 0.0;

  std::vector<NodeId> held_;
  linalg::FrontTree::Forward forward_;  ///< of unit forces on the held nodes
  Eigen::MatrixXd compliance_;
  VectorX rest_;
  VectorX x_;                                 ///< work
  std::unique_ptr<Preparation> preparation_;  ///< null without background; last, so that it ends first
};

}  // namespace rhexis::response
