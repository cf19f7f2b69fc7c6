#pragma once

/// The figures of this project: lines and symbols over two axes, as a self-contained SVG that follows the reader's
/// light or dark scheme. The same chart gives the same bytes.

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "result/chart_scale.h"

namespace rhexis::result {

enum class Symbol { none, circle, square, triangle, diamond };

struct ChartAxis {
  std::string label = {};  ///< with its unit: "time / s"
  Scale scale = Scale::linear;
};

struct ChartSeries {
  std::string name = {};       ///< in the legend
  std::vector<double> x = {};  ///< ascending where there is a line
  std::vector<double> y = {};  ///< one per x
  /// Ends of a whisker at each point, one per x; or both empty.
  std::vector<double> low = {}, high = {};
  bool line = true;
  bool dashed = false;
  Symbol symbol = Symbol::none;
  bool hollow = false;  ///< for points of other sources
  int colour = -1;      ///< place in the palette of kChartColours; -1: the series' own place in the chart
};
inline constexpr int kChartColours = 6;

/// Events: thin vertical lines from bottom to top.
struct ChartMarks {
  std::string name;  ///< in the legend
  std::vector<double> x;
};

/// All text is UTF-8, and is escaped.
struct Chart {
  std::string title = {};
  std::string subtitle = {};  ///< one line under the title; may be empty
  ChartAxis x = {}, y = {};
  std::vector<ChartSeries> series = {};
  std::vector<ChartMarks> marks = {};
  int width = 860;   ///< px, of the whole figure
  int height = 480;  ///< px
};

/// Errors: nothing to draw; a number that is not finite or too large to draw; one that is not positive on a logarithmic
/// axis. Lines of many points are thinned to what can be seen: every column keeps its first, last, least and greatest.
[[nodiscard]] Expected<std::string> chart_svg(const Chart& chart);

/// The same into a file, which appears whole; its folder is made when it is missing.
Expected<void> write_chart(const std::filesystem::path& path, const Chart& chart);

}  // namespace rhexis::result
