#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "mesh/body_request.h"
#include "mesh/extrude.h"
#include "mesh/generate.h"
#include "mesh/generated_sets.h"
#include "mesh/surface.h"

namespace rhexis::mesh {
namespace {

Expected<void> check_tube(const TubeShape& shape) {
  if (!usable_length(shape.radius))
    return fail(fmt::format("radius = {} is no length", shape.radius), "positive metres");
  if (!usable_length(shape.length))
    return fail(fmt::format("length = {} is no length", shape.length), "positive metres");
  if (!(shape.wall >= 0.0 && shape.wall < shape.radius))
    return fail(fmt::format("wall = {} does not fit into radius = {}", shape.wall, shape.radius),
                "0 for a solid rod, else less than the radius");
  // The inner side of the bend must not run into itself, nor the tube into its own beginning.
  const double most = std::min(360.0, shape.length / shape.radius * 180.0 / std::numbers::pi);
  if (!(std::abs(shape.bend) < most))
    return fail(fmt::format("bend = {} degrees is too sharp for this tube", shape.bend),
                fmt::format("less than {:.4g}", most));
  return {};
}

/// Where a point of the section lies when the section has moved by `way` (m) along the centre line: an arc that starts
/// along z and turns by `bend` degrees towards x over the length of the tube.
Vec3 along_centre_line(const TubeShape& shape, const Point2& point, double way) {
  if (shape.bend == 0.0) return {point[0], point[1], way};
  const double curvature = shape.bend * std::numbers::pi / 180.0 / shape.length;
  const double angle = curvature * way;
  const double half = std::sin(0.5 * angle);  // 1 - cos(angle) = 2 half^2 keeps its digits for slight bends
  return {point[0] * std::cos(angle) + 2.0 * half * half / curvature, point[1],
          (1.0 / curvature - point[0]) * std::sin(angle)};
}

/// "bottom", "top", "outer" and, with a wall, "inner". A face on the rim of an end has all its nodes on "outer", too:
/// the ends come first.
void add_tube_sides(TetMesh& mesh, const PlaneMesh& section, int layers) {
  const std::size_t points = section.points.size();
  const auto layer_of = [&](NodeId n) { return n.index() / points; };
  const auto rim_of = [&](NodeId n) { return section.rim[n.index() % points]; };
  std::vector<TetFace> bottom;
  std::vector<TetFace> top;
  std::vector<TetFace> outer;
  std::vector<TetFace> inner;
  for (const TetFace face : find_faces(mesh).boundary) {
    const auto nodes = face_nodes(mesh, face);
    const auto all = [&](const auto& condition) { return std::all_of(nodes.begin(), nodes.end(), condition); };
    if (all([&](NodeId n) { return layer_of(n) == 0; }))
      bottom.push_back(face);
    else if (all([&](NodeId n) { return layer_of(n) == static_cast<std::size_t>(layers); }))
      top.push_back(face);
    else if (rim_of(nodes[0]) == Rim::outer)
      outer.push_back(face);
    else
      inner.push_back(face);
  }
  add_surface(mesh, "bottom", std::move(bottom));
  add_surface(mesh, "top", std::move(top));
  add_surface(mesh, "outer", std::move(outer));
  if (!inner.empty()) add_surface(mesh, "inner", std::move(inner));
}

}  // namespace

Expected<TetMesh> make_tube(const TubeShape& shape, int nodes) {
  if (auto good = check_tube(shape); !good) return fail(good.error());
  std::unique_ptr<PlaneSection> section;
  if (shape.wall > 0.0)
    section = std::make_unique<AnnulusSection>(shape.radius, shape.radius - shape.wall);
  else
    section = std::make_unique<DiscSection>(shape.radius);
  const auto plan_for = [&](int count) { return plan_extrusion(*section, shape.length, count); };
  const auto plan = nodes > kMaxGeneratedNodes ? std::nullopt : plan_for(nodes);
  if (!plan) return no_such_count("tube", nodes, [&](int count) { return plan_for(count).has_value(); });
  const PlaneMesh plane = section->mesh(plan->points);
  TetMesh mesh = extrude(plane, plan->layers, [&](const Point2& point, int layer) {
    return along_centre_line(shape, point, part_of(shape.length, layer, plan->layers));
  });
  add_tube_sides(mesh, plane, plan->layers);
  return mesh;
}

}  // namespace rhexis::mesh
