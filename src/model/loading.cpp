#include "model/loading.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/check.h"
#include "mesh/surface.h"

namespace rhexis::model {
namespace {

using BlockMap = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

/// Shape functions of a triangle and their derivatives at the points of a rule that integrates N_a (x_,xi x x_,eta)
/// exactly over the reference triangle of area 1/2.
template <int kNodes, int kPoints>
struct TriangleRule {
  struct Point {
    double weight = 0.0;
    std::array<double, kNodes> N{};
    std::array<double, kNodes> N_xi{};
    std::array<double, kNodes> N_eta{};
  };
  std::array<Point, kPoints> points;
};

/// P1: N_a is linear, the normal constant: the centroid does.
TriangleRule<3, 1> make_linear_rule() {
  constexpr double kThird = 1.0 / 3.0;
  return {{{{0.5, {kThird, kThird, kThird}, {-1.0, 1.0, 0.0}, {-1.0, 0.0, 1.0}}}}};
}

/// P2: degree 2 + 1 + 1 = 4; the symmetric rule of six points (Strang and Fix), in closed form.
TriangleRule<6, 6> make_quadratic_rule() {
  const double outer_root = std::sqrt(38.0 - 44.0 * std::sqrt(0.4));
  const double weight_root = std::sqrt(213125.0 - 53320.0 * std::sqrt(10.0));
  TriangleRule<6, 6> rule;
  std::size_t next = 0;
  for (const double sign : {1.0, -1.0}) {
    const double a = (8.0 - std::sqrt(10.0) + sign * outer_root) / 18.0;
    const double weight = 0.5 * (620.0 + sign * weight_root) / 3720.0;
    for (const auto& [xi, eta] : {std::array{a, a}, std::array{1.0 - 2.0 * a, a}, std::array{a, 1.0 - 2.0 * a}}) {
      const double zeta = 1.0 - xi - eta;
      auto& point = rule.points[next++];
      point.weight = weight;
      point.N = {zeta * (2.0 * zeta - 1.0), xi * (2.0 * xi - 1.0), eta * (2.0 * eta - 1.0),
                 4.0 * zeta * xi,           4.0 * xi * eta,        4.0 * eta * zeta};
      point.N_xi = {1.0 - 4.0 * zeta, 4.0 * xi - 1.0, 0.0, 4.0 * (zeta - xi), 4.0 * eta, -4.0 * eta};
      point.N_eta = {1.0 - 4.0 * zeta, 0.0, 4.0 * eta - 1.0, -4.0 * xi, 4.0 * xi, 4.0 * (zeta - eta)};
    }
  }
  return rule;
}

/// Calls use(rule, nodes) for every triangle of the load, with the rule of its order.
template <class Use>
void for_each_triangle(const FollowerPressure& load, const Use& use) {
  static const TriangleRule<3, 1> kLinear = make_linear_rule();
  static const TriangleRule<6, 6> kQuadratic = make_quadratic_rule();
  const auto stride = static_cast<std::size_t>(load.nodes_per_triangle);
  for (std::size_t first = 0; first < load.triangles.size(); first += stride) {
    const std::int32_t* const nodes = &load.triangles[first];
    if (stride == 3) {
      use(kLinear, nodes);
    } else {
      use(kQuadratic, nodes);
    }
  }
}

/// Tangents x_,xi and x_,eta of the deformed triangle at a point of the rule, m.
template <class Point>
std::array<Vec3, 2> tangents(const Point& point, const std::int32_t* nodes, const DisplacementSpace& space,
                             const VectorX& u) {
  std::array<Vec3, 2> out{Vec3::Zero(), Vec3::Zero()};
  for (std::size_t a = 0; a < point.N.size(); ++a) {
    const Vec3 x = space.nodes[static_cast<std::size_t>(nodes[a])] + u.segment<3>(3 * nodes[a]);
    out[0] += point.N_xi[a] * x;
    out[1] += point.N_eta[a] * x;
  }
  return out;
}

/// target += [w]x, the matrix of w x (.).
void add_cross_matrix(const Vec3& w, BlockMap target) {
  target(0, 1) -= w[2];
  target(0, 2) += w[1];
  target(1, 0) += w[2];
  target(1, 2) -= w[0];
  target(2, 0) -= w[1];
  target(2, 1) += w[0];
}

std::vector<bool> held_nodes(const DisplacementSpace& space, const std::vector<PrescribedDof>& supports) {
  std::vector<std::int8_t> components(space.node_count(), 0);
  for (const PrescribedDof& support : supports) ++components[static_cast<std::size_t>(support.dof / 3)];
  std::vector<bool> held(space.node_count());
  for (std::size_t i = 0; i < held.size(); ++i) held[i] = components[i] == 3;
  return held;
}

/// An edge of a triangle: its ends and middle (-1 for P1), and +1 or -1 for the sense in which the triangle runs along.
struct DirectedEdge {
  std::int32_t low, high, middle, sense;
};

std::vector<DirectedEdge> directed_edges(const FollowerPressure& load) {
  std::vector<DirectedEdge> edges;
  const auto stride = static_cast<std::size_t>(load.nodes_per_triangle);
  for (std::size_t first = 0; first < load.triangles.size(); first += stride) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = load.triangles[first + i];
      const std::int32_t b = load.triangles[first + (i + 1) % 3];
      const std::int32_t middle = stride == 6 ? load.triangles[first + 3 + i] : -1;
      edges.push_back({std::min(a, b), std::max(a, b), middle, a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& p, const DirectedEdge& q) {
    return std::pair(p.low, p.high) < std::pair(q.low, q.high);
  });
  return edges;
}

/// The skew part of the load stiffness is an integral along the rim: along an edge that two triangles run in opposite
/// senses it cancels, and it couples only the nodes of the edge.
bool is_closed_or_held(const FollowerPressure& load, const std::vector<bool>& held) {
  const std::vector<DirectedEdge> edges = directed_edges(load);
  const auto is_held = [&](std::int32_t node) { return node < 0 || held[static_cast<std::size_t>(node)]; };
  for (auto edge = edges.begin(); edge != edges.end();) {
    const DirectedEdge& first = *edge;
    int sense = 0;
    for (; edge != edges.end() && edge->low == first.low && edge->high == first.high; ++edge) sense += edge->sense;
    const bool edge_held = is_held(first.low) && is_held(first.high) && is_held(first.middle);
    if (sense != 0 && !edge_held) return false;
  }
  return true;
}

}  // namespace

void add_body_force(const mesh::TetMesh& mesh, const DisplacementSpace& space, const Vec3& force_density,
                    VectorX& force) {
  const auto per_tet = static_cast<std::size_t>(space.nodes_per_tet());
  const double vertex_share = space.order == 1 ? 1.0 / 4.0 : -1.0 / 20.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const Vec3 total = mesh::signed_volume(mesh, TetId(t)) * force_density;
    for (std::size_t a = 0; a < per_tet; ++a) {
      force.segment<3>(3 * space.connectivity[t * per_tet + a]) += (a < 4 ? vertex_share : 1.0 / 5.0) * total;
    }
  }
}

void add_traction(const mesh::TetMesh& mesh, const DisplacementSpace& space, const std::vector<mesh::TetFace>& faces,
                  const Vec3& total_force, VectorX& force) {
  double area = 0.0;
  for (const mesh::TetFace& face : faces) area += mesh::face_area(mesh, face);
  RHEXIS_CHECK(area > 0.0, "a traction on {} faces of area {}", faces.size(), area);
  const std::size_t first = space.order == 1 ? 0 : 3;
  for (const mesh::TetFace& face : faces) {
    const Vec3 share = mesh::face_area(mesh, face) / area * total_force;
    const std::array<std::int32_t, 6> nodes = nodes_of_face(space, face);
    for (std::size_t a = first; a < first + 3; ++a) force.segment<3>(3 * nodes[a]) += share / 3.0;
  }
}

FollowerPressure make_follower_pressure(const mesh::TetMesh& mesh, const DisplacementSpace& space,
                                        const std::vector<mesh::TetFace>& faces, double pressure,
                                        const std::vector<PrescribedDof>& supports) {
  FollowerPressure load;
  load.pressure = pressure;
  load.nodes_per_triangle = space.order == 1 ? 3 : 6;
  for (const mesh::TetFace& face : faces) {
    RHEXIS_CHECK(face.tet.index() < mesh.tet_count(), "tet {} of {}", face.tet.value(), mesh.tet_count());
    const std::array<std::int32_t, 6> nodes = nodes_of_face(space, face);
    load.triangles.insert(load.triangles.end(), nodes.begin(), nodes.begin() + load.nodes_per_triangle);
  }
  load.closed_or_held_rim = is_closed_or_held(load, held_nodes(space, supports));
  return load;
}

void add_pressure_force(const FollowerPressure& load, const DisplacementSpace& space, const VectorX& u, double t,
                        VectorX& force) {
  for_each_triangle(load, [&](const auto& rule, const std::int32_t* nodes) {
    for (const auto& point : rule.points) {
      const auto [x_xi, x_eta] = tangents(point, nodes, space, u);
      const Vec3 f = -t * load.pressure * point.weight * x_xi.cross(x_eta);
      for (std::size_t a = 0; a < point.N.size(); ++a) force.segment<3>(3 * nodes[a]) += point.N[a] * f;
    }
  });
}

void subtract_pressure_stiffness(const FollowerPressure& load, const DisplacementSpace& space, const VectorX& u,
                                 double t, linalg::SaddleMatrix& K) {
  const linalg::BlockPattern& pattern = *K.A.pattern;
  if (!load.closed_or_held_rim && !K.skew) K.skew.emplace().values.assign(K.A.values.size(), 0.0);

  // d f_a / d x_b = [w_ab]x with w_ab = -t p int N_a (N_b,eta x_,xi - N_b,xi x_,eta). A cross matrix is skew, so the
  // symmetric part of the whole has the blocks [w_ab - w_ba]x / 2, none on the diagonal, and the skew part has
  // [w_ab + w_ba]x / 2.
  for_each_triangle(load, [&](const auto& rule, const std::int32_t* nodes) {
    for (const auto& point : rule.points) {
      const auto [x_xi, x_eta] = tangents(point, nodes, space, u);
      const double scale = -t * load.pressure * point.weight;
      const auto w = [&, &x_xi = x_xi, &x_eta = x_eta](std::size_t a, std::size_t b) -> Vec3 {
        return scale * point.N[a] * (point.N_eta[b] * x_xi - point.N_xi[b] * x_eta);
      };
      for (std::size_t a = 0; a < point.N.size(); ++a) {
        for (std::size_t b = 0; b < point.N.size(); ++b) {
          if (nodes[b] > nodes[a]) continue;
          const std::int32_t block = pattern.find(nodes[a], nodes[b]);
          RHEXIS_CHECK(block >= 0, "nodes {} and {} of a loaded face are no pair of the tangent", nodes[a], nodes[b]);
          const std::ptrdiff_t at = 9 * std::ptrdiff_t{block};
          const Vec3 w_ab = w(a, b);
          const Vec3 w_ba = w(b, a);
          if (a != b) add_cross_matrix(0.5 * (w_ba - w_ab), BlockMap(K.A.values.data() + at));
          if (!load.closed_or_held_rim) add_cross_matrix(-0.5 * (w_ab + w_ba), BlockMap(K.skew->values.data() + at));
        }
      }
    }
  });
}

linalg::FreeDofs free_dofs(const DisplacementSpace& space, const Loading& loading) {
  std::vector<bool> held(space.dof_count(), false);
  for (const PrescribedDof& support : loading.supports) held[static_cast<std::size_t>(support.dof)] = true;
  return linalg::make_free_dofs(held);
}

void external_force(const Loading& loading, const DisplacementSpace& space, const VectorX& u, double t,
                    VectorX& force) {
  force = t * loading.dead_force;
  for (const FollowerPressure& load : loading.pressures) add_pressure_force(load, space, u, t, force);
}

void subtract_load_stiffness(const Loading& loading, const DisplacementSpace& space, const VectorX& u, double t,
                             linalg::SaddleMatrix& K) {
  K.skew.reset();
  for (const FollowerPressure& load : loading.pressures) subtract_pressure_stiffness(load, space, u, t, K);
}

}  // namespace rhexis::model
