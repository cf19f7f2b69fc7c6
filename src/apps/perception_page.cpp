#include "apps/perception_page.h"

#include <chrono>
#include <thread>

#include "apps/interrupt.h"
#include "haptics/device_list.h"
#include "session/live_session.h"
#include "studies/perception_answers.h"
#include "studies/perception_task.h"

namespace rhexis::apps {
namespace {

constexpr std::chrono::milliseconds kLook{50};
/// That the page has to hear that it was the last trial.
constexpr std::chrono::milliseconds kFarewell{500};

session::LiveSettings settings_of(const PersonOptions& person, std::shared_ptr<session::LiveTask> task) {
  session::LiveSettings settings;
  settings.task = std::move(task);
  settings.version = RHEXIS_VERSION;
  settings.motion_scale = person.motion_scale;
  settings.force_scale = person.force_scale;
  settings.device = [name = person.device](std::shared_ptr<haptics::HandPath> script) {
    return haptics::make_device(name,
                                {.hand = std::move(script), .emulator = haptics::EmulatorSettings::firmly_held()});
  };
  return settings;
}

void tell(const studies::PerceptionTask::Standing& now, const studies::Progress& progress) {
  progress(static_cast<double>(now.runs_done) / static_cast<double>(now.runs),
           fmt::format("{} trials answered", now.answered));
}

/// Until all is answered.
void wait(const studies::PerceptionTask& task, const studies::Progress& progress) {
  const Interrupt interrupt;
  std::size_t told = 0;
  for (auto now = task.standing(); !interrupt.asked() && !now.is_over; now = task.standing()) {
    if (now.answered != told) tell(now, progress);
    told = now.answered;
    std::this_thread::sleep_for(kLook);
  }
  if (task.standing().is_over) std::this_thread::sleep_for(kFarewell);
}

}  // namespace

Expected<nlohmann::ordered_json> run_with_person(const studies::PerceptionSettings& settings,
                                                 const PersonOptions& person, const studies::StudyFolder& folder,
                                                 const studies::Progress& progress) {
  Expected<std::shared_ptr<studies::PerceptionTask>> task =
      studies::PerceptionTask::make(settings, folder.path() / studies::TrialLog::kName);
  if (!task) return fail(std::move(task.error()));
  if ((*task)->standing().is_over)  // killed before its report was written, or asked for it again
    return studies::write_answers(settings, (*task)->answered(), folder);
  Relay relay;
  Expected<std::unique_ptr<session::LiveSession>> live = session::LiveSession::open(settings_of(person, *task), relay);
  if (!live) return fail(std::move(live.error()));
  Expected<std::unique_ptr<server::Server>> server = listen(*person.view, **live, relay);
  if (!server) return fail(std::move(server.error()));
  if (Expected<void> begun = (*live)->start(); !begun) return fail(std::move(begun.error()));
  fmt::print(stderr, "page      {}\nCtrl-C ends it; the same command goes on with it\n", (*server)->url());
  show_page(*person.view, **server);
  wait(**task, progress);
  (*live)->stop();
  (*server)->stop();
  if (!(*task)->standing().is_over) folder.note("The experiment is not at its end: the same command goes on with it.");
  tell((*task)->standing(), progress);
  return studies::write_answers(settings, (*task)->answered(), folder);
}

}  // namespace rhexis::apps
