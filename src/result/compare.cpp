#include "result/compare.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/check.h"
#include "mesh/io/mesh_file.h"

namespace rhexis::result {
namespace {

namespace fs = std::filesystem;
using mesh::Field;
using mesh::MeshFile;

/// The meshes count as the same when no node is further apart than this fraction of the body's largest side: text
/// formats may have rounded.
constexpr double kSamePosition = 1e-6;

fs::path result_file(const fs::path& given) { return fs::is_directory(given) ? given / "result.vtkhdf" : given; }

Expected<void> check_same_mesh(const MeshFile& a, const MeshFile& b, const fs::path& name_a, const fs::path& name_b) {
  if (a.mesh.node_count() != b.mesh.node_count() || a.mesh.tet_count() != b.mesh.tet_count())
    return fail(fmt::format("{} nodes and {} tets, but '{}' has {} and {}", b.mesh.node_count(), b.mesh.tet_count(),
                            name_a.string(), a.mesh.node_count(), a.mesh.tet_count()),
                "compare results on the same mesh", name_b.string());
  for (std::size_t t = 0; t < a.mesh.tet_count(); ++t)
    if (a.mesh.tets[t] != b.mesh.tets[t])
      return fail(fmt::format("tet {} has other nodes than in '{}'", t, name_a.string()),
                  "compare results on the same mesh", name_b.string());
  const double allowed = kSamePosition * mesh::bounding_box(a.mesh).size().maxCoeff();
  for (std::size_t n = 0; n < a.mesh.node_count(); ++n)
    if ((a.mesh.nodes[n] - b.mesh.nodes[n]).norm() > allowed)
      return fail(fmt::format("node {} lies elsewhere than in '{}'", n, name_a.string()),
                  "compare results on the same mesh", name_b.string());
  return {};
}

FieldDifference difference(const Field& a, const Field& b) {
  FieldDifference d{.name = a.name, .centering = a.centering};
  const auto width = static_cast<std::size_t>(a.components);
  const std::size_t count = a.values.size() / width;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Map<const VectorX> va(a.values.data() + i * width, a.components);
    const Eigen::Map<const VectorX> vb(b.values.data() + i * width, b.components);
    const double apart = (vb - va).norm();
    if (!(apart <= d.largest)) {  // a NaN counts as the largest
      d.largest = apart;
      d.largest_at = i;
    }
    d.mean += apart / static_cast<double>(count);
    d.scale = std::max(d.scale, va.norm());
  }
  return d;
}

const Field* find_like(const std::vector<Field>& fields, const Field& wanted) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& field) {
    return field.name == wanted.name && field.centering == wanted.centering && field.components == wanted.components &&
           field.values.size() == wanted.values.size();
  });
  return found == fields.end() ? nullptr : &*found;
}

}  // namespace

BoxDifference box_difference(const Vec3& box, std::span<const double> a, std::span<const double> b) {
  RHEXIS_CHECK(a.size() == b.size() && a.size() % 3 == 0, "{} and {} components", a.size(), b.size());
  BoxDifference d;
  const std::size_t count = a.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 percent = 100.0 * (Eigen::Map<const Vec3>(b.data() + 3 * i) - Eigen::Map<const Vec3>(a.data() + 3 * i))
                                     .cwiseAbs()
                                     .cwiseQuotient(box);
    d.mean += percent / static_cast<double>(count);
    d.largest = d.largest.cwiseMax(percent);
  }
  return d;
}

Expected<Comparison> compare_results(const fs::path& a, const fs::path& b) {
  const fs::path name_a = result_file(a);
  const fs::path name_b = result_file(b);
  const Expected<MeshFile> file_a = mesh::read_mesh_file(name_a);
  if (!file_a) return fail(file_a.error());
  const Expected<MeshFile> file_b = mesh::read_mesh_file(name_b);
  if (!file_b) return fail(file_b.error());
  if (const Expected<void> same = check_same_mesh(*file_a, *file_b, name_a, name_b); !same) return fail(same.error());

  Comparison comparison;
  for (const Field& field : file_a->fields) {
    const Field* other = find_like(file_b->fields, field);
    if (other == nullptr) {
      comparison.only_in_one.push_back(field.name);
      continue;
    }
    comparison.fields.push_back(difference(field, *other));
    if (field.name == "displacement" && field.components == 3)
      comparison.displacement = box_difference(mesh::bounding_box(file_a->mesh).size(), field.values, other->values);
  }
  for (const Field& field : file_b->fields)
    if (find_like(file_a->fields, field) == nullptr) comparison.only_in_one.push_back(field.name);
  if (comparison.fields.empty())
    return fail(fmt::format("no field in common with '{}'", name_a.string()), "compare two results of `rhexis solve`",
                name_b.string());
  return comparison;
}

}  // namespace rhexis::result
