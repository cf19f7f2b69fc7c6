// The two measured numbers in the rule for beta and in the smoothing length: how strongly the jump term holds the
// spurious pressures, and how far it spreads a smooth one.

#include <gtest/gtest.h>

#include <numbers>

#include "mesh/generate.h"
#include "model/stabilisation.h"
#include "tests/model/dense_saddle.h"
#include "tests/support/kuhn_box.h"
#include "tests/support/measured.h"

namespace rhexis::test {
namespace {

/// kappa = 1: then K_S with beta = 1 is the bare jump matrix.
const material::MooneyRivlin kUnit{0.25, 0.25, 1.0};

mesh::TetMesh kuhn_cube(int cells, bool mirrored, const Vec3& size = Vec3::Ones()) {
  return make_kuhn_box({.cells = {cells, cells, cells}, .mirrored = mirrored, .map = [cells, size](const Vec3& x) {
                          return Vec3(x.cwiseProduct(size) / cells);
                        }});
}

mesh::TetMesh five_cube(int cells) { return mesh::make_structured_box(Vec3::Ones(), {cells, cells, cells}); }

/// Smallest p^T K_1 p / p^T M p over the null space of B, all sides held, the constant left out. No unit.
double least_spurious_jump(const mesh::TetMesh& mesh) {
  const Vec3 far = mesh::bounding_box(mesh).to;
  std::vector<bool> held;
  for (const Vec3& x : mesh.nodes) held.insert(held.end(), 3, x.minCoeff() < 1e-9 || (far - x).minCoeff() < 1e-9);
  const DenseSaddle dense = dense_saddle(mesh, kUnit, 1.0, held);
  const VectorX root = dense.volumes.cwiseSqrt();
  const Eigen::MatrixXd B = dense.B * root.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(B, Eigen::ComputeFullV);
  const double largest = svd.singularValues()[0];
  const Eigen::Index rank = (svd.singularValues().array() > 1e-9 * largest).count();
  const Eigen::MatrixXd null = svd.matrixV().rightCols(B.cols() - rank);
  const Eigen::MatrixXd K = root.cwiseInverse().asDiagonal() * dense.K_S * root.cwiseInverse().asDiagonal();
  const VectorX values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(null.transpose() * K * null, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_NEAR(values[0], 0.0, 1e-9);  // the constant pressure has no jumps
  return values[1];
}

TEST(StabilisationConstants, SpuriousPressuresCostAtLeastFour) {
  const auto check = [](const std::string& name, const mesh::TetMesh& mesh, double expected) {
    const double d = least_spurious_jump(mesh);
    test::measured("least jump of a spurious pressure, {}: {:.2f}", name, d);
    EXPECT_GT(d, 4.0) << name;
    EXPECT_NEAR(d, expected, 0.05) << name;
  };
  check("mirrored cells, 3 a side", kuhn_cube(3, true), 5.2);
  check("mirrored cells, 4 a side", kuhn_cube(4, true), 12.0);
  check("plain cells, 4 a side", kuhn_cube(4, false), 5.6);
  check("five-tet cells, 4 a side", five_cube(4), 4.6);
  check("mirrored flat cells 4:4:1, 3 a side", kuhn_cube(3, true, Vec3(4, 4, 1)), 5.61);
  const double free_mesh = least_spurious_jump(mesh::make_bar({.size = Vec3::Ones()}, 250).value());
  test::measured("least jump of a spurious pressure, free mesh of 250 nodes: {:.2f}", free_mesh);
  EXPECT_GT(free_mesh, 4.0);
}

TEST(StabilisationConstants, SmoothingLengthIsThatOfAPressureWave) {
  // A wave lambda = cos(k z): mass and elastic compliance, 1 / kappa + 3 / (4 mu), against the jump term, which should
  // act like l^2 k^2 times as much. Eight cells to half a wave.
  const material::MooneyRivlin law = material::to_mooney_rivlin({1e5, 0.49});
  const double beta = 20.0;
  const auto check = [&](const std::string& name, const mesh::TetMesh& mesh, double expected) {
    const DenseSaddle dense = dense_saddle(mesh, law, beta, std::vector<bool>(3 * mesh.node_count(), true));
    VectorX wave(dense.volumes.size());
    for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
      const std::array<Vec3, 4> x = mesh::corners(mesh, TetId(t));
      wave[static_cast<Eigen::Index>(t)] = std::cos(std::numbers::pi * 0.25 * (x[0] + x[1] + x[2] + x[3]).z());
    }
    const double jump = wave.dot(dense.K_S * wave);
    const double hold = (1 / law.kappa + 0.75 / law.shear_modulus()) * wave.dot(dense.volumes.asDiagonal() * wave);
    const double length = std::sqrt(jump / hold) / std::numbers::pi;
    const double predicted = model::smoothing_length(mesh, law, beta);
    const double diffusion = 0.5 * std::pow(length / predicted, 2);  // in h^2; the formula takes 0.5
    test::measured("smoothing length, {}: {:.4f} m of a wave, {:.4f} m by the formula, D = {:.2f} h^2", name, length,
                   predicted, diffusion);
    EXPECT_NEAR(diffusion, expected, 0.02) << name;
  };
  check("mirrored cells", kuhn_cube(8, true), 0.50);
  check("plain cells", kuhn_cube(8, false), 0.63);
  check("five-tet cells", five_cube(8), 0.66);
  // Here h varies, and the mean of its square is more than the square of its mean.
  check("free mesh", mesh::make_bar({.size = Vec3::Ones()}, 600).value(), 0.71);
}

}  // namespace
}  // namespace rhexis::test
