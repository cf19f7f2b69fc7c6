#pragma once

/// What a record holds (docs/record-format.md). The model is linear, so that a stiffness of six numbers at a grasp
/// point is its reaction to every pull.

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "record/store/operator.h"
#include "record/store/parameters.h"

namespace rhexis::record::store {

/// Of the record's angles: y as the crack of the scene points, z along its front, x = y cross z. Unit, right-handed.
struct Frame {
  Vec3 x = Vec3::UnitX();
  Vec3 y = Vec3::UnitY();
  Vec3 z = Vec3::UnitZ();
  /// Unit, at so many degrees from x.
  [[nodiscard]] Vec3 direction(double angle) const;
  friend bool operator==(const Frame&, const Frame&) = default;
};

/// What has happened on the way to a topology.
enum TopologyFlag : std::uint8_t {
  opened_nothing = 1,  ///< its last advance met nothing to cut: the body is as before that
  unstable = 2,        ///< its last advance would have left a part that can move freely: the body is as before that
  came_through = 4,    ///< the crack has left the body: further advances open nothing
};

/// All that topologies share.
struct RecordHead {
  Parameters parameters;
  Frame frame;
  bool single_precision = false;                   ///< of the global operators
  bool has_loads = false;                          ///< `rest` is there
  std::uint64_t fingerprint = 0;                   ///< of scene, mesh and method
  std::string program;                             ///< that wrote it: "rhexis 0.1.0"
  std::string title;                               ///< of the scene
  std::vector<double> nodes;                       ///< of the intact mesh, m, 3 per node
  std::vector<std::int32_t> tets;                  ///< 4 per tet
  std::vector<std::int32_t> points;                ///< node of each grasp point, ascending
  std::vector<std::array<std::int32_t, 2>> edges;  ///< of the intact surface: two grasp points, the lower first
  OperatorPattern pattern;

  friend bool operator==(const RecordHead&, const RecordHead&) = default;
};

/// One topology.
struct TopologyData {
  std::uint8_t flags = 0;              ///< of TopologyFlag
  std::vector<std::uint8_t> in_solve;  ///< per grasp point: it has a tet in the solve
  std::vector<double> stiffness;       ///< (L_ii)^-1, N/m, 6 per grasp point: xx yy zz xy yz xz; zero out of the solve
  std::vector<double> compliance;      ///< L_ij, m/N, 9 per edge by rows; zero where one of the two is out of the solve
  std::vector<double> rest;            ///< displacement by the loads alone, m, 3 per node; empty without loads
  std::variant<std::vector<double>, std::vector<float>> factor;  ///< one value per entry of the pattern
  std::vector<std::int32_t> moved_nodes;  ///< that are elsewhere than in the intact mesh, ascending
  std::vector<double> moved_to;           ///< m, 3 per moved node
  std::vector<std::int32_t> gone_tets;    ///< ascending
  std::vector<std::int32_t> frozen_tets;  ///< alive, on pieces without support; ascending

  friend bool operator==(const TopologyData&, const TopologyData&) = default;
};

/// What is looked up at the haptic rate: all of a record but the operators and the edits.
struct Record {
  RecordHead head;
  std::vector<std::uint8_t> flags;     ///< per topology
  std::vector<std::uint8_t> in_solve;  ///< topologies x points
  std::vector<double> stiffness;       ///< topologies x points x 6
  std::vector<double> compliance;      ///< topologies x edges x 9
  std::vector<double> rest;            ///< topologies x nodes x 3, or empty

  /// N/m
  [[nodiscard]] Mat3 stiffness_at(int topology, int point) const;
  [[nodiscard]] bool is_in_solve(int topology, int point) const {
    return in_solve[static_cast<std::size_t>(topology) * head.points.size() + static_cast<std::size_t>(point)] != 0;
  }
};

}  // namespace rhexis::record::store
