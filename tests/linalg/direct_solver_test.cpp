#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "base/parallel.h"
#include "linalg/saddle_solver.h"
#include "tests/linalg/random_systems.h"
#include "tests/support/box_problem.h"

namespace rhexis::linalg {
namespace {

using test::MatrixX;
using testing::HasSubstr;

constexpr double kTolerance = 1e-12;

struct Solution {
  LinearReport factor;
  LinearReport solve;
  VectorX u;
  VectorX p;
};

Solution solve(SaddleSolver& solver, const SaddleMatrix& K, const FreeDofs& free, const VectorX& b) {
  Solution out;
  out.factor = solver.factor(K, free);
  if (out.factor.ok()) {
    const VectorX bu = b.head(K.displacement_unknowns());
    const VectorX bp = b.tail(K.pressure_unknowns());
    out.solve = solver.solve(bu, bp, kTolerance, out.u, out.p);
  }
  return out;
}

/// Against a dense LU of the free part; held dofs zero.
void expect_solves(const Solution& solution, const SaddleMatrix& K, const FreeDofs& free, const VectorX& b) {
  ASSERT_TRUE(solution.factor.ok()) << solution.factor.message;
  ASSERT_TRUE(solution.solve.ok()) << solution.solve.message;
  EXPECT_LE(solution.solve.relative_residual, kTolerance);
  const int n = K.displacement_unknowns();
  const int m = K.pressure_unknowns();
  VectorX right(free.count() + m);
  right << b.head(n)(free.dof), b.tail(m);
  const MatrixX dense = test::restrict(test::dense(K), free);
  const Eigen::FullPivLU<MatrixX> lu(dense);
  const VectorX expected = lu.solve(right);
  VectorX found(right.size());
  found << solution.u(free.dof), solution.p;
  // Both are exact to rounding times the condition number.
  EXPECT_LT((found - expected).norm(), 10.0 * std::numeric_limits<double>::epsilon() / lu.rcond() * expected.norm());
  for (int dof = 0; dof < n; ++dof) {
    if (free.index[static_cast<std::size_t>(dof)] < 0) {
      EXPECT_EQ(solution.u[dof], 0.0);
    }
  }
}

int negative_eigenvalues(const SaddleMatrix& K, const FreeDofs& free) {
  const VectorX eigenvalues = test::restrict(test::dense(K), free).selfadjointView<Eigen::Lower>().eigenvalues();
  return static_cast<int>((eigenvalues.array() < 0.0).count());
}

TEST(DirectSolver, solves_definite_systems_and_counts_no_negative_pivot) {
  std::mt19937 random(21);
  const SaddleMatrix K = test::random_saddle(40, 0, 40.0, 1.0, random);
  const FreeDofs free = test::random_supports(120, random);
  const VectorX b = test::random_vector(120, random);
  const auto solver = make_saddle_solver("direct", nullptr);
  const Solution solution = solve(*solver, K, free, b);
  expect_solves(solution, K, free, b);
  EXPECT_EQ(solution.factor.negative_pivots, 0);
  EXPECT_EQ(solution.factor.message, "");
  EXPECT_GT(solver->memory_bytes(), 0U);
}

TEST(DirectSolver, falls_back_to_ldlt_with_the_inertia_of_an_indefinite_stiffness) {
  std::mt19937 random(22);
  const auto solver = make_saddle_solver("direct", nullptr);
  for (const double shift : {0.0, 3.0, 6.0, 40.0, 6.0}) {  // there and back: Cholesky is tried again every time
    const SaddleMatrix K = test::random_saddle(40, 0, shift, 1.0, random);
    const FreeDofs free = test::random_supports(120, random);
    const VectorX b = test::random_vector(120, random);
    const Solution solution = solve(*solver, K, free, b);
    expect_solves(solution, K, free, b);
    const int negative = negative_eigenvalues(K, free);
    EXPECT_EQ(solution.factor.negative_pivots, negative);
    EXPECT_EQ(solution.solve.negative_pivots, negative);
    EXPECT_EQ(negative == 0, shift == 40.0);
    if (negative > 0) {
      EXPECT_THAT(solution.factor.message, HasSubstr("not positive definite"));
    }
  }
}

TEST(DirectSolver, solves_saddle_systems_with_the_inertia_beyond_the_pressures) {
  std::mt19937 random(23);
  const auto solver = make_saddle_solver("direct", nullptr);
  for (const double shift : {0.0, 5.0, 40.0}) {
    const SaddleMatrix K = test::random_saddle(40, 60, shift, 1.0, random);
    const FreeDofs free = test::random_supports(120, random);
    const VectorX b = test::random_vector(180, random);
    const Solution solution = solve(*solver, K, free, b);
    expect_solves(solution, K, free, b);
    EXPECT_EQ(solution.factor.negative_pivots, negative_eigenvalues(K, free) - 60);
    EXPECT_EQ(*solution.factor.negative_pivots == 0, shift == 40.0);
  }
}

TEST(DirectSolver, solves_systems_with_a_skew_part_and_does_not_know_their_inertia) {
  std::mt19937 random(24);
  for (const int pressures : {0, 50}) {
    SaddleMatrix K = test::random_saddle(30, pressures, 10.0, 1.0, random);
    test::add_random_skew(K, 2.0, random);
    const FreeDofs free = test::random_supports(90, random);
    const VectorX b = test::random_vector(90 + pressures, random);
    const auto solver = make_saddle_solver("direct", nullptr);
    const Solution solution = solve(*solver, K, free, b);
    expect_solves(solution, K, free, b);
    EXPECT_FALSE(solution.factor.negative_pivots.has_value());
  }
}

TEST(DirectSolver, notices_other_supports_another_pattern_and_a_skew_part) {
  std::mt19937 random(25);
  const auto solver = make_saddle_solver("direct", nullptr);
  SaddleMatrix K = test::random_saddle(30, 40, 30.0, 1.0, random);
  const VectorX b = test::random_vector(130, random);
  for (int round = 0; round < 3; ++round) {
    const FreeDofs free = test::random_supports(90, random);
    expect_solves(solve(*solver, K, free, b), K, free, b);
    for (double& value : K.B.values) value *= 1.5;
    expect_solves(solve(*solver, K, free, b), K, free, b);
    K = test::random_saddle(30, 40, 30.0, 1.0, random);
    expect_solves(solve(*solver, K, free, b), K, free, b);
    test::add_random_skew(K, 1.0, random);
    expect_solves(solve(*solver, K, free, b), K, free, b);
    K.skew.reset();
    const SaddleMatrix displacement = test::random_saddle(20 + round, 0, 30.0, 1.0, random);
    const FreeDofs fewer = test::random_supports(3 * displacement.A.rows(), random);
    const VectorX c = test::random_vector(3 * displacement.A.rows(), random);
    expect_solves(solve(*solver, displacement, fewer, c), displacement, fewer, c);
  }
}

TEST(DirectSolver, is_exact_for_a_bulk_modulus_of_1e9_and_millimetres) {
  // mu = 1e4 Pa, h = 0.5 mm: a pressure row is 1e-18 m^3/Pa beside stiffnesses of 10 N/m.
  for (const double beta : {0.0, 1e5}) {
    const test::BoxProblem problem = test::make_box_problem(test::make_box({4, 3, 3}, 5e-4), {1e4, 1e9, beta});
    const auto n = problem.K.displacement_unknowns();
    const auto m = problem.K.pressure_unknowns();
    std::mt19937 random(26);
    VectorX u = 1e-4 * test::random_vector(n, random);
    const VectorX p = 1e3 * test::random_vector(m, random);
    for (int dof = 0; dof < n; ++dof) {
      if (problem.free.index[static_cast<std::size_t>(dof)] < 0) u[dof] = 0.0;
    }
    VectorX b(n + m);
    VectorX bu(n);
    VectorX bp(m);
    problem.K.multiply(u, p, bu, bp);
    b << bu, bp;
    const auto solver = make_saddle_solver("direct", nullptr);
    const Solution solution = solve(*solver, problem.K, problem.free, b);
    ASSERT_TRUE(solution.solve.ok()) << solution.solve.message;
    EXPECT_EQ(solution.factor.negative_pivots, 0);
    EXPECT_LT((solution.u - u).norm(), 1e-10 * u.norm());
    // Without stabilisation P1 / P0 locks here: pressures that no displacement feels are held by C alone.
    EXPECT_LT((solution.p - p).norm(), (beta > 0.0 ? 1e-9 : 1e-4) * p.norm());
  }
}

TEST(DirectSolver, reports_a_body_that_floats) {
  for (const int n : {1, 4, 9}) {  // rounding in the last pivots grows with the number of unknowns
    const mesh::TetMesh box = test::make_box({2 * n, n, n}, 0.01);
    for (const double kappa : {1e5, 1e9}) {
      const test::BoxProblem problem = test::make_box_problem(box, {1e4, kappa, 1.0});
      const FreeDofs all = make_free_dofs(std::vector<bool>(3 * box.node_count()));
      SaddleMatrix displacement;
      displacement.A = kappa == 1e5 ? problem.displacement_only : problem.K.A;
      for (const SaddleMatrix* K : {&problem.K, static_cast<const SaddleMatrix*>(&displacement)}) {
        const auto solver = make_saddle_solver("direct", nullptr);
        const LinearReport report = solver->factor(*K, all);
        EXPECT_EQ(report.outcome, LinearOutcome::singular) << n << ' ' << kappa;
        EXPECT_THAT(report.message, HasSubstr("hold it"));
        EXPECT_TRUE(solver->factor(*K, problem.free).ok());
      }
    }
  }
}

TEST(DirectSolver, reports_a_node_without_stiffness) {
  SaddleMatrix K;
  K.A = SymmetricBlockMatrix(std::make_shared<BlockPattern>(make_block_pattern(3, {}, 4)));
  for (const int node : {0, 2}) {
    for (const int c : {0, 4, 8}) K.A.values[static_cast<std::size_t>(9 * node + c)] = 2.0;
  }
  const auto solver = make_saddle_solver("direct", nullptr);
  EXPECT_EQ(solver->factor(K, make_free_dofs(std::vector<bool>(9))).outcome, LinearOutcome::singular);
  std::vector<bool> held(9);
  held[3] = held[4] = held[5] = true;
  const FreeDofs free = make_free_dofs(held);
  const VectorX b = VectorX::Ones(9);
  expect_solves(solve(*solver, K, free, b), K, free, b);  // and is of use afterwards
}

TEST(DirectSolver, refuses_what_is_not_a_number) {
  std::mt19937 random(27);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const SaddleMatrix good = test::random_saddle(10, 12, 30.0, 1.0, random);
  const FreeDofs free = make_free_dofs(std::vector<bool>(30));
  const auto solver = make_saddle_solver("direct", nullptr);
  for (const double bad : {nan, infinite}) {
    for (const int where : {0, 1, 2}) {
      SaddleMatrix K = good;
      (where == 0 ? K.A.values : where == 1 ? K.B.values : K.C.values)[3] = bad;
      EXPECT_EQ(solver->factor(K, free).outcome, LinearOutcome::not_finite);
    }
    ASSERT_TRUE(solver->factor(good, free).ok());
    VectorX u;
    VectorX p;
    VectorX bu = VectorX::Ones(30);
    VectorX bp = VectorX::Ones(12);
    bp[3] = bad;
    EXPECT_EQ(solver->solve(bu, bp, 1e-8, u, p).outcome, LinearOutcome::not_finite);
    bp[3] = 1.0;
    bu[7] = bad;
    EXPECT_EQ(solver->solve(bu, bp, 1e-8, u, p).outcome, LinearOutcome::not_finite);
  }
}

TEST(DirectSolver, does_not_read_held_dofs_of_the_right_hand_side) {
  std::mt19937 random(28);
  const SaddleMatrix K = test::random_saddle(10, 12, 30.0, 1.0, random);
  std::vector<bool> held(30);
  held[4] = true;
  const FreeDofs free = make_free_dofs(held);
  VectorX b = test::random_vector(42, random);
  const auto solver = make_saddle_solver("direct", nullptr);
  const Solution first = solve(*solver, K, free, b);
  b[4] = std::numeric_limits<double>::quiet_NaN();
  const Solution second = solve(*solver, K, free, b);
  ASSERT_TRUE(second.solve.ok());
  EXPECT_TRUE(first.u == second.u && first.p == second.p);
}

TEST(DirectSolver, takes_systems_with_nothing_to_solve) {
  std::mt19937 random(29);
  const auto solver = make_saddle_solver("direct", nullptr);
  const FreeDofs none = make_free_dofs(std::vector<bool>(30, true));
  for (const int pressures : {0, 12}) {  // with all nodes held, -C p = b is left
    const SaddleMatrix K = test::random_saddle(10, pressures, 30.0, 1.0, random);
    const VectorX b = test::random_vector(30 + pressures, random);
    const Solution solution = solve(*solver, K, none, b);
    ASSERT_TRUE(solution.solve.ok());
    EXPECT_TRUE(solution.u.isZero(0.0));
    if (pressures > 0) {
      EXPECT_LT((test::dense(K.C) * solution.p + b.tail(pressures)).norm(), 1e-14 * b.norm());
    }
  }
  const SaddleMatrix empty;
  VectorX u;
  VectorX p;
  ASSERT_TRUE(solver->factor(empty, FreeDofs{}).ok());
  EXPECT_TRUE(solver->solve(VectorX(), VectorX(), 1e-8, u, p).ok());
  const SaddleMatrix K = test::random_saddle(10, 5, 30.0, 1.0, random);
  const Solution zero = solve(*solver, K, make_free_dofs(std::vector<bool>(30)), VectorX::Zero(35));
  ASSERT_TRUE(zero.solve.ok());
  EXPECT_TRUE(zero.u.isZero(0.0) && zero.p.isZero(0.0));
}

TEST(DirectSolver, gives_the_same_bits_every_time) {
  const test::BoxProblem problem = test::make_box_problem(test::make_box({14, 9, 9}, 0.1), {});
  std::mt19937 random(30);
  const VectorX b = test::random_vector(problem.K.displacement_unknowns() + problem.K.pressure_unknowns(), random);
  SaddleMatrix displacement;
  displacement.A = problem.displacement_only;
  std::vector<VectorX> mixed;
  std::vector<VectorX> plain;
  for (const int threads : {1, 2, 2, 4}) {
    set_thread_count(threads);
    mixed.push_back(solve(*make_saddle_solver("direct", nullptr), problem.K, problem.free, b).u);
    plain.push_back(solve(*make_saddle_solver("direct", nullptr), displacement, problem.free,
                          b.head(displacement.displacement_unknowns()))
                        .u);
    EXPECT_TRUE(mixed.back() == mixed.front()) << threads;
    EXPECT_TRUE(plain.back() == plain.front()) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace rhexis::linalg
