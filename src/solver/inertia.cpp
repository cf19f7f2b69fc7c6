#include "solver/inertia.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"

namespace rhexis::solver {

std::vector<double> tet_masses(const model::Model& model, double density) {
  std::vector<double> mass = model.tet_volumes();
  for (double& m : mass) m *= density;
  return mass;
}

Inertia::Inertia(const Dynamics& dynamics, const model::Model& model, const VectorX& u) : dynamics_(dynamics) {
  RHEXIS_CHECK(dynamics.density > 0.0 && dynamics.step > 0.0, "density {}, step {}", dynamics.density, dynamics.step);
  const double h = dynamics.step;
  scale_ = 1.0 + dynamics.stiffness_damping / h;
  per_mass_ = (1.0 / (h * h) + dynamics.mass_damping / h) / scale_;
  motion_ = {u, VectorX::Zero(u.size()), VectorX::Zero(u.size())};
  lump(model);
}

void Inertia::lump(const model::Model& model) {
  const std::vector<std::int32_t>& connectivity = model.space().connectivity;
  const std::vector<double> of_tet = tet_masses(model, dynamics_.density);
  mass_.setZero(static_cast<Eigen::Index>(model.space().node_count()));
  for (std::size_t i = 0; i < connectivity.size(); ++i) mass_[connectivity[i]] += 0.25 * of_tet[i / 4];
}

void Inertia::follow(const model::Model& model, const std::vector<std::int32_t>& copied, const VectorX& before,
                     const VectorX& after) {
  const Eigen::Index nodes = before.size() / 3;
  const VectorX moved = before - motion_.u;
  motion_.u = after;
  motion_.u.head(before.size()) -= moved;
  motion_.velocity.conservativeResize(after.size());
  motion_.internal.setZero(after.size());
  for (std::size_t i = 0; i < copied.size(); ++i) {
    const Eigen::Index parent = 3 * Eigen::Index{copied[i]};
    const Eigen::Index copy = 3 * (nodes + static_cast<Eigen::Index>(i));
    motion_.velocity.segment<3>(copy) = motion_.velocity.segment<3>(parent);
    // A copy of a copy of the same edit has its parent's place already.
    motion_.u.segment<3>(copy) -= after.segment<3>(parent) - motion_.u.segment<3>(parent);
  }
  lump(model);
}

void Inertia::begin(const VectorX& u, const VectorX& internal) {
  motion_.velocity = (u - motion_.u) / dynamics_.step;
  motion_.u = u;
  motion_.internal = internal;
}

void Inertia::halt(const VectorX& u, const VectorX& internal) {
  motion_.velocity.setZero();
  motion_.u = u;
  motion_.internal = internal;
}

void Inertia::add_force(const VectorX& u, VectorX& out) const {
  const double h = dynamics_.step;
  const double of_velocity = 1.0 / (h * scale_);
  const double of_internal = dynamics_.stiffness_damping / (h * scale_);
  for (Eigen::Index i = 0; i < mass_.size(); ++i) {
    const auto now = u.segment<3>(3 * i);
    const auto then = motion_.u.segment<3>(3 * i);
    out.segment<3>(3 * i) += mass_[i] * (of_velocity * motion_.velocity.segment<3>(3 * i) - per_mass_ * (now - then)) +
                             of_internal * motion_.internal.segment<3>(3 * i);
  }
}

void Inertia::add_tangent(linalg::SaddleMatrix& K) const {
  for (Eigen::Index i = 0; i < mass_.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    double* block = &K.A.values[9 * static_cast<std::size_t>(K.A.pattern->row_start[row + 1] - 1)];
    for (const int diagonal : {0, 4, 8}) block[diagonal] += per_mass_ * mass_[i];
  }
}

double Inertia::momentum(const VectorX& u) const {
  double now = 0.0;
  double before = 0.0;
  for (Eigen::Index i = 0; i < mass_.size(); ++i) {
    const double square = mass_[i] * mass_[i];
    now += square * (u.segment<3>(3 * i) - motion_.u.segment<3>(3 * i)).squaredNorm();
    before += square * motion_.velocity.segment<3>(3 * i).squaredNorm();
  }
  const double h = dynamics_.step;
  return std::max(std::sqrt(now) / h, std::sqrt(before)) / (scale_ * h);
}

double Inertia::kinetic_energy(const VectorX& u) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < mass_.size(); ++i)
    sum += mass_[i] * (u.segment<3>(3 * i) - motion_.u.segment<3>(3 * i)).squaredNorm();
  return 0.5 * sum / (dynamics_.step * dynamics_.step);
}

}  // namespace rhexis::solver
