#pragma once

/// What every reader fills, whatever the format, and the one place where it becomes a TetMesh.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "mesh/io/mesh_file.h"

namespace rhexis::mesh::io {

/// What a file gathers under one name.
struct RawGroup {
  std::string name;
  int dimension = 0;                             ///< 0 points, 1 lines, 2 surfaces, 3 volumes
  std::vector<NodeId> nodes;                     ///< of all its elements, in any order, with repetitions
  std::vector<std::array<NodeId, 3>> triangles;  ///< those of a surface
};

struct RawMesh {
  std::vector<Vec3> nodes;                      ///< in the file's unit
  std::vector<Tet> tets;                        ///< in any orientation; indices are in range
  std::vector<RawGroup> groups;                 ///< in the order in which they become sets
  std::vector<Field> fields;                    ///< of the right size for nodes and tets
  std::map<std::string, std::size_t> left_out;  ///< cells that no use was found for, by kind
  std::vector<std::string> notes;
};

/// Refuses more than the typed indices can count. `things` for the message.
void check_count(std::uint64_t count, std::string_view things, int line = 0);

/// Scales, orients the tets, matches surface triangles with boundary faces, and makes sets of groups. Groups of one
/// name become one set. Throws ReadFailure when there is no tet, or a coordinate is not finite.
[[nodiscard]] MeshFile finish(RawMesh raw, const ReadOptions& options);

}  // namespace rhexis::mesh::io
