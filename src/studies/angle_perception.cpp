#include "studies/angle_perception.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/parallel.h"
#include "studies/angle_perception_figures.h"
#include "studies/perception_analysis.h"
#include "studies/perception_plate.h"
#include "studies/perception_tables.h"
#include "studies/published.h"
#include "studies/simulated_observer.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

/// Of simulated observers.
constexpr double kSlope = 4.0;
constexpr double kLapse = 0.02;
/// The subjects of the thesis, and how many such groups are simulated for the expected counts.
constexpr int kSubjects = 7;
constexpr int kGroups = 200;
/// Runs of a simulated observer by the two rules that find a threshold in one.
constexpr int kLongRuns = 2;
/// degrees, of angle-perception-feel: halves of 45 and what (5.2) makes of them.
constexpr double kFelt[] = {1.40625, 2.8125, 5.625, 11.25, 16.875, 22.5, 33.75, 45.0, 67.5};

/// Table 5.4 as seven observers of one function would fill it on average, by the rule of the thesis.
std::vector<ordered_json> expected_rows(PerceptionSettings settings, const Psychometric& truth, std::uint64_t seed) {
  settings.rule.name = kRuleNames[0];
  std::vector<std::vector<DifferenceClass>> groups(kGroups);
  parallel_for(groups.size(), [&](std::size_t group) {
    std::vector<AnsweredTrial> answered;
    for (std::size_t subject = 0; subject < kSubjects; ++subject) {
      const std::vector<AnsweredTrial> own = observe(settings, truth, seed + kSubjects * group + subject);
      answered.insert(answered.end(), own.begin(), own.end());
    }
    groups[group] = classify(counts_of(answered), settings.classes);
  });
  std::vector<ordered_json> rows;
  for (std::size_t k = 0; k < settings.classes.size(); ++k) {
    double trials = 0.0, right = 0.0, told = 0.0;
    for (const std::vector<DifferenceClass>& classes : groups) {
      trials += static_cast<double>(classes[k].trials) / kGroups;
      right += static_cast<double>(classes[k].right) / kGroups;
      told += (classes[k].is_told() ? 1.0 : 0.0) / kGroups;
    }
    rows.push_back({{"expected_trials", trials}, {"expected_right", right}, {"told_percent", 100.0 * told}});
  }
  return rows;
}

Expected<ordered_json> feel_rows(const PerceptionSettings& settings) {
  const Expected<PerceptionPlate> plate = PerceptionPlate::open(settings);
  if (!plate) return fail(plate.error());
  std::vector<double> differences;
  for (const double difference : kFelt)
    if (difference <= settings.rule.most) differences.push_back(difference);
  const Expected<std::vector<response::ContactLaw>> sample = plate->laws(settings.sample);
  if (!sample) return fail(sample.error());
  std::vector<std::vector<response::ContactLaw>> odd;
  for (const double difference : differences) {
    Expected<std::vector<response::ContactLaw>> laws = plate->laws(settings.sample - difference);
    if (!laws) return fail(laws.error());
    odd.push_back(std::move(*laws));
  }
  ordered_json rows = ordered_json::array();
  for (std::size_t point = 0; point < settings.points.size(); ++point) {
    for (std::size_t direction = 0; direction < settings.directions.size(); ++direction) {
      const Vec3& along = settings.directions[direction].value;
      const Vec3 of_sample = (*sample)[point].stiffness * along;
      for (std::size_t k = 0; k < differences.size(); ++k) {
        const Vec3 change = odd[k][point].stiffness * along - of_sample;
        rows.push_back({{"point", point},
                        {"direction", direction},
                        {"difference", differences[k]},
                        {"sample_N_per_m", of_sample.norm()},
                        {"change_percent", 100.0 * change.norm() / of_sample.norm()},
                        {"change_along_percent", 100.0 * change.dot(along) / of_sample.dot(along)}});
      }
    }
  }
  return rows;
}

PerceptionSettings for_rule(PerceptionSettings settings, std::string_view rule) {
  settings.rule.name = rule;
  if (rule == kRuleNames[0]) return settings;
  settings.points.resize(1);
  settings.directions.resize(1);
  settings.repeats = kLongRuns;
  return settings;
}

/// degrees: where a rule that hovers about this part of right answers does so for this observer.
double threshold_of(const Psychometric& truth, double part) {
  const double core = (part - kGuess) / (1.0 - kGuess - truth.lapse);
  return truth.threshold * std::pow(core / (1.0 - core), 1.0 / truth.slope);
}

ordered_json rule_row(const PerceptionSettings& settings, const Psychometric& truth, const RuleTrial& found) {
  const double spread = 100.0 * std::expm1(found.spread);
  const double own_target = settings.rule.name == kRuleNames[1] ? threshold_of(truth, std::cbrt(0.5)) : truth.threshold;
  return {{"rule", settings.rule.name},
          {"runs", settings.runs()},
          {"threshold", truth.threshold},
          {"trials", found.trials},
          {"bounded_percent", 100.0 * found.bounded},
          {"fitted", found.estimate},
          {"bias_percent", 100.0 * std::expm1(found.bias)},
          {"spread_percent", spread},
          {"interval_percent", 100.0 * found.held},
          {"trials_for_10_percent", found.trials * std::pow(found.spread / std::log(1.1), 2)},
          {"own_estimate", found.own > 0.0 ? ordered_json(found.own) : ordered_json(nullptr)},
          {"own_target", found.own > 0.0 ? ordered_json(own_target) : ordered_json(nullptr)}};
}

void beside_the_thesis(const StudyFolder& folder, const ordered_json& rows) {
  folder.compare("angle-perception.threshold", or_null(told_from(thesis_classes())),
                 "The thesis's own counts under its own test, done exactly; its fit says more (angle-perception-fit).");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const char* why =
        "No people took part: groups of seven simulated observers of the function fitted to the thesis's counts, by "
        "its "
        "rule, on average. Its five counts add up to 421, and seven subjects make 420 trials.";
    folder.compare(fmt::format("angle-perception.trials.{}", k + 1), rows[k].at("expected_trials"), why);
    folder.compare(fmt::format("angle-perception.right.{}", k + 1), rows[k].at("expected_right"), why);
    folder.compare(fmt::format("angle-perception.critical.{}", k + 1), rows[k].at("critical"),
                   "Binomial, exact, one-sided, of the thesis's number of trials.");
  }
}

}  // namespace

Expected<PerceptionSettings> AnglePerceptionOptions::settings() const {
  Expected<PerceptionSettings> read = read_perception(experiment);
  if (read && seed) read->seed = *seed;
  return read;
}

Expected<ordered_json> run_angle_perception(const AnglePerceptionOptions& options, const StudyFolder& folder,
                                            const Progress& progress) {
  const Expected<PerceptionSettings> settings = options.settings();
  if (!settings) return fail(settings.error());
  for (const double threshold : options.thresholds)
    if (!(threshold >= settings->rule.least && threshold <= settings->rule.most))
      return fail(fmt::format("a threshold of {} degrees", threshold),
                  fmt::format("{} to {}", settings->rule.least, settings->rule.most));
  if (options.observers < 1) return fail(fmt::format("{} observers", options.observers), "at least 1");
  const Expected<ordered_json> felt = feel_rows(*settings);
  if (!felt) return fail(felt.error());
  const double parts = static_cast<double>(kRuleNames.size() * options.thresholds.size()) + 2.0;
  double done = 1.0;
  bool goes_on = progress(done / parts, "what there is to feel");

  const std::vector<AnswerCount> thesis = thesis_answers();
  const std::optional<PsychometricFit> fit = fit_psychometric(thesis);
  RHEXIS_CHECK(fit.has_value(), "the thesis's counts have a threshold");
  Expected<PerceptionSettings> thesis_experiment = read_perception({});
  RHEXIS_CHECK(thesis_experiment.has_value(), "{}", thesis_experiment.error().message());
  const std::vector<ordered_json> expected = expected_rows(*thesis_experiment, fit->function, settings->seed);
  ordered_json rows = ordered_json::array();
  for (const DifferenceClass& one : thesis_classes()) {
    rows.push_back(class_row("thesis", one));
    rows.back().update(expected[rows.size() - 1]);
  }
  goes_on = goes_on && progress(++done / parts, "the thesis's counts");

  ordered_json rules = ordered_json::array();
  for (const std::string_view rule : kRuleNames) {
    for (const double threshold : options.thresholds) {
      if (!goes_on) break;
      const PerceptionSettings own = for_rule(*settings, rule);
      const Psychometric truth{threshold, kSlope, kLapse};
      rules.push_back(rule_row(own, truth, try_rule(own, truth, options.observers, settings->seed)));
      goes_on = progress(++done / parts, fmt::format("{}, threshold {} degrees", rule, threshold));
    }
  }

  folder.note(
      "No people took part in what this page shows: `rhexis study angle-perception --with person` runs the experiment. "
      "The "
      "thesis's counts stand under its own test, done exactly, and simulated observers show what its rule and two "
      "others "
      "find of a threshold that is known.");
  folder.note(fmt::format(
      "The verdict of the thesis is where guessing is ruled out: from {} degrees on. That says nothing of how often a "
      "hand "
      "is right there: the function fitted to the same counts has {:.0f}% of the answers right at {:.0f} degrees, its "
      "threshold.",
      *told_from(thesis_classes()), 100.0 * fit->function.probability(fit->function.threshold),
      fit->function.threshold));
  Expected<void> ok = folder.write_table(
      "angle-perception", rows,
      "Table 5.4 of the thesis: from and to in degrees; critical: the least number of right answers that guessing "
      "reaches in "
      "one of twenty cases at most. expected: groups of seven simulated observers of the fitted function, on average; "
      "told_percent: of those groups, for which the class is told.");
  if (ok)
    ok = folder.write_figure("angle-perception-thesis", answers_chart("The answers of the thesis", thesis, fit),
                             "Each class at its middle, the last at 67.5 degrees.");
  if (ok) ok = write_fit(folder, ordered_json::array({fit_row("thesis", thesis, fit)}));
  if (ok && !rules.empty())
    ok = folder.write_table("angle-perception-rules", rules,
                            "Simulated observers of known threshold (slope 4, 2% lapses): trials, fitted threshold "
                            "(geometric mean, degrees), its "
                            "bias and spread, how often the 95% interval holds the truth, and how many trials a spread "
                            "of 10% would take. own: "
                            "what the rule itself says, and what it should say.");
  if (ok && !rules.empty()) ok = folder.write_figure("angle-perception-rules", rules_chart(rules));
  if (ok)
    ok = folder.write_table(
        "angle-perception-feel", *felt,
        "Points and directions from 0, as the experiment lists them; the force of the exact response.");
  if (ok) ok = folder.write_figure("angle-perception-feel", feel_chart(*felt));
  if (!ok) return fail(std::move(ok.error()));
  beside_the_thesis(folder, rows);
  return rows;
}

}  // namespace rhexis::studies
