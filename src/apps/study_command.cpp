// rhexis study NAME [--out DIR]: one experiment of the two papers, into tables and figures.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "apps/command.h"
#include "apps/interrupt.h"
#include "apps/progress.h"
#include "studies/live_study.h"
#include "studies/reaction_error.h"
#include "studies/restructuring.h"
#include "studies/stability_map.h"

namespace rhexis::apps {
namespace {

using nlohmann::ordered_json;

/// A study is a function from its options to its rows, of which each column of `shown` is for people.
struct StudyRun {
  std::string name;
  std::string out;
  std::vector<std::string> shown;
  std::function<Expected<ordered_json>(const studies::StudyFolder&, const studies::Progress&)> run;
};

std::string cell_text(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float() && std::isfinite(value.get<double>())) return fmt::format("{:.4g}", value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return value.is_number_integer() ? value.dump() : "-";
}

/// Columns as wide as what stands in them: numbers to the right, words to the left.
void print_rows(const ordered_json& rows, const std::vector<std::string>& columns) {
  std::vector<std::size_t> width;
  for (const std::string& column : columns) {
    width.push_back(column.size());
    for (const ordered_json& row : rows) width.back() = std::max(width.back(), cell_text(row.at(column)).size());
  }
  const auto print_line = [&](auto&& cell) {
    std::string line;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const bool words = rows.front().at(columns[k]).is_string();
      line += words ? fmt::format("{:<{}}  ", cell(columns[k]), width[k])
                    : fmt::format("{:>{}}  ", cell(columns[k]), width[k]);
    }
    fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
  };
  print_line([](const std::string& column) { return column; });
  for (const ordered_json& row : rows) print_line([&](const std::string& column) { return cell_text(row.at(column)); });
}

int run(const StudyRun& study, const Common& common) {
  const std::filesystem::path out =
      study.out.empty() ? std::filesystem::path("out") / study.name : std::filesystem::path(study.out);
  const Expected<studies::StudyFolder> folder = studies::StudyFolder::open(out);
  if (!folder) return report(folder.error());
  bool begun = false;
  bool stopped = false;
  Expected<ordered_json> rows;
  {
    const Interrupt interrupt;
    Progress progress(!common.quiet);
    rows = study.run(*folder, [&](double fraction, std::string_view what) {
      begun = true;
      progress.update(fraction, std::string(what));
      stopped = interrupt.asked();
      return !stopped;
    });
  }
  if (!rows) {
    report(rows.error());
    return begun ? kFailedComputation : kBadInput;
  }
  if (common.json) print_json(*rows);
  if (!common.json && !common.quiet) print_rows(*rows, study.shown);
  say(common, "results  {}\n", out.string());
  if (!stopped) return kDone;
  fmt::print(stderr, "rhexis: study {}: stopped by Ctrl-C, the tables hold what was measured until then\n", study.name);
  return kFailedComputation;
}

void add_restructuring(CLI::App& study, const Common& common, int& code) {
  CLI::App* command = study.add_subcommand("restructuring", "What an advance of a crack costs, by five ways");
  command->footer("Example: rhexis study restructuring --nodes 506 1270 5000 --mode slow-pull");
  auto one = std::make_shared<StudyRun>();
  one->name = "restructuring";
  one->shown = {"nodes",     "mode",    "way",        "advances",        "ms_per_advance",
                "ms_median", "ms_most", "ms_per_tet", "sparse_over_this"};
  auto options = std::make_shared<studies::RestructuringOptions>();
  command->add_option("--out", one->out, "folder for the tables and figures; out/restructuring unless given");
  command->add_option("--nodes", options->nodes, "of the plates")->type_name("COUNT")->expected(-1);
  command->add_option("--mode", options->modes, fmt::format("{}", fmt::join(studies::kTearModes, ", ")))
      ->type_name("MODE")
      ->expected(-1);
  command->add_option("--way", options->ways, fmt::format("{}", fmt::join(studies::kWays, ", ")))
      ->type_name("WAY")
      ->expected(-1);
  command->add_option("--seconds", options->seconds_per_case, "a plate is torn anew from its start for about so long")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 3600.0));
  one->run = [options](const studies::StudyFolder& folder, const studies::Progress& progress) {
    return studies::run_restructuring(*options, folder, progress);
  };
  command->callback([one, &common, &code] { code = run(*one, common); });
}

void add_reaction_error(CLI::App& study, const Common& common, int& code) {
  CLI::App* command = study.add_subcommand("reaction-error", "How far recorded forces are from the exact ones");
  command->footer("Example: rhexis study reaction-error --advances 1 --step 5");
  auto one = std::make_shared<StudyRun>();
  one->name = "reaction-error";
  one->shown = {"advances",  "way",           "patterns",      "better",      "better_untied",   "mean",
                "deviation", "mean_relative", "thesis_better", "thesis_mean", "thesis_deviation"};
  auto options = std::make_shared<studies::ReactionErrorOptions>();
  command->add_option("--out", one->out, "folder for the tables and figures; out/reaction-error unless given");
  command->add_option("--nodes", options->nodes, "of the plate")->type_name("COUNT");
  command->add_option("--advances", options->advances, "1: Table 5.9 of the thesis, 2: Table 5.10")
      ->type_name("COUNT")
      ->expected(-1);
  command->add_option("--spacing", options->spacing, "between recorded cracks")->type_name("DEGREES");
  command->add_option("--spacings", options->spacings, "that are compared, at one advance")
      ->type_name("DEGREES")
      ->expected(-1);
  command->add_option("--step", options->step, "between the cracks that are asked for")->type_name("DEGREES");
  one->run = [options](const studies::StudyFolder& folder, const studies::Progress& progress) {
    return studies::run_reaction_error(*options, folder, progress);
  };
  command->callback([one, &common, &code] { code = run(*one, common); });
}

void add_haptic_stability(CLI::App& study, const Common& common, int& code) {
  CLI::App* command = study.add_subcommand("haptic-stability", "Which couplings an emulated haptic device bears");
  command->footer("Example: rhexis study haptic-stability --delay 0 1 2 --stiffness 500 1000 2000");
  auto one = std::make_shared<StudyRun>();
  one->name = "haptic-stability";
  one->shown = {"stiffness",     "delay_ms",   "over_bound",    "rests_free",
                "shake_mm_free", "rests_kept", "shake_mm_kept", "gain"};
  auto options = std::make_shared<studies::StabilityOptions>();
  command->add_option("--out", one->out, "folder for the table and figure; out/haptic-stability unless given");
  command->add_option("--stiffness", options->stiffness, "N/m, of the coupling")->type_name("N/M")->expected(-1);
  command->add_option("--damping", options->damping, "N s/m, of the coupling")->type_name("NS/M");
  command->add_option("--delay", options->delay, "ms, whole ones, of the force")->type_name("MS")->expected(-1);
  command->add_option("--resolution", options->device.resolution, "m, of the position; 0: exact")->type_name("M");
  command->add_option("--mass", options->device.mass, "kg, of device and finger")->type_name("KG");
  command->add_option("--hand-damping", options->device.hand_damping, "N s/m, of the hand")->type_name("NS/M");
  command->add_option("--seconds", options->seconds, "of each run")
      ->type_name("SECONDS")
      ->check(CLI::Range(1.2, 600.0));
  one->run = [options](const studies::StudyFolder& folder, const studies::Progress& progress) {
    return studies::run_stability_map(*options, folder, progress);
  };
  command->callback([one, &common, &code] { code = run(*one, common); });
}

void add_live(CLI::App& study, const Common& common, int& code) {
  CLI::App* command =
      study.add_subcommand("live", "How punctual a live session is: haptic loop, laws, pictures of its clients");
  command->footer("Example: rhexis study live --seconds 60 --nodes 5000");
  auto one = std::make_shared<StudyRun>();
  one->name = "live";
  one->shown = {"measure", "value", "unit", "note"};
  auto options = std::make_shared<studies::LiveOptions>();
  command->add_option("--out", one->out, "folder for the tables and figures; out/live unless given");
  command->add_option("--seconds", options->seconds, "to run; 600 unless given")
      ->type_name("SECONDS")
      ->check(CLI::Range(1.0, 86400.0));
  command->add_option("--nodes", options->nodes, "of the plate; 20000 unless given")
      ->type_name("COUNT")
      ->check(CLI::Range(100, 1'000'000));
  command->add_option("--clients", options->clients, "that watch; 3 unless given")
      ->type_name("COUNT")
      ->check(CLI::Range(1, 16));
  command->add_option("--device", options->device, "script or emulator; emulator unless given")->type_name("NAME");
  command->add_option("--priority", options->priority, "of the haptic loop under SCHED_FIFO; 80 unless given, 0: none")
      ->type_name("PRIORITY")
      ->check(CLI::Range(0, 99));
  one->run = [options](const studies::StudyFolder& folder, const studies::Progress& progress) {
    return studies::run_live_study(*options, folder, progress);
  };
  command->callback([one, &common, &code] { code = run(*one, common); });
}

}  // namespace

void add_study(CLI::App& app, const Common& common, int& code) {
  CLI::App* study = app.add_subcommand("study", "The experiments of the papers, into tables and figures");
  study->footer("Example: rhexis study restructuring --out out/restructuring");
  study->require_subcommand(1);
  for (const auto add : {add_restructuring, add_reaction_error, add_haptic_stability, add_live})
    add(*study, common, code);
}

}  // namespace rhexis::apps
