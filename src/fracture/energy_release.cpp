#include "fracture/energy_release.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "element/linear_tet.h"

namespace rhexis::fracture {
namespace {

/// How far q reaches along a front to either side of a point, in its segments: nodes are about a segment apart, and a
/// narrower q would be lost between them.
constexpr double kSegmentsWide = 2.0;

/// 1 up to `inner`, 0 from `outer`, straight between: nothing smoother pays on linear tets.
double plateau(double distance, const EnergyDomain& domain) {
  return std::clamp((domain.outer - distance) / (domain.outer - domain.inner), 0.0, 1.0);
}

struct Bodily {
  const mesh::TornMesh& body;
  std::span<const EnergyTet> tets;
  const Vec3& body_force;
};

/// What a tet of corners `x` adds to the integral, J/m times m: d the direction, q at its corners.
double share(const EnergyTet& tet, const Vec3& body_force, const std::array<Vec3, 4>& x, const Vec3& d,
             const std::array<double, 4>& q) {
  const element::LinearTet shape = element::make_linear_tet(x);
  Vec3 slope = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) slope += q[k] * shape.gradient[k];
  const Vec3 along = tet.gradient * d;  // u,K d_K
  const double q_mean = 0.25 * (q[0] + q[1] + q[2] + q[3]);
  return shape.volume * (along.dot(tet.P * slope) - tet.W * slope.dot(d) - q_mean * body_force.dot(along));
}

/// A point of a polyline: its distance along it, and of another point from it.
struct Foot {
  double distance = std::numeric_limits<double>::infinity();
  double at = 0.0;
};
Foot foot_on(const std::vector<FrontPoint>& front, const Vec3& of) {
  Foot best;
  double passed = 0.0;
  for (std::size_t i = 0; i + 1 < front.size(); ++i) {
    const Vec3 way = front[i + 1].position - front[i].position;
    const double part = std::clamp((of - front[i].position).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const double distance = (of - front[i].position - part * way).norm();
    if (distance < best.distance) best = {distance, passed + part * way.norm()};
    passed += way.norm();
  }
  return best;
}

/// One line through the whole plate.
double release_of_line(const Bodily& bodily, const FrontPoint& point, const EnergyDomain& domain) {
  double sum = 0.0;
  double lowest = std::numeric_limits<double>::infinity();  // extent of the plate along its front
  double highest = -lowest;
  for (const EnergyTet& tet : bodily.tets) {
    const std::array<Vec3, 4> x = mesh::corners(bodily.body.mesh(), tet.tet);
    std::array<double, 4> q{};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 way = x[k] - point.position;
      const double along = way.dot(point.tangent);
      lowest = std::min(lowest, along);
      highest = std::max(highest, along);
      q[k] = plateau((way - along * point.tangent).norm(), domain);
    }
    if (q != std::array<double, 4>{}) sum += share(tet, bodily.body_force, x, point.direction, q);
  }
  return highest > lowest ? sum / (highest - lowest) : 0.0;
}

std::vector<double> release_of_points(const Bodily& bodily, const std::vector<FrontPoint>& front,
                                      const EnergyDomain& domain) {
  std::vector<double> at{0.0};
  for (std::size_t i = 0; i + 1 < front.size(); ++i)
    at.push_back(at.back() + (front[i + 1].position - front[i].position).norm());
  const double length = at.back();
  const double width = kSegmentsWide * length / static_cast<double>(front.size() - 1);
  std::vector<double> release(front.size(), 0.0);
  for (const EnergyTet& tet : bodily.tets) {
    const std::array<Vec3, 4> x = mesh::corners(bodily.body.mesh(), tet.tet);
    std::array<Foot, 4> foot;
    std::array<double, 4> q{};
    for (std::size_t k = 0; k < 4; ++k) {
      foot[k] = foot_on(front, x[k]);
      q[k] = plateau(foot[k].distance, domain);
    }
    if (q == std::array<double, 4>{}) continue;
    for (std::size_t point = 0; point < front.size(); ++point) {
      std::array<double, 4> hat{};
      for (std::size_t k = 0; k < 4; ++k) hat[k] = q[k] * std::max(0.0, 1.0 - std::abs(foot[k].at - at[point]) / width);
      if (hat != std::array<double, 4>{})
        release[point] += share(tet, bodily.body_force, x, front[point].direction, hat);
    }
  }
  for (std::size_t point = 0; point < front.size(); ++point) {
    const auto half = [&](double reach) {  // of the hat, cut off where the front ends
      const double kept = std::min(reach, width);
      return kept - 0.5 * kept * kept / width;
    };
    release[point] /= half(at[point]) + half(length - at[point]);
  }
  return release;
}

}  // namespace

std::vector<EnergyTet> small_strain_energies(const material::Elastic& elastic, std::span<const TetId> tets,
                                             std::span<const Mat3> gradients) {
  RHEXIS_CHECK(tets.size() == gradients.size(), "{} tets have {} gradients", tets.size(), gradients.size());
  std::vector<EnergyTet> out(tets.size());
  for (std::size_t i = 0; i < tets.size(); ++i) {
    const Mat3 stress = element::small_strain_stress(elastic, gradients[i]);
    // sigma is symmetric: sigma : grad u = sigma : eps
    out[i] = {tets[i], gradients[i], stress, 0.5 * stress.cwiseProduct(gradients[i]).sum()};
  }
  return out;
}

std::vector<double> energy_release(const mesh::TornMesh& body, const Crack& crack, std::span<const EnergyTet> tets,
                                   const EnergyDomain& domain, const Vec3& body_force) {
  RHEXIS_CHECK(domain.outer > domain.inner && domain.inner >= 0.0, "q falls from {} to {}", domain.inner, domain.outer);
  const Bodily bodily{body, tets, body_force};
  if (crack.uniform) return {release_of_line(bodily, crack.front.front(), domain)};
  return release_of_points(bodily, crack.front, domain);
}

double stress_intensity(const material::Elastic& elastic, double energy_release) {
  return std::sqrt(std::max(0.0, energy_release) * elastic.young / (1.0 - elastic.poisson * elastic.poisson));
}

}  // namespace rhexis::fracture
