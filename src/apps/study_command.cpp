// rhexis study NAME [--out DIR]: one experiment of the two papers, into tables, figures and a report.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/beside_program.h"
#include "apps/command.h"
#include "apps/interrupt.h"
#include "apps/progress.h"
#include "apps/studies.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "studies/report.h"
#include "studies/reproduction.h"

namespace rhexis::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Columns as wide as what stands in them: numbers to the right, words to the left.
void print_rows(const ordered_json& rows, const std::vector<std::string>& columns) {
  std::vector<std::size_t> width;
  for (const std::string& column : columns) {
    width.push_back(column.size());
    for (const ordered_json& row : rows)
      width.back() = std::max(width.back(), studies::cell_text(row.at(column)).size());
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
  for (const ordered_json& row : rows)
    print_line([&](const std::string& column) { return studies::cell_text(row.at(column)); });
}

/// As `make viewer` lays it beside the program.
fs::path report_viewer() { return share_folder() / "report" / "report.js"; }

struct Finished {
  int code = kDone;
  studies::StudyRun run;
  ordered_json rows = {};
};

/// Runs one study into `out`. Errors are reported; `fraction` of the progress is told under the study's name.
Finished run(const Study& study, const StudyFunction& function, const fs::path& out, std::string command,
             const Common& common) {
  Finished finished{.run = {.study = std::string(study.name),
                            .title = std::string(study.title),
                            .command = std::move(command),
                            .threads = thread_count()}};
  const Expected<studies::StudyFolder> folder = studies::StudyFolder::open(out);
  if (!folder) {
    finished.code = report(folder.error());
    return finished;
  }
  bool begun = false;
  const Stopwatch watch;
  Expected<ordered_json> rows;
  {
    const Interrupt interrupt;
    Progress progress(!common.quiet);
    rows = function(*folder, [&](double fraction, std::string_view what) {
      begun = true;
      progress.update(fraction, fmt::format("{}: {}", study.name, what));
      finished.run.stopped = interrupt.asked();
      return !finished.run.stopped;
    });
  }
  finished.run.seconds = watch.seconds();
  if (!rows) {
    report(rows.error());
    finished.code = begun ? kFailedComputation : kBadInput;
    return finished;
  }
  finished.rows = std::move(*rows);
  if (const Expected<void> done = studies::write_report(*folder, finished.run, report_viewer()); !done) {
    report(done.error());
    finished.code = kFailedComputation;
    return finished;
  }
  if (!finished.run.stopped) return finished;
  fmt::print(stderr, "rhexis: study {}: stopped, the tables hold what was measured until then\n", study.name);
  finished.code = kFailedComputation;
  return finished;
}

void add_one(CLI::App& parent, const Study& study, const Common& common, int& code) {
  CLI::App* command = parent.add_subcommand(std::string(study.name), std::string(study.title));
  command->footer(
      fmt::format("Example: rhexis study {}{}{}", study.name, study.example.empty() ? "" : " ", study.example));
  auto out = std::make_shared<std::string>(fmt::format("out/{}", study.name));
  command->add_option("--out", *out, fmt::format("folder for tables, figures and report; {} unless given", *out));
  const StudyFunction function = study.with_options(*command);
  command->callback([&study, function, out, &common, &code] {
    const Finished finished = run(study, function, *out, command_line(), common);
    code = finished.code;
    if (finished.rows.empty()) return;
    if (common.json) print_json(finished.rows);
    if (!common.json && !common.quiet) print_rows(finished.rows, study.shown);
    say(common, "results  {}\nreport   {}\n", *out, (fs::path(*out) / "report.html").string());
  });
}

/// All of them at their default size, one after the other, each as `rhexis study NAME` runs it.
int run_all(const fs::path& out, const Common& common) {
  int worst = kDone;
  std::vector<studies::StudyRun> runs;
  ordered_json summary = ordered_json::array();
  for (const Study& study : all_studies()) {
    CLI::App defaults;
    const fs::path folder = out / study.name;
    const Finished finished = run(study, study.with_options(defaults), folder,
                                  fmt::format("rhexis study {} --out {}", study.name, folder.string()), common);
    worst = std::max(worst, finished.code);
    if (!finished.rows.empty()) runs.push_back(finished.run);
    summary.push_back({{"study", study.name}, {"seconds", finished.run.seconds}, {"code", finished.code}});
    say(common, "{:<18} {:8.1f} s  {}\n", study.name, finished.run.seconds,
        finished.code == kDone ? (folder / "report.html").string() : "not finished");
    if (const Expected<void> done = studies::write_report_index(out, runs); !done) return report(done.error());
    if (finished.run.stopped) break;
  }
  if (common.json) print_json(summary);
  say(common, "index    {}\n", (out / "index.html").string());
  return worst;
}

void add_all(CLI::App& parent, const Common& common, int& code) {
  CLI::App* command = parent.add_subcommand("all", "All studies at their default size, with an index of the reports");
  command->footer("Example: rhexis study all --out out/studies");
  auto out = std::make_shared<std::string>("out/studies");
  command->add_option("--out", *out, "folder for a folder a study; out/studies unless given");
  command->callback([out, &common, &code] { code = run_all(*out, common); });
}

/// The page of docs/reproduction.md, on stdout.
void add_reproduction(CLI::App& parent, int& code) {
  CLI::App* command =
      parent.add_subcommand("reproduction", "Print every published number beside ours, from what studies wrote");
  command->footer("Example: rhexis study reproduction out/studies > reproduction.md");
  auto folder = std::make_shared<std::string>("out/studies");
  command->add_option("folder", *folder, "of NAME/study.json or NAME.json; out/studies unless given");
  command->callback([folder, &code] {
    const Expected<std::string> page = studies::reproduction_markdown(*folder);
    if (!page) {
      code = report(page.error());
      return;
    }
    fmt::print("{}", *page);
  });
}

}  // namespace

void add_study(CLI::App& app, const Common& common, int& code) {
  CLI::App* parent = app.add_subcommand("study", "The experiments of the papers, into tables, figures and reports");
  parent->footer("Example: rhexis study identification --out out/identification");
  parent->require_subcommand(1);
  for (const Study& study : all_studies()) add_one(*parent, study, common, code);
  add_all(*parent, common, code);
  add_reproduction(*parent, code);
}

}  // namespace rhexis::apps
