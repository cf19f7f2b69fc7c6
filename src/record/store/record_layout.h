#pragma once

/// Names in the file of a record (docs/record-format.md).

#include <cstdint>

namespace rhexis::record::store {

inline constexpr const char* kRecordFormat = "rhexis record";
/// Of the file. A change of what a reader has to know makes a new one.
inline constexpr std::int64_t kRecordVersion = 1;

namespace name {
inline constexpr const char* kFormat = "format";  // attributes of the root
inline constexpr const char* kVersion = "version";
inline constexpr const char* kFingerprint = "fingerprint";
inline constexpr const char* kProgram = "program";
inline constexpr const char* kTitle = "title";
inline constexpr const char* kAdvances = "advances";
inline constexpr const char* kPullLength = "pull_length";
inline constexpr const char* kParameters = "parameters";
inline constexpr const char* kDirections = "directions";
inline constexpr const char* kLengths = "lengths";
inline constexpr const char* kPullDirections = "pull_directions";
inline constexpr const char* kFrame = "frame";
inline constexpr const char* kMesh = "mesh";
inline constexpr const char* kNodes = "nodes";
inline constexpr const char* kTets = "tets";
inline constexpr const char* kGrasp = "grasp";
inline constexpr const char* kPoints = "points";
inline constexpr const char* kEdges = "edges";
inline constexpr const char* kOperator = "operator";
inline constexpr const char* kDof = "dof";
inline constexpr const char* kStart = "start";
inline constexpr const char* kRow = "row";
inline constexpr const char* kFactor = "factor";
inline constexpr const char* kTopologies = "topologies";
inline constexpr const char* kFlags = "flags";
inline constexpr const char* kInSolve = "in_solve";
inline constexpr const char* kStiffness = "stiffness";
inline constexpr const char* kCompliance = "compliance";
inline constexpr const char* kRest = "rest";
inline constexpr const char* kEdits = "edits";
inline constexpr const char* kMovedStart = "moved_start";
inline constexpr const char* kMovedNode = "moved_node";
inline constexpr const char* kMovedTo = "moved_to";
inline constexpr const char* kGoneStart = "gone_start";
inline constexpr const char* kGoneTet = "gone_tet";
inline constexpr const char* kFrozenStart = "frozen_start";
inline constexpr const char* kFrozenTet = "frozen_tet";
}  // namespace name

}  // namespace rhexis::record::store
