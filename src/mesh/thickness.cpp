#include <algorithm>
#include <limits>

#include <Eigen/Dense>

#include "mesh/quality.h"
#include "mesh/surface.h"

namespace rhexis::mesh {
namespace {

/// For every face of every tet the face of the tet behind it; an invalid tet at the boundary.
using FaceMates = std::vector<std::array<TetFace, 4>>;

FaceMates face_mates(const TetMesh& mesh, const FaceTable& faces) {
  FaceMates mates(mesh.tet_count());
  for (const auto& [first, second] : faces.interior) {
    mates[first.tet.index()][first.vertex] = second;
    mates[second.tet.index()][second.vertex] = first;
  }
  return mates;
}

struct Ray {
  Vec3 from;
  Vec3 direction;  ///< unit
};

/// Distance along the ray to the plane of a face that the ray leaves through; infinity for faces it enters by.
double distance_to(const TetMesh& mesh, TetFace face, const Ray& ray) {
  const auto [a, b, c] = face_nodes(mesh, face);
  const Vec3 outward = (mesh.node(b) - mesh.node(a)).cross(mesh.node(c) - mesh.node(a));
  const double slope = outward.dot(ray.direction);
  if (!(slope > 0.0)) return std::numeric_limits<double>::infinity();
  return outward.dot(mesh.node(a) - ray.from) / slope;
}

/// Steps that all rays may take together, per tet. A sound mesh needs 2 to 10; a folded one can send a ray in circles.
constexpr std::size_t kStepsPerTet = 100;

/// Length of the ray inside the body, walked from tet to tet; negative when it got lost among flat tets, or no steps
/// are left. No search structure is needed, and coincident but unconnected faces (a slit) end the ray as they should.
double chord(const TetMesh& mesh, const FaceMates& mates, TetFace entry, const Ray& ray, std::size_t& steps_left) {
  for (std::size_t step = 0; step < mesh.tet_count() && steps_left > 0; ++step, --steps_left) {
    TetFace exit{entry.tet, -1};
    double length = std::numeric_limits<double>::infinity();
    for (std::int8_t k = 0; k < 4; ++k) {
      if (k == entry.vertex) continue;
      const double distance = distance_to(mesh, {entry.tet, k}, ray);
      if (distance < length) {
        length = distance;
        exit.vertex = k;
      }
    }
    if (exit.vertex < 0) return -1.0;
    const TetFace next = mates[exit.tet.index()][exit.vertex];
    if (!next.tet.valid()) return length;
    entry = next;
  }
  return -1.0;
}

}  // namespace

double thickness(const TetMesh& mesh) {
  const FaceTable faces = find_faces(mesh);
  const FaceMates mates = face_mates(mesh, faces);
  std::vector<std::pair<double, double>> chords;  // (length, area)
  chords.reserve(faces.boundary.size());
  double total = 0.0;
  std::size_t steps_left = kStepsPerTet * mesh.tet_count();
  for (const TetFace face : faces.boundary) {
    const auto [a, b, c] = face_nodes(mesh, face);
    const Vec3 twice_area = (mesh.node(b) - mesh.node(a)).cross(mesh.node(c) - mesh.node(a));
    const double area = 0.5 * twice_area.norm();
    if (!(area > 0.0)) continue;
    const double length = chord(
        mesh, mates, face, {(mesh.node(a) + mesh.node(b) + mesh.node(c)) / 3.0, -twice_area.normalized()}, steps_left);
    if (!(length > 0.0)) continue;
    chords.emplace_back(length, area);
    total += area;
  }
  std::sort(chords.begin(), chords.end());
  double below = 0.0;
  for (const auto& [length, area] : chords) {
    below += area;
    if (below >= kThicknessShare * total) return length;
  }
  return 0.0;
}

}  // namespace rhexis::mesh
