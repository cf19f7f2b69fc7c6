#include "mesh/io/msh_input.h"

#include <algorithm>
#include <array>

namespace rhexis::mesh::io {
namespace {

constexpr std::array<ElementKind, 32> kKinds{{{1, 1, 2, 1, "lines"},
                                              {2, 2, 3, 1, "triangles"},
                                              {3, 2, 4, 1, "quadrangles"},
                                              {4, 3, 4, 1, "tetrahedra"},
                                              {5, 3, 8, 1, "hexahedra"},
                                              {6, 3, 6, 1, "prisms"},
                                              {7, 3, 5, 1, "pyramids"},
                                              {8, 1, 3, 2, "second-order lines"},
                                              {9, 2, 6, 2, "second-order triangles"},
                                              {10, 2, 9, 2, "second-order quadrangles"},
                                              {11, 3, 10, 2, "second-order tetrahedra"},
                                              {12, 3, 27, 2, "second-order hexahedra"},
                                              {13, 3, 18, 2, "second-order prisms"},
                                              {14, 3, 14, 2, "second-order pyramids"},
                                              {15, 0, 1, 1, "points"},
                                              {16, 2, 8, 2, "second-order quadrangles"},
                                              {17, 3, 20, 2, "second-order hexahedra"},
                                              {18, 3, 15, 2, "second-order prisms"},
                                              {19, 3, 13, 2, "second-order pyramids"},
                                              {20, 2, 9, 3, "third-order triangles"},
                                              {21, 2, 10, 3, "third-order triangles"},
                                              {22, 2, 12, 4, "fourth-order triangles"},
                                              {23, 2, 15, 4, "fourth-order triangles"},
                                              {24, 2, 15, 5, "fifth-order triangles"},
                                              {25, 2, 21, 5, "fifth-order triangles"},
                                              {26, 1, 4, 3, "third-order lines"},
                                              {27, 1, 5, 4, "fourth-order lines"},
                                              {28, 1, 6, 5, "fifth-order lines"},
                                              {29, 3, 20, 3, "third-order tetrahedra"},
                                              {30, 3, 35, 4, "fourth-order tetrahedra"},
                                              {31, 3, 56, 5, "fifth-order tetrahedra"},
                                              {92, 3, 64, 3, "third-order hexahedra"}}};
constexpr int kTetrahedron = 4;

}  // namespace

void NodeTags::add(std::int64_t tag, int line) {
  tags_.push_back(tag);
  lines_.push_back(line);
}

void NodeTags::finish() {
  bool consecutive = true;
  for (std::size_t i = 1; i < tags_.size() && consecutive; ++i) consecutive = tags_[i] == tags_[i - 1] + 1;
  if (consecutive) return;
  for (std::size_t i = 0; i < tags_.size(); ++i) sorted_.emplace_back(tags_[i], NodeId(i));
  std::sort(sorted_.begin(), sorted_.end());
  const auto same = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                       [](const auto& a, const auto& b) { return a.first == b.first; });
  if (same != sorted_.end()) {
    refuse(fmt::format("node {} is there twice", same->first), "number every node once",
           lines_[(same + 1)->second.index()]);
  }
}

NodeId NodeTags::find(std::int64_t tag) const {
  if (tags_.empty()) return {};
  if (sorted_.empty()) {
    // Subtracting as unsigned, so that no tag can overflow.
    const std::uint64_t place = static_cast<std::uint64_t>(tag) - static_cast<std::uint64_t>(tags_.front());
    return place < tags_.size() ? NodeId(static_cast<std::size_t>(place)) : NodeId();
  }
  const auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(tag, NodeId()));
  return at != sorted_.end() && at->first == tag ? at->second : NodeId();
}

const ElementKind& element_kind(std::int64_t type, const Cursor& cursor) {
  const auto at =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const ElementKind& kind) { return kind.type == type; });
  if (at == kKinds.end()) cursor.refuse(fmt::format("element type {} is not known", type));
  return *at;
}

void check_kind(const ElementKind& kind, std::int64_t element, const Cursor& cursor) {
  if (kind.dimension < 3 || kind.type == kTetrahedron) return;
  cursor.refuse(fmt::format("element {}: {} are not read", element, kind.name),
                kind.nodes == 4 || std::string_view(kind.name).find("tetra") != std::string_view::npos
                    ? "mesh with elements of first order: gmsh -order 1"
                    : "mesh the volume with linear tetrahedra");
}

std::int64_t MshInput::integer(std::string_view wanted) {
  return binary ? cursor.binary_value<std::int32_t>(swap, wanted) : cursor.integer<std::int32_t>(wanted);
}

std::int64_t MshInput::size(std::string_view wanted) {
  const std::int64_t value = binary ? cursor.binary_value<std::int64_t>(swap, wanted) : cursor.integer(wanted);
  if (value < 0) cursor.refuse(fmt::format("{} is {}", wanted, value), "it should not be negative");
  return value;
}

double MshInput::real(std::string_view wanted) {
  return binary ? cursor.binary_value<double>(swap, wanted) : cursor.number(wanted);
}

void MshInput::begin_record(std::string_view what) {
  if (!binary) cursor.begin_record(what);
}

void MshInput::end_record(std::string_view what) {
  if (!binary) cursor.end_record(what);
}

void MshInput::read_position(std::int64_t tag) {
  Vec3 x;
  for (int k = 0; k < 3; ++k) x[k] = real("a coordinate");
  if (!x.allFinite()) {
    cursor.refuse(fmt::format("node {} lies at ({}, {}, {})", tag, x[0], x[1], x[2]), "coordinates have to be finite");
  }
  mesh.nodes.push_back(x);
}

RawGroup& MshInput::group(int dimension, std::int64_t physical, std::string name) {
  const auto [at, is_new] = group_index_.emplace(std::pair(dimension, physical), mesh.groups.size());
  if (is_new) {
    if (name.empty()) name = fmt::format("physical-{}-{}", dimension, physical);
    mesh.groups.push_back({std::move(name), dimension, {}, {}});
  }
  return mesh.groups[at->second];
}

void MshInput::add_element(const ElementKind& kind, const std::vector<NodeId>& nodes,
                           const std::vector<std::int64_t>& physicals) {
  for (const std::int64_t physical : physicals) {
    RawGroup& members = group(kind.dimension, physical);
    members.nodes.insert(members.nodes.end(), nodes.begin(), nodes.end());
    if (kind.nodes == 3 && kind.dimension == 2) members.triangles.push_back({nodes[0], nodes[1], nodes[2]});
  }
  if (kind.type == kTetrahedron) {
    mesh.tets.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
  } else if (physicals.empty()) {
    ++mesh.left_out[fmt::format("{} of no physical group", kind.name)];
  }
}

NodeId MshInput::node(std::int64_t tag, std::int64_t element) {
  const NodeId found = tags.find(tag);
  if (!found.valid()) cursor.refuse(fmt::format("element {} names node {}, which does not exist", element, tag));
  return found;
}

}  // namespace rhexis::mesh::io
