// Where a straight crack turns first, in pure opening and in pure shear, under refinement: the fit of the hoop stress
// beside the rule of one tet. docs/fracture.md shows what is printed here.

#include <gtest/gtest.h>

#include <cstdlib>

#include "fracture/path.h"
#include "fracture/path_start.h"
#include "tests/fracture/cracked_plate.h"
#include "tests/fracture/cut_support.h"
#include "tests/fracture/stress_fields.h"
#include "tests/support/measured.h"
#include "tests/support/reference.h"
#include "tests/support/shared_data.h"

namespace rhexis::fracture::test {
namespace {

constexpr double kShearKink = -70.53;  // degrees, Erdogan and Sih: acos(1/3), for K_II > 0

struct Turns {
  double hoop = 0.0;       ///< degrees
  double one_tet = 0.0;    ///< maximum principal, ahead only
  double to_letter = 0.0;  ///< the same over all tets, as the thesis has it
};

Turns turns(const LocalObject& local, const Crack& crack, double mean_edge) {
  const auto turn = [&](const char* name, bool ahead_only) {
    const auto criterion = make_criterion(
        name, {.strength = 1.0, .advance_threshold = 1.0, .ahead_only = ahead_only, .mean_edge = mean_edge});
    return turn_of(judge_front(**criterion, crack, mean_edge, local.stresses()).at(0), crack.front[0]);
  };
  return {turn("maximum-hoop", true), turn("maximum-principal", true), turn("maximum-principal", false)};
}

Turns turns_of(const mesh::TetMesh& mesh, const Crack& crack, const WholeProblem& problem) {
  const mesh::TornMesh body(mesh);
  const Surroundings surroundings(mesh);
  const VectorX u = solve_whole(body, problem);
  return turns(local_fields(body, surroundings, crack, problem, u), crack, surroundings.mean_edge());
}

void print(const std::string& mesh, Mode mode, double edge, const Turns& turns) {
  rhexis::test::measured("kink {} {} h {:.2f} mm: hoop {:.1f}, one tet {:.1f}, to the letter {:.1f} degrees",
                         mode == Mode::opening ? "I" : "II", mesh, 1e3 * edge, turns.hoop, turns.one_tet,
                         turns.to_letter);
}

class FirstKink : public testing::TestWithParam<Mode> {
 protected:
  double truth() const { return GetParam() == Mode::opening ? 0.0 : kShearKink; }
};

TEST_P(FirstKink, OnTheReferenceMeshes) {
  for (const std::string stem : {"u10", "u5", "graded"}) {
    const auto path = rhexis::test::shared_dir() / "reference/6_fracture_modeI" / stem;
    RHEXIS_SKIP_WITHOUT(path.parent_path());
    const mesh::TetMesh mesh = rhexis::test::read_reference_mesh(path);
    const Turns turns = turns_of(mesh, front_at(0.06, 0.12, 0.01), pulled_plate(mesh, GetParam(), "top", "bottom"));
    print(stem, GetParam(), Surroundings(mesh).mean_edge(), turns);
    EXPECT_NEAR(turns.hoop, truth(), 1.0);
    EXPECT_GT(std::abs(turns.one_tet - truth()), 15.0);  // what the fit is for
  }
}

TEST_P(FirstKink, OfACrackBetweenFacesOfTheMesh) {
  for (const int n : {12, 24, 48, 96}) {
    if (n == 96 && std::getenv("RHEXIS_FULL") == nullptr) break;
    for (const std::uint64_t seed : {1, 2, 3}) {
      const mesh::TetMesh mesh = cracked_plate(Vec3(0.24, 0.24, 0.01), {n, n, std::max(1, n / 24)}, n / 4, 0.2, seed);
      const Turns turns = turns_of(mesh, front_at(0.06, 0.12, 0.01), pulled_plate(mesh, GetParam()));
      print(fmt::format("box {} seed {}", n, seed), GetParam(), Surroundings(mesh).mean_edge(), turns);
      EXPECT_NEAR(turns.hoop, truth(), 1.0);
    }
  }
}

TEST_P(FirstKink, OfACrackThatWasCut) {
  // The whole way of a scene: a generated plate that does not know the crack, and the incision that keeps the nodes.
  for (const int nodes : {506, 1270, 5000, 20000}) {
    if (nodes == 20000 && std::getenv("RHEXIS_FULL") == nullptr) break;
    CutBody cut(*mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, nodes));
    const auto start = make_crack(Vec3(0.0, 0.12, 0.0), Vec3(0.06, 0.12, 0.0), Vec3::UnitZ(), cut.surroundings);
    ASSERT_TRUE(start) << start.error().message();
    cut.cut(start->surface);
    const WholeProblem problem = pulled_plate(cut.body.mesh(), GetParam());
    const VectorX u = solve_whole(cut.body, problem);
    const Crack& crack = start->cracks.at(0);
    const double edge = cut.surroundings.mean_edge();
    const Turns turns = fracture::test::turns(local_fields(cut.body, cut.surroundings, crack, problem, u), crack, edge);
    print(fmt::format("cut {}", nodes), GetParam(), edge, turns);
    EXPECT_NEAR(turns.hoop, truth(), GetParam() == Mode::opening ? 3.0 : 5.0);  // the goal; the tip is a notch here
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, FirstKink, testing::Values(Mode::opening, Mode::shear),
                         [](const auto& one) { return one.param == Mode::opening ? "opening" : "shear"; });

}  // namespace
}  // namespace rhexis::fracture::test
