#pragma once

/// The folder that `rhexis tear` leaves behind (docs/results.md): every topology as VTU and VTKHDF, the series of them,
/// that of a body with mass after it was let go, the force trace as CSV and SVG, the last state and summary.json.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "result/result_folder.h"
#include "scene/tear_problem.h"
#include "session/tear_session.h"

namespace rhexis::apps {

class TearOutput {
 public:
  static Expected<TearOutput> open(const std::filesystem::path& path);

  /// The body as it is now. `time` s.
  Expected<void> write_topology(session::TearSession& tear, double time);
  /// The body that nobody holds as it is now. `time` s.
  Expected<void> write_released(session::TearSession& tear, double time);
  /// A line of force.csv. The file grows line by line, so that a killed run keeps what it measured.
  Expected<void> write_tick(session::TearSession& tear, double time, const Vec3& hand,
                            const session::TickReport& report);
  /// A force on the hand that no tick ends with: that before an advance.
  void note_force(const Vec3& force) { largest_force_ = std::max(largest_force_, force.norm()); }
  /// result.vtkhdf, the body as it is now, and force.svg.
  Expected<void> write_result(session::TearSession& tear, const std::string& title);
  Expected<void> write_summary(const nlohmann::ordered_json& summary) { return folder_.write_summary(summary); }

  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  [[nodiscard]] double largest_force() const { return largest_force_; }        ///< N
  [[nodiscard]] double largest_displacement() const { return largest_move_; }  ///< m, over the states written

 private:
  void note_displacement(const VectorX& u);

  explicit TearOutput(result::ResultFolder folder) : folder_(std::move(folder)) {}

  result::ResultFolder folder_;
  std::ofstream trace_;
  std::vector<double> time_;          ///< s, of each tick
  std::vector<Vec3> force_;           ///< N, on the hand, of each tick
  std::vector<double> advance_time_;  ///< s, of each advance
  double largest_force_ = 0.0;
  double largest_move_ = 0.0;
};

struct TearTimes {
  double read = 0.0;   ///< s
  double build = 0.0;  ///< s, of the session: orders, factors
  double total = 0.0;  ///< s
};

/// `why`: empty when the script came to its end.
/// `warnings`: beside those of the problem.
[[nodiscard]] nlohmann::ordered_json make_tear_summary(const scene::TearProblem& problem,
                                                       const std::vector<std::string>& warnings,
                                                       const std::string& scene, session::TearSession& tear,
                                                       const TearOutput& output, const std::string& why,
                                                       const TearTimes& times);
void print_tear_outcome(const nlohmann::ordered_json& summary, const std::filesystem::path& out);

}  // namespace rhexis::apps
