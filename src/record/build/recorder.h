#pragma once

/// From a torn body to what a record keeps of it.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "record/build/operator_factor.h"
#include "record/build/torn_state.h"
#include "record/store/record.h"
#include "response/elastic_elements.h"

namespace rhexis::record::build {

/// A topology with the factor of its stiffness: what the topologies that follow from it start with.
struct FactoredState {
  TornState torn;
  OperatorFactor factor;
};

/// What is the same for all topologies of a record; does not change.
class Recorder {
 public:
  /// Grasp points are the nodes of the intact surface that no support holds, edges those of the surface between two of
  /// them.
  Recorder(const mesh::TetMesh& mesh, response::ElasticBody elastic, bool single_precision);

  /// The parts of a head that come from here: mesh, points, edges, pattern, loads, precision.
  void describe(store::RecordHead& head) const;
  [[nodiscard]] const std::vector<std::int32_t>& points() const { return points_; }
  [[nodiscard]] const OperatorLayout& layout() const { return *layout_; }
  [[nodiscard]] const response::ElasticModel& model() const { return model_; }

  /// Factors what has changed. False: the body has a free motion, and the state is of no more use.
  [[nodiscard]] bool factor(FactoredState& state) const;
  /// After one more advance along `direction` (unit) by `length` (m), factored. An advance that would leave a part that
  /// can move freely is not made, and the flag says so.
  [[nodiscard]] FactoredState advanced(const FactoredState& before, const Vec3& direction, double length) const;
  [[nodiscard]] store::TopologyData record(const FactoredState& state) const;
  /// (L_ii)^-1 of every grasp point, N/m; zero out of the solve.
  [[nodiscard]] std::vector<Mat3> stiffnesses(const FactoredState& state) const;

 private:
  [[nodiscard]] std::vector<double> stiffness_of(const mesh::TornMesh& body) const;
  [[nodiscard]] std::vector<double> rest_of(const FactoredState& state) const;
  /// L_ij between two nodes, from the selected inverse.
  [[nodiscard]] Mat3 compliance(const std::vector<double>& inverse, std::int32_t a, std::int32_t b) const;
  [[nodiscard]] std::vector<Mat3> stiffnesses(const mesh::TornMesh& body, const std::vector<double>& inverse) const;

  mesh::TetMesh mesh_;
  response::ElasticModel model_;
  bool single_precision_;
  bool has_loads_ = false;
  std::vector<std::int32_t> points_;                ///< nodes, ascending
  std::vector<std::array<std::int32_t, 2>> edges_;  ///< of points
  std::unique_ptr<const OperatorLayout> layout_;
};

}  // namespace rhexis::record::build
