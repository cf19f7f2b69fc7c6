#include "response/recorded_response.h"

#include <Eigen/Eigenvalues>

#include "response/recorded_contact.h"
#include "tests/response/recorded_case.h"
#include "tests/support/measured.h"

namespace rhexis::response::test {
namespace {

using record::store::Advanced;

/// Two factorisations of one stiffness differ by its condition number, some 1e6, times 2^-53.
constexpr double kSame = 1e-9;

const std::vector<Vec3> kHolds{{0.03, 0.0, 0.005}, {0.031, 0.113, 0.01}, {0.09, 0.02, 0.0}, {0.2, 0.24, 0.01}};

double largest(const VectorX& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0; }

class RecordedResponseOf : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Plate, RecordedResponseOf, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Loaded" : "Unloaded"; });

TEST_P(RecordedResponseOf, IsTheExactOneAtEveryRecordedCrack) {
  const RecordedCase& plate = RecordedCase::plate(GetParam());
  double worst = 0.0;
  for (int number = 0; number < plate.topologies(); ++number) {
    const record::build::TornState torn = plate.torn(number);
    const mesh::TornMesh& body = torn.body.mesh();
    const auto exact = plate.exact(body);
    const auto recorded = plate.recorded(body, plate.advances_to(number));
    for (std::size_t k = 0; k < kHolds.size(); ++k) {
      const SurfacePoint point = point_at(body, kHolds[k], k == 0 ? 0.05 : 0.0);
      exact->grasp(nodes_of(point));
      recorded->grasp(nodes_of(point));
      const RecordUse use = *recorded->record_use();
      EXPECT_EQ(use.topology, number);
      EXPECT_FALSE(use.outside || use.past_last || use.torn_off) << number << ", hold " << k;
      bool made = true;
      for (int n = number; n > 0; n = plate.numbering().parent(n))
        made = made && (plate.record->record().flags[static_cast<std::size_t>(n)] &
                        (record::store::opened_nothing | record::store::unstable)) == 0;
      EXPECT_EQ(use.not_made, !made);
      const VectorX force = VectorX::LinSpaced(3 * point.count, -0.7, 1.1);
      VectorX u;
      VectorX wanted;
      recorded->whole_displacement(force, 1.0, u);
      exact->whole_displacement(force, 1.0, wanted);
      const double scale = largest(wanted);
      worst = std::max({worst, (recorded->compliance() - exact->compliance()).norm() / exact->compliance().norm(),
                        largest(recorded->rest() - exact->rest()) / scale, largest(u - wanted) / scale});
      EXPECT_LT(worst, kSame) << "topology " << number << ", hold " << k;
      const double energy = exact->stored_energy(force);
      EXPECT_NEAR(recorded->stored_energy(force), energy, kSame * energy);
    }
  }
  rhexis::test::measured("recorded response against the exact one: off by {:.1e}", worst);
}

TEST_P(RecordedResponseOf, StoresTheEnergyOfATearToo) {
  const RecordedCase& plate = RecordedCase::plate(GetParam());
  record::build::TornState torn = plate.torn(0);
  const mesh::TornMesh& body = torn.body.mesh();
  const auto exact = plate.exact(body);
  const auto recorded = plate.recorded(body, {});
  const std::size_t before = body.history().size();
  torn.advance(Vec3::UnitY(), 0.0403);
  ASSERT_EQ(body.history().size(), before + 1);
  const CrackAdvance straight_on = plate.advance(90.0);
  ASSERT_TRUE(exact->follow(body.history().back(), {}, &straight_on).ok);
  ASSERT_TRUE(recorded->follow(body.history().back(), {}, &straight_on).ok);
  const double energy = exact->stored_energy({});
  EXPECT_EQ(energy != 0.0, GetParam());
  EXPECT_NEAR(recorded->stored_energy({}), energy, 1e-6 * std::abs(energy));  // a difference of energies 1e3 as large
}

TEST(RecordedResponse, BetweenRecordedCracksIsTheSumOfTheThesis) {
  const RecordedCase& plate = RecordedCase::plate(false);
  const record::build::TornState torn = plate.torn(0);
  const mesh::TornMesh& body = torn.body.mesh();
  const record::store::Lookup lookup(plate.record->record());
  const std::vector<Advanced> cracks{{71.0, 0.04}, {123.0, 0.04}};
  for (std::size_t n = 0; n <= 2; ++n) {
    std::vector<CrackAdvance> advances;
    for (std::size_t k = 0; k < n; ++k) advances.push_back(plate.advance(cracks[k].angle));
    const auto response = plate.recorded(body, advances);
    for (const Vec3& at : kHolds) {
      const SurfacePoint point = point_at(body, at);
      response->grasp(nodes_of(point));
      const Eigen::MatrixXd& C = response->compliance();
      EXPECT_EQ(C, C.transpose());
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C).eigenvalues().minCoeff(), 0.0);
      // The rule of the thesis, at a recorded direction, against its table.
      const ContactLaw law = make_contact_law(point, ContactRule::blend, ContactMode::hold, C, response->rest());
      for (const double angle : record::store::pull_angles(plate.record->head().parameters)) {
        const Vec3 pull = 0.03 * plate.record->head().frame.direction(angle);
        Vec3 wanted = Vec3::Zero();
        for (int k = 0; k < point.count; ++k) {
          const int of = *plate.record->point_of(point.node[static_cast<std::size_t>(k)].value());
          wanted += point.weight[k] * lookup.reaction(std::span(cracks).first(n), of, pull).force;
        }
        EXPECT_LT((law.force(pull) - wanted).norm(), 1e-12 * wanted.norm()) << n << ' ' << angle;
      }
    }
  }
}

TEST(RecordedResponse, DisplacesByTheNearestOperatorUnderTheInterpolatedDisplacementOfTheHand) {
  const RecordedCase& plate = RecordedCase::plate(false);
  const record::build::TornState torn = plate.torn(0);
  const mesh::TornMesh& body = torn.body.mesh();
  const auto between = plate.recorded(body, {plate.advance(70.0)});
  const SurfacePoint point = point_at(body, kHolds[1]);
  between->grasp(nodes_of(point));
  const int nearest = between->record_use()->topology;
  EXPECT_EQ(plate.numbering().choices(nearest).front().direction, 1);
  const record::build::TornState recorded = plate.torn(nearest);
  const auto exact = plate.exact(recorded.body.mesh());
  exact->grasp(nodes_of(point));
  const VectorX force = VectorX::LinSpaced(3 * point.count, -1.0, 0.5);
  const VectorX same = exact->compliance().llt().solve(between->compliance() * force);
  VectorX u;
  VectorX wanted;
  between->whole_displacement(force, 1.0, u);
  exact->whole_displacement(same, 1.0, wanted);
  for (std::size_t i = 0; i < body.mesh().node_count(); ++i) {
    if (!plate.record->is_in_solve(nearest, static_cast<std::int32_t>(i))) continue;
    const auto at = static_cast<Eigen::Index>(3 * i);
    EXPECT_LT((u - wanted).segment<3>(at).norm(), kSame * largest(wanted)) << i;
  }
  EXPECT_LT((u - wanted).norm(), 0.2 * wanted.norm());  // and where the record has no node its neighbours' mean
}

TEST(RecordedResponse, SaysWhatIsOutsideAndTakesTheNearest) {
  const RecordedCase& plate = RecordedCase::plate(false);
  const record::build::TornState torn = plate.torn(0);
  const mesh::TornMesh& body = torn.body.mesh();
  const SurfacePoint point = point_at(body, kHolds[1]);
  const auto held = [&](const std::vector<CrackAdvance>& advances) {
    auto out = plate.recorded(body, advances);
    out->grasp(nodes_of(point));
    return out;
  };
  const auto end = held({plate.advance(0.0)});
  const auto other_end = held({plate.advance(180.0)});
  EXPECT_FALSE(end->record_use()->outside || other_end->record_use()->outside);
  EXPECT_TRUE(held({plate.advance(-20.0)})->record_use()->outside);
  EXPECT_EQ(held({plate.advance(-20.0)})->compliance(), end->compliance());
  EXPECT_EQ(held({plate.advance(200.0)})->compliance(), other_end->compliance());
  EXPECT_EQ(held({plate.advance(185.0)})->record_use()->topology, other_end->record_use()->topology);

  const std::vector<CrackAdvance> three{plate.advance(90.0), plate.advance(90.0), plate.advance(0.0)};
  EXPECT_TRUE(held(three)->record_use()->past_last);
  EXPECT_EQ(held(three)->compliance(), held({three[0], three[1]})->compliance());

  // Another crack, and one that begins: the topology stays.
  CrackAdvance other = plate.advance(90.0);
  other.crack = 1;
  CrackAdvance begun = plate.advance(90.0);
  begun.started = true;
  for (const CrackAdvance& advance : {other, begun}) {
    const auto response = held({three[0], advance});
    EXPECT_TRUE(response->record_use()->outside);
    EXPECT_EQ(response->compliance(), held({three[0]})->compliance());
    response->go_back({}, {});
    EXPECT_FALSE(response->record_use()->outside);
    response->go_back({}, {});
    response->go_back({}, {});  // before the crack of the scene
    EXPECT_TRUE(response->record_use()->outside);
  }
}

TEST(RecordedResponse, KeepsAPointThatHasComeOffInTheRecordAlone) {
  const RecordedCase& plate = RecordedCase::plate(true);
  const record::build::TornState torn = plate.torn(0);
  const mesh::TornMesh& body = torn.body.mesh();
  int found = 0;
  for (int number = 1; number < plate.topologies(); ++number) {
    for (const std::int32_t node : plate.record->head().points) {
      if (plate.record->is_in_solve(number, node) || !plate.record->is_in_solve(0, node)) continue;
      const NodeId held(node);
      const auto response = plate.recorded(body, plate.advances_to(number));
      response->grasp(std::span(&held, 1));
      EXPECT_TRUE(response->record_use()->torn_off);
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(Mat3(response->compliance())).eigenvalues()[0], 0.0);
      VectorX u;
      response->whole_displacement(Vec3(0.1, 0.2, -0.3), 1.0, u);
      EXPECT_TRUE(u.allFinite());
      EXPECT_LT(
          (u.segment<3>(3 * Eigen::Index{node}) - response->rest() - response->compliance() * Vec3(0.1, 0.2, -0.3))
              .norm(),
          1e-12);
      ++found;
    }
  }
  EXPECT_GT(found, 0) << "some topology has to lose a grasp point";
}

TEST(RecordedResponse, OfSinglePrecisionFeelsTheSameForceToTheBit) {
  RecordedCase plate;
  plate.request = record::build::test::plate(300, false);
  const auto read = [&](bool single) {
    plate.request.single_precision = single;
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / ("single" + std::to_string(::getpid()));
    EXPECT_TRUE(record::build::Campaign::plan(plate.request)->run(file, {}, {}).has_value());
    plate.record = *record::store::LoadedRecord::read(file);
    std::filesystem::remove(file);
    return plate.record;
  };
  const SharedRecord whole = read(false);
  const SharedRecord half = read(true);
  EXPECT_LT(static_cast<double>(half->memory_bytes()), 0.7 * static_cast<double>(whole->memory_bytes()));
  const record::build::TornState torn = plate.torn(0);
  const SurfacePoint point = point_at(torn.body.mesh(), kHolds[1]);
  const std::vector<CrackAdvance> advances{plate.advance(71.0)};
  RecordedResponse one(torn.body.mesh(), whole, plate.request.elastic, advances);
  RecordedResponse other(torn.body.mesh(), half, plate.request.elastic, advances);
  one.grasp(nodes_of(point));
  other.grasp(nodes_of(point));
  EXPECT_EQ(one.compliance(), other.compliance());
  VectorX u;
  VectorX v;
  const VectorX force = VectorX::LinSpaced(3 * point.count, -1.0, 0.5);
  one.whole_displacement(force, 1.0, u);
  other.whole_displacement(force, 1.0, v);
  EXPECT_NE(u, v);
  EXPECT_LT((u - v).norm(), 1e-5 * u.norm());
}

}  // namespace
}  // namespace rhexis::response::test
