#pragma once

/// The figures of the study of recorded forces.

#include <array>
#include <vector>

#include <nlohmann/json.hpp>

#include "result/chart.h"
#include "studies/reaction_cell.h"

namespace rhexis::studies {

/// The force of one pull at one point over the angle of the crack.
class ForceCurve {
 public:
  ForceCurve() = default;
  /// Of the grasp point nearest to `at`, pulled by `by` (m).
  ForceCurve(const std::vector<Vec3>& points, const Vec3& at, const Vec3& by);
  /// Takes up a torn body at the point and pull of `of`.
  void add(const ReactionQuery& query, const ForceCurve& of);
  void append(const ForceCurve& other);
  /// angle, exact_N, and of every way WAY_N.
  [[nodiscard]] nlohmann::ordered_json rows() const;

 private:
  std::size_t point_ = 0;
  Vec3 pull_ = Vec3::Zero();
  std::vector<double> angle_;
  std::vector<std::array<double, 4>> force_;  ///< N
};

[[nodiscard]] result::Chart spacing_chart(const nlohmann::ordered_json& rows);
[[nodiscard]] result::Chart distance_chart(const nlohmann::ordered_json& rows);
/// `spacing`: degrees, of the record.
[[nodiscard]] result::Chart angle_chart(const nlohmann::ordered_json& rows, double spacing);
[[nodiscard]] result::Chart force_chart(const nlohmann::ordered_json& rows, double spacing);

}  // namespace rhexis::studies
