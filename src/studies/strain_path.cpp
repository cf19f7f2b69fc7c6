#include "studies/strain_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace rhexis::studies {
namespace {

constexpr double kShare = 0.95;  // of the volume

}  // namespace

double strain_of(const mesh::TetMesh& mesh, const VectorX& u) {
  std::vector<std::pair<double, double>> strain_and_volume;
  double whole = 0.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const std::array<Vec3, 4> X = mesh::corners(mesh, TetId(t));
    const auto moved = [&](std::size_t k) -> Vec3 { return X[k] + u.segment<3>(3 * mesh.tets[t][k].value()); };
    Mat3 reference;
    Mat3 deformed;
    for (std::size_t k = 0; k < 3; ++k) {
      reference.col(static_cast<Eigen::Index>(k)) = X[k + 1] - X[0];
      deformed.col(static_cast<Eigen::Index>(k)) = moved(k + 1) - moved(0);
    }
    const Mat3 F = deformed * reference.inverse();
    const Vec3 stretch = Eigen::JacobiSVD<Mat3>(F).singularValues();
    const double volume = mesh::signed_volume(mesh, TetId(t));
    strain_and_volume.emplace_back((stretch.array() - 1.0).abs().maxCoeff(), volume);
    whole += volume;
  }
  std::sort(strain_and_volume.begin(), strain_and_volume.end());
  double below = 0.0;
  for (const auto& [strain, volume] : strain_and_volume) {
    below += volume;
    if (below >= kShare * whole) return strain;
  }
  return strain_and_volume.empty() ? 0.0 : strain_and_volume.back().first;
}

std::optional<PathPoint> passes(const std::vector<PathPoint>& path, double limit) {
  PathPoint before;
  for (const PathPoint& point : path) {
    if (point.difference > limit) {
      const double part = (limit - before.difference) / (point.difference - before.difference);
      return PathPoint{std::lerp(before.load, point.load, part), std::lerp(before.strain, point.strain, part), limit};
    }
    before = point;
  }
  return std::nullopt;
}

}  // namespace rhexis::studies
