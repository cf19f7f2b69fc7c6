// rhexis tear SCENE [--out DIR] [--set key=value ...]: the scene's scripted pulls, without a screen.

#include <filesystem>

#include "apps/interrupt.h"
#include "apps/progress.h"
#include "apps/scene_options.h"
#include "apps/tear_output.h"
#include "base/clock.h"
#include "scene/tear_problem.h"
#include "session/scene_record.h"
#include "session/script.h"
#include "session/start.h"
#include "session/tear_session.h"

namespace rhexis::apps {
namespace {

using session::TearSession;

/// Of a body that moves by itself a state is written so often.
constexpr int kTicksPerState = 20;

/// The scripted hand, tick by tick. Ends early on trouble, on an error of the output, or when asked to.
class Script {
 public:
  Script(const scene::TearProblem& problem, TearSession& tear, TearOutput& output)
      : problem_(problem), tear_(tear), output_(output), ticks_(ticks_of(session::script_seconds(problem.pulls))) {}

  /// Empty when the script came to its end; else why it did not.
  Expected<std::string> run(Progress& progress, const Interrupt& interrupt) {
    if (Expected<void> done = output_.write_topology(tear_, 0.0); !done) return fail(std::move(done.error()));
    for (const scene::PullSettings& pull : problem_.pulls) {
      const auto mode = pull.push ? response::ContactMode::push : response::ContactMode::hold;
      if (const Expected<void> holds = tear_.grasp(pull.at, mode); !holds)
        return fmt::format("the pull of {}: {}", pull.place.describe(), holds.error().message());
      say_what_the_record_lacks();
      const int moving = ticks_of(pull.seconds);
      const int all = moving + ticks_of(pull.hold);
      for (int k = 1; k <= all; ++k) {
        const Vec3 hand = pull.by * (static_cast<double>(std::min(k, moving)) / moving);
        Expected<std::string> trouble = tick(hand, progress);
        if (!trouble || !trouble->empty()) return trouble;
        if (interrupt.asked()) return stopped();
      }
      // After a last pull without a wait the result is written as it stands, and then the hand lets go.
      if (&pull == &problem_.pulls.back() && pull.wait == 0.0) break;
      tear_.let_go();
      Expected<std::string> trouble = wait(ticks_of(pull.wait), progress, interrupt);
      if (!trouble || !trouble->empty()) return trouble;
    }
    return std::string();
  }

 private:
  /// A tick is 1 ms.
  static int ticks_of(double seconds) { return static_cast<int>(std::lround(1000.0 * seconds)); }

  [[nodiscard]] std::string stopped() const { return fmt::format("stopped at {:.3f} s", 1e-3 * tick_); }

  /// The body alone. What has a mass is on its way, and shown on it.
  Expected<std::string> wait(int ticks, Progress& progress, const Interrupt& interrupt) {
    const bool moves = tear_.settings().dynamics.has_value();
    for (int k = 1; k <= ticks; ++k) {
      Expected<std::string> trouble = tick(Vec3::Zero(), progress);
      if (!trouble || !trouble->empty()) return trouble;
      if (moves && k % kTicksPerState == 0) {
        progress.update(static_cast<double>(tick_) / ticks_, fmt::format("{:.3f} s: let go", 1e-3 * tick_));
        if (Expected<void> done = output_.write_released(tear_, tick_ / 1000.0); !done)
          return fail(std::move(done.error()));
      }
      if (interrupt.asked()) return stopped();
    }
    return std::string();
  }

  Expected<std::string> tick(const Vec3& hand, Progress& progress) {
    const double time = 1e-3 * ++tick_;
    Expected<void> written;
    tear_.pass(1e-3);
    const session::TickReport report = tear_.tick(hand, [&](const session::AdvanceRecord& advance) {
      if (written) written = output_.write_topology(tear_, time);
      output_.note_force(advance.force_before);
      say_what_the_record_lacks();
      progress.update(static_cast<double>(tick_) / ticks_,
                      fmt::format("{:.3f} s: advance {}, {:.1f} mm, {} pieces", time, tear_.advances().size(),
                                  1e3 * advance.length, advance.pieces));
    });
    if (report.let_go)
      spdlog::warn("{:.3f} s: the hand has let go: what it held has come off, or lost its support", time);
    if (!report.late.empty() && report.late != late_) spdlog::warn("{:.3f} s: {}", time, report.late);
    if (!report.late.empty()) late_ = report.late;
    if (written) written = output_.write_tick(tear_, time, hand, report);
    if (!written) return fail(std::move(written.error()));
    return report.trouble;
  }

  /// Each thing once.
  void say_what_the_record_lacks() {
    const std::optional<response::RecordUse> use = tear_.record_use();
    if (!use) return;
    for (const std::string& remark : session::remarks_on(*use, said_))
      spdlog::warn("{:.3f} s: {}", 1e-3 * tick_, remark);
    said_.add(*use);
  }

  const scene::TearProblem& problem_;
  TearSession& tear_;
  TearOutput& output_;
  int ticks_;
  int tick_ = 0;
  std::string late_;  ///< said already
  response::RecordUse said_;
};

int tear(const SceneOptions& options, const Common& common) {
  const Stopwatch watch;
  const Expected<scene::Scene> scene = read_scene(options);
  if (!scene) return report(scene.error());
  const Expected<scene::TearProblem> built = scene::build_tear_problem(*scene);
  if (!built) return report(built.error());
  const scene::TearProblem& problem = *built;
  log_remarks(problem.notes, problem.warnings);
  const double read_seconds = watch.seconds();
  Expected<session::TearStart> start = session::start_tear(problem);
  if (!start) return report(start.error());
  log_remarks({}, start->warnings);
  TearSession& tear = *start->tear;
  const double build_seconds = watch.seconds() - read_seconds;
  Expected<TearOutput> output = TearOutput::open(options.folder());
  if (!output) return report(output.error());
  say(common, "{}\nbody            {} nodes, {} tets; model {}\ntears by        {}, {}\n", problem.title,
      problem.mesh.node_count(), problem.mesh.tet_count(), tear.model_name(), tear.settings().criterion,
      problem.fracture.incision);

  Expected<std::string> why;
  {
    const Interrupt interrupt;
    Progress progress(!common.quiet);
    why = Script(problem, tear, *output).run(progress, interrupt);
  }
  Expected<void> written;
  if (!why) written = fail(std::move(why.error()));
  if (written) written = output->write_result(tear, problem.title);
  nlohmann::ordered_json summary;
  if (written) {
    summary = make_tear_summary(problem, start->warnings, options.scene, tear, *output, *why,
                                {.read = read_seconds, .build = build_seconds, .total = watch.seconds()});
    written = output->write_summary(summary);
  }
  if (!written) {
    report(written.error());
    return kFailedComputation;  // the input was good: the disk filled up, or the folder went away
  }
  if (common.json) print_json(summary);
  if (!common.json && !common.quiet) print_tear_outcome(summary, output->path());
  if (why->empty()) return kDone;
  fmt::print(stderr, "rhexis: {}: {}\n", options.scene, *why);
  return kFailedComputation;
}

}  // namespace

void add_tear(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("tear", "Run the scene's scripted pulls: hold, pull, tear");
  command->footer("Example: rhexis tear scenes/plate-tear.toml --out out/plate --set fracture.criterion=maximum-hoop");
  const auto options = add_scene_options(*command);
  add_out_option(*command, *options);
  command->callback([options, &common, &code] { code = tear(*options, common); });
}

}  // namespace rhexis::apps
