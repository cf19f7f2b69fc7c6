#pragma once

/// One writer a format, each into memory. What may be written has been checked before (mesh_file.cpp).

#include <string>
#include <vector>

#include "mesh/io/mesh_file.h"

namespace rhexis::mesh::io {

/// Gmsh 2.2, ASCII.
[[nodiscard]] std::string format_msh(const TetMesh& mesh);
/// Appended base64, zlib, little endian.
[[nodiscard]] std::string format_vtu(const TetMesh& mesh, const std::vector<Field>& fields);
/// VTKHDF 1.0.
[[nodiscard]] Expected<std::string> format_vtkhdf(const TetMesh& mesh, const std::vector<Field>& fields);

}  // namespace rhexis::mesh::io
