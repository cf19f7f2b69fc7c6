// One contract for all criteria, then what each says in closed form.

#include "fracture/criterion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/fracture/stress_fields.h"

namespace rhexis::fracture::test {
namespace {

constexpr double kEdge = 0.01;

CriterionSettings settings_with(double strength, double threshold, bool ahead_only = true) {
  return {.strength = strength, .advance_threshold = threshold, .ahead_only = ahead_only, .mean_edge = kEdge};
}

std::unique_ptr<Criterion> make(std::string_view name, const CriterionSettings& settings) {
  auto criterion = make_criterion(name, settings);
  EXPECT_TRUE(criterion) << criterion.error().message();
  return std::move(*criterion);
}

/// A tip in mixed mode, with scatter as a coarse mesh has it, so that nothing is symmetric by accident.
std::vector<TetStress> mixed_tip(std::uint64_t seed = 1) {
  std::vector<TetStress> tets = tets_around(tip_field(3000.0, -800.0, 500.0), kEdge, 200, seed);
  std::mt19937_64 random(seed + 100);
  for (TetStress& tet : tets) {
    Mat3 scatter;
    for (int i = 0; i < 9; ++i) scatter(i / 3, i % 3) = 2000.0 * (uniform(random) - 0.5);
    tet.stress += 0.5 * (scatter + scatter.transpose());
  }
  return tets;
}

class CriterionContract : public testing::TestWithParam<std::string_view> {
 protected:
  const FrontSection section{};
  std::unique_ptr<Criterion> with(double strength, double threshold, bool ahead_only = true) const {
    return make(GetParam(), settings_with(strength, threshold, ahead_only));
  }
};

TEST_P(CriterionContract, TurnsWithTheBody) {
  const std::vector<TetStress> tets = mixed_tip();
  const auto criterion = with(1e4, 5e3);
  const Judgement here = criterion->judge(section, tets);
  ASSERT_GT(here.value, 0.0);
  ASSERT_GT(here.length, 0.0);
  const Mat3 Q = (Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()) * Eigen::AngleAxisd(2.0, Vec3::UnitX()))
                     .toRotationMatrix();
  const Vec3 shift(0.3, -0.2, 0.1);
  FrontSection turned = section;
  turned.point = {Q * section.point.position + shift, Q * section.point.direction, Q * section.point.tangent};
  std::vector<TetStress> turned_tets = tets;
  for (TetStress& tet : turned_tets) {
    tet.centroid = Q * tet.centroid + shift;
    tet.stress = Q * tet.stress * Q.transpose();
  }
  const Judgement there = criterion->judge(turned, turned_tets);
  // Some hundred operations of relative error 2^-53 on numbers of that size; the eigenvectors of stresses that differ
  // by a tenth lose one digit. A flat maximum is found to the root of rounding, 1e-8 radians.
  EXPECT_NEAR(there.value, here.value, 1e-12 * here.value);
  EXPECT_NEAR(there.length, here.length, 1e-13);
  EXPECT_LT((there.direction - Q * here.direction).norm(), 1e-7);
}

TEST_P(CriterionContract, ScalesWithStress) {
  std::vector<TetStress> tets = mixed_tip();
  const Judgement once = with(1e4, 5e3)->judge(section, tets);
  for (TetStress& tet : tets) tet.stress *= 8.0;  // a power of two: to the last bit
  const Judgement scaled = with(8e4, 4e4)->judge(section, tets);
  EXPECT_EQ(scaled.value, 8.0 * once.value);
  EXPECT_EQ(scaled.direction, once.direction);
  EXPECT_EQ(scaled.length, once.length);
  EXPECT_EQ(scaled.met, once.met);
}

TEST_P(CriterionContract, MoreStressNeverHeals) {
  std::vector<TetStress> tets = mixed_tip();
  const auto criterion = with(1e4, 5e3);
  Judgement last = criterion->judge(section, tets);
  for (int i = 0; i < 20; ++i) {
    for (TetStress& tet : tets) tet.stress *= 1.1;
    const Judgement now = criterion->judge(section, tets);
    EXPECT_GT(now.value, last.value);
    EXPECT_GE(now.length, last.length);
    EXPECT_TRUE(now.met || !last.met);
    last = now;
  }
  EXPECT_TRUE(last.met);
}

TEST_P(CriterionContract, ZeroStressNeverTears) {
  const Judgement judgement = with(std::numeric_limits<double>::min(), std::numeric_limits<double>::min())
                                  ->judge(section, tets_around(uniform_field(Mat3::Zero()), kEdge));
  EXPECT_FALSE(judgement.met);
  EXPECT_EQ(judgement.value, 0.0);
  EXPECT_EQ(judgement.length, 0.0);
}

TEST_P(CriterionContract, NoTetIsNoTear) {
  const Judgement judgement = with(1.0, 1.0)->judge(section, {});
  EXPECT_FALSE(judgement.met);
  EXPECT_FALSE(judgement.tet.valid());
  EXPECT_EQ(judgement.direction, section.point.direction);
}

TEST_P(CriterionContract, IsMetFromTheStrengthOn) {
  const std::vector<TetStress> tets = mixed_tip();
  const double value = with(1.0, 1.0)->judge(section, tets).value;
  EXPECT_TRUE(with(value, 1.0)->judge(section, tets).met);
  EXPECT_FALSE(with(std::nextafter(value, 2.0 * value), 1.0)->judge(section, tets).met);
}

TEST_P(CriterionContract, ReachesTheFurthestTetAboveTheLowerThreshold) {
  const std::vector<TetStress> tets = mixed_tip();
  double last = std::numeric_limits<double>::infinity();
  bool falls = false;
  for (const double threshold : {1.0, 4e3, 8e3, 1.2e4, 1.6e4, 1e6}) {
    const double length = with(2e6, threshold)->judge(section, tets).length;
    EXPECT_LE(length, last);
    falls = falls || length < last;
    last = length;
    const bool is_a_distance = std::any_of(tets.begin(), tets.end(), [&](const TetStress& tet) {
      return tet.centroid.head<2>().norm() == length && tet.centroid[0] >= 0.0;
    });
    EXPECT_TRUE(is_a_distance || length == 0.0);
  }
  EXPECT_TRUE(falls);
  EXPECT_EQ(last, 0.0);
}

TEST_P(CriterionContract, TetsAtTheHandDoNotCount) {
  std::vector<TetStress> tets = mixed_tip();
  const Judgement without = with(1e4, 5e3)->judge(section, tets);
  TetStress held = tets.front();
  held.centroid = Vec3(3.4 * kEdge, 0.1 * kEdge, 0.0);
  held.stress = 1e9 * Mat3::Identity() + 1e9 * Vec3::UnitY() * Vec3::UnitY().transpose();
  held.at_hand = true;
  tets.push_back(held);
  const Judgement with_hand = with(1e4, 5e3)->judge(section, tets);
  EXPECT_EQ(with_hand.value, without.value);
  EXPECT_EQ(with_hand.direction, without.direction);
  EXPECT_EQ(with_hand.length, without.length);
  tets.back().at_hand = false;
  EXPECT_NE(with(1e4, 5e3)->judge(section, tets).value, without.value);
}

TEST_P(CriterionContract, AheadOnlyLeavesOutWhatIsBehind) {
  // Far behind, out of every ring: it can only decide where single tets do.
  std::vector<TetStress> tets = mixed_tip();
  const Judgement without = with(1e4, 5e3)->judge(section, tets);
  TetStress behind = tets.front();
  behind.tet = TetId(12345);
  behind.centroid = Vec3(-5.0 * kEdge, 0.1 * kEdge, 0.0);
  behind.stress = in_plane(1e6, 3e6, 0.0);
  tets.push_back(behind);
  const Judgement ahead = with(1e4, 5e3, true)->judge(section, tets);
  EXPECT_EQ(ahead.value, without.value);
  EXPECT_EQ(ahead.length, without.length);
  EXPECT_NE(ahead.tet, behind.tet);
  const Judgement all = with(1e4, 5e3, false)->judge(section, tets);
  EXPECT_DOUBLE_EQ(all.length, behind.centroid.head<2>().norm());
  EXPECT_EQ(all.tet == behind.tet, GetParam() != "maximum-hoop");
}

TEST_P(CriterionContract, BesideCountsAsAhead) {
  const std::vector<TetStress> beside = [] {
    std::vector<TetStress> tets = tets_around(uniform_field(in_plane(2e4, 0.0, 0.0)), kEdge, 1);
    tets[0].centroid = Vec3(0.0, 2.0 * kEdge, 0.0);
    return tets;
  }();
  EXPECT_DOUBLE_EQ(with(1e4, 5e3)->judge(section, beside).length, 2.0 * kEdge);
}

TEST_P(CriterionContract, MirrorsWithTheBody) {
  const std::vector<TetStress> tets = mixed_tip();
  const Judgement here = with(1e4, 5e3)->judge(section, tets);
  ASSERT_GT(std::abs(here.direction[1]), 1e-3);
  std::vector<TetStress> mirrored = tets;
  const Mat3 M = Vec3(1.0, -1.0, 1.0).asDiagonal();
  for (TetStress& tet : mirrored) {
    tet.centroid = M * tet.centroid;
    tet.stress = M * tet.stress * M;
  }
  const Judgement there = with(1e4, 5e3)->judge(section, mirrored);
  EXPECT_NEAR(there.value, here.value, 1e-12 * here.value);  // as for TurnsWithTheBody
  EXPECT_LT((there.direction - M * here.direction).norm(), 1e-7);
}

TEST_P(CriterionContract, GoesForwardInThePlaneOfTheSection) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<TetStress> tets = tets_around(uniform_field(Mat3::Zero()), kEdge, 1 + static_cast<int>(seed), seed);
    for (TetStress& tet : tets) {
      Mat3 any;
      for (int i = 0; i < 9; ++i) any(i / 3, i % 3) = uniform(random) - 0.5;
      tet.stress = any + any.transpose();
    }
    const Judgement judgement = with(1e-3, 1e-3)->judge(section, tets);
    EXPECT_NEAR(judgement.direction.norm(), 1.0, 1e-14);
    EXPECT_NEAR(judgement.direction.dot(section.point.tangent), 0.0, 1e-14);
    EXPECT_GE(judgement.direction.dot(section.point.direction), -1e-9);
  }
}

TEST_P(CriterionContract, AFrontPointSeesItsOwnSectionOnly) {
  std::vector<TetStress> tets = mixed_tip();
  const Judgement alone = with(1e4, 5e3)->judge({section.point, 0.6 * kEdge}, tets);
  EXPECT_EQ(alone.value, with(1e4, 5e3)->judge(section, tets).value);  // all of them lie within
  TetStress other = tets.front();
  other.centroid = Vec3(kEdge, 0.1 * kEdge, 0.7 * kEdge);
  other.stress = in_plane(0.0, 1e8, 0.0);
  tets.push_back(other);
  EXPECT_EQ(with(1e4, 5e3)->judge({section.point, 0.6 * kEdge}, tets).value, alone.value);
  EXPECT_GT(with(1e4, 5e3)->judge({section.point, 0.8 * kEdge}, tets).value, 2.0 * alone.value);
}

INSTANTIATE_TEST_SUITE_P(All, CriterionContract, testing::ValuesIn(kCriterionNames), [](const auto& one) {
  std::string name(one.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

/// One tet two mean edges ahead in uniaxial tension at `degrees` from +x.
Judgement pulled(std::string_view name, double degrees) {
  const Vec3 pull(std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0.0);
  std::vector<TetStress> tets = tets_around(uniform_field(7e3 * pull * pull.transpose()), kEdge, 1);
  tets[0].centroid = Vec3(2.0 * kEdge, 0.0, 0.0);
  return make(name, settings_with(7e3 * (1.0 - 1e-14), 1.0))->judge({}, tets);
}

TEST(UniaxialTension, IsItsOwnValueForAll) {
  for (const std::string_view name : kCriterionNames) {
    const Judgement judgement = pulled(name, 60.0);
    EXPECT_NEAR(judgement.value, 7e3, 1e-10) << name;
    EXPECT_TRUE(judgement.met) << name;
  }
}

TEST(UniaxialTension, OpensAcrossThePull) {
  for (const double degrees : {30.0, 60.0, 90.0, 120.0, 150.0}) {
    EXPECT_NEAR(turn_of(pulled("maximum-principal", degrees), {}), degrees - 90.0, 1e-10);
    EXPECT_NEAR(turn_of(pulled("von-mises", degrees), {}), degrees - 90.0, 1e-10);
    EXPECT_NEAR(turn_of(pulled("maximum-hoop", degrees), {}), degrees - 90.0, 1e-6);  // a flat maximum, in degrees
  }
}

TEST(UniaxialTension, ShearsAtFortyFiveDegreesTheNearerWay) {
  EXPECT_NEAR(turn_of(pulled("maximum-shear", 60.0), {}), 15.0, 1e-10);
  EXPECT_NEAR(turn_of(pulled("maximum-shear", 120.0), {}), -15.0, 1e-10);
  EXPECT_NEAR(turn_of(pulled("maximum-shear", 90.0), {}), 45.0, 1e-10);  // both as near: towards the upper flank
}

TEST(MaximumPrincipal, WithoutAnAxisOfItsOwnGoesStraight) {
  // Equal tension in the plane, and in space: any plane will do, so none turns the crack.
  for (const double through : {0.0, 5e3}) {
    Mat3 stress = in_plane(5e3, 5e3, 0.0);
    stress(2, 2) = through;
    std::vector<TetStress> tets = tets_around(uniform_field(stress), kEdge, 1);
    tets[0].centroid = Vec3(kEdge, 0.0, 0.0);
    EXPECT_NEAR(turn_of(make("maximum-principal", settings_with(1.0, 1.0))->judge({}, tets), {}), 0.0, 1e-10);
  }
}

TEST(MaximumPrincipal, TensionAlongTheFrontTurnsNothing) {
  Mat3 stress = Mat3::Zero();
  stress(2, 2) = 5e3;
  std::vector<TetStress> tets = tets_around(uniform_field(stress), kEdge, 1);
  tets[0].centroid = Vec3(kEdge, 0.0, 0.0);
  const Judgement judgement = make("maximum-principal", settings_with(1.0, 1.0))->judge({}, tets);
  EXPECT_TRUE(judgement.met);
  EXPECT_EQ(judgement.direction, Vec3(Vec3::UnitX()));
}

TEST(OneTetCriteria, DifferInTheirValue) {
  // s = (5, 1, -2) in other axes.
  const Mat3 Q = Eigen::AngleAxisd(0.9, Vec3(1.0, 1.0, 1.0).normalized()).toRotationMatrix();
  const Mat3 stress = Q * Vec3(5.0, 1.0, -2.0).asDiagonal() * Q.transpose();
  std::vector<TetStress> tets = tets_around(uniform_field(stress), kEdge, 1);
  tets[0].centroid = Vec3(kEdge, 0.0, 0.0);
  const auto value = [&](std::string_view name) { return make(name, settings_with(1.0, 1.0))->judge({}, tets).value; };
  EXPECT_NEAR(value("maximum-principal"), 5.0, 1e-14);
  EXPECT_NEAR(value("maximum-shear"), 7.0, 1e-14);
  EXPECT_NEAR(value("von-mises"), std::sqrt(0.5 * (16.0 + 9.0 + 49.0)), 1e-14);
}

TEST(OneTetCriteria, LeaveOutNoTetThatDecides) {
  // One tet by itself is worked out in any case.
  for (const std::string_view name : {"maximum-principal", "maximum-shear", "von-mises"}) {
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
      const std::vector<TetStress> tets = mixed_tip(seed);
      const auto criterion = make(name, settings_with(1e4, 5e3));
      Judgement most;
      double length = 0.0;
      for (const TetStress& tet : tets) {
        const Judgement alone = criterion->judge({}, std::span(&tet, 1));
        if (alone.value > most.value) most = alone;
        length = std::max(length, alone.length);
      }
      const Judgement all = criterion->judge({}, tets);
      EXPECT_EQ(all.tet, most.tet);
      EXPECT_EQ(all.value, most.value);
      EXPECT_EQ(all.direction, most.direction);
      EXPECT_EQ(all.length, length);
      EXPECT_GT(length, 0.0);
    }
  }
}

/// Erdogan and Sih: K_I sin t + K_II (3 cos t - 1) = 0, in degrees.
double erdogan_sih(double K_I, double K_II) {
  if (K_II == 0.0) return 0.0;
  const double ratio = K_I / K_II;
  return 2.0 * std::atan((ratio - std::copysign(std::sqrt(ratio * ratio + 8.0), K_II)) / 4.0) / kDegree;
}

TEST(MaximumHoop, IsErdoganAndSihNextToASharpTip) {
  for (const auto& [K_I, K_II] : {std::pair{1.0, 0.0}, {1.0, 0.3}, {1.0, -1.0}, {0.2, 1.0}, {0.0, 1.0}, {0.0, -1.0}}) {
    const auto tets = tets_around(tip_field(1000.0 * K_I, 1000.0 * K_II), kEdge);
    const Judgement judgement = make("maximum-hoop", settings_with(1.0, 1.0))->judge({}, tets);
    EXPECT_NEAR(turn_of(judgement, {}), erdogan_sih(K_I, K_II), 1e-5);  // the basis holds the field; a flat maximum
    // At half a mean edge: (2 pi r)^-1/2 cos(t/2) (K_I cos^2(t/2) - 3/2 K_II sin t).
    const double t = erdogan_sih(K_I, K_II) * kDegree;
    const double hoop = std::cos(t / 2.0) * (K_I * std::pow(std::cos(t / 2.0), 2) - 1.5 * K_II * std::sin(t));
    const double expected = 1000.0 * hoop / std::sqrt(2.0 * std::numbers::pi * 0.5 * kEdge);
    EXPECT_NEAR(judgement.value, expected, 1e-9 * expected);
  }
  EXPECT_NEAR(erdogan_sih(0.0, 1.0), -70.5288, 1e-4);
}

TEST(MaximumHoop, SeesThroughScatter) {
  // Every tet wrong by up to a quarter of the stress at the ring: single tets are lost, the fit is not.
  double worst_fit = 0.0;
  double worst_tet = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<TetStress> tets = tets_around(tip_field(3000.0, 0.0), kEdge, 300, seed);
    std::mt19937_64 random(seed);
    for (TetStress& tet : tets)
      tet.stress += 6000.0 * in_plane(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5);
    worst_fit = std::max(worst_fit, std::abs(turn_of(make("maximum-hoop", settings_with(1, 1))->judge({}, tets), {})));
    worst_tet =
        std::max(worst_tet, std::abs(turn_of(make("maximum-principal", settings_with(1, 1))->judge({}, tets), {})));
  }
  EXPECT_LT(worst_fit, 5.0);
  EXPECT_GT(worst_tet, 15.0);
}

TEST(Toughness, TakesThePlaceOfTheStrength) {
  Judgement judgement;
  judgement.value = 10.0;
  judgement.length = 7.0;
  judgement.direction = Vec3(0.6, 0.8, 0.0);
  EXPECT_TRUE(by_toughness(judgement, 3.0, 3.0, kEdge).met);
  EXPECT_FALSE(by_toughness(judgement, 2.999, 3.0, kEdge).met);
  EXPECT_EQ(by_toughness(judgement, 3.0, 3.0, kEdge).length, kEdge);
  EXPECT_EQ(by_toughness(judgement, 3.0, 3.0, kEdge).direction, judgement.direction);
  judgement.met = true;
  EXPECT_FALSE(by_toughness(judgement, 1.0, 3.0, kEdge).met);
  for (const double none : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_FALSE(by_toughness(judgement, none, 3.0, kEdge).met);
  judgement.value = -1.0;  // pressed together: the crack is closed, whatever the integral says
  EXPECT_FALSE(by_toughness(judgement, 30.0, 3.0, kEdge).met);
}

TEST(MakeCriterion, SaysWhatIsWrong) {
  const auto message = [](std::string_view name, const CriterionSettings& settings) {
    const auto made = make_criterion(name, settings);
    return made ? std::string("made") : made.error().message();
  };
  EXPECT_EQ(message("maximum-hop", settings_with(1.0, 1.0)),
            "unknown criterion 'maximum-hop' (did you mean 'maximum-hoop'?)");
  EXPECT_NE(message("x", settings_with(1.0, 1.0)).find("\"von-mises\""), std::string::npos);
  EXPECT_NE(message("von-mises", settings_with(1.0, 1.5)), "made");
  EXPECT_NE(message("von-mises", settings_with(std::nan(""), 1.0)), "made");
  EXPECT_EQ(message("von-mises", settings_with(1.5, 1.5)), "made");
}

}  // namespace
}  // namespace rhexis::fracture::test
