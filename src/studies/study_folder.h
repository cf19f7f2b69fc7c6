#pragma once

/// What the studies have in common: a folder of tables and figures, what goes into its report, and a word on the way.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "result/chart.h"
#include "result/shape_picture.h"

namespace rhexis::studies {

/// Told after each piece of work: how much of all is done, in [0, 1], and what it was. False: stop, with what there is.
using Progress = std::function<bool(double fraction, std::string_view what)>;

struct StudyTable {
  std::string name;
  std::string caption;
  nlohmann::ordered_json rows;
};
struct StudyFigure {
  std::string name;
  std::string caption;
  std::string svg;
};
struct StudyShapes {
  std::string name;
  std::string caption;
  std::string svg;
  result::ShapePicture picture;
};
using StudyItem = std::variant<StudyTable, StudyFigure, StudyShapes>;

/// What a study has written so far, in the order in which each name came first.
struct StudyContents {
  std::vector<std::string> notes;  ///< paragraphs of the report
  std::vector<StudyItem> items;
  nlohmann::ordered_json published = nlohmann::ordered_json::array();  ///< of beside_published
};

/// A handle: copies are of the same folder.
class StudyFolder {
 public:
  /// Makes the folder when it is missing, so that a study does not run for nothing.
  static Expected<StudyFolder> open(std::filesystem::path path);

  /// NAME.json, an array of flat objects that all have the same keys, and NAME.csv, the same under a header. At least
  /// one row; a number that is not finite is null in the one and empty in the other. A name that was written before is
  /// written anew. `caption`: one or two sentences for the report.
  Expected<void> write_table(std::string_view name, const nlohmann::ordered_json& rows,
                             std::string_view caption = {}) const;
  /// NAME.svg.
  Expected<void> write_figure(std::string_view name, const result::Chart& chart, std::string_view caption = {}) const;
  /// NAME.svg; in the report to be turned.
  Expected<void> write_shapes(std::string_view name, const result::ShapePicture& picture,
                              std::string_view caption = {}) const;
  /// A paragraph at the head of the report: what was done, and an honest word on what differs.
  void note(std::string text) const;
  /// A number of the papers beside ours, as beside_published has it; an id that was given before is replaced.
  void compare(std::string_view id, const nlohmann::ordered_json& ours, const std::string& why) const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const StudyContents& contents() const { return *contents_; }

 private:
  explicit StudyFolder(std::filesystem::path path)
      : path_(std::move(path)), contents_(std::make_shared<StudyContents>()) {}
  void keep(StudyItem item) const;

  std::filesystem::path path_;
  std::shared_ptr<StudyContents> contents_;
};

}  // namespace rhexis::studies
