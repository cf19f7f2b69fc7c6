// One factor after another, against one from nothing to the bit, and against dense matrices.

#include "record/build/operator_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "record/build/recorder.h"
#include "tests/record/build/recorded_plate.h"
#include "tests/support/measured.h"

namespace rhexis::record::build {
namespace {

Eigen::MatrixXd dense(const store::OperatorPattern& pattern, const std::vector<double>& values) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(pattern.rows(), pattern.rows());
  for (std::int32_t j = 0; j < pattern.rows(); ++j) {
    for (auto p = static_cast<std::size_t>(pattern.start[static_cast<std::size_t>(j)]);
         p < static_cast<std::size_t>(pattern.start[static_cast<std::size_t>(j) + 1]); ++p)
      out(pattern.row[p], j) = values[p];
  }
  return out;
}

TEST(OperatorFactor, AfterAnAdvanceIsThatFromNothingToTheBit) {
  const CampaignRequest request = test::plate(300, false);
  const Recorder recorder(request.mesh, request.elastic, false);
  const std::int32_t rows = recorder.layout().pattern().rows();
  FactoredState state{test::torn(request, 0), OperatorFactor(recorder.layout())};
  ASSERT_TRUE(recorder.factor(state));
  EXPECT_EQ(state.factor.columns_made(), rows);
  for (const int number : {2, 8}) {  // straight on, and from there straight on
    state.torn = test::torn(request, number);
    ASSERT_TRUE(recorder.factor(state));
    rhexis::test::measured("topology {}: {} of {} columns computed again", number, state.factor.columns_made(), rows);
    EXPECT_LT(state.factor.columns_made(), rows);
    FactoredState anew{test::torn(request, number), OperatorFactor(recorder.layout())};
    ASSERT_TRUE(recorder.factor(anew));
    EXPECT_TRUE(state.factor.values() == anew.factor.values());
  }
}

TEST(OperatorFactor, IsTheCholeskyFactorAndHasItsInverse) {
  const CampaignRequest request = test::plate(120, false);
  const Recorder recorder(request.mesh, request.elastic, false);
  const store::OperatorPattern& pattern = recorder.layout().pattern();
  FactoredState state{test::torn(request, 3), OperatorFactor(recorder.layout())};
  ASSERT_TRUE(recorder.factor(state));
  const Eigen::MatrixXd L = dense(pattern, state.factor.values());
  const Eigen::MatrixXd K = L * L.transpose();
  EXPECT_LT((Eigen::MatrixXd(K.llt().matrixL()) - L).norm(), 1e-9 * L.norm());  // the condition of K
  const Eigen::MatrixXd inverse = K.llt().solve(Eigen::MatrixXd::Identity(K.rows(), K.cols()));
  const Eigen::MatrixXd selected = dense(pattern, state.factor.selected_inverse());
  double worst = 0.0;
  for (std::int32_t j = 0; j < pattern.rows(); ++j) {
    for (auto p = static_cast<std::size_t>(pattern.start[static_cast<std::size_t>(j)]);
         p < static_cast<std::size_t>(pattern.start[static_cast<std::size_t>(j) + 1]); ++p) {
      const std::int32_t i = pattern.row[p];
      worst = std::max(worst, std::abs(selected(i, j) - inverse(i, j)) / std::sqrt(inverse(i, i) * inverse(j, j)));
    }
  }
  rhexis::test::measured("selected inverse: {:.1e} of the diagonal at worst", worst);
  EXPECT_LT(worst, 1e-10);
}

TEST(OperatorFactor, RefusesABodyThatMovesFreely) {
  CampaignRequest request = test::plate(120, false);
  request.elastic.supports.resize(6);  // two nodes: it turns about the line between them
  const Recorder recorder(request.mesh, request.elastic, false);
  FactoredState state{test::torn(test::plate(120, false), 0), OperatorFactor(recorder.layout())};
  EXPECT_FALSE(recorder.factor(state));
}

}  // namespace
}  // namespace rhexis::record::build
