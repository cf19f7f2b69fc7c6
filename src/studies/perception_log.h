#pragma once

/// The file of an experiment's answers: a line a trial, written as it is answered, so that a kill loses the trial in
/// flight at most, and the same command goes on where it stood.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "studies/perception_experiment.h"

namespace rhexis::studies {

class TrialLog {
 public:
  static constexpr const char* kName = "trials.jsonl";

  /// Gives `experiment` the answers that the file holds, and goes on behind them; a last line that was not finished is
  /// taken away. `experiment` is new, of these settings and this seed. Errors: a file of another experiment or seed, a
  /// line that is no trial of this one, with its number; a file that cannot be written. One without an answer gives
  /// way.
  static Expected<TrialLog> open(const std::filesystem::path& path, const PerceptionSettings& settings,
                                 std::uint64_t seed, PerceptionExperiment& experiment);

  /// On the disk when it comes back; after an error nothing of it is there. `seconds`: that the trial took; 0 where
  /// nobody measured.
  Expected<void> append(const AnsweredTrial& answered, double seconds);
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  TrialLog(std::filesystem::path path, std::FILE* file, std::uintmax_t bytes)
      : path_(std::move(path)), file_(file), bytes_(bytes) {}
  Expected<void> write_line(const std::string& line);

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uintmax_t bytes_;  ///< of the whole lines
};

/// Of a line: trial, run, point, direction (from 0), difference (degrees), same, answer, right.
[[nodiscard]] nlohmann::ordered_json trial_json(const AnsweredTrial& answered);

}  // namespace rhexis::studies
