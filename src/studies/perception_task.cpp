#include "studies/perception_task.h"

#include <algorithm>

#include <fmt/format.h>

namespace rhexis::studies {
namespace {

using wire::Presented;

std::unique_ptr<wire::Vec3> own(const Vec3& v) { return std::make_unique<wire::Vec3>(v.x(), v.y(), v.z()); }

}  // namespace

Expected<std::shared_ptr<PerceptionTask>> PerceptionTask::make(const PerceptionSettings& settings,
                                                               const std::filesystem::path& log) {
  Expected<PerceptionPlate> plate = PerceptionPlate::open(settings);
  if (!plate) return fail(std::move(plate.error()));
  Expected<std::vector<response::ContactLaw>> sample = plate->laws(settings.sample);
  if (!sample) return fail(std::move(sample.error()));
  auto experiment = std::make_unique<PerceptionExperiment>(settings, settings.seed);
  Expected<TrialLog> opened = TrialLog::open(log, settings, settings.seed, *experiment);
  if (!opened) return fail(std::move(opened.error()));
  std::shared_ptr<PerceptionTask> task(
      new PerceptionTask(settings, std::move(*plate), std::move(experiment), std::move(*opened), std::move(*sample)));
  if (task->standing().is_over) return task;
  if (Expected<void> met = task->meet_trial(); !met) return fail(std::move(met.error()));
  return task;
}

PerceptionTask::PerceptionTask(PerceptionSettings settings, PerceptionPlate plate,
                               std::unique_ptr<PerceptionExperiment> experiment, TrialLog log,
                               std::vector<response::ContactLaw> sample)
    : settings_(std::move(settings)),
      plate_(std::move(plate)),
      experiment_(std::move(experiment)),
      log_(std::move(log)),
      sample_(std::move(sample)) {
  stand();
}

Expected<void> PerceptionTask::carry_out(const wire::PayloadUnion& command) {
  if (experiment_->current() == nullptr) return fail("the experiment is over");
  if (unmet_) return fail(*unmet_);
  if (const wire::FeelT* feel = command.AsFeel()) {
    if (feel->presented > Presented::MAX) return fail("there is no such plate", "the sample, A or B");
    presented_ = feel->presented;
    return {};
  }
  const wire::AnswerT* said = command.AsAnswer();
  if (said == nullptr || (said->same != Presented::a && said->same != Presented::b))
    return fail("that is no answer", "A or B");
  if (!std::all_of(felt_.begin(), felt_.end(), [](bool felt) { return felt; }))
    return fail("not all plates have been felt", "take hold of the sample, of A and of B first");
  return answer(said->same == Presented::a ? Side::a : Side::b);
}

/// It is on the disk before it counts.
Expected<void> PerceptionTask::answer(Side side) {
  const AnsweredTrial answered{*experiment_->current(), side};
  if (Expected<void> kept = log_.append(answered, watch_.seconds()); !kept) return kept;
  experiment_->answer(side);
  stand();
  return experiment_->current() == nullptr ? Expected<void>{} : meet_trial();
}

Expected<void> PerceptionTask::meet_trial() {
  const Trial& trial = *experiment_->current();
  presented_ = Presented::sample;
  felt_ = {};
  unmet_.reset();
  watch_.restart();
  Expected<std::vector<response::ContactLaw>> laws = plate_.laws(settings_.sample - trial.difference);
  if (!laws) {
    unmet_ = laws.error();
    return fail(std::move(laws.error()));
  }
  odd_ = (*laws)[trial.point];
  return {};
}

const response::ContactLaw& PerceptionTask::felt() const {
  const Trial* trial = experiment_->current();
  if (trial == nullptr) return sample_.front();
  const bool is_odd = presented_ != Presented::sample && (presented_ == Presented::a) != (trial->same == Side::a);
  return is_odd ? odd_ : sample_[trial->point];
}

wire::TrialT PerceptionTask::show() const {
  const bool is_over = experiment_->current() == nullptr;
  const Trial& trial = is_over ? experiment_->answered().back().trial : *experiment_->current();
  wire::TrialT out;
  out.title = settings_.title;
  out.number = static_cast<std::uint32_t>(trial.number);
  out.runs_done = static_cast<std::uint32_t>(experiment_->runs_done());
  out.runs = static_cast<std::uint32_t>(experiment_->runs());
  out.presented = presented_;
  out.felt_sample = felt_[0];
  out.felt_a = felt_[1];
  out.felt_b = felt_[2];
  out.point = own(settings_.points[trial.point].value);
  out.direction = own(settings_.directions[trial.direction].value);
  out.finished = is_over;
  out.file = log_.path().string();
  return out;
}

void PerceptionTask::stand() {
  const std::lock_guard lock(mutex_);
  standing_ = {.answered = experiment_->answered().size(),
               .runs_done = experiment_->runs_done(),
               .runs = experiment_->runs(),
               .is_over = experiment_->current() == nullptr};
}

PerceptionTask::Standing PerceptionTask::standing() const {
  const std::lock_guard lock(mutex_);
  return standing_;
}

}  // namespace rhexis::studies
