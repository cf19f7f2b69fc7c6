#pragma once

/// An experiment on crack angles with a person: the state machine between the page and the plates.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "base/clock.h"
#include "session/live_task.h"
#include "studies/perception_experiment.h"
#include "studies/perception_log.h"
#include "studies/perception_plate.h"

namespace rhexis::studies {

class PerceptionTask final : public session::LiveTask {
 public:
  /// Goes on where `log` stands, which may be at the end. Errors: as of PerceptionPlate and TrialLog.
  static Expected<std::shared_ptr<PerceptionTask>> make(const PerceptionSettings& settings,
                                                        const std::filesystem::path& log);

  Expected<std::unique_ptr<session::OpenBody>> open() override { return plate_.torn(settings_.sample); }
  Expected<void> carry_out(const wire::PayloadUnion& command) override;
  void has_hold() override { felt_[static_cast<std::size_t>(presented_)] = true; }
  [[nodiscard]] const response::ContactLaw& felt() const override;
  [[nodiscard]] wire::TrialT show() const override;

  /// From any thread.
  struct Standing {
    std::size_t answered = 0, runs_done = 0, runs = 0;
    bool is_over = false;
  };
  [[nodiscard]] Standing standing() const;
  /// When the session has stopped.
  [[nodiscard]] const std::vector<AnsweredTrial>& answered() const { return experiment_->answered(); }

 private:
  PerceptionTask(PerceptionSettings settings, PerceptionPlate plate, std::unique_ptr<PerceptionExperiment> experiment,
                 TrialLog log, std::vector<response::ContactLaw> sample);
  Expected<void> answer(Side side);
  /// Tears the odd plate of the current trial. After an error only the sample is felt, and nothing can be answered: the
  /// odd plate of the trial before is not to pass for it.
  Expected<void> meet_trial();
  void stand();

  PerceptionSettings settings_;
  PerceptionPlate plate_;
  std::unique_ptr<PerceptionExperiment> experiment_;
  TrialLog log_;
  std::vector<response::ContactLaw> sample_;  ///< per point
  response::ContactLaw odd_;
  std::optional<Error> unmet_;  ///< why the current trial has no odd plate
  wire::Presented presented_ = wire::Presented::sample;
  std::array<bool, 3> felt_{};  ///< sample, A, B, in this trial
  Stopwatch watch_;             ///< of this trial
  mutable std::mutex mutex_;
  Standing standing_;
};

}  // namespace rhexis::studies
