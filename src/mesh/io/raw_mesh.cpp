#include "mesh/io/raw_mesh.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "mesh/io/read_failure.h"
#include "mesh/surface.h"
#include "mesh/validate.h"

namespace rhexis::mesh::io {
namespace {

template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

using Triangle = std::array<NodeId, 3>;
Triangle sorted(Triangle triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

/// Finds the boundary face with three given nodes, in any order.
class BoundaryLookup {
 public:
  explicit BoundaryLookup(const TetMesh& mesh) {
    for (const TetFace face : find_faces(mesh).boundary) entries_.push_back({sorted(face_nodes(mesh, face)), face});
    std::sort(entries_.begin(), entries_.end());
  }
  /// nullptr when the triangle is no boundary face.
  [[nodiscard]] const TetFace* find(const Triangle& triangle) const {
    const Triangle key = sorted(triangle);
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), key,
                                     [](const Entry& entry, const Triangle& value) { return entry.first < value; });
    return at != entries_.end() && at->first == key ? &at->second : nullptr;
  }

 private:
  using Entry = std::pair<Triangle, TetFace>;
  std::vector<Entry> entries_;
};

/// One group for each name, in the order of first appearance.
std::vector<RawGroup> merge_by_name(std::vector<RawGroup> groups, std::vector<std::string>& notes) {
  std::vector<RawGroup> merged;
  std::map<std::string, std::size_t> place;
  for (RawGroup& group : groups) {
    group.name = printable(group.name);
    const auto [at, is_new] = place.emplace(group.name, merged.size());
    if (is_new) {
      merged.push_back(std::move(group));
      continue;
    }
    RawGroup& first = merged[at->second];
    if (first.dimension != group.dimension) {
      notes.push_back(
          fmt::format("groups of different dimension share the name {}: its node set holds the nodes of all",
                      in_quotes(group.name)));
    }
    first.nodes.insert(first.nodes.end(), group.nodes.begin(), group.nodes.end());
    first.triangles.insert(first.triangles.end(), group.triangles.begin(), group.triangles.end());
  }
  return merged;
}

void make_sets(std::vector<RawGroup> groups, MeshFile& out) {
  groups = merge_by_name(std::move(groups), out.notes);
  const bool has_surfaces =
      std::any_of(groups.begin(), groups.end(), [](const RawGroup& g) { return !g.triangles.empty(); });
  const BoundaryLookup boundary(has_surfaces ? out.mesh : TetMesh{});
  for (RawGroup& group : groups) {
    if (group.nodes.empty()) {
      out.notes.push_back(fmt::format("group {} holds no element: left out", in_quotes(group.name)));
      continue;
    }
    std::vector<TetFace> faces;
    std::size_t stray = 0;
    for (const Triangle& triangle : group.triangles) {
      if (const TetFace* face = boundary.find(triangle))
        faces.push_back(*face);
      else
        ++stray;
    }
    if (stray > 0) {
      out.notes.push_back(fmt::format("{} of {} triangles of {} are no boundary face of the tets: in its node set only",
                                      stray, group.triangles.size(), in_quotes(group.name)));
    }
    sort_unique(group.nodes);
    sort_unique(faces);
    if (!faces.empty()) out.mesh.face_sets.push_back({group.name, std::move(faces)});
    out.mesh.node_sets.push_back({std::move(group.name), std::move(group.nodes)});
  }
}

void note_unused_nodes(MeshFile& out) {
  std::vector<bool> used(out.mesh.nodes.size(), false);
  for (const Tet& tet : out.mesh.tets) {
    for (const NodeId node : tet) used[node.index()] = true;
  }
  const auto unused = std::count(used.begin(), used.end(), false);
  if (unused == 0) return;
  const auto first = std::find(used.begin(), used.end(), false) - used.begin();
  out.notes.push_back(
      fmt::format("{} nodes belong to no tet (the first is {}): kept, as nodes that do not move", unused, first));
}

void note_not_finite(MeshFile& out) {
  for (const Field& field : out.fields) {
    const auto bad =
        std::count_if(field.values.begin(), field.values.end(), [](double v) { return !std::isfinite(v); });
    if (bad > 0)
      out.notes.push_back(fmt::format("field {} holds {} values that are not finite", in_quotes(field.name), bad));
  }
}

}  // namespace

void check_count(std::uint64_t count, std::string_view things, int line) {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
  if (count > kMost)
    refuse(fmt::format("{} {} are more than {} can be counted", count, things, kMost), "cut the mesh", line);
}

MeshFile finish(RawMesh raw, const ReadOptions& options) {
  std::vector<std::string> left_out;
  for (const auto& [kind, count] : raw.left_out) left_out.push_back(fmt::format("{} {}", count, kind));
  if (raw.tets.empty()) {
    refuse(left_out.empty() ? "it holds no tetrahedron"
                            : fmt::format("it holds no tetrahedron, only {}", fmt::join(left_out, ", ")),
           "mesh the volume, and save linear tetrahedra");
  }
  MeshFile out;
  out.notes = std::move(raw.notes);
  out.fields = std::move(raw.fields);
  for (Field& field : out.fields) field.name = printable(field.name);
  out.mesh.nodes = std::move(raw.nodes);
  out.mesh.tets = std::move(raw.tets);
  for (std::size_t i = 0; i < out.mesh.nodes.size(); ++i) {
    Vec3& x = out.mesh.nodes[i];
    x *= options.unit;
    if (!x.allFinite())
      refuse(fmt::format("node {} lies at ({}, {}, {})", i, x[0], x[1], x[2]), "coordinates have to be finite");
  }
  if (!left_out.empty()) {
    out.notes.push_back(fmt::format("left out: {} (the body is made of linear tetrahedra)", fmt::join(left_out, ", ")));
  }
  if (const std::size_t turned = orient_tets(out.mesh); turned > 0) {
    out.notes.push_back(
        fmt::format("{} of {} tets were inside out: two nodes of each swapped", turned, out.mesh.tets.size()));
  }
  note_unused_nodes(out);
  note_not_finite(out);
  make_sets(std::move(raw.groups), out);
  return out;
}

}  // namespace rhexis::mesh::io
