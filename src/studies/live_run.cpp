#include "studies/live_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "haptics/device_list.h"
#include "server/server.h"
#include "session/live_session.h"
#include "studies/study_plate.h"

namespace rhexis::studies {
namespace {

using std::chrono::milliseconds;

/// Beside the plate of study_plate.h: what lets it tear.
constexpr std::string_view kTearing = R"([fracture]
criterion = "maximum-principal"
strength = 0.4e6
advance_threshold = 0.2e6
[[pull]]
at = [0.10, 0.0, 0.005]
by = [-0.12, 0.0, 0.0]
seconds = 6.0
)";

/// A device of 8.9 N, a plate of 34.
constexpr double kForceScale = 0.2;

constexpr milliseconds kLook{10};
/// Between the letting go and the reset.
constexpr milliseconds kRest{200};
constexpr milliseconds kPatience{10'000};

template <class PayloadT>
wire::SharedMessage command(PayloadT payload) {
  return wire::encode(std::move(payload));
}

/// Tears, by what a page may ask: when the script has come to its end, or the body to pieces, from the start again.
class Director {
 public:
  explicit Director(WatchingClient& hand) : hand_(hand) {}
  void look() {
    const Glance now = hand_.glance();
    const auto time = std::chrono::steady_clock::now();
    if (phase_ == Phase::waits && now.bodies > bodies_ && now.scripted) {
      phase_ = Phase::tears;
      ++pulls_;
    } else if (phase_ == Phase::tears && now.states > 0 && (!now.scripted || now.pieces > 1)) {
      hand_.say(command(wire::ScriptT{}));
      phase_ = Phase::rests;
      until_ = time + kRest;
    } else if (phase_ == Phase::rests && time >= until_) {
      bodies_ = now.bodies;
      hand_.say(command(wire::ResetT{}));
      phase_ = Phase::waits;
    }
  }
  [[nodiscard]] int pulls() const { return pulls_; }

 private:
  enum class Phase { waits, tears, rests };
  WatchingClient& hand_;
  Phase phase_ = Phase::waits;
  std::size_t bodies_ = 0;
  std::chrono::steady_clock::time_point until_{};
  int pulls_ = 0;
};

struct Show {
  PhysicsLog log;
  ProbedDevice* probe = nullptr;  ///< the session's
  std::unique_ptr<session::LiveSession> session;
  std::unique_ptr<server::Server> server;
  std::vector<std::unique_ptr<WatchingClient>> clients;
};

Expected<void> open_session(const LiveOptions& options, const std::filesystem::path& folder, Show& show) {
  session::LiveSettings settings;
  settings.scene = (folder / "live-plate.toml").string();
  settings.version = "study live";
  settings.priority = options.priority;
  settings.force_scale = kForceScale;
  const auto ticks = static_cast<std::size_t>(1e3 * (options.seconds + 60.0));
  settings.device = [&](std::shared_ptr<haptics::HandPath> script) -> Expected<std::unique_ptr<haptics::Device>> {
    Expected<std::unique_ptr<haptics::Device>> device = haptics::make_device(
        options.device, {.hand = std::move(script), .emulator = haptics::EmulatorSettings::firmly_held()});
    if (!device) return device;
    if (!(*device)->traits().follows_script)
      return fail(fmt::format("device '{}' does not tear by itself", options.device), "one that follows the script");
    auto probed = std::make_unique<ProbedDevice>(std::move(*device), ticks);
    show.probe = probed.get();
    return probed;
  };
  if (Expected<void> done = write_atomically(
          settings.scene, plate_scene("The plate of the study `live`", options.nodes).append(kTearing));
      !done)
    return done;
  Expected<std::unique_ptr<session::LiveSession>> opened = session::LiveSession::open(std::move(settings), show.log);
  if (!opened) return fail(std::move(opened.error()));
  show.session = std::move(*opened);
  return {};
}

/// On a free port; the page that a server has to have says what is going on.
Expected<void> open_server(const LiveOptions& options, const std::filesystem::path& folder, Show& show) {
  server::ServerSettings settings;
  settings.port = 0;
  settings.page = folder / "page";
  settings.recordings = folder;
  std::error_code code;
  std::filesystem::create_directories(settings.page, code);
  if (Expected<void> done = write_atomically(settings.page / "index.html", "<title>rhexis study live</title>\n"); !done)
    return done;
  Expected<std::unique_ptr<server::Server>> server = server::Server::listen(settings, *show.session);
  if (!server) return fail(std::move(server.error()));
  show.server = std::move(*server);
  show.log.set(*show.server);
  show.server->start();
  for (int k = 0; k < options.clients; ++k) {
    Expected<std::unique_ptr<WatchingClient>> client = WatchingClient::connect(show.server->port());
    if (!client) return fail(std::move(client.error()));
    show.clients.push_back(std::move(*client));
    if (k > 0) continue;  // the first has the hand, and is waited for so that it is the first
    const Stopwatch watch;
    while (!show.clients[0]->glance().hand) {
      if (1e3 * watch.seconds() > static_cast<double>(kPatience.count())) return fail("no client is given the hand");
      std::this_thread::sleep_for(milliseconds(1));
    }
  }
  return {};
}

/// Lets it run. Each second's rates of the physics go into `run`.
void watch(const LiveOptions& options, const Progress& progress, Show& show, LiveRun& run) {
  WatchingClient& hand = *show.clients[0];
  Director director(hand);
  const Stopwatch clock;
  double told = 0.0;
  double seconds = 0.0;
  for (; seconds < options.seconds; seconds = clock.seconds()) {
    std::this_thread::sleep_for(kLook);
    director.look();
    const Glance now = hand.glance();
    if (now.gone) break;
    if (seconds < told + 1.0) continue;
    told += 1.0;
    if (now.rates.physics_hz > 0.0) {
      run.steps_per_second.push_back(now.rates.physics_hz);
      run.longest_step = std::max(run.longest_step, now.rates.physics_worst_ms);
    }
    if (!progress(std::min(1.0, seconds / options.seconds),
                  fmt::format("pull {}, {} advances", director.pulls(), now.advances)))
      break;
  }
  run.seconds = seconds;
  run.pulls = director.pulls();
}

}  // namespace

Expected<LiveRun> run_live(const LiveOptions& options, const StudyFolder& folder, const Progress& progress) {
  if (!(options.seconds > 0.0) || options.clients < 1)
    return fail(fmt::format("{} clients for {} s", options.clients, options.seconds), "one and more than 0 at least");
  Show show;
  LiveRun run;
  if (Expected<void> done = open_session(options, folder.path(), show); !done) return fail(std::move(done.error()));
  if (Expected<void> done = open_server(options, folder.path(), show); !done) return fail(std::move(done.error()));
  if (Expected<void> done = show.session->start(); !done) return fail(std::move(done.error()));
  watch(options, progress, show, run);
  show.session->stop();
  for (const auto& client : show.clients) {
    run.clients.push_back(client->end());
    if (const std::string& trouble = run.clients.back().trouble; !trouble.empty())
      return fail(fmt::format("client {} was lost: {}", run.clients.size(), trouble));
  }
  show.server->stop();
  std::error_code gone;  // the page is no result
  std::filesystem::remove(folder.path() / "page/index.html", gone);
  std::filesystem::remove(folder.path() / "page", gone);
  run.ticks = show.session->haptic_loop().statistics();
  run.priority = show.session->haptic_loop().priority_text();
  run.marks = show.probe->take_marks();
  run.events = show.log.take_events();
  return run;
}

}  // namespace rhexis::studies
