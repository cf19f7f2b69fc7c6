#include "mesh/extrude.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/body_request.h"
#include "mesh/generated_sets.h"

namespace rhexis::mesh {
namespace {

/// Height over edge length at which the three tets of an equilateral prism have the largest mean radius ratio, 0.79.
constexpr double kBestPrismAspect = 0.85;
/// The node count is met within this share.
constexpr double kCountTolerance = 0.02;

}  // namespace

std::optional<ExtrusionPlan> plan_extrusion(const PlaneSection& section, double height, int nodes) {
  std::optional<ExtrusionPlan> best;
  double best_cost = 0.0;
  for (int layers = 1; 3 * (layers + 1) <= nodes; ++layers) {
    const int points = (nodes + (layers + 1) / 2) / (layers + 1);
    const double off = std::abs(points * (layers + 1.0) - nodes);
    if (off > kCountTolerance * nodes) continue;
    const auto edge = section.edge_length(points);
    if (!edge) continue;
    const double aspect = height / layers / *edge;
    if (aspect < 1.0 / kMaxPrismAspect) break;  // more layers leave fewer points a layer: prisms get only flatter
    if (aspect > kMaxPrismAspect) continue;
    const double cost = std::abs(std::log(aspect / kBestPrismAspect));
    if (best && cost >= best_cost) continue;
    best = {points, layers};
    best_cost = cost;
  }
  return best;
}

TetMesh extrude(const PlaneMesh& section, int layers,
                const std::function<Vec3(const Point2& point, int layer)>& place) {
  const std::size_t points = section.points.size();
  TetMesh mesh;
  mesh.nodes.reserve(points * static_cast<std::size_t>(layers + 1));
  for (int k = 0; k <= layers; ++k)
    for (const Point2& point : section.points) mesh.nodes.push_back(place(point, k));

  mesh.tets.reserve(3 * section.triangles.size() * static_cast<std::size_t>(layers));
  for (std::size_t k = 0; k < static_cast<std::size_t>(layers); ++k)
    for (const Triangle& triangle : section.triangles) {
      // Ranked columns: the diagonal between two of them leads from the foot of the lower to the head of the higher
      // rank. Neighbouring prisms agree on it, and ranks have no cycles, which is when a prism can be cut in three.
      std::array<std::pair<double, std::size_t>, 3> ranked;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto column = static_cast<std::size_t>(triangle[i]);
        ranked[i] = {hashed_fraction(column, k), column};
      }
      std::sort(ranked.begin(), ranked.end());
      const auto foot = [&](std::size_t i) { return NodeId(k * points + ranked[i].second); };
      const auto head = [&](std::size_t i) { return NodeId((k + 1) * points + ranked[i].second); };
      add_oriented_tet(mesh, {foot(0), foot(1), foot(2), head(2)});
      add_oriented_tet(mesh, {foot(0), foot(1), head(1), head(2)});
      add_oriented_tet(mesh, {foot(0), head(0), head(1), head(2)});
    }
  return mesh;
}

}  // namespace rhexis::mesh
