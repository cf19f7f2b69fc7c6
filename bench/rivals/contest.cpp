#include "bench/rivals/contest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/check.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "bench/rivals/calculix.h"
#include "bench/rivals/contestant.h"
#include "bench/rivals/race.h"
#include "bench/rivals/stable_neo_hookean.h"

namespace rhexis::rivals {
namespace {

using model::ModelKind;
using nlohmann::ordered_json;

constexpr int kRepeats = 3;               ///< of a race to rest; the median counts
constexpr std::array kOurMoves{1, 2, 3};  ///< in which the hand goes to its place; Bullet's are in bullet_entries
constexpr double kLongest = 30.0;         ///< s, of a race to rest at most
constexpr double kExact = 1e-8;           ///< an error below which there is no other to be as good
constexpr int kSamples = 4;               ///< of a hand that moves
/// Bullet's forces against the law that its header states, in single precision: positions of 0.1 m are good to 1e-8 m,
/// strains of an edge of 2 mm to 1e-5, and bending strains are of a percent.
constexpr double kSameLaw = 1e-2;
/// Of the law's derivatives against central differences of steps of 1e-5: their truncation and rounding are 1e-10.
constexpr double kDerivative = 1e-8;

ordered_json in_ms(double seconds) { return std::isfinite(seconds) ? ordered_json(1e3 * seconds) : ordered_json(); }
ordered_json if_finite(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(); }
std::string shown(double seconds) {
  return std::isfinite(seconds) ? fmt::format("{:.{}f}", 1e3 * seconds,
                                              seconds < 0.01  ? 2
                                              : seconds < 0.1 ? 1
                                                              : 0)
                                : "-";
}
std::string shown_percent(double error) {
  return std::isfinite(error) ? fmt::format("{:.3g}%", 100.0 * error) : "lost";
}

/// What Rhexis sends.
struct Ours {
  std::string name;
  std::shared_ptr<const model::Model> model;  ///< of the converged answer
  MakeContestant make;
};
std::vector<Ours> ours_of(const Bar& bar, BulletLaw law) {
  const auto live = [&bar](ModelKind kind) {
    const std::shared_ptr<const model::Model> model = bar.model(kind, true);
    return Ours{std::string(model->name()), model, [&bar, model] { return make_live(bar, model); }};
  };
  if (law == BulletLaw::neo_hookean) return {live(ModelKind::hyperelastic)};
  return {{"linear", bar.model(ModelKind::linear, false), [&bar] { return make_linear(bar); }},
          live(ModelKind::corotated)};
}

/// The converged answers of Bullet's law. Its linear one is that of `corotated`; its neo-Hookean one is looked for from
/// the answer of `hyperelastic`, which is near.
class BulletAnswers {
 public:
  BulletAnswers(const Bar& bar, BulletLaw law)
      : bar_(bar),
        law_(bar.elastic),
        is_linear_(law == BulletLaw::linear),
        model_(bar.model(is_linear_ ? ModelKind::corotated : ModelKind::hyperelastic, true)),
        near_(model_->initial_state()) {}
  /// Each from the one before.
  const VectorX& at(const Vec3& hand) {
    near_ = converged(bar_, *model_, hand, near_);
    u_ = is_linear_ ? near_.u : converged(bar_, law_, hand, near_.u);
    return u_;
  }
  /// Of the hand at the last answer, N.
  [[nodiscard]] Vec3 force() const;

 private:
  const Bar& bar_;
  StableNeoHookean law_;
  bool is_linear_;
  std::shared_ptr<const model::Model> model_;
  model::State near_;
  VectorX u_;
};

Vec3 force_of(const Bar& bar, const model::Model& model, const model::State& state) {
  model::Residual residual{VectorX::Zero(state.u.size()), VectorX::Zero(state.lambda.size())};
  model.residual(state, *model.make_scratch(), residual);
  return residual.u.segment<3>(3 * Eigen::Index{bar.hand.value()});
}
Vec3 BulletAnswers::force() const {
  return is_linear_ ? force_of(bar_, *model_, near_)
                    : Vec3(internal_force(bar_, law_, u_).segment<3>(3 * Eigen::Index{bar_.hand.value()}));
}

/// `at(hand)` gives the converged displacement and force.
template <class Answer>
Way way_with(const Answer& at) {
  Way way;
  for (int i = 1; i <= kSamples; ++i) {
    auto [u, force] = at(circling_hand(i * way.every * kFrame, way.speed));
    way.displacement.push_back(std::move(u));
    way.force.push_back(force);
  }
  return way;
}

/// Bullet's own forces against the law that is taken for its own.
void check_law(const Bar& bar, BulletLaw law, const VectorX& answer) {
  if (law == BulletLaw::linear) return;  // its rotations are good to 0.01 rad only, see docs/rivals.md
  const StableNeoHookean published(bar.elastic);
  const VectorX ours = internal_force(bar, published, answer);
  const double apart = (BulletBar(bar, law, {}).elastic_force(answer) + ours).norm() / ours.norm();
  const double wrong = derivative_error(published);
  fmt::print(
      "Bullet's forces at its converged answer are {:.1e} from the law in its header; derivatives good to {:.0e}\n",
      apart, wrong);
  RHEXIS_CHECK(apart < kSameLaw, "Bullet's law is another one");
  RHEXIS_CHECK(wrong < kDerivative, "the derivatives of Bullet's law are wrong by {:.1e}", wrong);
}

ordered_json rest_row(const Bar& bar, BulletLaw law, const std::string& program, int threads,
                      const std::string& settings, const Rest& rest) {
  return {{"nodes", bar.mesh.node_count()},
          {"law", law == BulletLaw::linear ? "linear-elastic" : "neo-Hookean"},
          {"program", program},
          {"threads", threads},
          {"settings", settings},
          {"hold_ms", 1e3 * rest.hold},
          {"ms_to_10_percent", in_ms(rest.reached[0])},
          {"ms_to_1_percent", in_ms(rest.reached[1])},
          {"ms_to_0.1_percent", in_ms(rest.reached[2])}};
}

/// `best`: as of race_to_rest.
Rest median_rest(const MakeContestant& make, int moves, const VectorX& answer, const RestTimes& best) {
  std::array<Rest, kRepeats> all;
  for (Rest& rest : all) rest = race_to_rest(*make(), hand_at_rest(), moves, answer, best);
  const auto median = [&](const auto& of) {
    std::array<double, kRepeats> values;
    std::transform(all.begin(), all.end(), values.begin(), of);
    std::nth_element(values.begin(), values.begin() + kRepeats / 2, values.end());
    return values[kRepeats / 2];
  };
  Rest out;
  out.hold = median([](const Rest& rest) { return rest.hold; });
  for (std::size_t e = 0; e < kErrors.size(); ++e)
    out.reached[e] = median([e](const Rest& rest) { return rest.reached[e]; });
  return out;
}

void print_rest(const std::string& who, double hold, const RestTimes& at, const std::string& remark) {
  fmt::print("  {:<24} {:>8} {:>8} {:>8} {:>8}   {}\n", who, hold > 0.0 ? shown(hold) : "", shown(at[0]), shown(at[1]),
             shown(at[2]), remark);
}

void contest_at_rest(const Bar& bar, BulletLaw law, bool every, const VectorX& bullet_answer,
                     const std::vector<Ours>& ours, ContestTables& tables) {
  fmt::print("\nAt rest after the hand has gone 10 mm: ms from when it sets out, by the error that is left\n");
  fmt::print("  {:<24} {:>8} {:>8} {:>8} {:>8}\n", "", "hold", "10%", "1%", "0.1%");
  RestTimes longest;
  longest.fill(kLongest);
  RestTimes best = longest;
  std::array<std::string, kErrors.size()> best_settings;
  set_thread_count(1);  // as Bullet
  for (const BulletEntry& entry : bullet_entries(law, every)) {
    const Rest rest =
        median_rest([&] { return make_bullet(bar, law, entry.settings); }, entry.moves, bullet_answer, best);
    const std::string settings = fmt::format("moves: {}, {}", entry.moves, entry.settings.name());
    tables.rest.push_back(rest_row(bar, law, "Bullet", 1, settings, rest));
    print_rest("Bullet", 0.0, rest.reached, settings);
    for (std::size_t e = 0; e < kErrors.size(); ++e) {
      if (rest.reached[e] >= best[e]) continue;
      best[e] = rest.reached[e];
      best_settings[e] = settings;
    }
  }
  set_thread_count(0);
  for (std::size_t e = 0; e < kErrors.size(); ++e)
    if (best_settings[e].empty()) best[e] = std::numeric_limits<double>::infinity();
  print_rest("Bullet, the best", 0.0, best, "");
  for (const Ours& one : ours) {
    const VectorX answer = converged(bar, *one.model, hand_at_rest(), one.model->initial_state()).u;
    for (const int threads : {1, 2}) {
      set_thread_count(threads);
      const std::string who = fmt::format("{}, {} thread{}", one.name, threads, threads > 1 ? "s" : "");
      Rest rest;
      rest.hold = std::numeric_limits<double>::infinity();
      for (const int moves : kOurMoves) {
        const Rest tried = median_rest(one.make, moves, answer, longest);
        const std::string settings = fmt::format("moves: {}", moves);
        tables.rest.push_back(rest_row(bar, law, one.name, threads, settings, tried));
        print_rest(who, tried.hold, tried.reached, settings);
        rest.hold = std::min(rest.hold, tried.hold);
        for (std::size_t e = 0; e < kErrors.size(); ++e) rest.reached[e] = std::min(rest.reached[e], tried.reached[e]);
      }
      set_thread_count(0);
      fmt::print("    Bullet takes {:.1f}, {:.1f}, {:.1f} times as long; with taking hold {:.1f}, {:.1f}, {:.1f}\n",
                 best[0] / rest.reached[0], best[1] / rest.reached[1], best[2] / rest.reached[2],
                 best[0] / (rest.hold + rest.reached[0]), best[1] / (rest.hold + rest.reached[1]),
                 best[2] / (rest.hold + rest.reached[2]));
    }
  }
}

void contest_moving(const Bar& bar, BulletLaw law, BulletAnswers& answers, const std::vector<Ours>& ours,
                    ContestTables& tables) {
  fmt::print(
      "\nThe hand at 50 mm/s on a circle, a frame each 1/60 s of its way: ms a frame, mean error of displacement and "
      "force\n");
  const auto add = [&](const std::string& program, int threads, const std::string& settings,
                       const Following& following) {
    tables.moving.push_back({{"nodes", bar.mesh.node_count()},
                             {"law", law == BulletLaw::linear ? "linear-elastic" : "neo-Hookean"},
                             {"program", program},
                             {"threads", threads},
                             {"settings", settings},
                             {"frame_ms", 1e3 * following.frame},
                             {"error", if_finite(following.error)},
                             {"force_error", if_finite(following.force_error)}});
    fmt::print("  {:<24} {:>8} {:>9} {:>9}   {}\n",
               fmt::format("{}, {} thread{}", program, threads, threads > 1 ? "s" : ""), shown(following.frame),
               shown_percent(following.error), shown_percent(following.force_error), settings);
  };
  std::vector<Following> bullet;
  const Way of_bullet = way_with([&](const Vec3& hand) {
    const VectorX& u = answers.at(hand);
    return std::pair(u, answers.force());
  });
  set_thread_count(1);
  for (const BulletSettings& settings : bullet_followers()) {
    bullet.push_back(race_along(*make_bullet(bar, law, settings), of_bullet));
    add("Bullet", 1, settings.name(), bullet.back());
  }
  set_thread_count(0);
  for (const Ours& one : ours) {
    model::State near = one.model->initial_state();
    const Way way = way_with([&](const Vec3& hand) {
      near = converged(bar, *one.model, hand, near);
      return std::pair(near.u, force_of(bar, *one.model, near));
    });
    for (const int threads : {1, 2}) {
      set_thread_count(threads);
      const Following following = race_along(*one.make(), way);
      set_thread_count(0);
      add(one.name, threads, "", following);
      if (following.error < kExact) continue;
      double equal = std::numeric_limits<double>::infinity();
      double nearest = equal;
      double of_nearest = 0.0;
      for (const Following& other : bullet) {
        if (other.error <= following.error) equal = std::min(equal, other.frame);
        if (other.error < nearest) {
          nearest = other.error;
          of_nearest = other.frame;
        }
      }
      if (std::isfinite(equal)) {
        fmt::print("    Bullet takes {:.1f} times as long a frame to the same error\n", equal / following.frame);
      } else {
        fmt::print(
            "    no setting of Bullet has that error; the nearest has {:.1f} times it, and {:.1f} times the frame\n",
            nearest / following.error, of_nearest / following.frame);
      }
    }
  }
}

}  // namespace

Vec3 hand_at_rest() { return {0.0, 0.0, -0.01}; }

std::vector<BulletEntry> bullet_entries(BulletLaw law, bool every) {
  const auto one = [](int moves, double density, int iterations) {
    return BulletEntry{{.density = density, .iterations = iterations}, moves};
  };
  std::vector<BulletEntry> out;
  if (law == BulletLaw::linear) {
    out = {one(5, 100, 50),   one(12, 1000, 50), one(5, 100, 300),
           one(5, 1000, 200), one(1, 100, 100),  one(12, 100, 100)};
  } else {
    out = {one(5, 1000, 50), one(12, 1000, 50), one(12, 100, 100), one(12, 1000, 100), one(12, 1000, 300)};
  }
  if (!every) return out;
  for (const int moves : {1, 5, 8, 12})
    for (const double density : {1000.0, 100.0, 1.0})
      for (const int iterations : {20, 50, 100, 200, 300}) out.push_back(one(moves, density, iterations));
  for (const int moves : {1, 5, 12}) {
    for (const double damping : {0.005, 0.02, 0.1}) out.push_back({{.damping = damping, .iterations = 100}, moves});
    for (const bool line_search : {false, true})
      for (const int newton : {2, 4})
        out.push_back({{.density = 100, .newton = newton, .iterations = 100, .line_search = line_search}, moves});
    for (const double damping : {0.0, 0.005, 0.05})
      out.push_back({{.damping = damping, .steps = 100, .is_implicit = false}, moves});
  }
  return out;
}

std::vector<BulletSettings> bullet_followers() {
  std::vector<BulletSettings> out;
  for (const int iterations : {25, 50, 100, 200, 400}) out.push_back({.density = 100, .iterations = iterations});
  out.push_back({.density = 1000, .iterations = 200});
  out.push_back({.density = 1000, .damping = 0.02, .iterations = 50});
  return out;
}

void contest(const Bar& bar, BulletLaw law, bool every, ContestTables& tables) {
  fmt::print("\n== {} nodes, {} tets, {}\n", bar.mesh.node_count(), bar.mesh.tet_count(),
             law == BulletLaw::linear ? "linear-elastic" : "neo-Hookean");
  BulletAnswers answers(bar, law);
  const VectorX bullet_answer = answers.at(hand_at_rest());
  check_law(bar, law, bullet_answer);
  const std::vector<Ours> ours = ours_of(bar, law);
  contest_at_rest(bar, law, every, bullet_answer, ours, tables);
  contest_moving(bar, law, answers, ours, tables);
}

void compare_answers(const Bar& bar, ContestTables& tables) {
  fmt::print("\n== {} nodes, {} tets: the converged answer, against CalculiX\n", bar.mesh.node_count(),
             bar.mesh.tet_count());
  if (!is_calculix_here()) {
    fmt::print(
        "  no ccx on the PATH (Debian: calculix-ccx): each law is held against its own solution by Rhexis alone\n");
    return;
  }
  struct Pair {
    CalculixLaw law;
    ModelKind kind;
  };
  std::optional<CalculixAnswer> neo_hookean;
  const auto row = [&](const std::string& what, double seconds, double apart, std::optional<double> theirs) {
    tables.converged.push_back({{"nodes", bar.mesh.node_count()},
                                {"answer", what},
                                {"ms", seconds > 0.0 ? ordered_json(1e3 * seconds) : ordered_json()},
                                {"calculix_ms", theirs ? ordered_json(1e3 * *theirs) : ordered_json()},
                                {"difference", apart}});
    fmt::print("  {:<44} {:>8} ms, CalculiX {:>8} ms, difference {:.1e}\n", what, seconds > 0.0 ? shown(seconds) : "",
               theirs ? shown(*theirs) : "", apart);
  };
  for (const Pair pair : {Pair{CalculixLaw::linear, ModelKind::linear},
                          Pair{CalculixLaw::st_venant_kirchhoff, ModelKind::geometrically_nonlinear},
                          Pair{CalculixLaw::neo_hookean, ModelKind::hyperelastic}}) {
    const std::shared_ptr<const model::Model> model = bar.model(pair.kind, false);
    const Stopwatch watch;
    const VectorX u = converged(bar, *model, hand_at_rest(), model->initial_state()).u;
    const double seconds = watch.seconds();
    const std::optional<CalculixAnswer> theirs = run_calculix(bar, pair.law, hand_at_rest());
    if (!theirs) {
      fmt::print("  {:<44} CalculiX gave no answer\n", model->name());
      continue;
    }
    if (pair.law == CalculixLaw::neo_hookean) neo_hookean = theirs;
    row(fmt::format("{}{}", model->name(), model->pressure_unknowns() > 0 ? ", beta 0" : ""), seconds,
        error_of(u, theirs->u), theirs->seconds);
  }
  if (!neo_hookean) return;
  const std::shared_ptr<const model::Model> stabilised = bar.model(ModelKind::hyperelastic, true);
  const model::State ours = converged(bar, *stabilised, hand_at_rest(), stabilised->initial_state());
  row("hyperelastic, beta auto, from neo-Hookean", 0.0, error_of(ours.u, neo_hookean->u), {});
  row("Bullet's neo-Hookean from CalculiX's", 0.0,
      error_of(converged(bar, StableNeoHookean(bar.elastic), hand_at_rest(), ours.u), neo_hookean->u), {});
}

}  // namespace rhexis::rivals
