#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "linalg/block_incomplete_cholesky.h"
#include "linalg/patches.h"
#include "linalg/saddle_residual.h"
#include "linalg/saddle_solver.h"
#include "tests/linalg/random_systems.h"
#include "tests/support/box_problem.h"

namespace rhexis::linalg {
namespace {

using test::MatrixX;
using testing::HasSubstr;

struct Solution {
  LinearReport factor;
  LinearReport solve;
  VectorX u;
  VectorX p;
};

Solution solve(SaddleSolver& solver, const SaddleMatrix& K, const FreeDofs& free, const VectorX& bu, const VectorX& bp,
               double tolerance) {
  Solution out;
  out.factor = solver.factor(K, free);
  if (out.factor.ok()) out.solve = solver.solve(bu, bp, tolerance, out.u, out.p);
  return out;
}

/// Weight in x-z and a little growth: both right-hand sides are there, smooth as in a Newton step.
struct Load {
  VectorX bu;
  VectorX bp;
  explicit Load(const SaddleMatrix& K) : bu(VectorX::Zero(K.displacement_unknowns())) {
    for (Eigen::Index i = 0; i < bu.size(); i += 3) {
      bu[i] = 0.3 / static_cast<double>(bu.size());
      bu[i + 2] = 1.0 / static_cast<double>(bu.size());
    }
    bp = VectorX::Constant(K.pressure_unknowns(), 1e-3 / std::max(1, K.pressure_unknowns()));
  }
};

SaddleMatrix displacement_system(const test::BoxProblem& problem) {
  SaddleMatrix K;
  K.A = problem.displacement_only;
  return K;
}

void expect_like_direct(const Solution& found, const SaddleMatrix& K, const FreeDofs& free, const Load& load,
                        double tolerance) {
  ASSERT_TRUE(found.factor.ok()) << found.factor.message;
  ASSERT_TRUE(found.solve.ok()) << found.solve.message;
  EXPECT_LE(found.solve.relative_residual, tolerance);
  const Solution exact = solve(*make_saddle_solver("direct", nullptr), K, free, load.bu, load.bp, 1e-14);
  ASSERT_TRUE(exact.solve.ok());
  // A residual of `tolerance` times the condition number, some 1e4 on these meshes.
  EXPECT_LT((found.u - exact.u).norm(), 1e4 * tolerance * exact.u.norm());
  if (found.p.size() > 0) {
    EXPECT_LT((found.p - exact.p).norm(), 1e4 * tolerance * exact.p.norm());
  }
  for (std::size_t dof = 0; dof < free.index.size(); ++dof) {
    if (free.index[dof] < 0) {
      EXPECT_EQ(found.u[static_cast<Eigen::Index>(dof)], 0.0);
    }
  }
}

TEST(ConjugateGradients, solve_displacement_systems) {
  const test::BoxProblem problem = test::make_box_problem(test::make_box({8, 4, 4}, 0.25), {1.0, 5.0, 0.0});
  const SaddleMatrix K = displacement_system(problem);
  const Load load(K);
  const auto solver = make_saddle_solver("cg", nullptr);
  const Solution found = solve(*solver, K, problem.free, load.bu, load.bp, 1e-10);
  expect_like_direct(found, K, problem.free, load, 1e-10);
  EXPECT_GT(found.solve.iterations, 5);
  EXPECT_LT(found.solve.iterations, 80);
  EXPECT_FALSE(found.solve.negative_pivots.has_value());
}

TEST(ConjugateGradients, on_the_condensed_system_need_few_iterations_at_any_beta) {
  const mesh::TetMesh box = test::make_box({10, 5, 5}, 0.2);
  struct Case {
    double beta;
    int most;
  };
  // beta = 0: C is its own diagonal, so the preconditioner is the inverse. Around 1 the diagonal of C is furthest from
  // C.
  for (const auto& [beta, most] : {Case{0.0, 1}, Case{1.0, 36}, Case{100.0, 13}, Case{1000.0, 8}}) {
    const test::BoxProblem problem = test::make_box_problem(box, {1.0, 25.0, beta});
    const Load load(problem.K);
    const auto solver = make_saddle_solver("cg", nullptr);
    const Solution found = solve(*solver, problem.K, problem.free, load.bu, load.bp, 1e-8);
    expect_like_direct(found, problem.K, problem.free, load, 1e-8);
    EXPECT_LE(found.solve.iterations, most) << beta;
    EXPECT_GT(solver->memory_bytes(), 100000U);
  }
}

TEST(ConjugateGradients, solve_when_a_pressure_couples_more_nodes_than_an_element_has) {
  std::mt19937 random(41);  // the pattern of A + B D^-1 B^T is larger than that of A, as for pressures at vertices
  SaddleMatrix K = test::random_saddle(60, 20, 40.0, 1.0, random);
  auto wide = std::make_shared<CsrPattern>();
  wide->row_start.push_back(0);
  for (std::int32_t p = 0; p < 20; ++p) {
    for (std::int32_t node = p; node < 60; node += 7) wide->column.push_back(node);
    wide->row_start.push_back(static_cast<std::int32_t>(wide->column.size()));
  }
  K.B = CouplingMatrix(wide);
  for (double& value : K.B.values) value = test::uniform(random);
  const FreeDofs free = test::random_supports(180, random);
  Load load(K);
  load.bu = test::random_vector(180, random);
  load.bp = test::random_vector(20, random);
  const Solution found = solve(*make_saddle_solver("cg", nullptr), K, free, load.bu, load.bp, 1e-10);
  expect_like_direct(found, K, free, load, 1e-10);
  EXPECT_LT(found.solve.iterations, 20);
}

TEST(ConjugateGradients, notice_other_values_of_c_supports_and_patterns) {
  const auto solver = make_saddle_solver("cg", nullptr);
  for (const std::array<int, 3> cells : {std::array<int, 3>{4, 3, 3}, std::array<int, 3>{3, 3, 3}}) {
    test::BoxProblem problem = test::make_box_problem(test::make_box(cells, 0.25), {1.0, 25.0, 10.0});
    const Load load(problem.K);
    const auto check = [&] {
      const Solution found = solve(*solver, problem.K, problem.free, load.bu, load.bp, 1e-9);
      expect_like_direct(found, problem.K, problem.free, load, 1e-9);
      return found.solve.iterations;
    };
    const int iterations = check();
    EXPECT_EQ(check(), iterations);
    for (double& value : problem.K.C.values) value *= 0.1;
    check();
    for (double& value : problem.K.A.values) value *= 2.0;
    check();
    std::vector<bool> held(problem.free.index.size());
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = problem.free.index[i] < 0 || i % 11 == 0;
    problem.free = make_free_dofs(held);
    check();
    const SaddleMatrix K = displacement_system(problem);
    expect_like_direct(solve(*solver, K, problem.free, load.bu, VectorX(), 1e-9), K, problem.free, Load(K), 1.0);
  }
}

TEST(ConjugateGradients, solve_where_a_alone_is_indefinite_but_the_condensed_matrix_is_not) {
  test::BoxProblem problem = test::make_box_problem(test::make_box({6, 4, 4}, 0.25), {1.0, 1000.0, 1.0});
  // Take stiffness off volume changes until A is indefinite; the pressures still hold them.
  for (std::size_t i = 0; i < problem.K.A.values.size(); ++i) {
    const double bulk = (problem.displacement_only.values[i] - problem.K.A.values[i]) / 1000.0;
    problem.K.A.values[i] -= 3.0 * bulk;
  }
  const Load load(problem.K);
  const auto direct = make_saddle_solver("direct", nullptr);
  EXPECT_EQ(direct->factor(problem.K, problem.free).negative_pivots, 0);
  SaddleMatrix a_alone;
  a_alone.A = problem.K.A;
  EXPECT_GT(*make_saddle_solver("direct", nullptr)->factor(a_alone, problem.free).negative_pivots, 0);
  const Solution found = solve(*make_saddle_solver("cg", nullptr), problem.K, problem.free, load.bu, load.bp, 1e-8);
  expect_like_direct(found, problem.K, problem.free, load, 1e-8);
}

TEST(ConjugateGradients, report_an_indefinite_matrix) {
  const test::BoxProblem problem = test::make_box_problem(test::make_box({4, 3, 3}, 0.25), {1.0, 25.0, 10.0});
  SaddleMatrix mixed = problem.K;
  SaddleMatrix plain = displacement_system(problem);
  for (SaddleMatrix* K : {&mixed, &plain}) {
    std::vector<double>& values = K->A.values;  // a spring of negative stiffness on every node
    for (std::int32_t node = 0; node < K->A.rows(); ++node) {
      const auto block = static_cast<std::size_t>(K->A.pattern->row_start[static_cast<std::size_t>(node) + 1]) - 1;
      for (const std::size_t c : {0U, 4U, 8U}) values[9 * block + c] -= 0.35;
    }
    ASSERT_GT(*make_saddle_solver("direct", nullptr)->factor(*K, problem.free).negative_pivots, 0);
    const Load load(*K);
    const Solution found = solve(*make_saddle_solver("cg", nullptr), *K, problem.free, load.bu, load.bp, 1e-8);
    const LinearReport& last = found.factor.ok() ? found.solve : found.factor;
    EXPECT_EQ(last.outcome, LinearOutcome::indefinite);
    EXPECT_THAT(last.message, HasSubstr("direct"));
  }
}

TEST(ConjugateGradients, say_what_they_could_not_reach) {
  const test::BoxProblem problem = test::make_box_problem(test::make_box({4, 3, 3}, 0.25), {1.0, 1e6, 1.0});
  const Load load(problem.K);
  const Solution found = solve(*make_saddle_solver("cg", nullptr), problem.K, problem.free, load.bu, load.bp, 1e-22);
  EXPECT_EQ(found.solve.outcome, LinearOutcome::not_converged);
  EXPECT_LT(found.solve.relative_residual, 1e-6);
  EXPECT_THAT(found.solve.message, HasSubstr("1.0e-22 was asked"));
}

TEST(IncompleteCholesky, is_exact_without_fill_and_shifts_when_it_breaks_down) {
  std::mt19937 random(42);
  std::vector<std::int32_t> chain;  // a tree has no fill
  for (std::int32_t i = 0; i + 1 < 30; ++i) chain.insert(chain.end(), {i, i + 1});
  auto pattern = std::make_shared<BlockPattern>(make_block_pattern(30, chain, 2));
  SymmetricBlockMatrix A = test::random_block_matrix(pattern, 12.0, random);
  const FreeDofs free = test::random_supports(90, random);
  BlockIncompleteCholesky factor;
  ASSERT_TRUE(factor.factor(A, free));
  EXPECT_EQ(factor.shift(), 0.0);
  VectorX r = test::random_vector(90, random);
  clear_held(free, r);
  VectorX z(90);
  factor.solve(r, z);
  const VectorX expected = test::restrict(test::dense(A), free).llt().solve(r(free.dof));
  EXPECT_LT((z(free.dof) - expected).norm(), 1e-13 * expected.norm());
  EXPECT_TRUE((z -
               [&] {
                 VectorX kept = z;
                 clear_held(free, kept);
                 return kept;
               }())
                  .isZero(0.0));

  A = test::random_block_matrix(pattern, 2.0, random);
  ASSERT_TRUE(factor.factor(A, free));
  EXPECT_GT(factor.shift(), 0.0);
  A = test::random_block_matrix(pattern, -50.0, random);
  EXPECT_FALSE(factor.factor(A, free));
}

TEST(Patches, are_connected_and_about_the_size_asked_for) {
  const SymmetricCsr C = test::make_box_problem(test::make_box({6, 5, 4}, 1.0), {}).K.C;
  const std::vector<std::int32_t> patch = cut_into_patches(*C.pattern, 60);
  const int count = *std::max_element(patch.begin(), patch.end()) + 1;
  EXPECT_EQ(*std::min_element(patch.begin(), patch.end()), 0);
  std::vector<int> size(static_cast<std::size_t>(count));
  for (const std::int32_t of : patch) ++size[static_cast<std::size_t>(of)];
  EXPECT_GE(count, 12);
  EXPECT_LE(count, 24);
  for (const int members : size) EXPECT_GE(members, 30);
}

TEST(Minres, iterations_stay_flat_under_refinement) {
  std::vector<int> iterations;
  for (const int n : {2, 4, 6, 9}) {
    const test::BoxProblem problem =
        test::make_box_problem(test::make_box({2 * n, n, n}, 1.0 / n), {1.0, 1000.0, 100.0});
    const Load load(problem.K);
    const Solution found =
        solve(*make_saddle_solver("minres", &problem.blocks), problem.K, problem.free, load.bu, load.bp, 1e-8);
    if (n <= 6) expect_like_direct(found, problem.K, problem.free, load, 1e-8);
    ASSERT_TRUE(found.solve.ok());
    iterations.push_back(found.solve.iterations);
    RecordProperty("iterations_n" + std::to_string(n), found.solve.iterations);
  }
  // 28, 37, 42, 46 (docs/solvers.md) for 90 times as many tets: it levels off.
  EXPECT_LE(iterations[3], iterations[2] + 4);
  EXPECT_LE(iterations[3], 50);
}

TEST(Minres, solves_displacement_systems_and_indefinite_ones) {
  test::BoxProblem problem = test::make_box_problem(test::make_box({4, 3, 3}, 0.25), {1.0, 5.0, 10.0});
  const SaddleMatrix K = displacement_system(problem);
  const Load load(K);
  const auto solver = make_saddle_solver("minres", &problem.blocks);
  expect_like_direct(solve(*solver, K, problem.free, load.bu, load.bp, 1e-9), K, problem.free, load, 1e-9);
  for (std::size_t i = 0; i < problem.K.A.values.size(); ++i) {  // A itself with negative eigenvalues
    problem.K.A.values[i] -= 0.6 * (problem.displacement_only.values[i] - problem.K.A.values[i]);
  }
  const auto direct = make_saddle_solver("direct", nullptr);
  EXPECT_GT(*direct->factor(problem.K, problem.free).negative_pivots, 0);
  const Load mixed(problem.K);
  expect_like_direct(solve(*solver, problem.K, problem.free, mixed.bu, mixed.bp, 1e-9), problem.K, problem.free, mixed,
                     1e-9);
}

TEST(Minres, notices_other_supports) {
  test::BoxProblem problem = test::make_box_problem(test::make_box({4, 3, 3}, 0.25), {1.0, 25.0, 10.0});
  const auto solver = make_saddle_solver("minres", &problem.blocks);
  const Load load(problem.K);
  expect_like_direct(solve(*solver, problem.K, problem.free, load.bu, load.bp, 1e-9), problem.K, problem.free, load,
                     1e-9);
  std::vector<bool> held(problem.free.index.size());
  for (std::size_t i = 0; i < held.size(); ++i) held[i] = problem.free.index[i] < 0 || i % 11 == 0;
  problem.free = make_free_dofs(held);
  expect_like_direct(solve(*solver, problem.K, problem.free, load.bu, load.bp, 1e-9), problem.K, problem.free, load,
                     1e-9);
}

class IterativeSolvers : public testing::TestWithParam<std::string> {};

TEST_P(IterativeSolvers, refuse_a_skew_part_and_say_why) {
  std::mt19937 random(43);
  test::BoxProblem problem = test::make_box_problem(test::make_box({2, 2, 2}, 0.5), {});
  test::add_random_skew(problem.K, 0.1, random);
  const auto solver = make_saddle_solver(GetParam(), &problem.blocks);
  const LinearReport report = solver->factor(problem.K, problem.free);
  EXPECT_EQ(report.outcome, LinearOutcome::not_supported);
  EXPECT_THAT(report.message, HasSubstr("free rim"));
  problem.K.skew.reset();
  EXPECT_TRUE(solver->factor(problem.K, problem.free).ok());
}

TEST_P(IterativeSolvers, refuse_what_is_not_a_number) {
  const test::BoxProblem problem = test::make_box_problem(test::make_box({2, 2, 2}, 0.5), {});
  const auto solver = make_saddle_solver(GetParam(), &problem.blocks);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    SaddleMatrix K = problem.K;
    K.B.values[7] = bad;
    EXPECT_EQ(solver->factor(K, problem.free).outcome, LinearOutcome::not_finite);
    SaddleMatrix plain = displacement_system(problem);
    plain.A.values[3] = bad;
    EXPECT_EQ(solver->factor(plain, problem.free).outcome, LinearOutcome::not_finite);
    Load load(problem.K);
    load.bu[problem.free.dof[5]] = bad;
    EXPECT_EQ(solve(*solver, problem.K, problem.free, load.bu, load.bp, 1e-8).solve.outcome, LinearOutcome::not_finite);
  }
}

TEST_P(IterativeSolvers, take_systems_with_nothing_to_solve) {
  test::BoxProblem problem = test::make_box_problem(test::make_box({2, 2, 2}, 0.5), {});
  const auto solver = make_saddle_solver(GetParam(), &problem.blocks);
  const Load load(problem.K);
  const Solution zero =
      solve(*solver, problem.K, problem.free, VectorX::Zero(load.bu.size()), VectorX::Zero(load.bp.size()), 1e-8);
  ASSERT_TRUE(zero.solve.ok());
  EXPECT_TRUE(zero.u.isZero(0.0) && zero.p.isZero(0.0));
  const FreeDofs none = make_free_dofs(std::vector<bool>(problem.free.index.size(), true));
  const Solution held = solve(*solver, problem.K, none, load.bu, load.bp, 1e-9);
  ASSERT_TRUE(held.solve.ok()) << held.solve.message;
  EXPECT_TRUE(held.u.isZero(0.0));
  EXPECT_LT((test::dense(problem.K.C) * held.p + load.bp).norm(), 1e-9 * load.bp.norm());
  const SaddleMatrix plain = displacement_system(problem);
  const Solution nothing = solve(*solver, plain, none, load.bu, VectorX(), 1e-8);
  ASSERT_TRUE(nothing.solve.ok());
  EXPECT_TRUE(nothing.u.isZero(0.0));
}

TEST_P(IterativeSolvers, give_the_same_bits_on_any_number_of_threads) {
  const test::BoxProblem problem = test::make_box_problem(test::make_box({14, 13, 13}, 0.1), {});  // rows in two pieces
  const Load load(problem.K);
  std::vector<Solution> found;
  for (const int threads : {1, 2, 2}) {
    set_thread_count(threads);
    found.push_back(
        solve(*make_saddle_solver(GetParam(), &problem.blocks), problem.K, problem.free, load.bu, load.bp, 1e-6));
    ASSERT_TRUE(found.back().solve.ok()) << found.back().solve.message;
    EXPECT_TRUE(found.back().u == found.front().u && found.back().p == found.front().p) << threads;
  }
  set_thread_count(0);
}

INSTANTIATE_TEST_SUITE_P(All, IterativeSolvers, testing::Values("cg", "minres"));

}  // namespace
}  // namespace rhexis::linalg
