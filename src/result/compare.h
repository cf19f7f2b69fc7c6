#pragma once

/// `rhexis compare A B`: how far two results on the same mesh are apart, field by field.

#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/vec.h"
#include "mesh/field.h"

namespace rhexis::result {

/// Of one field; vectors and tensors by the Euclidean norm of the difference of an entity's values.
struct FieldDifference {
  std::string name;
  mesh::Centering centering = mesh::Centering::point;
  double largest = 0.0;        ///< max |b - a|, in the field's unit
  double mean = 0.0;           ///< mean |b - a|
  std::size_t largest_at = 0;  ///< node or tet of the largest
  double scale = 0.0;          ///< max |a|
  [[nodiscard]] double relative_largest() const {
    return scale > 0.0 ? largest / scale : (largest > 0.0 ? INFINITY : 0.0);
  }
  [[nodiscard]] double relative_mean() const { return scale > 0.0 ? mean / scale : (mean > 0.0 ? INFINITY : 0.0); }
};

/// The paper's measure (Table 5): |u_b - u_a| per component over the bounding box of the body, in percent.
struct BoxDifference {
  Vec3 mean = Vec3::Zero();
  Vec3 largest = Vec3::Zero();
};

/// Of two displacements of the same nodes, 3 values a node, m; `box`: sides of the bounding box, m.
[[nodiscard]] BoxDifference box_difference(const Vec3& box, std::span<const double> a, std::span<const double> b);

struct Comparison {
  std::vector<FieldDifference> fields;   ///< those that both results hold, in the order of the first
  std::vector<std::string> only_in_one;  ///< names of the others
  BoxDifference displacement;            ///< zero when a result has no displacement
};

/// A and B are result files or the folders that `rhexis solve` wrote. The meshes must be the same: same nodes and tets
/// in the same order (positions within a millionth of the body's size); the error names the first that differs.
Expected<Comparison> compare_results(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace rhexis::result
