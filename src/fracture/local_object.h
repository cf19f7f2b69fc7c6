#pragma once

/// The local object (sections 2.2, 4.1 of the thesis): the tets around a crack front, whose stress says whether the
/// crack runs on. Where the body's response gives the displacement of its boundary alone, it is solved by itself: FEM2,
/// K_oo u_o = f_o - K_ob u_b (4.7). Where the response is that of the torn body, and so gives the inside as well, that
/// solve would find the same once more, and the displacement is taken as it is. Made anew after each advance.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/vec.h"
#include "fracture/tet_stress.h"
#include "material/parameters.h"
#include "mesh/torn_mesh.h"

namespace rhexis::fracture {

/// What loads the body beside the hand.
struct LocalLoads {
  Vec3 body_force = Vec3::Zero();    ///< N/m^3: density times gravity
  std::span<const Vec3> node_force;  ///< N, per node of the body, or empty
};

/// Of one tet with the displacement of the body's nodes (m, 3 per node); `at_hand` is left to the caller.
[[nodiscard]] TetStress stress_of(const mesh::TornMesh& body, const material::Elastic& elastic, TetId tet,
                                  const VectorX& u);

class LocalObject {
 public:
  /// `tets`: in the solve, ascending (Surroundings::tets_near). `supported`: per node of the body, nonzero where a
  /// support gives any component of the displacement. `hand`: the nodes that are held. Nodes shared with tets in the
  /// solve outside, supported and held nodes are the boundary. Refers to nothing afterwards.
  LocalObject(const mesh::TornMesh& body, const material::Elastic& elastic, std::vector<TetId> tets,
              std::span<const std::uint8_t> supported, std::span<const NodeId> hand, const LocalLoads& loads = {});
  ~LocalObject();
  LocalObject(LocalObject&&) noexcept;
  LocalObject& operator=(LocalObject&&) noexcept;

  [[nodiscard]] const std::vector<TetId>& tets() const;
  [[nodiscard]] const std::vector<NodeId>& nodes() const;     ///< ascending
  [[nodiscard]] const std::vector<NodeId>& boundary() const;  ///< b, ascending
  [[nodiscard]] const std::vector<NodeId>& interior() const;  ///< o, ascending

  /// Assembles and factors K_oo, once. False: a part of it hangs on to no boundary firmly, and it cannot be solved.
  [[nodiscard]] bool factor();
  /// `u_boundary`: m, 3 per boundary node. False, and nothing changes, where it cannot be factored. Does not allocate
  /// but for the factor, the first time.
  [[nodiscard]] bool solve(const VectorX& u_boundary);
  /// `u`: m, 3 per node of nodes(), in equilibrium. Does not allocate.
  void take(const VectorX& u);
  /// The same of a body of large strain, whose stress is its own: of each tet in turn.
  void take(const VectorX& u, const std::function<void(TetStress&)>& set_stress);

  /// Of the last solve, or of what was taken last. Zero before the first.
  [[nodiscard]] const VectorX& displacement() const;             ///< m, 3 per node
  [[nodiscard]] const std::vector<TetStress>& stresses() const;  ///< per tet
  [[nodiscard]] const std::vector<Mat3>& gradients() const;      ///< grad u, per tet

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace rhexis::fracture
