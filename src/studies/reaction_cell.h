#pragma once

/// One cell of a record's grid of crack angles: what the record says of the cracks within it, and what is true.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "record/build/recorder.h"
#include "record/store/record.h"

namespace rhexis::studies {

/// The body before its first advance, and how it runs on.
struct ReactionBody {
  const mesh::TetMesh* mesh = nullptr;  ///< intact
  record::store::Frame frame;
  double length = 0.0;  ///< m, of an advance
  const record::build::Recorder* recorder = nullptr;
  const record::build::FactoredState* first = nullptr;
};

/// Between two recorded angles of every advance, degrees.
struct ReactionCell {
  std::vector<double> low, high;
  std::vector<std::vector<double>> inside;  ///< per advance: the angles that are asked for, low < angle <= high or all
};

/// A point in a torn body: its stiffness, N/m, as it is and by the ways of kReactionWays from the
/// recorded corners of the cell.
struct ReactionSample {
  std::size_t point = 0;  ///< grasp point
  Mat3 exact, nearest, linear, local;
};

/// Of one torn body in the cell.
struct ReactionQuery {
  std::vector<double> angles;  ///< degrees, per advance
  std::vector<Vec3> path;      ///< m, the crack from its mouth to its front
  int torn_off = 0;            ///< points left out: without a tet in the solve here or in a corner
  std::vector<ReactionSample> samples;
};

/// Ordered by angles, the last advance fastest.
void visit_cell(const ReactionBody& body, const ReactionCell& cell,
                const std::function<void(const ReactionQuery&)>& visit);

}  // namespace rhexis::studies
