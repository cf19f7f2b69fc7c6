// beta = "auto" against beta 0, 1, 10, 100, 1000 on bodies whose trusted answer is Taylor-Hood on the refined mesh:
//   (a) the error of lambda is at least 5 times below that of beta = 0, and at most 1.5 times the best of the sweep;
//   (b) the error of u is at most 1.3 times the best of the sweep.
// Where a demand is not met the case is named below, with what holds instead and why; docs/stabilisation.md repeats it.
// All cases take some ten minutes: they run with RHEXIS_FULL=1 in the environment, a quarter of them always.

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>

#include "mesh/generate.h"
#include "mesh/quality.h"
#include "mesh/validate.h"
#include "model/refine.h"
#include "model/stabilisation.h"
#include "tests/solver/stabilisation_bodies.h"
#include "tests/support/measured.h"

namespace rhexis {
namespace {

enum class When { always, two_nus, full };  ///< two_nus: nu 0.49 and 0.4999 always, the others in full runs

struct NamedBody {
  std::string name;
  std::function<test::StudyBody()> make;
  When when = When::full;
};

const std::vector<NamedBody>& bodies() {
  static const std::vector<NamedBody> list{
      {"bar3", [] { return test::make_bar_body(3); }, When::two_nus},
      {"bar4", [] { return test::make_bar_body(4); }},
      {"barfree", [] { return test::make_bar_body(mesh::make_bar({.size = Vec3(0.1, 0.1, 0.4)}, 300).value()); }},
      {"cook4", [] { return test::make_cook_body(4); }, When::always},
      {"cook8", [] { return test::make_cook_body(8); }},
      {"foot4", [] { return test::make_foot_body(4, true); }, When::always},
      {"foot6", [] { return test::make_foot_body(6, true); }},
      {"tube10", [] { return test::make_tube_body(10, 12); }, When::two_nus},
      {"tube12", [] { return test::make_tube_body(12, 12); }},
      // Two cells through the height of a bent bar; cells twice as long as the wall is thick; one diagonal for all.
      {"bar2", [] { return test::make_bar_body(2); }},
      {"tube8", [] { return test::make_tube_body(8, 8); }},
      {"foot6plain", [] { return test::make_foot_body(6, false); }},
  };
  return list;
}

/// Cases in which no beta of the sweep brings the error of lambda 5 times below that of beta = 0, so that (a) asks for
/// more than the mesh can give. The test holds them to that reason.
const std::set<std::pair<std::string, double>> kNoBetaIsFiveTimesBelowZero{
    {"bar2", 0.45},  {"bar2", 0.49},  {"bar3", 0.45},  {"bar4", 0.45},  {"cook4", 0.45},
    {"foot4", 0.45}, {"foot4", 0.49}, {"foot6", 0.45}, {"foot6", 0.49}, {"foot6plain", 0.45}};

/// Cases in which (b) fails, and how far: error of u over the best of the sweep. Too few cells in bending (bar2, cook4,
/// tube): there a larger beta softens the body by just what locking stiffened it. One diagonal for all cells under the
/// footing: there a smaller beta is better.
const std::map<std::pair<std::string, double>, double> kDisplacementBounds{
    {{"cook4", 0.45}, 2.5},       {{"tube10", 0.45}, 1.35},     {{"bar2", 0.45}, 12.0},
    {{"bar2", 0.49}, 1.8},        {{"bar2", 0.499}, 1.6},       {{"tube8", 0.45}, 1.5},
    {{"tube8", 0.49}, 1.5},       {{"tube8", 0.499}, 1.5},      {{"foot6plain", 0.45}, 1.55},
    {{"foot6plain", 0.49}, 2.35}, {{"foot6plain", 0.499}, 2.5}, {{"foot6plain", 0.4999}, 2.5}};

constexpr std::array<double, 5> kSweep{0, 1, 10, 100, 1000};

struct Case {
  NamedBody body;
  double nu = 0.0;
};

/// A quarter of the cases unless all are asked for.
bool is_run(const Case& tested) {
  const bool one_of_two = tested.nu == 0.49 || tested.nu == 0.4999;
  const When when = tested.body.when;
  return std::getenv("RHEXIS_FULL") != nullptr || when == When::always || (when == When::two_nus && one_of_two);
}

class AutoBetaStudy : public testing::TestWithParam<Case> {};

TEST_P(AutoBetaStudy, IsNearTheBestOfTheSweep) {
  const auto& [named, nu] = GetParam();
  const test::StudyBody body = named.make();
  const material::MooneyRivlin law = material::to_mooney_rivlin({body.young, nu});
  const mesh::TetMesh fine = model::refine(body.mesh);
  const test::Answer reference =
      test::seen_on(body.mesh, fine, test::solve(body, fine, nu, model::ModelKind::taylor_hood, 0.0));

  std::vector<test::StudyErrors> errors;
  std::vector<double> oscillations;
  std::vector<double> betas(kSweep.begin(), kSweep.end());
  betas.push_back(model::auto_beta(law));
  double min_J = 1.0;
  std::string iterations;
  for (const double beta : betas) {
    const test::Answer answer = test::solve(body, body.mesh, nu, model::ModelKind::hyperelastic, beta);
    errors.push_back(test::errors_of(body.mesh, answer, reference));
    oscillations.push_back(test::oscillation(body.mesh, answer));
    min_J = answer.min_J;
    iterations += fmt::format(" {}", answer.iterations);
  }
  const test::StudyErrors& at_zero = errors.front();
  const test::StudyErrors& at_auto = errors.back();
  double best_lambda = errors[1].lambda;
  double best_u = errors[0].u;
  std::string lambdas, us;
  for (std::size_t i = 0; i < kSweep.size(); ++i) {
    if (i > 0) best_lambda = std::min(best_lambda, errors[i].lambda);
    best_u = std::min(best_u, errors[i].u);
    lambdas += fmt::format("{:.3f} | ", errors[i].lambda);
    us += fmt::format("{:.4f} | ", errors[i].u);
  }
  test::measured("| {} | {} | {:.4g} | {}**{:.3f}** | {:.1f} | {:.2f} | {}**{:.4f}** | {:.2f} | {:.2f} / {:.2f} |",
                 named.name, nu, betas.back(), lambdas, at_auto.lambda, at_zero.lambda / at_auto.lambda,
                 at_auto.lambda / best_lambda, us, at_auto.u, at_auto.u / best_u, oscillations.front(),
                 oscillations.back());
  test::measured("{} {}: nodes {} tets {}, smallest J with auto {:.2f}, Newton iterations{}", named.name, nu,
                 body.mesh.node_count(), body.mesh.tet_count(), min_J, iterations);
  const double thick = mesh::thickness(body.mesh);
  test::measured("{} {}: smoothing length over thickness: auto {:.2f}, beta 100 {:.2f}, beta 1000 {:.2f}", named.name,
                 nu, model::smoothing_length(body.mesh, law, betas.back()) / thick,
                 model::smoothing_length(body.mesh, law, 100) / thick,
                 model::smoothing_length(body.mesh, law, 1000) / thick);

  EXPECT_LE(at_auto.lambda, 1.5 * best_lambda);
  if (kNoBetaIsFiveTimesBelowZero.contains({named.name, nu}))
    EXPECT_GT(best_lambda, at_zero.lambda / 5.0) << "no longer an exception";
  else
    EXPECT_LE(at_auto.lambda, at_zero.lambda / 5.0);

  const auto exception = kDisplacementBounds.find({named.name, nu});
  if (exception == kDisplacementBounds.end()) {
    EXPECT_LE(at_auto.u, 1.3 * best_u);
  } else {
    EXPECT_LE(at_auto.u, exception->second * best_u);
    EXPECT_GT(at_auto.u, 1.3 * best_u) << "no longer an exception";
  }
  // What holds in every case, exceptions included.
  EXPECT_LT(at_auto.u, at_zero.u);
  EXPECT_LT(at_auto.lambda, 0.5);
  EXPECT_LT(oscillations.back(), 0.5 * oscillations.front());
  EXPECT_GT(min_J, 0.7);
}

std::vector<Case> cases() {
  std::vector<Case> list;
  for (const NamedBody& body : bodies())
    for (const double nu : {0.45, 0.49, 0.499, 0.4999})
      if (is_run({body, nu})) list.push_back({body, nu});
  return list;
}

INSTANTIATE_TEST_SUITE_P(All, AutoBetaStudy, testing::ValuesIn(cases()), [](const auto& tested) {
  return fmt::format("{}_nu{:.0f}", tested.param.body.name, 1e4 * tested.param.nu);
});

TEST(StudyBodies, MeshesAndTheirRefinementsAreSoundAndFillTheSame) {
  for (const NamedBody& named : bodies()) {
    const mesh::TetMesh mesh = named.make().mesh;
    const mesh::TetMesh fine = model::refine(mesh);
    EXPECT_TRUE(mesh::find_defects(mesh).empty()) << named.name;
    EXPECT_TRUE(mesh::find_defects(fine).empty()) << named.name;
    for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
      double volume = 0.0;
      for (std::size_t child = 8 * t; child < 8 * (t + 1); ++child) volume += mesh::signed_volume(fine, TetId(child));
      ASSERT_NEAR(volume, mesh::signed_volume(mesh, TetId(t)), 1e-12 * volume) << named.name << " tet " << t;
    }
    EXPECT_EQ(mesh::find_faces(fine).boundary.size(), 4 * mesh::find_faces(mesh).boundary.size()) << named.name;
  }
}

// What a beta costs in lambda goes by the length over which it smooths, not by beta: at equal lengths, betas that
// differ a hundredfold lose the same; at equal beta they do not.
TEST(SmoothingLength, DecidesWhatIsLostAndBetaDoesNot) {
  const test::StudyBody body = test::make_cook_body(4);
  const mesh::TetMesh fine = model::refine(body.mesh);
  std::vector<double> lengths, by_length, by_beta;
  for (const auto& [nu, beta] : {std::pair{0.49, 10.0}, {0.499, 100.0}, {0.4999, 1000.0}}) {
    const test::Answer reference =
        test::seen_on(body.mesh, fine, test::solve(body, fine, nu, model::ModelKind::taylor_hood, 0.0));
    const auto error = [&](double with) {
      return test::errors_of(body.mesh, test::solve(body, body.mesh, nu, model::ModelKind::hyperelastic, with),
                             reference)
          .lambda;
    };
    lengths.push_back(model::smoothing_length(body.mesh, material::to_mooney_rivlin({body.young, nu}), beta));
    by_length.push_back(error(beta));
    by_beta.push_back(error(100.0));
    test::measured("nu {}: beta {} smooths over {:.2f} mm, error of lambda {:.3f}; beta 100: {:.3f}", nu, beta,
                   1e3 * lengths.back(), by_length.back(), by_beta.back());
  }
  for (std::size_t i = 1; i < lengths.size(); ++i) {
    EXPECT_NEAR(lengths[i], lengths[0], 0.02 * lengths[0]);
    EXPECT_NEAR(by_length[i], by_length[0], 0.02 * by_length[0]);
  }
  EXPECT_GT(by_beta[0], 2.0 * by_beta[1]);
}

}  // namespace
}  // namespace rhexis
