#include "mesh/body_request.h"
#include "mesh/extrude.h"
#include "mesh/generate.h"
#include "mesh/generated_sets.h"

namespace rhexis::mesh {

Expected<TetMesh> make_plate(const BoxShape& shape, int nodes) {
  if (auto good = check_box(shape.size); !good) return fail(good.error());
  const RectangleSection section(shape.size[0], shape.size[1]);
  const double height = shape.size[2];
  const auto plan_for = [&](int count) { return plan_extrusion(section, height, count); };
  const auto plan = nodes > kMaxGeneratedNodes ? std::nullopt : plan_for(nodes);
  if (!plan) return no_such_count("plate", nodes, [&](int count) { return plan_for(count).has_value(); });
  TetMesh mesh = extrude(section.mesh(plan->points), plan->layers, [&](const Point2& point, int layer) {
    return Vec3(point[0], point[1], part_of(height, layer, plan->layers));
  });
  add_box_sides(mesh, shape.size);
  return mesh;
}

}  // namespace rhexis::mesh
