#include "studies/torn_on.h"

#include <algorithm>

#include "base/clock.h"

namespace rhexis::studies {
namespace {

/// The whole pull; 0.06 mm a tick moves the stress at the tip by a thousandth of the strength on the coarsest plate.
constexpr int kTicks = 2000;

}  // namespace

Expected<TornOn> TornOn::start(const StudyPlate& plate, TearMode mode, bool background) {
  StudyPlate own = plate;
  own.settings.background = background;
  // Every local object has the length of the advances from the start, as every later one in the thesis.
  if (mode == TearMode::imposed) own.settings.local_radius = kImposedLength;
  Expected<std::unique_ptr<session::TearSession>> session = start_tearing(own);
  if (!session) return fail(std::move(session.error()));
  return TornOn(std::move(*session), mode, plate.by);
}

void TornOn::tear_on(std::size_t count) {
  const std::size_t wanted = advances_.size() + count;
  while (!at_end_ && advances_.size() < wanted) step();
}

void TornOn::step() {
  ++step_;
  Stopwatch watch;
  const auto observe = [&](const session::AdvanceRecord& record) {
    advances_.push_back({record, watch.seconds()});
    watch.restart();
  };
  session::TickReport report;
  if (mode_ == TearMode::imposed) {
    report = session_->impose(0, Vec3::UnitY(), kImposedLength, observe);
    at_end_ = step_ == kImposedAdvances;
  } else {
    report = session_->tick(by_ * (static_cast<double>(step_) / kTicks), observe);
    at_end_ = step_ == kTicks;
  }
  const std::vector<fracture::Crack>& cracks = session_->cracks();
  at_end_ = at_end_ || !report.trouble.empty() || report.let_go ||
            std::all_of(cracks.begin(), cracks.end(), [](const fracture::Crack& crack) { return crack.finished; });
}

double TornOn::part_done() const {
  if (at_end_) return 1.0;
  return static_cast<double>(step_) / (mode_ == TearMode::imposed ? kImposedAdvances : kTicks);
}

double TornOn::local_radius(const session::AdvanceRecord& after) const {
  return std::max(session_->settings().local_radius, after.length);
}

}  // namespace rhexis::studies
