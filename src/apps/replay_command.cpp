// rhexis replay RECORDING [--check]: a recorded interaction in the page, or its bits computed again.

#include <memory>
#include <string>

#include "apps/live_view.h"
#include "apps/progress.h"
#include "session/replay_check.h"
#include "session/replay_source.h"

namespace rhexis::apps {
namespace {

int check(const std::string& recording, const Common& common) {
  Expected<session::CheckReport> checked;
  {
    Progress progress(!common.quiet);
    checked = session::check_recording(recording, [&](double part) { progress.update(part, "computing again"); });
  }
  if (!checked) return report(checked.error());
  if (!checked->difference.empty()) {
    fmt::print(stderr, "rhexis: {}: {}\n", recording, checked->difference);
    return kFailedComputation;
  }
  say(common, "the same bits: {} haptic ticks, {} steps, {} advances\n", checked->ticks, checked->steps,
      checked->advances);
  return kDone;
}

int replay(const std::string& recording, const LiveViewOptions& view, const Common& common) {
  Relay relay;
  Expected<std::unique_ptr<session::ReplaySource>> source = session::ReplaySource::open(recording, relay);
  if (!source) return report(source.error());
  return serve(
      view, common, **source, relay,
      [&] {
        (*source)->start();
        return Expected<void>{};
      },
      [&] { (*source)->stop(); });
}

}  // namespace

void add_replay(CLI::App& app, const Common& common, int& code) {
  CLI::App* command = app.add_subcommand("replay", "Play a recorded interaction in the page, or check its bits");
  command->footer("Example: rhexis replay out/recordings/plate-tear.h5 --check");
  auto recording = std::make_shared<std::string>();
  auto checks = std::make_shared<bool>(false);
  command->add_option("recording", *recording, "file that play has recorded (docs/recording.md)")->required();
  command->add_flag("--check", *checks, "compute it again, and fail on the first bit that differs");
  const auto view = add_live_view_options(*command);
  command->callback(
      [=, &common, &code] { code = *checks ? check(*recording, common) : replay(*recording, *view, common); });
}

}  // namespace rhexis::apps
