#pragma once

/// A plate that is torn on, advance by advance, in one of the two ways of the restructuring study; and what each
/// advance took.

#include <memory>
#include <span>
#include <vector>

#include "studies/study_plate.h"

namespace rhexis::studies {

/// imposed: the thesis's two advances of 40.3 mm, straight on. slow_pull: the hand moves so slowly that the criterion
/// decides each advance at its strength, a mean edge or two long.
enum class TearMode { imposed, slow_pull };

/// Of the thesis, m (5.2: the mean over all free nodes, directions and pulls) and how many (Ncp).
inline constexpr double kImposedLength = 40.3e-3;
inline constexpr int kImposedAdvances = 2;

struct TimedAdvance {
  session::AdvanceRecord record;
  double seconds =
      0.0;  ///< of the wall, from the end of the advance before, or the begin of the tick, judging included
};

class TornOn {
 public:
  /// `background` as in TearSettings. Errors as of start_tearing.
  static Expected<TornOn> start(const StudyPlate& plate, TearMode mode, bool background);

  /// At least `count` more advances, all of a tick; fewer when the tearing has come to its end. Added to advances().
  void tear_on(std::size_t count);
  [[nodiscard]] bool at_end() const { return at_end_; }
  /// Of the whole tearing, in [0, 1].
  [[nodiscard]] double part_done() const;

  /// Without the crack of the start.
  [[nodiscard]] const std::vector<TimedAdvance>& advances() const { return advances_; }
  /// history()[0] made the crack of the start, history()[k] is advance k - 1.
  [[nodiscard]] const mesh::TornMesh& body() const { return session_->body(); }
  [[nodiscard]] std::span<const NodeId> hand_nodes() const { return session_->hand().nodes(); }
  /// Radius of the local object after an advance, m.
  [[nodiscard]] double local_radius(const session::AdvanceRecord& after) const;

 private:
  TornOn(std::unique_ptr<session::TearSession> session, TearMode mode, const Vec3& by)
      : session_(std::move(session)), mode_(mode), by_(by) {}
  void step();

  std::unique_ptr<session::TearSession> session_;
  TearMode mode_;
  Vec3 by_;
  int step_ = 0;  ///< imposed advances, or ticks
  bool at_end_ = false;
  std::vector<TimedAdvance> advances_;
};

}  // namespace rhexis::studies
