#include "fracture/path_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fracture/front.h"
#include "fracture/path.h"

namespace rhexis::fracture {
namespace {

/// `from` is well inside when the body goes on this far behind it, in mean edges.
constexpr double kWellInside = 0.25;
/// A crack that starts by itself: depth in a plate and radius elsewhere, in mean edges.
constexpr double kFirstDepth = 1.0;
constexpr double kFirstRadius = 1.5;
constexpr int kHalfDiscPoints = 7;
/// Sizes that are tried, in these, as far as kLargestFirst.
constexpr double kFirstGrowth = 0.5;
constexpr double kLargestFirst = 4.0;
/// Lengths below this part of the body's size, and sines below it, are none.
constexpr double kNothing = 1e-9;

/// The point of the line through `at` along `tangent` nearest to the middle of the body: `at` may be anywhere along it.
Vec3 beside_middle(const Vec3& at, const Vec3& tangent, const Surroundings& surroundings) {
  const Vec3 middle = 0.5 * (surroundings.box().from + surroundings.box().to);
  return at + (middle - at).dot(tangent) * tangent;
}

/// The cracks of the stretches of the line through `at` along `tangent` in the body.
std::vector<Crack> fronts_on_line(const Vec3& at, const Vec3& tangent, const Vec3& direction,
                                  const Surroundings& surroundings) {
  const double size = surroundings.box().size().norm();
  const Vec3 beside = beside_middle(at, tangent, surroundings);
  if (!((beside - surroundings.box().from).norm() <= 2.0 * size)) return {};  // far off, perhaps too far for squares
  std::vector<FrontPoint> line(2);                                            // beyond the body both ways
  for (std::size_t k = 0; k < 2; ++k) line[k] = {beside + (k == 0 ? -2.0 : 2.0) * size * tangent, direction, tangent};
  if (!surroundings.is_plate()) return settle(line, surroundings);
  std::vector<Crack> cracks;  // a plate keeps the two ends of its front
  for (const Surroundings::Interval& part : surroundings.inside(line[0].position, line[1].position)) {
    Crack& crack = cracks.emplace_back();
    crack.uniform = true;
    for (const double end : {part.from, part.to})
      crack.front.push_back({line[0].position + end * (line[1].position - line[0].position), direction, tangent});
  }
  return cracks;
}

/// The plane up to the front through a point, from `length` m behind it or where the body begins, from one end of the
/// body to the other along `tangent`.
CutSurface plane_through(const Vec3& through, const Vec3& direction, double length, const Vec3& tangent,
                         const Surroundings& surroundings) {
  const Vec3 to = beside_middle(through, tangent, surroundings);
  const double margin = kCutMargin * surroundings.mean_edge();
  double lowest = std::numeric_limits<double>::infinity();  // of the box's corners along the tangent, beside `to`
  double highest = -lowest;
  double behind = 0.0;  // the same, back along the direction
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 at = surroundings.box().from;
    for (int k = 0; k < 3; ++k)
      if ((corner >> k & 1) != 0) at[k] = surroundings.box().to[k];
    lowest = std::min(lowest, (at - to).dot(tangent));
    highest = std::max(highest, (at - to).dot(tangent));
    behind = std::max(behind, (to - at).dot(direction));
  }
  // A triangle that reaches far beyond the body knows its heights there only to rounding of its size.
  const Vec3 from = to - std::min(length, behind + margin) * direction;
  const Vec3 down = (lowest - margin) * tangent;
  const Vec3 up = (highest + margin) * tangent;
  // Normal tangent x (to - from), as that of the front.
  return {{{from + down, from + up, to + up}, {from + down, to + up, to + down}}};
}

/// Half a disc about a point of the surface, in the plane of normal `normal`, growing along `inward`.
InitialCrack half_disc(const Vec3& centre, const Vec3& normal, const Vec3& inward, double radius,
                       const Surroundings& surroundings) {
  const double margin = kCutMargin * surroundings.mean_edge();
  const Vec3 along = inward.cross(normal);  // tangent x direction = normal in the middle
  InitialCrack out;
  Crack rim;
  for (int i = 0; i < kHalfDiscPoints; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / (kHalfDiscPoints - 1) - 0.5);
    FrontPoint& point = rim.front.emplace_back();
    point.direction = std::cos(angle) * inward + std::sin(angle) * along;
    point.position = centre + radius * point.direction;
  }
  std::vector<Vec3> to_surface(rim.front.size(), Vec3::Zero());
  end_on_surface(rim, to_surface, surroundings);
  for (std::size_t i = 0; i < rim.front.size(); ++i) rim.front[i].position += to_surface[i];
  out.cracks = settle(rim.front, surroundings);

  std::vector<Vec3> edge;
  for (const FrontPoint& point : rim.front) edge.push_back(point.position);
  const Vec3 outside = centre - (radius + margin) * inward;
  edge.insert(edge.begin(), edge.front() - margin * (inward + along));
  edge.push_back(edge.back() - margin * (inward - along));
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) out.surface.triangles.push_back({outside, edge[i + 1], edge[i]});
  return out;
}

/// A surface triangle of the present body: a face of a tet in the solve that no other in the solve has.
struct Outside {
  Vec3 centre = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< outward, unit
};
std::vector<Outside> outside_of(const mesh::TornMesh& body, TetId tet) {
  std::vector<Outside> out;
  for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
    const mesh::TetFace side{tet, vertex};
    if (!mesh::is_on_solved_surface(body, side)) continue;
    const std::array<NodeId, 3> nodes = mesh::face_nodes(body.mesh(), side);
    const Vec3& a = body.mesh().node(nodes[0]);
    const Vec3& b = body.mesh().node(nodes[1]);
    const Vec3& c = body.mesh().node(nodes[2]);
    out.push_back({(a + b + c) / 3.0, (b - a).cross(c - a).normalized()});
  }
  return out;
}

}  // namespace

Expected<InitialCrack> make_crack(const Vec3& from, const Vec3& to, const Vec3& through,
                                  const Surroundings& surroundings) {
  const double size = surroundings.box().size().norm();
  const double length = through.stableNorm();
  if (!(length > 0.0)) return fail("the crack goes through the body along no direction", "'through' is not zero");
  Vec3 tangent = through / length;
  if (surroundings.is_plate()) {
    if (std::hypot(tangent[0], tangent[1]) > kNothing)
      return fail("the crack of a plate does not go through its thickness", "through = [0, 0, 1]");
  }
  const Vec3 way = (to - from) - (to - from).dot(tangent) * tangent;
  if (!(way.stableNorm() > kNothing * size))
    return fail("the crack has no length", "'from' and 'to' lie apart, not only along 'through'");
  const Vec3 direction = way.stableNormalized();
  // The normal decides the side of nodes that lie on the plane. Towards the middle of the body it mirrors with the
  // body.
  const Vec3 middle = 0.5 * (surroundings.box().from + surroundings.box().to);
  if (tangent.cross(direction).dot(middle - to) < -kNothing * size) tangent = -tangent;

  InitialCrack out;
  out.cracks = fronts_on_line(to, tangent, direction, surroundings);
  if (out.cracks.empty())
    return fail("the front of the crack does not pass through the body",
                "the line through 'to' along 'through' meets it");
  const double behind = kWellInside * surroundings.mean_edge();
  // A slit: its other tip runs the other way, with the same upper flank.
  std::vector<Crack> other;
  if (surroundings.is_inside(from - behind * direction))
    other = fronts_on_line(from, -tangent, -direction, surroundings);
  const double back = other.empty() ? kCutMargin * surroundings.mean_edge() : 0.0;
  out.cracks.insert(out.cracks.end(), other.begin(), other.end());
  out.surface = plane_through(to, direction, way.stableNorm() + back, tangent, surroundings);
  return out;
}

std::optional<InitialCrack> start_crack(const mesh::TornMesh& body, std::span<const TetStress> tets, double strength,
                                        const Surroundings& surroundings, double larger) {
  const TetStress* worst = nullptr;
  PrincipalStress decisive;
  std::vector<Outside> faces;
  for (const TetStress& tet : tets) {
    // No principal stress is larger than the norm: below the strength, where most tets are, none is worked out.
    if (tet.at_hand || tet.stress.norm() < strength) continue;
    const PrincipalStress principal = principal_stress(tet.stress);
    if (principal.value[0] < strength || (worst != nullptr && principal.value[0] <= decisive.value[0])) continue;
    std::vector<Outside> of_tet = outside_of(body, tet.tet);
    if (of_tet.empty()) continue;
    worst = &tet;
    decisive = principal;
    faces = std::move(of_tet);
  }
  if (worst == nullptr) return std::nullopt;

  Vec3 normal = decisive.axes.col(0);
  if (surroundings.is_plate()) normal[2] = 0.0;
  // The face whose normal lies most in the crack's plane: the crack runs in from there. A plate's rim before its faces.
  const Outside* start = nullptr;
  double most = kNothing;
  for (const Outside& face : faces) {
    Vec3 inward = -face.normal;
    if (surroundings.is_plate()) inward[2] = 0.0;
    const double in_plane = inward.cross(normal).norm();
    if (in_plane > most) {
      most = in_plane;
      start = &face;
    }
  }
  const double edge = larger * surroundings.mean_edge();
  if (surroundings.is_plate()) {
    if (normal.norm() < kNothing) return std::nullopt;  // tension through the thickness: no line along z follows
    normal.normalize();
    const Vec3 up = Vec3::UnitZ();
    Vec3 direction = normal.cross(up);
    Vec3 from = worst->centroid - 0.5 * kFirstDepth * edge * direction;
    if (start != nullptr) {
      if (direction.dot(start->normal) > 0.0) direction = -direction;
      from = start->centre;
    }
    auto crack = make_crack(from, from + kFirstDepth * edge * direction, up, surroundings);
    return crack ? std::optional(*crack) : std::nullopt;
  }
  if (start == nullptr) return std::nullopt;
  normal.normalize();
  const Vec3 inward = (-start->normal + start->normal.dot(normal) * normal).normalized();
  InitialCrack out = half_disc(start->centre, normal, inward, kFirstRadius * edge, surroundings);
  return out.cracks.empty() ? std::nullopt : std::optional(out);
}

Expected<FirstCut> cut_initial(const mesh::TornMesh& body, const CrackLine& line, const Surroundings& surroundings,
                               const IncisionSettings& settings) {
  Expected<InitialCrack> start = make_crack(line.from, line.to, line.through, surroundings);
  if (!start) return fail(std::move(start.error()));
  Incision incision = incise(body, surroundings, start->surface, settings);
  if (incision.edit.empty()) return fail("the crack opens nothing in the mesh", "a longer crack, or a finer mesh");
  return FirstCut{std::move(*start), std::move(incision)};
}

std::optional<FirstCut> cut_first(const mesh::TornMesh& body, std::span<const TetStress> tets, double strength,
                                  const Surroundings& surroundings, const IncisionSettings& settings) {
  for (double larger = 1.0; larger <= kLargestFirst; larger += kFirstGrowth) {
    const std::optional<InitialCrack> start = start_crack(body, tets, strength, surroundings, larger);
    if (!start) continue;  // too small for a front, perhaps
    Incision incision = incise(body, surroundings, start->surface, settings);
    if (!incision.edit.empty()) return FirstCut{*start, std::move(incision)};
  }
  return std::nullopt;
}

}  // namespace rhexis::fracture
