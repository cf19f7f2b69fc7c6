#include "linalg/front_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>

#include "base/parallel.h"
#include "linalg/front_solver.h"
#include "mesh/generate.h"
#include "tests/support/front_body.h"

namespace rhexis::linalg {
namespace {

using test::FrontBody;
using test::FrontOracle;
using Nodes = std::vector<std::int32_t>;

// Condition numbers stay below 1e4 (springs to the ground), both sides make relative errors of about 1e-16 times that,
// and the oracle of the Schur complement inverts once more.
constexpr double kSame = 1e-11;
// The same in single precision, 6e-8.
constexpr double kSameSingle = 1e-3;

FrontBody plate(int nodes, bool rough = false) {
  return FrontBody(mesh::make_plate({{0.24, 0.24, 0.01}}, nodes).value(), 0.02, rough);
}

double difference(const auto& a, const auto& b) { return (a - b).norm() / std::max(b.norm(), 1e-300); }

/// Everything that a version answers, against the whole assembled and factored again.
void expect_exact(const FrontTree& tree, const FrontBody& body, const Nodes& kept, std::mt19937_64& random) {
  ASSERT_EQ(tree.outcome(), FrontOutcome::ok);
  FrontOracle oracle(body);
  ASSERT_TRUE(oracle.ok);
  std::vector<std::int32_t> kept_dofs;
  std::vector<std::int32_t> others;
  for (const std::int32_t dof : oracle.free.dof) {
    (std::binary_search(kept.begin(), kept.end(), dof / 3) ? kept_dofs : others).push_back(dof);
  }
  ASSERT_EQ(tree.kept_dofs(), kept_dofs);
  const auto n = static_cast<Eigen::Index>(kept_dofs.size());
  ASSERT_EQ(tree.schur().rows(), n);
  ASSERT_EQ(tree.schur().cols(), n);
  const Eigen::MatrixXd& S = tree.schur();
  EXPECT_TRUE(S == S.transpose());
  if (n > 0) {  // the block of K^-1 on the kept dofs is the inverse of the Schur complement
    const Eigen::MatrixXd compliance = oracle.columns(kept_dofs)(kept_dofs, Eigen::all);
    EXPECT_LT(difference(S, compliance.inverse()), kSame);
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(S);
  const auto solve_kept = [&](const Eigen::MatrixXd& b) { return n > 0 ? Eigen::MatrixXd(factor.solve(b)) : b; };

  // Some dofs at random, kept ones too, each a column; one of the columns reaches two dofs.
  std::vector<std::int32_t> dofs;
  for (int i = 0; i < 5; ++i) dofs.push_back(others[random() % others.size()]);
  if (n > 0) dofs.push_back(kept_dofs[random() % kept_dofs.size()]);
  const auto columns = static_cast<Eigen::Index>(dofs.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(columns, columns);
  rows(0, 1) = -0.5;
  const FrontTree::Forward forward = tree.forward(dofs, rows);
  const Eigen::MatrixXd flexible = oracle.columns(dofs);
  const Eigen::MatrixXd expected = rows.transpose() * flexible(dofs, Eigen::all) * rows;
  EXPECT_LT(difference(forward.gram + forward.kept.transpose() * solve_kept(forward.kept), expected), kSame);
  const VectorX under_load = rows.transpose() * oracle.solution(dofs);
  EXPECT_LT(
      difference(VectorX(forward.with_load + forward.kept.transpose() * solve_kept(tree.schur_load())), under_load),
      kSame);
  const double energy =
      tree.load_energy() + (n > 0 ? tree.schur_load().dot(VectorX(solve_kept(tree.schur_load()))) : 0.0);
  EXPECT_NEAR(energy, oracle.load.dot(oracle.solution), kSame * std::abs(energy));

  if (kept.empty()) {
    VectorX b = VectorX::Constant(oracle.load.size(), 1e300);  // held dofs are not read
    for (const std::int32_t dof : oracle.free.dof) b[dof] = oracle.load[dof];
    VectorX whole;
    FrontSolver::Work work;
    const FrontSolver solver(tree);
    solver.solve(b, whole, work);
    EXPECT_LT(difference(whole, oracle.solution), kSameSingle);
    const FourLanes four = b * Eigen::RowVector4d(1.0, -2.0, 0.0, 0.5);
    FourLanes of_four;
    solver.solve(four, of_four, work);
    EXPECT_LT(difference(Eigen::MatrixXd(of_four),
                         Eigen::MatrixXd(oracle.solution * Eigen::RowVector4d(1.0, -2.0, 0.0, 0.5))),
              kSameSingle);
    const TwoLanes two = b * Eigen::RowVector2d(0.0, 3.0);
    TwoLanes of_two;
    solver.solve(two, of_two, work);
    EXPECT_LT(difference(Eigen::MatrixXd(of_two), Eigen::MatrixXd(oracle.solution * Eigen::RowVector2d(0.0, 3.0))),
              kSameSingle);
  }

  VectorX amount(columns);
  for (double& a : amount) a = static_cast<double>(random() % 100) / 50.0 - 1.0;
  VectorX x;
  tree.backward(solve_kept(forward.kept * amount + 0.7 * tree.schur_load()), &forward, amount, 0.7, x);
  EXPECT_LT(difference(x, VectorX(flexible * rows * amount + 0.7 * oracle.solution)), kSame);
  VectorX some = VectorX::Constant(x.size(), 1e300);  // what it does not solve for is not read
  const Nodes nodes{static_cast<std::int32_t>(random() % body.position.size()), dofs[0] / 3, dofs.back() / 3};
  tree.backward_at(nodes, solve_kept(forward.kept * amount + 0.7 * tree.schur_load()), &forward, amount, 0.7, some);
  for (const std::int32_t node : nodes) EXPECT_TRUE(some.segment<3>(3 * node) == x.segment<3>(3 * node)) << node;
  tree.backward(solve_kept(tree.schur_load()), nullptr, VectorX(), 1.0, x);
  EXPECT_LT(difference(x, oracle.solution), kSame);
  EXPECT_TRUE(x.allFinite());
}

TEST(FrontTree, solves_like_the_sparse_factor) {
  std::mt19937_64 random(1);
  for (const int nodes : {60, 300, 1500}) {
    const FrontBody body = plate(nodes, true);
    const auto tree = FrontTree::make(body, {});
    expect_exact(*tree, body, {}, random);
    EXPECT_EQ(tree->fronts_made(), tree->front_count());
    EXPECT_GT(tree->flops_made(), 0.0);
    EXPECT_GT(tree->memory_bytes(), sizeof(double) * 6 * 3 * static_cast<std::size_t>(nodes));
  }
}

TEST(FrontTree, condenses_onto_the_kept_nodes) {
  std::mt19937_64 random(2);
  const FrontBody body = plate(800, true);
  Nodes kept = body.nodes_within({8, 8, 0}, 2.5);
  kept.push_back(body.node_count() - 1);
  const auto tree = FrontTree::make(body, kept);
  expect_exact(*tree, body, kept, random);
}

TEST(FrontTree, takes_bodies_in_pieces_and_single_tets) {
  std::mt19937_64 random(3);
  const mesh::TetMesh mesh = mesh::make_structured_box({3, 1, 1}, {9, 3, 3});
  FrontBody body(mesh, 0.02);
  for (std::int32_t e = 0; e < body.element_count(); ++e) {
    const double x = body.centroid(e)[0];
    body.active[static_cast<std::size_t>(e)] = x < 1.5 || x > 3.0;
  }
  Nodes kept = body.nodes_within(body.position.back(), 2.0);
  for (const std::int32_t node : body.nodes_within(body.position.front(), 1.5)) kept.push_back(node);
  std::sort(kept.begin(), kept.end());
  const auto tree = FrontTree::make(body, kept);
  expect_exact(*tree, body, kept, random);
  for (std::size_t e = 0; e < body.tets.size(); ++e) body.active[e] = e == 40;
  expect_exact(*FrontTree::make(body, {}), body, {}, random);
}

TEST(FrontTree, everything_kept_or_held_leaves_no_front_with_pivots) {
  FrontBody body(mesh::make_structured_box({1, 1, 1}, {2, 2, 2}), 0.02);
  Nodes all;
  for (std::int32_t i = 0; i < body.node_count(); ++i) all.push_back(i);
  const auto tree = FrontTree::make(body, all);
  FrontOracle oracle(body);
  ASSERT_EQ(tree->outcome(), FrontOutcome::ok);
  EXPECT_EQ(tree->kept_dofs(), oracle.free.dof);
  EXPECT_LT(
      difference(VectorX(tree->schur().llt().solve(tree->schur_load())), VectorX(oracle.solution(oracle.free.dof))),
      kSame);
  body.free.assign(body.free.size(), false);
  const auto held = FrontTree::make(body, {});
  EXPECT_EQ(held->outcome(), FrontOutcome::ok);
  VectorX x;
  held->backward(VectorX(), nullptr, VectorX(), 1.0, x);
  EXPECT_EQ(x.size(), 3 * body.node_count());
  EXPECT_TRUE(x.isZero(0.0));
}

/// Edits a body and remembers what a FrontTree has to be told.
class Editor {
 public:
  Editor(FrontBody& body, std::mt19937_64& random) : body_(body), random_(random) {}

  [[nodiscard]] Vec3 random_point() const { return body_.position[random_() % body_.position.size()]; }

  /// Takes the elements near a point out of the sum, or back into it.
  void switch_elements(const Vec3& at, double radius, bool active) {
    for (std::int32_t e = 0; e < body_.element_count(); ++e) {
      if (body_.is_active(e) == active || (body_.centroid(e) - at).norm() > radius) continue;
      body_.active[static_cast<std::size_t>(e)] = active;
      change.touched.push_back(e);
    }
  }
  void change_stiffness(const Vec3& at, double radius) {
    for (std::int32_t e = 0; e < body_.element_count(); ++e) {
      if ((body_.centroid(e) - at).norm() > radius) continue;
      body_.scale[static_cast<std::size_t>(e)] = 0.5 + 0.1 * static_cast<double>(random_() % 10);
      change.touched.push_back(e);
    }
  }
  /// Parts the elements near a point along a plane: those on one side take copies of the nodes they share.
  void split(const Vec3& at, double radius) {
    std::vector<std::int32_t> copy(body_.position.size(), -1);
    const Vec3 normal = Vec3::Unit(static_cast<int>(random_() % 2));
    const Nodes near = body_.nodes_within(at, radius);
    for (std::int32_t e = 0; e < body_.element_count(); ++e) {
      if (normal.dot(body_.centroid(e) - at) < 0.0) continue;
      bool rewired = false;
      for (std::int32_t& node : body_.tets[static_cast<std::size_t>(e)]) {
        const auto n = static_cast<std::size_t>(node);
        if (n >= copy.size() || !std::binary_search(near.begin(), near.end(), node)) continue;
        if (std::abs(normal.dot(body_.position[n] - at)) > 0.6) continue;
        if (copy[n] < 0) {
          copy[n] = body_.copy_node(node);
          change.copied.push_back(node);
        }
        node = copy[n];
        rewired = true;
      }
      if (rewired) change.touched.push_back(e);
    }
  }

  ElementChange change;

 private:
  FrontBody& body_;
  std::mt19937_64& random_;
};

struct Version {
  std::shared_ptr<const FrontTree> tree;
  FrontBody body;
  Nodes kept;
  std::size_t before = 0;  // in the history: what an undo gives
};

/// What brings `from` back to `to`, which came before it.
ElementChange difference_of(const FrontBody& from, const FrontBody& to) {
  ElementChange out;
  for (std::int32_t e = 0; e < to.element_count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    if (from.tets[i] != to.tets[i] || from.active[i] != to.active[i] || from.scale[i] != to.scale[i]) {
      out.touched.push_back(e);
    }
  }
  return out;
}

void follow_random_edits(FrontBody body, unsigned seed, int steps) {
  std::mt19937_64 random(seed);
  Nodes always;
  if (seed % 2 == 0) always = body.nodes_within(body.position[random() % body.position.size()], 1.2);
  std::vector<Version> history{{FrontTree::make(body, always), body, always, 0}};
  bool some_left = false;
  for (int step = 0; step < steps; ++step) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
    const Version& last = history.back();
    Version now{nullptr, last.body, last.kept, history.size() - 1};
    Editor edit(now.body, random);
    const Vec3 at = edit.random_point();
    const auto what = random() % 6;
    if (what == 5) {  // back by one to three edits, by an update instead of by the version that is still there
      std::size_t back = last.before;
      for (auto more = random() % 3; more > 0; --more) back = history[back].before;
      const Version& to = history[back];
      edit.change = difference_of(last.body, to.body);
      now.body = to.body;
      now.kept = to.kept;
      now.before = to.before;
    } else {
      if (what == 0) edit.switch_elements(at, 1.5, false);
      if (what == 1) edit.switch_elements(at, 4.0, true);
      if (what == 2) edit.change_stiffness(at, 1.2);
      if (what == 3) edit.split(at, 3.0);
      if (what >= 4 || random() % 3 == 0) {
        now.kept = now.body.nodes_within(random() % 2 == 0 ? at : edit.random_point(), 2.5);
        now.kept.insert(now.kept.end(), always.begin(), always.end());
        std::sort(now.kept.begin(), now.kept.end());
        now.kept.erase(std::unique(now.kept.begin(), now.kept.end()), now.kept.end());
      }
    }
    edit.change.kept = now.kept;
    now.tree = last.tree->updated(now.body, edit.change);
    some_left = some_left || now.tree->fronts_made() < now.tree->front_count();
    expect_exact(*now.tree, now.body, now.kept, random);
    if (step % 5 == 4) {
      const Version& before = history[random() % history.size()];
      expect_exact(*before.tree, before.body, before.kept, random);
    }
    if (testing::Test::HasFailure()) return;
    history.push_back(std::move(now));
  }
  EXPECT_TRUE(some_left);
}

TEST(FrontTree, says_when_a_piece_is_loose_and_recovers) {
  std::mt19937_64 random(5);
  FrontBody body(mesh::make_plate({{0.24, 0.24, 0.01}}, 700).value(), 0.0);  // nothing holds but the side
  const auto whole = FrontTree::make(body, {});
  ASSERT_EQ(whole->outcome(), FrontOutcome::ok);
  FrontBody torn = body;
  Editor edit(torn, random);
  for (std::int32_t e = 0; e < body.element_count(); ++e) {
    if (std::abs(body.centroid(e)[0] - 8.0) > 1.5) continue;
    torn.active[static_cast<std::size_t>(e)] = false;
    edit.change.touched.push_back(e);
  }
  const auto loose = whole->updated(torn, edit.change);
  EXPECT_EQ(loose->outcome(), FrontOutcome::not_positive_definite);
  EXPECT_EQ(FrontTree::make(torn, {})->outcome(), FrontOutcome::not_positive_definite);
  EXPECT_TRUE(loose->kept_dofs().empty());
  // With nodes of the loose piece kept, the rest is definite; only what is left on them is not.
  ElementChange keep;
  keep.kept = torn.nodes_within(torn.position.back(), 1.5);
  const auto held = loose->updated(torn, keep);
  EXPECT_EQ(held->outcome(), FrontOutcome::ok);
  EXPECT_TRUE(held->schur().allFinite());
  // From a version that failed back to one that does not.
  const auto mended = loose->updated(body, edit.change);
  ASSERT_EQ(mended->outcome(), FrontOutcome::ok);
  VectorX expected;
  VectorX x;
  whole->backward(VectorX(), nullptr, VectorX(), 1.0, expected);
  mended->backward(VectorX(), nullptr, VectorX(), 1.0, x);
  EXPECT_LT(difference(x, expected), 1e-9);  // without springs to the ground the condition number is some 1e6
}

TEST(FrontTree, says_when_an_element_is_negative_or_not_a_number) {
  FrontBody body = plate(300);
  const auto tree = FrontTree::make(body, {});
  for (const double scale :
       {-20.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    FrontBody bad = body;
    bad.scale[100] = scale;
    ElementChange change;
    change.touched = {100};
    EXPECT_EQ(tree->updated(bad, change)->outcome(), FrontOutcome::not_positive_definite) << scale;
    const std::array<std::int32_t, 4> nodes = bad.nodes(100);
    change.kept = {nodes.begin(), nodes.end()};
    std::sort(change.kept.begin(), change.kept.end());
    if (scale > 0.0) {
      EXPECT_EQ(tree->updated(bad, change)->outcome(), FrontOutcome::not_positive_definite) << scale;
    }
  }
}

TEST(FrontTree, factored_again_it_is_what_one_that_is_new_is) {
  FrontBody body = plate(700, true);
  const auto tree = FrontTree::make(body, {});
  for (std::size_t e = 0; e < body.scale.size(); ++e) body.scale[e] = 1.0 + 0.1 * static_cast<double>(e % 7);
  VectorX x;
  VectorX expected;
  tree->refactored(body)->backward(VectorX(), nullptr, VectorX(), 1.0, x);
  FrontTree::make(body, {})->backward(VectorX(), nullptr, VectorX(), 1.0, expected);
  EXPECT_TRUE(x == expected);
}

TEST(FrontSolver, takes_over_the_fronts_that_two_versions_share) {
  std::mt19937_64 random(9);
  FrontBody body = plate(3000);
  const auto first = FrontTree::make(body, {});
  const FrontSolver before(*first);
  Editor edit(body, random);
  edit.split(Vec3(9, 9, 0), 5.0);
  const auto second = first->updated(body, edit.change);
  const FrontSolver anew(*second);
  const FrontSolver after(*second, &before);
  const VectorX b = VectorX::LinSpaced(3 * body.node_count(), -1.0, 1.0);
  FrontSolver::Work work;
  VectorX x;
  VectorX y = b;
  anew.solve(b, x, work);
  after.solve(y, y, work);  // in place
  EXPECT_TRUE(x == y);
  EXPECT_LT(after.memory_bytes(), 0.7 * static_cast<double>(second->memory_bytes()));
}

TEST(FrontSolver, gives_the_same_bits_on_any_number_of_threads) {
  const FrontBody body(mesh::make_bar({{1, 1, 2}}, 3000).value(), 0.02);  // with fronts that threads share
  const FrontSolver solver(*FrontTree::make(body, {}));
  const VectorX b = VectorX::LinSpaced(3 * body.node_count(), -1.0, 1.0);
  const auto solve = [&](int threads) {
    set_thread_count(threads);
    FrontSolver::Work work;
    VectorX x;
    solver.solve(b, x, work);
    set_thread_count(0);
    return x;
  };
  const VectorX one = solve(1);
  EXPECT_TRUE(one == solve(2));
  EXPECT_TRUE(one == solve(5));
}

/// All that a make and two updates give, in one vector.
VectorX answers(const FrontBody& body, int threads) {
  set_thread_count(threads);
  std::mt19937_64 random(6);
  FrontBody edited = body;
  Editor edit(edited, random);
  const Vec3 at(9, 9, 0);
  edit.change.kept = body.nodes_within(at, 4.0);
  const auto tree = FrontTree::make(body, {})->updated(body, edit.change);
  edit.split(at, 5.0);
  const auto next = tree->updated(edited, edit.change);
  VectorX x;
  next->backward(next->schur().llt().solve(next->schur_load()), nullptr, VectorX(), 1.0, x);
  set_thread_count(0);
  VectorX out(x.size() + next->schur().size());
  out << x, next->schur().reshaped();
  return out;
}

TEST(FrontTree, the_bits_do_not_depend_on_the_number_of_threads) {
  const FrontBody body = plate(3000);
  const VectorX one = answers(body, 1);
  EXPECT_GT(one.norm(), 0.0);
  EXPECT_TRUE(one == answers(body, 2));
  EXPECT_TRUE(one == answers(body, 5));
}

TEST(FrontTree, a_version_is_solved_with_while_another_thread_makes_the_next) {
  const FrontBody body = plate(1500);
  const auto tree = FrontTree::make(body, {});
  VectorX expected;
  tree->backward(VectorX(), nullptr, VectorX(), 1.0, expected);
  std::shared_ptr<const FrontTree> last = tree;
  std::thread background([&] {
    std::mt19937_64 random(7);
    FrontBody edited = body;
    for (int i = 0; i < 10; ++i) {
      Editor edit(edited, random);
      const Vec3 at = edit.random_point();
      edit.change_stiffness(at, 2.0);
      edit.change.kept = body.nodes_within(at, 2.5);
      last = last->updated(edited, edit.change);
    }
  });
  bool same = true;
  VectorX x;
  for (int i = 0; i < 30; ++i) {
    tree->backward(VectorX(), nullptr, VectorX(), 1.0, x);
    same = same && x == expected;
  }
  background.join();
  EXPECT_TRUE(same);
  EXPECT_EQ(last->outcome(), FrontOutcome::ok);
}

TEST(FrontTree, far_from_the_kept_nodes_nothing_is_made_again) {
  std::mt19937_64 random(8);
  FrontBody body = plate(4000);
  ElementChange change;
  const Vec3 at = 0.4 * body.position.back();
  change.kept = body.nodes_within(at, 4.0);
  const auto first = FrontTree::make(body, {})->updated(body, change);
  // An element among kept nodes belongs to them alone.
  Editor among(body, random);
  among.switch_elements(at, 1.5, false);
  ASSERT_FALSE(among.change.touched.empty());
  among.change.kept = change.kept;
  const auto second = first->updated(body, among.change);
  EXPECT_LT(second->fronts_made(), 20U);
  // A step of the kept nodes along the plate.
  change.kept = body.nodes_within(at + Vec3(1.0, 0.0, 0.0), 4.0);
  const auto third = second->updated(body, change);
  EXPECT_LT(third->fronts_made(), third->front_count() / 2);
  expect_exact(*third, body, change.kept, random);
}

class FrontTreeEdits : public testing::TestWithParam<unsigned> {};

TEST_P(FrontTreeEdits, a_plate_is_followed_exactly) { follow_random_edits(plate(700, true), GetParam(), 25); }
TEST_P(FrontTreeEdits, a_box_is_followed_exactly) {
  follow_random_edits(FrontBody(mesh::make_bar({{1, 1, 2}}, 500).value(), 0.02), 100 + GetParam(), 12);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FrontTreeEdits, testing::Range(0U, 6U));

}  // namespace
}  // namespace rhexis::linalg
