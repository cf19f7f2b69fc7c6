#pragma once

/// One reader a format, each from memory: files, fuzzers and tests feed them alike. `file` is the name for messages.

#include <string>
#include <string_view>

#include "mesh/io/mesh_file.h"

namespace rhexis::mesh::io {

Expected<MeshFile> parse_msh(std::string_view bytes, const std::string& file, const ReadOptions& options = {});
Expected<MeshFile> parse_vtu(std::string_view bytes, const std::string& file, const ReadOptions& options = {});
Expected<MeshFile> parse_vtk(std::string_view bytes, const std::string& file, const ReadOptions& options = {});
Expected<MeshFile> parse_vtkhdf(std::string_view bytes, const std::string& file, const ReadOptions& options = {});

/// By the ending of the name `file` (.gz is unpacked first).
Expected<MeshFile> parse_mesh(std::string_view bytes, const std::string& file, const ReadOptions& options = {});

}  // namespace rhexis::mesh::io
