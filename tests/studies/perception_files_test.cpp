// What an experiment reads and writes: its settings, its answers.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "studies/angle_perception.h"
#include "studies/perception_answers.h"
#include "studies/perception_log.h"
#include "studies/perception_plate.h"
#include "studies/study_plate.h"
#include "tests/support/run_command.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::StartsWith;

bool go_on(double, std::string_view) { return true; }

const std::filesystem::path kExample =
    std::filesystem::path(RHEXIS_SOURCE_DIR) / "scenes/experiments/angle-perception.toml";

TEST(PerceptionSettings, AreTheThesisWhereNothingIsSaid) {
  const PerceptionSettings thesis = *read_perception({});
  EXPECT_EQ(thesis.runs(), 12U);
  EXPECT_EQ(thesis.rule.name, "halving");
  EXPECT_EQ(thesis.rule.most, 89.0);
  EXPECT_THAT(thesis.classes, testing::ElementsAre(0.0, 15.0, 30.0, 45.0, 60.0));
  const Expected<PerceptionSettings> example = read_perception(kExample);
  ASSERT_TRUE(example) << example.error().message();
  EXPECT_EQ(fingerprint_of(*example), fingerprint_of(thesis)) << "the example says what leaving it all out means";
  EXPECT_EQ(example->seed, thesis.seed);
  EXPECT_EQ(example->classes, thesis.classes);
}

TEST(PerceptionSettings, TheExampleSaysEveryKey) {
  const std::string text = test::slurp(kExample);
  const std::string docs = test::slurp(std::filesystem::path(RHEXIS_SOURCE_DIR) / "docs/angle-perception.md");
  for (const scene::Section& section : perception_sections()) {
    for (const scene::Key& key : section.keys) {
      if (key.name != "scene") {
        EXPECT_THAT(text, HasSubstr("\n" + key.name + " = "));
      }
      EXPECT_THAT(docs, HasSubstr("`" + (section.name.empty() ? "" : section.name + ".") + key.name + "`"));
    }
  }
}

TEST(PerceptionSettings, OfAnotherPlateHaveAnotherFingerprint) {
  const std::filesystem::path path = test::fresh_folder("plates") / "plate.toml";
  PerceptionSettings settings = *read_perception({});
  settings.scene = path;
  const auto fingerprint = [&](const std::string& text) {
    std::ofstream(path) << text;
    return fingerprint_of(settings);
  };
  EXPECT_NE(fingerprint("title = \"one\""), fingerprint("title = \"two\""));
}

TEST(PerceptionSettings, NameEveryMistakeWithItsLine) {
  struct Case {
    const char* text;
    const char* error;
  };
  for (const Case& one : {
           Case{"repeats = 0", "e.toml:1: 'repeats' is 0 (give an integer, 1 to 100)"},
           Case{"\nseeds = 3", "e.toml:2: unknown key 'seeds' (did you mean 'seed'?)"},
           Case{"[rule]\nname = \"halfing\"",
                "e.toml:2: 'rule.name' is 'halfing', an unknown name (did you mean 'halving'?)"},
           Case{"[rules]\nname = 1", "e.toml:1: unknown section 'rules' (did you mean 'rule'?)"},
           Case{"[rule]\nstart = 120.0",
                "e.toml:2: 'rule.start' is 120, and differences have to leave the crack between 0 and the sample's 90 "
                "degrees (1 to 89)"},
           Case{"classes = [30.0, 15.0]",
                "e.toml:1: 'classes' do not ascend (where each class after the first begins)"},
           Case{"[[direction]]\nalong = [0.0, 0.0, 0.0]",
                "e.toml:2: 'direction.along' is no direction (not all noughts)"},
           Case{"[[point]]\nat = [nan, 0.0, 0.0]",
                "e.toml:2: 'point.0.at.0' is nan (give three numbers in m, each -1000000 to 1000000)"},
           Case{"scene = \"plate.toml\"", "e.toml: nothing says where the plate is held (add a [[point]])"},
           Case{"[crack]\nsample = 180.0", "e.toml:2: 'crack.sample' is 180"},
       }) {
    const Expected<PerceptionSettings> settings = parse_perception(one.text, "e.toml");
    ASSERT_FALSE(settings) << one.text;
    EXPECT_THAT(settings.error().message(), StartsWith(one.error));
  }
}

TEST(PerceptionPlate, GivesWayByTheAngleOfItsCrack) {
  const Expected<PerceptionPlate> plate = PerceptionPlate::open(*read_perception({}));
  ASSERT_TRUE(plate) << plate.error().message();
  const auto sample = *plate->laws(90.0);
  ASSERT_EQ(sample.size(), 2U);
  // In steps, since the mesh decides which edges a crack goes along: a small turn changes least, a large one not most.
  const auto change = [&](double difference) {
    const auto odd = *plate->laws(90.0 - difference);
    return (odd[0].stiffness - sample[0].stiffness).norm() / sample[0].stiffness.norm();
  };
  const double small = change(5.625);
  EXPECT_GT(small, 1e-4);
  for (const double difference : {22.5, 45.0, 67.5}) EXPECT_GT(change(difference), 5.0 * small) << difference;
  EXPECT_EQ((*plate->laws(90.0))[1].stiffness, sample[1].stiffness) << "the same bits";
}

TEST(PerceptionPlate, NamesWhatItCannotTake) {
  PerceptionSettings settings = *read_perception({});
  settings.scene = std::filesystem::path(RHEXIS_SOURCE_DIR) / "scenes/plate-tear.toml";
  EXPECT_THAT(PerceptionPlate::open(settings).error().message(),
              HasSubstr("plate-tear.toml: the body of an experiment"));
  settings.scene = test::fresh_folder("soft") / "soft.toml";
  std::string soft = plate_scene("Soft", 300);
  std::ofstream(settings.scene) << soft.replace(soft.find("\"linear\""), 8, "\"corotated\"");
  EXPECT_THAT(PerceptionPlate::open(settings).error().message(),
              HasSubstr("soft.toml: a plate of model 'corotated' has another law at every pull (kind = \"linear\")"));
  settings = *parse_perception("[[point]]\nat = [0.24, 0.12, 0.0]\n", "e.toml");
  EXPECT_THAT(PerceptionPlate::open(settings).error().message(), StartsWith("e.toml:2: "));
}

TEST(TrialLog, GoesOnWhereAKillHasLeftIt) {
  const std::filesystem::path path = test::fresh_folder("log") / TrialLog::kName;
  const PerceptionSettings settings = *read_perception({});
  std::vector<Trial> trials;
  {
    PerceptionExperiment experiment(settings, 4);
    Expected<TrialLog> log = TrialLog::open(path, settings, 4, experiment);
    ASSERT_TRUE(log) << log.error().message();
    for (int k = 0; k < 7; ++k) {
      experiment.answer(k % 3 == 0 ? Side::a : Side::b);
      ASSERT_TRUE(log->append(experiment.answered().back(), 1.5));
    }
    trials = {experiment.answered().back().trial, *experiment.current()};
  }
  const std::string whole = test::slurp(path);
  std::ofstream(path, std::ios::app) << "{\"trial\": 8, \"run";  // killed while it was written
  PerceptionExperiment again(settings, 4);
  ASSERT_TRUE(TrialLog::open(path, settings, 4, again));
  EXPECT_EQ(test::slurp(path), whole);
  ASSERT_EQ(again.answered().size(), 7U);
  EXPECT_EQ(again.answered().back().trial, trials[0]);
  EXPECT_EQ(*again.current(), trials[1]);
}

TEST(TrialLog, RefusesAnotherExperiment) {
  const std::filesystem::path path = test::fresh_folder("log") / TrialLog::kName;
  PerceptionSettings settings = *read_perception({});
  {
    PerceptionExperiment experiment(settings, 4);
    Expected<TrialLog> log = TrialLog::open(path, settings, 4, experiment);
    experiment.answer(Side::a);
    ASSERT_TRUE(log && log->append(experiment.answered().back(), 0.0));
  }
  const auto error = [&](const PerceptionSettings& of, std::uint64_t seed) {
    PerceptionExperiment experiment(of, seed);
    const Expected<TrialLog> log = TrialLog::open(path, of, seed, experiment);
    return log ? std::string("none") : log.error().message();
  };
  EXPECT_EQ(error(settings, 4), "none");
  EXPECT_THAT(error(settings, 5), HasSubstr("trials.jsonl:1: these are the answers to another experiment"));
  settings.repeats = 3;
  EXPECT_THAT(error(settings, 4), HasSubstr("trials.jsonl:1: "));
  settings.repeats = 2;
  std::string text = test::slurp(path);
  text.replace(text.find("\"difference\":45"), 15, "\"difference\":44");
  std::ofstream(path) << text;
  EXPECT_THAT(error(settings, 4), HasSubstr("trials.jsonl:2: this is not the trial that comes next"));
  std::ofstream(path) << "nonsense\n";
  EXPECT_THAT(error(settings, 4), HasSubstr("trials.jsonl:1: these are the answers to another experiment"));
}

TEST(TrialLog, GivesWayWhereNothingWasAnswered) {
  const std::filesystem::path path = test::fresh_folder("log") / TrialLog::kName;
  const PerceptionSettings settings = *read_perception({});
  for (const std::uint64_t seed : {4U, 5U}) {
    PerceptionExperiment experiment(settings, seed);
    ASSERT_TRUE(TrialLog::open(path, settings, seed, experiment)) << seed;
  }
  const std::string kept = test::slurp(path);
  EXPECT_THAT(kept, HasSubstr("\"seed\":5"));
  EXPECT_EQ(std::count(kept.begin(), kept.end(), '\n'), 1);
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  PerceptionExperiment experiment(settings, 4);
  EXPECT_THAT(TrialLog::open(path, settings, 4, experiment).error().message(), HasSubstr("trials.jsonl: not a file"));
}

TEST(ScriptedAnswers, AreNotKeptWhereALineIsWrong) {
  const std::filesystem::path path = test::fresh_folder("script");
  PerceptionSettings settings = *read_perception({});
  const auto error = [&](const std::string& answers) {
    std::ofstream(path / "answers.txt") << answers;
    const auto rows = run_scripted_answers(settings, path / "answers.txt", *StudyFolder::open(path / "out"), go_on);
    return rows ? std::string("none") : rows.error().message();
  };
  std::string many;
  for (int k = 0; k < 61; ++k) many += "A\n";
  EXPECT_THAT(error(many), HasSubstr("answers.txt:61: the experiment has 60 trials (no more answers)"));
  const std::string kept = test::slurp(path / "out" / TrialLog::kName);
  EXPECT_EQ(std::count(kept.begin(), kept.end(), '\n'), 1) << "what experiment it is, and no answer";
  EXPECT_THAT(error("# none\n"), HasSubstr("answers.txt: there is no answer in it (A or B, a line each)"));
  settings.scene = path / "nowhere.toml";
  EXPECT_THAT(error("A\n"), HasSubstr("nowhere.toml: there is no such file"));
}

TEST(ScriptedAnswers, AreSavedAnalysedAndGoneOnWith) {
  const std::filesystem::path path = test::fresh_folder("script");
  AnglePerceptionOptions options;
  options.seed = 9;
  std::string text = "# answers\n";
  for (const AnsweredTrial& one : [&] {
         PerceptionExperiment experiment(*options.settings(), 9);
         while (const Trial* trial = experiment.current())
           experiment.answer(trial->difference > 10.0 ? trial->same : other(trial->same));
         return experiment.answered();
       }())
    text += std::string(1, letter_of(one.answer)) + "\n";
  const auto run = [&](const std::string& answers) {
    std::ofstream(path / "answers.txt") << answers;
    return run_scripted_answers(*options.settings(), path / "answers.txt", *StudyFolder::open(path / "out"), go_on);
  };
  ASSERT_TRUE(run(text.substr(0, 10 + 2 * 23)));
  const Expected<ordered_json> rows = run(text);
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 10U);
  int trials = 0;
  for (const ordered_json& row : *rows)
    if (row["source"] == "answers") trials += row["trials"].get<int>();
  EXPECT_EQ(trials, 60);
  EXPECT_TRUE((*rows)[1]["told"]) << "from 15 degrees on all are right";
  EXPECT_THAT(run(text + "A\n").error().message(), HasSubstr("answers.txt:62: the experiment has 60 trials"));
  EXPECT_THAT(run("C\n").error().message(), HasSubstr("answers.txt:1: 'C' is no answer (A or B)"));
  const std::string turned = text[10] == 'A' ? "B\n" : "A\n";
  EXPECT_THAT(run(turned).error().message(), HasSubstr("answers.txt:1: trial 1 was answered"));
}

TEST(AnglePerception, SetsTheThesisBesideSimulatedObservers) {
  const std::filesystem::path path = test::fresh_folder("angle");
  const StudyFolder folder = *StudyFolder::open(path);
  AnglePerceptionOptions options;
  options.observers = 4;
  options.thresholds = {15.0};
  const Expected<ordered_json> rows = run_angle_perception(options, folder, go_on);
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 5U);
  double trials = 0.0;
  for (const ordered_json& row : *rows) trials += row["expected_trials"].get<double>();
  EXPECT_NEAR(trials, 420.0, 1e-9);
  for (const char* name : {"angle-perception.csv", "angle-perception-rules.json", "angle-perception-fit.json",
                           "angle-perception-feel.json", "angle-perception-feel.svg", "angle-perception-rules.svg"})
    EXPECT_TRUE(std::filesystem::exists(path / name)) << name;
  bool found = false;
  for (const ordered_json& row : folder.contents().published) {
    if (row["id"] != "angle-perception.threshold") continue;
    found = true;
    EXPECT_EQ(row["ours"], 15.0);
  }
  EXPECT_TRUE(found);
  options.thresholds = {120.0};
  EXPECT_THAT(run_angle_perception(options, folder, go_on).error().message(), HasSubstr("1 to 89"));
}

}  // namespace
}  // namespace rhexis::studies
