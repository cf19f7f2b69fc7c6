// The rotation nearest to F, batched and scalar, against a singular value decomposition.

#include "element/polar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include "base/vec.h"
#include "element/tet_kernels.h"

namespace rhexis::test {
namespace {

using element::kBatch;
using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The maximiser of tr(R^T F) over rotations: the smallest singular value takes the sign of det F.
Mat3 by_svd(const Mat3& F) {
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if (U.determinant() * svd.matrixV().determinant() < 0.0) U.col(2) *= -1.0;
  return U * svd.matrixV().transpose();
}

using OfOneTet = void (*)(const double (&)[9], double (&)[9]);

Mat3 scalar(OfOneTet rotation, const Mat3& F) {
  double f[9], r[9];
  Eigen::Map<RowMat3>{f} = F;
  rotation(f, r);
  return Eigen::Map<RowMat3>(r);
}

class Rotations {
 public:
  explicit Rotations(unsigned seed) : random_(seed) {}
  Mat3 operator()() {
    return Eigen::Quaterniond(normal_(random_), normal_(random_), normal_(random_), normal_(random_))
        .normalized()
        .toRotationMatrix();
  }
  double normal() { return normal_(random_); }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

class BatchedPolar : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    kernels_ = element::find_tet_kernels(GetParam());
    if (kernels_ == nullptr) GTEST_SKIP() << "not on this processor";
  }
  /// All lanes filled with different matrices.
  std::array<Mat3, kBatch> operator()(const std::array<Mat3, kBatch>& F) const {
    alignas(64) double f[9 * kBatch], r[9 * kBatch];
    for (int lane = 0; lane < kBatch; ++lane) {
      for (int i = 0; i < 9; ++i) f[i * kBatch + lane] = F[static_cast<std::size_t>(lane)](i / 3, i % 3);
    }
    kernels_->polar(f, r);
    std::array<Mat3, kBatch> out;
    for (int lane = 0; lane < kBatch; ++lane) {
      for (int i = 0; i < 9; ++i) out[static_cast<std::size_t>(lane)](i / 3, i % 3) = r[i * kBatch + lane];
    }
    return out;
  }

  /// Largest error over 400 batches of Q diag(s) P.
  template <class Stretches>
  double largest_error(const Stretches& stretches) const {
    Rotations rotation(5);
    double largest = 0.0;
    for (int trial = 0; trial < 400; ++trial) {
      std::array<Mat3, kBatch> F, expected;
      for (std::size_t lane = 0; lane < kBatch; ++lane) {
        const Mat3 P = rotation(), Q = rotation();
        const Vec3 s = stretches(rotation);
        F[lane] = Q * s.asDiagonal() * P;
        expected[lane] = by_svd(F[lane]);
      }
      const std::array<Mat3, kBatch> R = (*this)(F);
      for (std::size_t lane = 0; lane < kBatch; ++lane) {
        largest = std::max(largest, (R[lane] - expected[lane]).cwiseAbs().maxCoeff());
      }
    }
    return largest;
  }

  const element::TetKernels* kernels_ = nullptr;
};

TEST_P(BatchedPolar, OrdinaryStretches) {
  EXPECT_LT(largest_error([](Rotations& r) {
              return Vec3(1.0 + 0.1 * std::tanh(r.normal()), 1.0, 1.0 + 0.2 * std::tanh(r.normal()));
            }),
            2e-14);
}

TEST_P(BatchedPolar, LargeStretches) {
  // s2 + s3 >= 0.4, s1 <= 10: the condition of R is s1 / (s2 + s3).
  EXPECT_LT(largest_error([](Rotations& r) {
              return Vec3(1.0 + 9.0 * std::abs(std::tanh(r.normal())), 0.6, 0.2 + std::abs(std::tanh(r.normal())));
            }),
            3e-13);
}

TEST_P(BatchedPolar, Inverted) {
  EXPECT_LT(largest_error([](Rotations& r) {
              return Vec3(1.2, 0.9 + 0.1 * std::tanh(r.normal()), -0.1 - 0.5 * std::abs(std::tanh(r.normal())));
            }),
            1e-13);
}

TEST_P(BatchedPolar, NearlyFlat) {
  EXPECT_LT(largest_error([](Rotations& r) { return Vec3(1.2, 0.9, 1e-9 * r.normal()); }), 1e-13);
}

TEST_P(BatchedPolar, TinyAndHugeScales) {
  for (const double scale : {1e-6, 1e6}) {
    EXPECT_LT(
        largest_error([&](Rotations& r) { return Vec3(scale * Vec3(1.2, 1.0, 0.8 + 0.1 * std::tanh(r.normal()))); }),
        1e-13)
        << scale;
  }
}

TEST_P(BatchedPolar, DegenerateGivesSomeRotationThatIsNoWorse) {
  const double nearly = 1e-12;
  const std::array<Mat3, kBatch> F{Mat3::Zero(),
                                   Vec3(1.0, 0.0, 0.0).asDiagonal().toDenseMatrix(),
                                   Vec3(1.0, 1.0, -1.0).asDiagonal().toDenseMatrix(),
                                   Vec3(2.0, 1.0, -1.0).asDiagonal().toDenseMatrix(),
                                   Vec3(1.0, nearly, -nearly).asDiagonal().toDenseMatrix(),
                                   -Mat3::Identity(),
                                   1e-200 * Mat3::Ones(),
                                   Vec3(1.0, 1.0 + 1e-9, -1.0).asDiagonal().toDenseMatrix()};
  const std::array<Mat3, kBatch> R = (*this)(F);
  for (std::size_t lane = 0; lane < kBatch; ++lane) {
    EXPECT_LT((R[lane].transpose() * R[lane] - Mat3::Identity()).norm(), 1e-13) << lane;
    EXPECT_NEAR(R[lane].determinant(), 1.0, 1e-13) << lane;
    const double best = (by_svd(F[lane]).transpose() * F[lane]).trace();
    EXPECT_NEAR((R[lane].transpose() * F[lane]).trace(), best, 1e-13 * F[lane].cwiseAbs().sum()) << lane;
  }
}

TEST_P(BatchedPolar, OneBadLaneLeavesTheOthersAlone) {
  Rotations rotation(8);
  std::array<Mat3, kBatch> F;
  for (Mat3& f : F) f = rotation() * Vec3(1.3, 1.0, 0.7).asDiagonal() * rotation();
  F[2].setConstant(std::numeric_limits<double>::quiet_NaN());
  F[5].setZero();
  const std::array<Mat3, kBatch> R = (*this)(F);
  EXPECT_TRUE(std::isnan(R[2](0, 0)));
  for (const std::size_t lane : {0, 1, 3, 4, 5, 6, 7}) {
    EXPECT_LT((R[lane].transpose() * R[lane] - Mat3::Identity()).norm(), 1e-13) << lane;
    if (lane != 5) {
      EXPECT_LT((R[lane] - by_svd(F[lane])).norm(), 1e-13) << lane;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EachInstructionSet, BatchedPolar, testing::Values("portable", "avx2", "avx512"),
                         [](const auto& tested) { return std::string(tested.param); });

class NearestRotation : public testing::TestWithParam<OfOneTet> {};

TEST_P(NearestRotation, AgreesWithTheSvdAndDegenerateIsFixed) {
  Rotations rotation(21);
  for (int trial = 0; trial < 500; ++trial) {
    const Mat3 F =
        rotation() *
        Vec3(1.5 + 0.3 * std::tanh(rotation.normal()), 1.0, 0.6 * std::tanh(rotation.normal())).asDiagonal() *
        rotation();
    EXPECT_LT((scalar(GetParam(), F) - by_svd(F)).norm(), 2e-13);
  }
  EXPECT_EQ(scalar(GetParam(), Mat3::Zero()), Mat3::Identity());
  EXPECT_TRUE(scalar(GetParam(), Mat3::Constant(std::numeric_limits<double>::infinity())).array().isNaN().all());
  EXPECT_EQ(scalar(GetParam(), -Mat3::Identity()), scalar(GetParam(), -Mat3::Identity()));
}

INSTANTIATE_TEST_SUITE_P(OfOneTet, NearestRotation,
                         testing::Values(&element::nearest_rotation, &element::rotation_by_eigenvectors),
                         [](const auto& tested) { return tested.index == 0 ? "ClosedForm" : "Eigenvectors"; });

}  // namespace
}  // namespace rhexis::test
