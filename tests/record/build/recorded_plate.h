#pragma once

/// The plate of the thesis, coarse, with a crack that may turn three ways, twice.

#include <gtest/gtest.h>

#include "mesh/generate.h"
#include "record/build/campaign.h"

namespace rhexis::record::build::test {

/// Held at +x. `loaded`: under its weight and a force at every node, with a support that moves.
inline CampaignRequest plate(int nodes, bool loaded) {
  CampaignRequest request;
  request.mesh = *mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, nodes);
  request.elastic.elastic = {.young = 1.0e6, .poisson = 0.4};
  for (const NodeId node : request.mesh.find_node_set("+x")->nodes) {
    for (std::int32_t c = 0; c < 3; ++c)
      request.elastic.supports.push_back({3 * node.value() + c, loaded && c == 0 ? 1e-3 : 0.0});
  }
  if (loaded) {
    request.elastic.density = 1000.0;
    request.elastic.gravity = Vec3(0.0, 1.0, -9.81);
    request.elastic.dead_force = VectorX::Constant(static_cast<Eigen::Index>(3 * request.mesh.node_count()), 1e-4);
    for (const model::PrescribedDof& support : request.elastic.supports) request.elastic.dead_force[support.dof] = 0.0;
  }
  request.crack = {Vec3(0.12, 0.0, 0.0), Vec3(0.12, 0.06, 0.0), Vec3::UnitZ()};
  request.parameters.directions = 3;
  request.program = "rhexis test";
  request.title = "Plate";
  return request;
}

/// The torn body of a topology, by its advances from the start.
inline TornState torn(const CampaignRequest& request, int number) {
  TornState state = *TornState::begin(request.mesh, request.elastic, request.crack);
  const store::Frame frame = frame_of(request.crack);
  for (const store::Choice& choice : store::Numbering(request.parameters).choices(number))
    state.advance(
        frame.direction(store::direction_angles(request.parameters)[static_cast<std::size_t>(choice.direction)]),
        request.parameters.lengths[static_cast<std::size_t>(choice.length)]);
  return state;
}

}  // namespace rhexis::record::build::test
