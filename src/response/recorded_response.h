#pragma once

/// The answer of the thesis (sections 4.1, 4.2.1, 4.3): the force at the hand interpolated between recorded topologies,
/// (4.27), and the displacement by the global operator of the nearest one, (4.8), (4.9), under the displacement that
/// the interpolated force has at the hand. Nothing is factored while the body tears (docs/recorded-response.md).
///
/// A record follows one crack, number 0, by so many advances. What it does not know is clamped, and said by record_use.

#include <memory>
#include <span>
#include <vector>

#include "record/store/loaded_record.h"
#include "record/store/reaction.h"
#include "response/elastic_elements.h"
#include "response/response.h"

namespace rhexis::response {

using SharedRecord = std::shared_ptr<const record::store::LoadedRecord>;

class RecordedResponse final : public Response {
 public:
  /// `mesh`: the body of the record, which outlives the response, and takes its edits before the response follows them.
  /// `advances`: those that it has made since it was that of topology 0, one per edit. RHEXIS_CHECK: nodes as the
  /// record has them.
  RecordedResponse(const mesh::TornMesh& mesh, SharedRecord record, ElasticBody body,
                   std::span<const CrackAdvance> advances = {});

  void grasp(std::span<const NodeId> nodes) override;
  FollowReport follow(const mesh::MeshEdit& edit, std::span<const Focus> focus,
                      const CrackAdvance* advance = nullptr) override;
  void go_back(const mesh::MeshEdit& edit, std::span<const Focus> focus) override;

  [[nodiscard]] const Eigen::MatrixXd& compliance() const override { return compliance_; }
  [[nodiscard]] const VectorX& rest() const override { return rest_; }
  void displacement(std::span<const NodeId> nodes, const VectorX& held_forces, double loads, VectorX& out) override;
  void whole_displacement(const VectorX& held_forces, double loads, VectorX& out) override;
  [[nodiscard]] bool is_of_torn_body() const override { return false; }
  [[nodiscard]] std::optional<RecordUse> record_use() const override { return use_; }
  [[nodiscard]] double stored_energy(const VectorX& held_forces) override;
  /// Of the record, which others may share, and of this.
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  void push(const CrackAdvance* advance);
  void look_up();
  void find_rest();
  void solve_held();
  [[nodiscard]] bool holds_in(int topology) const;
  [[nodiscard]] Eigen::MatrixXd moves_of_held(int topology) const;
  void fill_gaps(int topology, Eigen::Ref<Eigen::MatrixXd> of_nodes) const;

  const mesh::TornMesh& mesh_;
  SharedRecord record_;
  record::store::Lookup lookup_;
  ElasticModel model_;
  std::vector<record::store::Advanced> advances_;  ///< of the record's crack
  std::vector<bool> counts_;                       ///< per edit: it is one of those
  int before_first_ = 0;                           ///< edits that were taken back beyond topology 0

  RecordUse use_;
  bool outside_ = false;                ///< use_.outside, whatever is held
  std::vector<std::uint8_t> in_solve_;  ///< per node of the body
  VectorX rest_of_all_;                 ///< m, 3 per node
  double energy_at_rest_ = 0.0;         ///< J
  double energy_at_first_ = 0.0;        ///< J
  std::vector<NodeId> held_;
  Eigen::MatrixXd compliance_;
  VectorX rest_;
  Eigen::MatrixXd moves_;  ///< m/N, 3 per node of the body: by forces on the held nodes
};

}  // namespace rhexis::response
