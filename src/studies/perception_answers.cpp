#include "studies/perception_answers.h"

#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "scene/scene.h"
#include "studies/angle_perception_figures.h"
#include "studies/perception_log.h"
#include "studies/perception_plate.h"
#include "studies/perception_tables.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

/// Line and answer.
using ScriptedAnswers = std::vector<std::pair<int, Side>>;

Expected<ScriptedAnswers> read_script(const std::filesystem::path& path) {
  const Expected<std::string> text = scene::read_scene_text(path);
  if (!text) return fail(text.error().what, "a file of answers, A or B, a line each", path.string());
  ScriptedAnswers out;
  std::istringstream lines(*text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const std::string word = line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
    if (word != "A" && word != "B" && word != "a" && word != "b")
      return fail(scene::in_quotes(word) + " is no answer", "A or B", path.string(), number);
    out.emplace_back(number, word == "A" || word == "a" ? Side::a : Side::b);
  }
  if (out.empty()) return fail("there is no answer in it", "A or B, a line each", path.string());
  return out;
}

}  // namespace

Expected<ordered_json> write_answers(const PerceptionSettings& settings, const std::vector<AnsweredTrial>& answered,
                                     const StudyFolder& folder) {
  if (answered.empty()) return fail("not a trial was answered");
  const std::vector<AnswerCount> counts = counts_of(answered);
  const std::optional<PsychometricFit> fit = fit_psychometric(counts);
  const std::vector<DifferenceClass> classes = classify(counts, settings.classes);
  ordered_json rows = ordered_json::array();
  for (const DifferenceClass& one : classes) rows.push_back(class_row("answers", one));
  for (const DifferenceClass& one : thesis_classes()) rows.push_back(class_row("thesis", one));
  ordered_json trials = ordered_json::array();
  for (const AnsweredTrial& one : answered) trials.push_back(trial_json(one));
  const std::optional<double> from = told_from(classes);
  folder.note(fmt::format(
      "{} trials by the rule '{}', seed {}. {}", answered.size(), settings.rule.name, settings.seed,
      from ? fmt::format("Told apart from {} degrees on.", *from) : "No class of differences is told apart."));
  folder.compare("angle-perception.threshold", or_null(from),
                 "Of these answers: other hands, another device and plate than the thesis's.");
  Expected<void> ok = folder.write_table("angle-perception", rows, "As Table 5.4 of the thesis, which stands below.");
  if (ok)
    ok = write_fit(folder,
                   ordered_json::array({fit_row("answers", counts, fit),
                                        fit_row("thesis", thesis_answers(), fit_psychometric(thesis_answers()))}));
  if (ok) ok = folder.write_figure("angle-perception-answers", answers_chart("The answers", counts, fit));
  if (ok) ok = folder.write_table("angle-perception-trials", trials);
  if (!ok) return fail(std::move(ok.error()));
  return rows;
}

Expected<ordered_json> run_scripted_answers(const PerceptionSettings& settings, const std::filesystem::path& answers,
                                            const StudyFolder& folder, const Progress& progress) {
  const Expected<ScriptedAnswers> script = read_script(answers);
  if (!script) return fail(script.error());
  // A script touches no plate; an experiment that no plate can be made for is none all the same.
  if (const Expected<PerceptionPlate> plate = PerceptionPlate::open(settings); !plate) return fail(plate.error());
  PerceptionExperiment experiment(settings, settings.seed);
  Expected<TrialLog> log = TrialLog::open(folder.path() / TrialLog::kName, settings, settings.seed, experiment);
  if (!log) return fail(std::move(log.error()));
  const std::size_t before = experiment.answered().size();
  for (std::size_t k = 0; k < script->size(); ++k) {
    const auto& [line, side] = (*script)[k];
    const auto wrong = [&, at = line](const std::string& what, const std::string& remedy) {
      return fail(what, remedy, answers.string(), at);
    };
    if (k < before) {
      if (experiment.answered()[k].answer == side) continue;
      return wrong(fmt::format("trial {} was answered {} before", k + 1, letter_of(experiment.answered()[k].answer)),
                   "--out names another folder");
    }
    if (experiment.current() == nullptr)
      return wrong(fmt::format("the experiment has {} trials", experiment.answered().size()), "no more answers");
    experiment.answer(side);
  }
  // Kept when all lines are good: a script with a mistake leaves no answers behind.
  for (std::size_t k = before; k < experiment.answered().size(); ++k)
    if (Expected<void> kept = log->append(experiment.answered()[k], 0.0); !kept) return fail(std::move(kept.error()));
  progress(1.0, fmt::format("{} answers", experiment.answered().size()));
  if (experiment.current() != nullptr)
    folder.note(fmt::format("The experiment is not at its end: {} of {} runs are done.", experiment.runs_done(),
                            experiment.runs()));
  return write_answers(settings, experiment.answered(), folder);
}

}  // namespace rhexis::studies
