// rhexis precompute SCENE --out FILE.h5 [--memory MB] [--set key=value ...]: the record of a body that tears.

#include <unistd.h>

#include "apps/interrupt.h"
#include "apps/progress.h"
#include "apps/scene_options.h"
#include "base/clock.h"
#include "record/build/campaign.h"
#include "record/store/record_writer.h"
#include "scene/tear_problem.h"
#include "session/scene_record.h"

namespace rhexis::apps {
namespace {

using nlohmann::ordered_json;
using record::build::Campaign;
using record::build::CampaignReport;
using record::build::Ending;

struct PrecomputeOptions {
  std::shared_ptr<SceneOptions> scene;
  double memory = 0.0;  ///< MB; 0: as many advances as the scene says
};

/// Seconds between two lines of progress where no terminal shows a bar.
constexpr double kQuietSeconds = 1.0;

Expected<Campaign> plan(const scene::TearProblem& problem, const PrecomputeOptions& options) {
  const scene::CrackSettings& crack = problem.cracks.front();
  Expected<Campaign> campaign =
      Campaign::plan(session::record_request(problem, std::string("rhexis ") + RHEXIS_VERSION));
  if (!campaign) return fail(campaign.error().at(crack.place.file ? *crack.place.file : "", crack.place.line));
  if (options.memory > 0.0) {
    if (Expected<void> chosen = campaign->choose_advances(1e6 * options.memory); !chosen)
      return fail(chosen.error().at("--memory"));
  }
  return campaign;
}

/// Bytes of each way to keep what the thesis keeps as dense inverses, for all topologies.
ordered_json sizes_of(const record::store::RecordHead& head, double topologies) {
  const double rows = head.pattern.rows();
  const double surface = 3.0 * static_cast<double>(head.points.size());
  const double entries = static_cast<double>(head.pattern.entries());
  return {{"dense_inverse_double", 8.0 * rows * rows * topologies},
          {"dense_inverse_single", 4.0 * rows * rows * topologies},
          {"surface_block_double", 8.0 * surface * surface * topologies},
          {"factor_double", 8.0 * entries * topologies},
          {"factor_single", 4.0 * entries * topologies},
          {"reactions",
           8.0 * (6.0 * static_cast<double>(head.points.size()) + 9.0 * static_cast<double>(head.edges.size())) *
               topologies}};
}

ordered_json make_summary(const Campaign& campaign, const CampaignReport& done, const std::string& out,
                          double seconds) {
  const record::store::RecordHead& head = campaign.head();
  const char* const ending = done.ending == Ending::complete          ? "complete"
                             : done.ending == Ending::was_there       ? "was there"
                             : done.ending == Ending::left_to_another ? "left to another process"
                                                                      : "stopped";
  return {{"record", out},
          {"ending", ending},
          {"fingerprint", fmt::format("{:016x}", head.fingerprint)},
          {"advances", head.parameters.advances},
          {"topologies", campaign.topologies()},
          {"resumed", done.resumed},
          {"computed", done.computed},
          {"grasp_points", head.points.size()},
          {"edges", head.edges.size()},
          {"unknowns", head.pattern.rows()},
          {"factor_entries", head.pattern.entries()},
          {"bytes", done.file_bytes},
          {"bytes_of", sizes_of(head, campaign.topologies())},
          {"seconds", seconds}};
}

void print_outcome(const ordered_json& summary) {
  if (summary["ending"] == "was there") fmt::print("record          is there already, of this scene\n");
  if (summary["ending"] == "left to another process") fmt::print("record          another process puts it together\n");
  if (summary["ending"] != "was there")
    fmt::print("topologies      {}: {} computed, {} from before\ntime            {:.2f} s\n",
               summary["topologies"].get<int>(), summary["computed"].get<int>(), summary["resumed"].get<int>(),
               summary["seconds"].get<double>());
  if (summary["bytes"] > 0)
    fmt::print("file            {}, {:.1f} MB\n", summary["record"].get<std::string>(),
               1e-6 * summary["bytes"].get<double>());
}

Expected<CampaignReport> run(const Campaign& campaign, const std::string& out, bool quiet) {
  const record::build::Rank rank = record::build::rank_of_this_process();
  const Interrupt interrupt;
  Progress progress(!quiet && rank.rank == 0);
  const Stopwatch watch;
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  double shown = 0.0;
  int first = -1;
  return campaign.run(out, rank, [&](int there, int all) {
    if (first < 0) {
      first = there - 1;
      if (first > 0 && rank.rank == 0) spdlog::info("{} of {} topologies are there from before", first, all);
    }
    const double seconds = watch.seconds();
    if (terminal || seconds - shown >= kQuietSeconds || there == all) {
      const double part = static_cast<double>(there - first) / (all - first);
      progress.update(part, fmt::format("{} of {} topologies{}", there, all,
                                        terminal ? "" : fmt::format(", {:.0f} s left", seconds * (1.0 - part) / part)));
      shown = seconds;
    }
    return !interrupt.asked();
  });
}

int precompute(const PrecomputeOptions& options, const Common& common) {
  const Stopwatch watch;
  const Expected<scene::Scene> scene = read_scene(*options.scene);
  if (!scene) return report(scene.error());
  const Expected<scene::TearProblem> problem = scene::build_tear_problem(*scene, scene::Puller::record);
  if (!problem) return report(problem.error());
  log_remarks(problem->notes, problem->warnings);
  const Expected<Campaign> campaign = plan(*problem, options);
  if (!campaign) return report(campaign.error());
  const record::store::RecordHead& head = campaign->head();
  say(common,
      "{}\nbody            {} nodes, {} tets; {} grasp points, {} edges between them\nrecord          {} advances, {} "
      "directions, {} lengths: {} topologies, about {:.1f} MB\n",
      problem->title, problem->mesh.node_count(), problem->mesh.tet_count(), head.points.size(), head.edges.size(),
      head.parameters.advances, head.parameters.directions, head.parameters.lengths.size(), campaign->topologies(),
      1e-6 * record::store::bytes_of_record(head, campaign->topologies()));
  const std::string& out = options.scene->out;
  const Expected<CampaignReport> done = run(*campaign, out, common.quiet);
  if (!done) return report(done.error());
  const ordered_json summary = make_summary(*campaign, *done, out, watch.seconds());
  if (common.json) print_json(summary);
  if (!common.json && !common.quiet) print_outcome(summary);
  if (done->ending != Ending::stopped) return kDone;
  fmt::print(stderr, "rhexis: {}: stopped; the same command goes on where it stood\n", options.scene->scene);
  return kFailedComputation;
}

}  // namespace

void add_precompute(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("precompute", "Record the body's responses to cracks that may come");
  command->footer("Example: rhexis precompute scenes/plate-tear.toml --out out/plate.h5 --memory 500");
  auto options = std::make_shared<PrecomputeOptions>();
  options->scene = add_scene_options(*command);
  command->add_option("--out", options->scene->out, "the record; a run that was killed is taken up from FILE.h5.parts")
      ->type_name("FILE.h5")
      ->required();
  command->add_option("--memory", options->memory, "as many advances as fit into so much, whatever the scene says")
      ->type_name("MB")
      ->check(CLI::Range(1e-3, 1e9));
  command->callback([options, &common, &code] { code = precompute(*options, common); });
}

}  // namespace rhexis::apps
