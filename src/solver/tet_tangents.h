#pragma once

/// The tangents of the tets with their pressures eliminated by D, each at the state of its last look: what the
/// preconditioner of a live body is summed from,
///
///     A_e + b_e b_e^T / d_e.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linalg/front_tree.h"
#include "linalg/saddle_matrix.h"
#include "model/model.h"

namespace rhexis::solver {

class TetTangents final : public linalg::ElementSource {
 public:
  /// `inertia`: of the mass, N/m per volume.
  TetTangents(const model::Model& model, const linalg::FreeDofs& free, const model::State& state, double inertia);
  /// Touched tets at `state`, turned back by T, which is per node; the others as they were.
  void follow(const model::Model& model, const linalg::FreeDofs& free, const model::State& state,
              std::span<const std::int32_t> touched, const std::vector<Mat3>& T);
  /// Per tet, m^3/Pa.
  void set_diagonal(const VectorX& d) { d_ = d; }
  /// Adds this part of its trace to the diagonal of each tet.
  void shift_by(double part) { shift_ = part; }

  std::int32_t node_count() const override { return static_cast<std::int32_t>(free_.size()); }
  std::int32_t element_count() const override { return static_cast<std::int32_t>(nodes_.size()); }
  bool is_active(std::int32_t tet) const override {
    return left_out_.empty() || left_out_[static_cast<std::size_t>(tet)] == 0;
  }
  std::array<std::int32_t, 4> nodes(std::int32_t tet) const override { return nodes_[static_cast<std::size_t>(tet)]; }
  void stiffness(std::int32_t tet, linalg::ElementMatrix& out) const override;
  void load(std::int32_t, linalg::ElementVector& out) const override { out.setZero(); }
  Vec3 node_load(std::int32_t) const override { return Vec3::Zero(); }
  unsigned free_components(std::int32_t node) const override { return free_[static_cast<std::size_t>(node)]; }

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  void take_nodes(const model::Model& model, const linalg::FreeDofs& free);

  std::vector<double> blocks_, coupling_;
  std::vector<std::array<std::int32_t, 4>> nodes_;
  std::vector<std::uint8_t> left_out_;  ///< per tet
  std::vector<unsigned> free_;          ///< per node
  VectorX d_;
  double inertia_;
  std::vector<double> mass_;  ///< per tet, of its mass on the tangent's diagonal, N/m; empty: it has none
  double shift_ = 0.0;
};

}  // namespace rhexis::solver
