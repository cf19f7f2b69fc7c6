#pragma once

/// One plate torn in one way of tearing, by all the ways of following it that are asked for.

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/restructuring.h"
#include "studies/torn_on.h"

namespace rhexis::studies {

/// One advance, followed by one way.
struct Restructured {
  std::size_t advance = 0;  ///< number of the advance in its round
  int round = 0;
  int tets = 0;          ///< removed
  double length = 0.0;   ///< m
  double seconds = 0.0;  ///< in all
  /// Parts, s; NaN where the way has no such part.
  double remesh = kNone, local = kNone, update = kNone, wait = kNone;
  double assembly = kNone, analysis = kNone, factor = kNone;
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
};

class RestructuringCase {
 public:
  /// `ways`: of kWays.
  RestructuringCase(const StudyPlate& plate, TearMode mode, std::vector<std::string> ways)
      : plate_(plate), mode_(mode), ways_(std::move(ways)) {}

  /// Tears the plate from its start to its end, once, by one of the exact ways: they take turns. `told` after each
  /// block of advances, with the part of the round that is done; false stops. Errors: a torn body that is not stable.
  Expected<bool> run_round(const std::function<bool(double)>& told);

  /// Rounds until every way has been timed once.
  [[nodiscard]] int least_rounds() const { return wants("exact") && wants("exact-all-work") ? 2 : 1; }
  /// One row per way that was timed; see run_restructuring.
  [[nodiscard]] std::vector<nlohmann::ordered_json> rows(int nodes) const;

 private:
  class Follower;
  [[nodiscard]] bool wants(std::string_view way) const;
  /// Such a way is due at this advance; from what it took it follows when it is due again.
  [[nodiscard]] bool is_due(std::string_view way, std::size_t advance) const;
  void keep(std::string_view way, Restructured what);
  /// The same advances by a session whose response is recorded. Errors: of the disk, on which the record is made.
  Expected<void> tear_recorded();
  void keep_exact(std::string_view way, const TornOn& torn, std::size_t from);
  Expected<void> follow(Follower& follower, const TornOn& torn, std::size_t advance);
  /// Mean of "sparse" over that of the way, in the rounds that have both: side by side, since machines drift.
  [[nodiscard]] double sparse_over(std::string_view way) const;

  using ByWay = std::map<std::string, std::vector<Restructured>, std::less<>>;
  const StudyPlate& plate_;
  TearMode mode_;
  response::SharedRecord record_;  ///< of straight advances, made when it is first needed
  std::vector<std::string> ways_;
  int round_ = -1;
  ByWay done_;
};

}  // namespace rhexis::studies
