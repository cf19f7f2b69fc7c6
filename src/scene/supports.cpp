#include "scene/supports.h"

#include <cmath>

#include "scene/rigid_motion.h"

namespace rhexis::scene {
namespace {

/// Values closer than this, relative to the body's box, are the same value said in two ways ("50%" and metres).
constexpr double kSameValue = 1e-12;

struct Prescription {
  const SupportSettings* support = nullptr;  ///< nullptr: free, or a node without a tet
  double value = 0.0;                        ///< m
};

std::string name_of_node(const Body& body, const model::DisplacementSpace& space, std::int32_t node) {
  const auto vertices = static_cast<std::int32_t>(body.mesh.node_count());
  if (node < vertices) return fmt::format("node {}", node);
  const auto& ends = space.edges[static_cast<std::size_t>(node - vertices)];
  return fmt::format("the middle of nodes {} and {}", ends[0].value(), ends[1].value());
}

Expected<void> prescribe(const SupportSettings& support, const Body& body, const model::DisplacementSpace& space,
                         std::vector<Prescription>& dofs) {
  const Expected<std::vector<NodeId>> set = nodes_of(body, support.set, support.set_place);
  if (!set) return fail(set.error());
  const std::vector<std::int32_t> nodes = model::nodes_of_set(space, *set);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!support.displacement[axis]) continue;
    const auto [amount, relative] = *support.displacement[axis];
    const double value = relative ? amount * body.box.size()[static_cast<Eigen::Index>(axis)] : amount;
    for (const std::int32_t node : nodes) {
      if (static_cast<std::size_t>(node) < body.used.size() && !body.used[static_cast<std::size_t>(node)]) continue;
      Prescription& dof = dofs[3 * static_cast<std::size_t>(node) + axis];
      if (dof.support != nullptr && std::abs(dof.value - value) > kSameValue * body.box.size().maxCoeff())
        return support.displacement_place[axis].fail(
            fmt::format("{} of {} (set {}) is fixed at {} m, but at {} m by {} (set {})", "xyz"[axis],
                        name_of_node(body, space, node), in_quotes(support.set), value, dof.value,
                        dof.support->displacement_place[axis].describe(), in_quotes(dof.support->set)),
            "one value for each component of a node");
      if (dof.support == nullptr) dof = {&support, value};
    }
  }
  return {};
}

Expected<void> check_held(const Scene& scene, const Body& body, const std::vector<model::HeldComponent>& held) {
  const Vec3 centre = 0.5 * (body.box.from + body.box.to);
  const std::vector<std::string> motions = free_rigid_motions(held, centre, body.box.size().norm());
  if (motions.empty()) return {};
  if (scene.supports.empty()) return fail("nothing holds the body", "add a [[support]]", scene.file);
  std::string list;
  for (const std::string& motion : motions) list += (list.empty() ? "" : ", ") + motion;
  return scene.supports.front().place.fail("the supports leave the body a free rigid motion: " + list,
                                           "hold another component, or more nodes");
}

}  // namespace

Expected<std::vector<model::PrescribedDof>> make_supports(const Scene& scene, const Body& body,
                                                          const model::DisplacementSpace& space) {
  std::vector<Prescription> dofs(space.dof_count());
  for (const SupportSettings& support : scene.supports)
    if (Expected<void> done = prescribe(support, body, space, dofs); !done) return fail(std::move(done.error()));

  std::vector<model::PrescribedDof> supports;
  std::vector<model::HeldComponent> held;
  for (std::size_t dof = 0; dof < dofs.size(); ++dof) {
    const std::size_t node = dof / 3;
    const bool unused = node < body.used.size() && !body.used[node];
    if (dofs[dof].support != nullptr) held.push_back({space.nodes[node], static_cast<int>(dof % 3)});
    if (dofs[dof].support != nullptr || unused) supports.push_back({static_cast<std::int32_t>(dof), dofs[dof].value});
  }
  if (Expected<void> done = check_held(scene, body, held); !done) return fail(std::move(done.error()));
  return supports;
}

}  // namespace rhexis::scene
