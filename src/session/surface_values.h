#pragma once

/// What a client sees of the body at one moment: where its surface is, and a field on it.

#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/torn_mesh.h"
#include "session/surface_tracker.h"
#include "wire/frame.h"

namespace rhexis::session {

/// out: 3 per vertex, m. `u`: m, 3 per node of the body.
void surface_displacement(const SurfaceTracker& surface, const VectorX& u, std::vector<float>& out);

/// Fields of stress, averaged to the vertices. Keeps what it needs from one moment to the next.
class SurfaceValues {
 public:
  /// Of `field` for the displacement `u`: out has one value a vertex, m or Pa; empty for Field::none. A stress is the
  /// average over the tets around the vertex that are alive, weighted by volume; no stress is in a frozen piece.
  /// `stress`: Cauchy, Pa, of a tet in the solve.
  void find(wire::Field field, const mesh::TornMesh& body, const std::function<Mat3(TetId)>& stress,
            const SurfaceTracker& surface, const VectorX& u, std::vector<float>& out);
  /// The body has another topology, or is another.
  void body_changed() { tets_.clear(); }

 private:
  std::vector<TetId> tets_;     ///< alive, with a vertex on the surface; empty: to be found
  std::vector<double> sum_;     ///< per node: value times volume
  std::vector<double> volume_;  ///< per node
};

}  // namespace rhexis::session
