#pragma once

/// What the studies have in common: a folder of tables and figures, and a word on the way.

#include <filesystem>
#include <functional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "result/chart.h"

namespace rhexis::studies {

/// Told after each piece of work: how much of all is done, in [0, 1], and what it was. False: stop, with what there is.
using Progress = std::function<bool(double fraction, std::string_view what)>;

class StudyFolder {
 public:
  /// Makes the folder when it is missing, so that a study does not run for nothing.
  static Expected<StudyFolder> open(std::filesystem::path path);

  /// NAME.json, an array of flat objects that all have the same keys, and NAME.csv, the same under a header. At least
  /// one row; a number that is not finite is null in the one and empty in the other.
  Expected<void> write_table(std::string_view name, const nlohmann::ordered_json& rows) const;
  /// NAME.svg.
  Expected<void> write_figure(std::string_view name, const result::Chart& chart) const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit StudyFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;
};

}  // namespace rhexis::studies
