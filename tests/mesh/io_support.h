#pragma once

/// Meshes and files for the tests of mesh/io.

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "mesh/io/mesh_file.h"
#include "mesh/validate.h"

namespace rhexis::mesh::test {

/// An empty folder that goes away with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rhexis-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// For names of parameterised tests, which allow no dot.
inline std::string with_underscores(std::string name) {
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A bar of n cubes of six tets each, with coordinates that decimals cannot hold, sets of every kind, and a node that
/// no tet uses.
inline TetMesh awkward_bar(int n) {
  TetMesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k < 4; ++k)
      mesh.nodes.emplace_back(i / 3.0 + 1e-17 * k, (k & 1) * std::sqrt(2.0), (k >> 1) * 1e-301 / 7.0 + (k >> 1) * 0.1);
  }
  constexpr int kCube[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};
  for (int i = 0; i < n; ++i) {
    for (const auto& t : kCube)
      mesh.tets.push_back({NodeId(4 * i + t[0]), NodeId(4 * i + t[1]), NodeId(4 * i + t[2]), NodeId(4 * i + t[3])});
  }
  orient_tets(mesh);
  mesh.nodes.emplace_back(-0.1, std::nextafter(1.0, 2.0), 4.9e-324);
  const auto last = static_cast<int>(mesh.nodes.size()) - 2;
  NodeSet body{"body", {}};
  for (int i = 0; i <= last; ++i) body.nodes.emplace_back(i);
  mesh.node_sets.push_back({"a point", {NodeId(2)}});
  mesh.node_sets.push_back(body);
  mesh.node_sets.push_back({"-x", {NodeId(0), NodeId(1), NodeId(2), NodeId(3)}});
  mesh.node_sets.push_back({"also all", body.nodes});
  // The end x = 0 is made of the faces 0 1 3 and 0 2 3; which vertex they are opposite to depends on the orientation.
  FaceSet end{"-x", {}};
  for (int t = 0; t < 6; ++t) {
    for (std::int8_t k = 0; k < 4; ++k) {
      const auto nodes = face_nodes(mesh, {TetId(t), k});
      if (std::all_of(nodes.begin(), nodes.end(), [](NodeId node) { return node.value() < 4; }))
        end.faces.push_back({TetId(t), k});
    }
  }
  mesh.face_sets.push_back(end);
  return mesh;
}

inline std::vector<Field> awkward_fields(const TetMesh& mesh) {
  std::vector<Field> fields{{"u <&\"> v", Centering::point, 3, {}},
                            {"lambda", Centering::cell, 1, {}},
                            {"stress", Centering::cell, 6, {}},
                            {"lambda", Centering::point, 1, {}}};
  for (Field& field : fields) {
    const std::size_t entities = field.centering == Centering::point ? mesh.node_count() : mesh.tet_count();
    for (std::size_t i = 0; i < entities * static_cast<std::size_t>(field.components); ++i) {
      field.values.push_back(std::sin(static_cast<double>(i) + 0.1) *
                             std::pow(10.0, static_cast<double>(i % 37) * 16 - 290));
    }
  }
  return fields;
}

}  // namespace rhexis::mesh::test
