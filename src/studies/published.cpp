#include "studies/published.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"

namespace rhexis::studies {
namespace {

constexpr std::string_view kTable4 = "paper, Table 4";
constexpr std::string_view kTable5 = "paper, Table 5";
constexpr std::string_view kTable6 = "paper, Table 6";
constexpr std::string_view kFig57 = "thesis, Fig. 5.7 (read off the chart)";
constexpr std::string_view kTable54 = "thesis, Table 5.4";
constexpr std::string_view kTable59 = "thesis, Table 5.9";
constexpr std::string_view kTable510 = "thesis, Table 5.10";
constexpr std::nullopt_t kTrend = std::nullopt;

constexpr std::array kNumbers{
    Published{"identification.nodes", "nodes of the vessel", 401.0, "", "", "paper, 5.1"},
    Published{"identification.tets", "tets of the vessel", 1101.0, "", "", "paper, 5.1"},
    Published{"identification.mean.rho510", "mean difference from another program, rho 510", 0.89, "", "%", kTable4},
    Published{"identification.mean.rho5.1", "mean difference from another program, rho 5.1", 1.72, "", "%", kTable4},

    Published{"stabilisation.oscillation", "lambda over the tets as beta grows", kTrend, "oscillation falls", "",
              "paper, 5.3, Fig. 4"},

    Published{"models.mean.linear", "mean difference from PSH, linear", 22.0, "", "%", kTable5},
    Published{"models.mean.corotated", "mean difference from PSH, corotated", 3.33, "", "%", kTable5},
    Published{"models.mean.geometrically-nonlinear", "mean difference from PSH, geometrically nonlinear", 3.36, "", "%",
              kTable5},
    Published{"models.max.linear", "largest difference from PSH, linear", 96.2, "", "%", kTable5},
    Published{"models.max.corotated", "largest difference from PSH, corotated", 13.6, "", "%", kTable5},
    Published{"models.max.geometrically-nonlinear", "largest difference from PSH, geometrically nonlinear", 13.4, "",
              "%", kTable5},
    Published{"models.mean-x.linear", "mean difference in x, linear", 18.3, "", "%", kTable5},
    Published{"models.mean-y.linear", "mean difference in y, linear", 43.3, "", "%", kTable5},
    Published{"models.mean-z.linear", "mean difference in z, linear", 4.41, "", "%", kTable5},
    Published{"models.mean-x.corotated", "mean difference in x, corotated", 4.64, "", "%", kTable5},
    Published{"models.mean-y.corotated", "mean difference in y, corotated", 4.47, "", "%", kTable5},
    Published{"models.mean-z.corotated", "mean difference in z, corotated", 0.88, "", "%", kTable5},
    Published{"models.mean-x.geometrically-nonlinear", "mean difference in x, geometrically nonlinear", 4.09, "", "%",
              kTable5},
    Published{"models.mean-y.geometrically-nonlinear", "mean difference in y, geometrically nonlinear", 4.59, "", "%",
              kTable5},
    Published{"models.mean-z.geometrically-nonlinear", "mean difference in z, geometrically nonlinear", 1.43, "", "%",
              kTable5},
    Published{"models.density", "differences as the density grows tenfold", kTrend, "they widen", "",
              "paper, 6.1, Fig. 5"},
    Published{"models.volume", "volume of the linear model at large deformation", kTrend, "swells markedly", "",
              "paper, 6.2 (b)"},

    Published{"timing.build.linear", "build of the tangent, linear", 0.09, "", "corotated build", kTable6},
    Published{"timing.build.corotated", "build of the tangent, corotated", 1.0, "", "corotated build", kTable6},
    Published{"timing.build.geometrically-nonlinear", "build of the tangent, geometrically nonlinear", 1.3, "",
              "corotated build", kTable6},
    Published{"timing.build.hyperelastic", "build of the tangent, PSH", 10.1, "", "corotated build", kTable6},
    Published{"timing.solve.linear", "linear solve, linear", 4.2, "", "corotated build", kTable6},
    Published{"timing.solve.corotated", "linear solve, corotated", 4.2, "", "corotated build", kTable6},
    Published{"timing.solve.geometrically-nonlinear", "linear solve, geometrically nonlinear", 4.2, "",
              "corotated build", kTable6},
    Published{"timing.solve.hyperelastic", "linear solve, PSH", 19.8, "", "corotated build", kTable6},
    Published{"timing.iteration", "a whole Newton iteration, PSH over corotated", 29.9 / 5.2, "", "", kTable6},
    Published{"timing.real-time", "one Newton iteration per simulation step", kTrend, "expected to do, not shown", "",
              "paper, 6.3"},

    Published{"restructuring.nodes", "nodes of the plate", 506.0, "", "", "thesis, Table 5.3"},
    Published{"restructuring.local.506", "an advance, local object, 506 nodes", 7.4, "", "ms", kFig57},
    Published{"restructuring.local.765", "an advance, local object, 765 nodes", 12.6, "", "ms", kFig57},
    Published{"restructuring.local.1012", "an advance, local object, 1012 nodes", 27.5, "", "ms", kFig57},
    Published{"restructuring.local.1270", "an advance, local object, 1270 nodes", 30.4, "", "ms", kFig57},
    Published{"restructuring.whole.506", "an advance, whole inverse, 506 nodes", 376.9, "", "ms", kFig57},
    Published{"restructuring.whole.765", "an advance, whole inverse, 765 nodes", 1290.9, "", "ms", kFig57},
    Published{"restructuring.whole.1012", "an advance, whole inverse, 1012 nodes", 2813.1, "", "ms", kFig57},
    Published{"restructuring.whole.1270", "an advance, whole inverse, 1270 nodes", 5905.7, "", "ms", kFig57},

    Published{"reaction-error.patterns.1", "patterns, one advance", 2773440.0, "", "", kTable59},
    Published{"reaction-error.better.1", "smaller error with correction, one advance", 92.8, "", "%", kTable59},
    Published{"reaction-error.mean-without.1", "mean error without correction, one advance", 4.0e-3, "", "", kTable59},
    Published{"reaction-error.deviation-without.1", "its deviation", 2.6e-2, "", "", kTable59},
    Published{"reaction-error.mean-with.1", "mean error with correction, one advance", 2.1e-3, "", "", kTable59},
    Published{"reaction-error.deviation-with.1", "its deviation", 1.9e-2, "", "", kTable59},
    Published{"reaction-error.patterns.2", "patterns, two advances", 499219200.0, "", "", kTable510},
    Published{"reaction-error.better.2", "smaller error with correction, two advances", 71.3, "", "%", kTable510},
    Published{"reaction-error.mean-without.2", "mean error without correction, two advances", 4.8e-3, "", "",
              kTable510},
    Published{"reaction-error.deviation-without.2", "its deviation", 2.7e-2, "", "", kTable510},
    Published{"reaction-error.mean-with.2", "mean error with correction, two advances", 3.2e-3, "", "", kTable510},
    Published{"reaction-error.deviation-with.2", "its deviation", 1.7e-2, "", "", kTable510},

    Published{"angle-perception.threshold", "angle that a hand can tell", 15.0, "", "degrees", "thesis, 5.3"},
    Published{"angle-perception.trials.1", "trials, first class of Table 5.4", 124.0, "", "", kTable54},
    Published{"angle-perception.trials.2", "trials, second class", 128.0, "", "", kTable54},
    Published{"angle-perception.trials.3", "trials, third class", 41.0, "", "", kTable54},
    Published{"angle-perception.trials.4", "trials, fourth class", 114.0, "", "", kTable54},
    Published{"angle-perception.trials.5", "trials, fifth class", 14.0, "", "", kTable54},
    Published{"angle-perception.right.1", "right answers, first class", 58.0, "", "", kTable54},
    Published{"angle-perception.right.2", "right answers, second class", 85.0, "", "", kTable54},
    Published{"angle-perception.right.3", "right answers, third class", 29.0, "", "", kTable54},
    Published{"angle-perception.right.4", "right answers, fourth class", 92.0, "", "", kTable54},
    Published{"angle-perception.right.5", "right answers, fifth class", 13.0, "", "", kTable54},
    Published{"angle-perception.critical.1", "critical value at 5%, first class", 72.0, "", "", kTable54},
    Published{"angle-perception.critical.2", "critical value at 5%, second class", 74.0, "", "", kTable54},
    Published{"angle-perception.critical.3", "critical value at 5%, third class", 27.0, "", "", kTable54},
    Published{"angle-perception.critical.4", "critical value at 5%, fourth class", 67.0, "", "", kTable54},
    Published{"angle-perception.critical.5", "critical value at 5%, fifth class", 11.0, "", "", kTable54},
};

}  // namespace

std::span<const Published> published_numbers() { return kNumbers; }

const Published& published(std::string_view id) {
  const auto* const found =
      std::find_if(kNumbers.begin(), kNumbers.end(), [&](const Published& one) { return one.id == id; });
  RHEXIS_CHECK(found != kNumbers.end(), "nothing was published as '{}'", id);
  return *found;
}

double published_value(std::string_view id) {
  const Published& one = published(id);
  RHEXIS_CHECK(one.value.has_value(), "'{}' is a trend", id);
  return *one.value;
}

nlohmann::ordered_json beside_published(std::string_view id, const nlohmann::ordered_json& ours,
                                        const std::string& why) {
  const Published& one = published(id);
  nlohmann::ordered_json row{{"id", one.id}, {"what", one.what}, {"unit", one.unit}};
  row["published"] = one.value ? nlohmann::ordered_json(*one.value) : nlohmann::ordered_json(one.trend);
  row["ours"] = ours;
  row["ratio"] = one.value && ours.is_number() && *one.value != 0.0
                     ? nlohmann::ordered_json(ours.get<double>() / *one.value)
                     : nlohmann::ordered_json(nullptr);
  row["source"] = one.source;
  row["why"] = why;
  return row;
}

}  // namespace rhexis::studies
