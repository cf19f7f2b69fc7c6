#pragma once

/// Reading and writing meshes and results by the name's ending:
///   .msh (Gmsh 2.2 and 4.1, ASCII and binary), .vtu (ASCII, base64, appended raw or base64, zlib), .vtk (legacy, ASCII
///   and binary), .vtkhdf (VTKHDF 1); each also with .gz behind it. Written: .vtkhdf, .vtu, .msh.

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/field.h"
#include "mesh/tet_mesh.h"

namespace rhexis::mesh {

struct MeshFile {
  TetMesh mesh;                    ///< in the file's order; tets are positively oriented
  std::vector<Field> fields;       ///< PointData and CellData over the nodes and tets kept, in the file's order
  std::vector<std::string> notes;  ///< what was repaired or left out on reading, one line each, for the log
};

struct ReadOptions {
  double unit = 1.0;  ///< metres per unit of the file
};

/// Every error names the file, and the line for text formats. Higher-order tets, other cell kinds and points that no
/// tet uses are refused or left out with a note as docs/meshes.md says. Defects of the mesh (flat, duplicate tets, ...)
/// are not looked for here: see mesh/validate.h. Nothing a file holds can crash the program or exhaust memory: counts
/// are checked against the file's size before anything is allocated.
Expected<MeshFile> read_mesh_file(const std::filesystem::path& path, const ReadOptions& options = {});
/// The bytes of such a file as they are: what io::parse_mesh takes. Errors: none, not a file, larger than 8 GiB.
Expected<std::string> read_mesh_bytes(const std::filesystem::path& path);

/// Writes by the ending of `path`, whole or not at all. MSH keeps sets as physical groups and drops fields.
/// Errors: an ending that cannot be written, a folder that cannot be written to, a field of the wrong size.
Expected<void> write_mesh_file(const std::filesystem::path& path, const TetMesh& mesh,
                               const std::vector<Field>& fields = {});

/// `steps.pvd`: a ParaView series; `value` is what its time slider shows, `file` relative to the .pvd.
struct SeriesEntry {
  double value = 0.0;
  std::string file;
};
Expected<void> write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries);

}  // namespace rhexis::mesh
