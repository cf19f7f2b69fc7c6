#include "fracture/energy_release.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "element/linear_tet.h"

namespace rhexis::fracture {
namespace {

/// 1 up to `inner`, 0 from `outer`, straight between: nothing smoother pays on linear tets.
double plateau(double distance, const EnergyDomain& domain) {
  return std::clamp((domain.outer - distance) / (domain.outer - domain.inner), 0.0, 1.0);
}

/// What one tet adds to the integral, J/m times m: d the direction, q at its corners.
double share(const material::Elastic& elastic, const element::LinearTet& tet, const Mat3& gradient, const Vec3& d,
             const std::array<double, 4>& q, const Vec3& body_force) {
  const Mat3 stress = element::small_strain_stress(elastic, gradient);
  const double energy = 0.5 * stress.cwiseProduct(gradient).sum();  // sigma is symmetric: sigma : grad u = sigma : eps
  Vec3 slope = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) slope += q[k] * tet.gradient[k];
  const Vec3 along = gradient * d;  // u,k d_k
  const double q_mean = 0.25 * (q[0] + q[1] + q[2] + q[3]);
  return tet.volume * (slope.dot(stress * along) - energy * slope.dot(d) - q_mean * body_force.dot(along));
}

/// Nearest place on a polyline: distance, segment and the part of the way along it.
struct Foot {
  double distance = 0.0;
  std::size_t segment = 0;
  double part = 0.0;
};
Foot foot_on(const std::vector<FrontPoint>& front, const Vec3& at) {
  Foot best{std::numeric_limits<double>::infinity(), 0, 0.0};
  for (std::size_t i = 0; i + 1 < front.size(); ++i) {
    const Vec3 way = front[i + 1].position - front[i].position;
    const double part = std::clamp((at - front[i].position).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const double distance = (at - front[i].position - part * way).norm();
    if (distance < best.distance) best = {distance, i, part};
  }
  return best;
}

}  // namespace

std::vector<double> energy_release(const mesh::TornMesh& body, const material::Elastic& elastic, const Crack& crack,
                                   std::span<const TetId> tets, std::span<const Mat3> gradients,
                                   const EnergyDomain& domain, const Vec3& body_force) {
  RHEXIS_CHECK(tets.size() == gradients.size(), "{} tets have {} gradients", tets.size(), gradients.size());
  RHEXIS_CHECK(domain.outer > domain.inner && domain.inner >= 0.0, "q falls from {} to {}", domain.inner, domain.outer);
  const std::vector<FrontPoint>& front = crack.front;
  const std::size_t sections = crack.uniform ? 1 : front.size();
  std::vector<double> release(sections, 0.0);
  double lowest = std::numeric_limits<double>::infinity();  // extent of the plate along its front
  double highest = -lowest;

  for (std::size_t i = 0; i < tets.size(); ++i) {
    const std::array<Vec3, 4> x = mesh::corners(body.mesh(), tets[i]);
    std::array<double, 4> q{};
    if (crack.uniform) {
      const FrontPoint& point = front.front();
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 way = x[k] - point.position;
        const double along = way.dot(point.tangent);
        lowest = std::min(lowest, along);
        highest = std::max(highest, along);
        q[k] = plateau((way - along * point.tangent).norm(), domain);
      }
      if (q == std::array<double, 4>{}) continue;
      release[0] += share(elastic, element::make_linear_tet(x), gradients[i], point.direction, q, body_force);
      continue;
    }
    std::array<Foot, 4> foot;
    for (std::size_t k = 0; k < 4; ++k) {
      foot[k] = foot_on(front, x[k]);
      q[k] = plateau(foot[k].distance, domain);
    }
    if (q == std::array<double, 4>{}) continue;
    const element::LinearTet tet = element::make_linear_tet(x);
    const auto [first, last] = std::minmax_element(foot.begin(), foot.end(),
                                                   [](const Foot& a, const Foot& b) { return a.segment < b.segment; });
    for (std::size_t point = first->segment; point <= last->segment + 1; ++point) {
      std::array<double, 4> hat{};  // q, falling to 0 along the front at the neighbours of the point
      for (std::size_t k = 0; k < 4; ++k) {
        if (foot[k].segment == point) hat[k] = q[k] * (1.0 - foot[k].part);
        if (foot[k].segment + 1 == point) hat[k] = q[k] * foot[k].part;
      }
      if (hat == std::array<double, 4>{}) continue;
      release[point] += share(elastic, tet, gradients[i], front[point].direction, hat, body_force);
    }
  }

  if (crack.uniform) {
    release[0] = highest > lowest ? release[0] / (highest - lowest) : 0.0;
    return release;
  }
  for (std::size_t point = 0; point < sections; ++point) {
    double length = 0.0;  // of the hat along the front
    if (point > 0) length += 0.5 * (front[point].position - front[point - 1].position).norm();
    if (point + 1 < sections) length += 0.5 * (front[point + 1].position - front[point].position).norm();
    release[point] /= length;
  }
  return release;
}

double stress_intensity(const material::Elastic& elastic, double energy_release) {
  return std::sqrt(std::max(0.0, energy_release) * elastic.young / (1.0 - elastic.poisson * elastic.poisson));
}

}  // namespace rhexis::fracture
