#include "result/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/check.h"
#include "mesh/io/xml_text.h"
#include "result/svg_writer.h"

namespace rhexis::result {
namespace {

/// Okabe and Ito's colours, which people of every colour vision tell apart, each for a light and a dark ground.
constexpr std::array<std::array<std::string_view, 2>, kChartColours> kPalette{{{"#0072b2", "#56b4e9"},
                                                                               {"#d55e00", "#ff9248"},
                                                                               {"#00805e", "#2fd0a3"},
                                                                               {"#b0508a", "#e79bc8"},
                                                                               {"#9a6b00", "#f0c541"},
                                                                               {"#40474f", "#c9d1d9"}}};

constexpr double kMargin = 16.0;        // px, around everything
constexpr double kLabelSize = 12.0;     // px, of ticks and legend
constexpr double kTitleSize = 16.0;     // px
constexpr double kCharacter = 0.55;     // mean width of a character, in sizes of its font
constexpr double kLegendRow = 20.0;     // px
constexpr double kLegendSample = 28.0;  // px, the bit of line before a name
constexpr double kLegendGap = 22.0;     // px, between entries
constexpr double kPadding = 0.05;       // of the range, beyond the data
constexpr double kZeroNear = 0.3;       // data that begin below this part of their largest number begin at zero
constexpr double kSymbolRadius = 4.5;   // px
constexpr double kColumn = 0.5;         // px, of a thinned line
constexpr double kXTickSpacing = 90.0;  // px, wanted
constexpr double kYTickSpacing = 48.0;  // px, wanted

/// About how wide a text comes out, px; fonts differ, so what follows it keeps a distance.
double text_width(std::string_view text, double size) {
  const auto characters =
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
  return kCharacter * size * static_cast<double>(characters);
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Takes the numbers in, or says which cannot be drawn.
Expected<void> take(const std::string& owner, const ChartAxis& axis, const std::vector<double>& values, Range& range) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto wrong = [&](std::string_view what) {
      return fail(fmt::format("'{}' cannot be drawn: number {} along '{}' is {}", owner, i, axis.label, what));
    };
    if (!std::isfinite(values[i])) return wrong("not finite");
    if (std::abs(values[i]) > kLargestDrawn) return wrong("too large");
    if (axis.scale == Scale::log && values[i] < 1.0 / kLargestDrawn)
      return wrong("not positive, and the axis is logarithmic");
    range.take(values[i]);
  }
  return {};
}

/// A little air around the data, in the measure of the axis; zero is shown where it is near. Along a linear x what is
/// drawn is mostly a time or a length, which has its ends.
ChartScale make_scale(Scale scale, Range range, bool tight) {
  if (scale == Scale::log) {
    const double air = std::pow(range.high / range.low, kPadding);
    return {scale, std::max(range.low / air, 1.0 / kLargestDrawn), std::min(range.high * air, kLargestDrawn)};
  }
  if (range.low > 0.0 && range.low < kZeroNear * range.high) range.low = 0.0;
  if (range.high < 0.0 && range.high > kZeroNear * range.low) range.high = 0.0;
  if (tight) return {scale, range.low, range.high};
  const double air = kPadding * (range.high - range.low);
  return {scale, range.low == 0.0 ? 0.0 : std::max(range.low - air, -kLargestDrawn),
          range.high == 0.0 ? 0.0 : std::min(range.high + air, kLargestDrawn)};
}

struct Point {
  double x, y;  // px, in the plot
};

/// Of every column of the screen the first, least, greatest and last point, in their order.
std::vector<Point> thinned(const std::vector<Point>& points) {
  std::vector<Point> out;
  for (std::size_t begin = 0; begin < points.size();) {
    const double column = std::floor(points[begin].x / kColumn);
    std::size_t end = begin;
    while (end < points.size() && std::floor(points[end].x / kColumn) == column) ++end;
    const auto [least, greatest] = std::minmax_element(points.begin() + static_cast<std::ptrdiff_t>(begin),
                                                       points.begin() + static_cast<std::ptrdiff_t>(end),
                                                       [](const Point& a, const Point& b) { return a.y < b.y; });
    std::array<std::size_t, 4> keep{begin, static_cast<std::size_t>(least - points.begin()),
                                    static_cast<std::size_t>(greatest - points.begin()), end - 1};
    std::sort(keep.begin(), keep.end());
    for (std::size_t k = 0; k < keep.size(); ++k)
      if (k == 0 || keep[k] != keep[k - 1]) out.push_back(points[keep[k]]);
    begin = end;
  }
  return out;
}

class Drawing : private SvgWriter {
 public:
  Drawing(const Chart& chart, const ChartScale& x, const ChartScale& y) : chart_(chart), x_(x), y_(y) {
    for (std::size_t k = 0; k < chart.series.size(); ++k) {
      const int colour = chart.series[k].colour;
      colour_.push_back(colour < 0 ? k % kChartColours : static_cast<std::size_t>(colour) % kChartColours);
    }
  }

  std::string draw() {
    open();
    heading();
    legend();
    axes();
    plot();
    out_ += "</svg>\n";
    return std::move(out_);
  }

 private:
  void open();
  void heading();
  void legend();
  void axes();
  void plot();
  void line(const ChartSeries& series, std::size_t colour, const std::vector<Point>& points);
  void whiskers(const ChartSeries& series, std::size_t colour, const std::vector<Point>& points);
  void symbol(const ChartSeries& series, std::size_t colour, Point at);
  [[nodiscard]] Point place(double x, double y) const {
    return {x_.place(x) * plot_width_, (1.0 - y_.place(y)) * plot_height_};
  }

  const Chart& chart_;
  const ChartScale& x_;
  const ChartScale& y_;
  std::vector<std::size_t> colour_;
  double top_ = kMargin;  // px, of what comes next
  double plot_width_ = 0.0;
  double plot_height_ = 0.0;
};

/// All rules begin with the class of the root, so that a page may hold several charts beside its own style.
void Drawing::open() {
  add("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"rhexis-chart\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" role=\"img\">\n<title>{2}</title>\n<style>\n",
      chart_.width, chart_.height, mesh::io::xml_escaped(chart_.title));
  const auto rules = [&](std::size_t scheme, std::string_view ground, std::string_view ink, std::string_view faint,
                         std::string_view grid) {
    add(".rhexis-chart .ground{{fill:{}}} .rhexis-chart text{{fill:{}}} .rhexis-chart .faint{{fill:{}}}\n", ground, ink,
        faint);
    add(".rhexis-chart .grid{{stroke:{}}} .rhexis-chart .axis,.rhexis-chart .mark{{stroke:{}}}\n", grid, faint);
    for (std::size_t k = 0; k < kPalette.size(); ++k)
      add(".rhexis-chart .c{0}{{stroke:{1}}} .rhexis-chart .f{0}{{fill:{1};stroke:{2}}} "
          ".rhexis-chart .h{0}{{fill:{2};stroke:{1}}}\n",
          k, kPalette[k][scheme], ground);
  };
  add(".rhexis-chart text{{font:{}px system-ui,-apple-system,\"Segoe UI\",Roboto,\"Helvetica Neue\",Arial,\"DejaVu "
      "Sans\",sans-serif}}\n",
      px(kLabelSize));
  add(".rhexis-chart text.title{{font-size:{}px;font-weight:600}} .rhexis-chart .middle{{text-anchor:middle}} "
      ".rhexis-chart .end{{text-anchor:end}}\n",
      px(kTitleSize));
  add(".rhexis-chart .grid,.rhexis-chart .axis{{stroke-width:1}} .rhexis-chart .mark{{stroke-width:1;opacity:.55}}\n"
      ".rhexis-chart .line{{fill:none;stroke-width:2;stroke-linejoin:round;stroke-linecap:round}} "
      ".rhexis-chart .dashed{{stroke-dasharray:7 5}} .rhexis-chart .symbol{{stroke-width:1.6}} "
      ".rhexis-chart .filled{{stroke-width:1}}\n");
  rules(0, "#ffffff", "#1f2328", "#59636e", "#e3e6ea");
  add("@media (prefers-color-scheme:dark){{\n");
  rules(1, "#0d1117", "#e6edf3", "#9198a1", "#2b3138");
  add("}}\n</style>\n<rect class=\"ground\" width=\"{}\" height=\"{}\"/>\n", chart_.width, chart_.height);
}

void Drawing::heading() {
  if (!chart_.title.empty()) {
    text(kMargin, top_ + kTitleSize, "title", chart_.title);
    top_ += 1.5 * kTitleSize;
  }
  if (!chart_.subtitle.empty()) {
    text(kMargin, top_ + kLabelSize, "faint", chart_.subtitle);
    top_ += 1.5 * kLabelSize;
  }
}

/// In rows above the plot, where it covers nothing.
void Drawing::legend() {
  double x = kMargin;
  top_ += 6.0;
  const auto entry = [&](const std::string& name, auto&& sample) {
    if (name.empty()) return;
    const double width = kLegendSample + 8.0 + text_width(name, kLabelSize);
    if (x > kMargin && x + width > chart_.width - kMargin) {
      x = kMargin;
      top_ += kLegendRow;
    }
    add("<g transform=\"translate({} {})\">", px(x), px(top_ + kLegendRow / 2.0));
    sample();
    text(kLegendSample + 8.0, 0.35 * kLabelSize, "name", name);
    add("</g>\n");
    x += width + kLegendGap;
  };
  for (std::size_t k = 0; k < chart_.series.size(); ++k) {
    const ChartSeries& series = chart_.series[k];
    entry(series.name, [&] {
      if (series.line) line(series, colour_[k], {{0.0, 0.0}, {kLegendSample, 0.0}});
      symbol(series, colour_[k], {kLegendSample / 2.0, 0.0});
    });
  }
  for (const ChartMarks& marks : chart_.marks) {
    if (marks.x.empty()) continue;
    entry(marks.name, [&] { add("<path class=\"mark\" d=\"M{0} -7V7\"/>", px(kLegendSample / 2.0)); });
  }
  top_ += kLegendRow + 10.0;
}

void Drawing::axes() {
  const double bottom = kMargin + 2.6 * kLabelSize + 12.0;
  plot_height_ = std::max(40.0, chart_.height - top_ - bottom);
  const std::vector<Tick> y_ticks = y_.ticks(static_cast<int>(plot_height_ / kYTickSpacing));
  double widest = 0.0;
  for (const Tick& tick : y_ticks) widest = std::max(widest, text_width(tick.label, kLabelSize));
  const double left = kMargin + 1.8 * kLabelSize + widest + 8.0;
  plot_width_ = std::max(40.0, chart_.width - left - kMargin - 8.0);

  add("<g transform=\"translate({} {})\">\n", px(left), px(top_));
  for (const Tick& tick : y_ticks) {
    const double y = (1.0 - y_.place(tick.value)) * plot_height_;
    add("<path class=\"grid\"{} d=\"M0 {}H{}\"/>\n", tick.label.empty() ? " opacity=\".55\"" : "", px(y),
        px(plot_width_));
    if (!tick.label.empty()) text(-8.0, y + 0.35 * kLabelSize, "faint end", tick.label);
  }
  for (const Tick& tick : x_.ticks(static_cast<int>(plot_width_ / kXTickSpacing))) {
    const double x = x_.place(tick.value) * plot_width_;
    add("<path class=\"grid\"{} d=\"M{} 0V{}\"/>\n", tick.label.empty() ? " opacity=\".55\"" : "", px(x),
        px(plot_height_));
    if (!tick.label.empty()) text(x, plot_height_ + 8.0 + kLabelSize, "faint middle", tick.label);
  }
  const double zero = chart_.y.scale == Scale::linear ? y_.place(0.0) : 0.0;
  const double base = zero >= 0.0 && zero <= 1.0 ? (1.0 - zero) * plot_height_ : plot_height_;
  add("<path class=\"axis\" d=\"M0 {}H{}\"/>\n", px(base), px(plot_width_));
  text(plot_width_ / 2.0, plot_height_ + 12.0 + 2.5 * kLabelSize, "middle", chart_.x.label);
  text(0.0, 0.0, "middle", chart_.y.label,
       fmt::format(" transform=\"translate({} {}) rotate(-90)\"", px(kMargin + 0.8 * kLabelSize - left),
                   px(plot_height_ / 2.0)));
}

void Drawing::plot() {
  for (const ChartMarks& marks : chart_.marks) {
    if (marks.x.empty()) continue;
    add("<path class=\"mark\" d=\"");
    for (const double x : marks.x) add("M{} 0V{}", px(x_.place(x) * plot_width_), px(plot_height_));
    add("\"/>\n");
  }
  std::vector<std::vector<Point>> points(chart_.series.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ChartSeries& series = chart_.series[k];
    for (std::size_t i = 0; i < series.x.size(); ++i) points[k].push_back(place(series.x[i], series.y[i]));
    if (series.line) line(series, colour_[k], thinned(points[k]));
  }
  // Symbols lie above all lines.
  for (std::size_t k = 0; k < points.size(); ++k) {
    whiskers(chart_.series[k], colour_[k], points[k]);
    for (const Point& point : points[k]) symbol(chart_.series[k], colour_[k], point);
  }
  add("</g>\n");
}

void Drawing::line(const ChartSeries& series, std::size_t colour, const std::vector<Point>& points) {
  add("<path class=\"line{} c{}\" d=\"", series.dashed ? " dashed" : "", colour);
  for (std::size_t i = 0; i < points.size(); ++i)
    add("{}{} {}", i == 0 ? "M" : i == 1 ? "L" : " ", px(points[i].x), px(points[i].y));
  add("\"/>\n");
}

void Drawing::whiskers(const ChartSeries& series, std::size_t colour, const std::vector<Point>& points) {
  if (series.low.empty()) return;
  add("<path class=\"line c{}\" style=\"stroke-width:1.2\" d=\"", colour);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string x = px(points[i].x);
    const std::string left = px(points[i].x - 3.0);
    const std::string low = px(place(series.x[i], series.low[i]).y);
    const std::string high = px(place(series.x[i], series.high[i]).y);
    add("M{} {}V{}M{} {}h6M{} {}h6", x, low, high, left, low, left, high);
  }
  add("\"/>\n");
}

void Drawing::symbol(const ChartSeries& series, std::size_t colour, Point at) {
  if (series.symbol == Symbol::none) return;
  const std::string classes = fmt::format("symbol {}{}", series.hollow ? "h" : "filled f", colour);
  const std::string x = px(at.x);
  const double r = kSymbolRadius;
  switch (series.symbol) {
    case Symbol::none: break;
    case Symbol::circle:
      add("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", classes, x, px(at.y), px(r));
      break;
    case Symbol::square:
      add("<path class=\"{0}\" d=\"M{1} {2}h{3}v{3}h-{3}z\"/>\n", classes, px(at.x - 0.9 * r), px(at.y - 0.9 * r),
          px(1.8 * r));
      break;
    case Symbol::triangle:
      add("<path class=\"{}\" d=\"M{} {}l{} {}h-{}z\"/>\n", classes, x, px(at.y - 1.2 * r), px(1.15 * r), px(2.0 * r),
          px(2.3 * r));
      break;
    case Symbol::diamond:
      add("<path class=\"{0}\" d=\"M{1} {2}l{3} {3}l-{3} {3}l-{3} -{3}z\"/>\n", classes, x, px(at.y - 1.25 * r),
          px(1.25 * r));
      break;
  }
}

}  // namespace

Expected<std::string> chart_svg(const Chart& chart) {
  Range x;
  Range y;
  for (const ChartSeries& series : chart.series) {
    RHEXIS_CHECK(series.x.size() == series.y.size(), "{} x, {} y", series.x.size(), series.y.size());
    RHEXIS_CHECK(
        series.low.size() == series.high.size() && (series.low.empty() || series.low.size() == series.x.size()),
        "{} points, {} and {} ends of whiskers", series.x.size(), series.low.size(), series.high.size());
    if (Expected<void> done = take(series.name, chart.x, series.x, x); !done) return fail(done.error());
    for (const std::vector<double>* values : {&series.y, &series.low, &series.high})
      if (Expected<void> done = take(series.name, chart.y, *values, y); !done) return fail(done.error());
  }
  if (!(y.low <= y.high)) return fail("chart '" + chart.title + "' has no point to draw");
  for (const ChartMarks& marks : chart.marks)
    if (Expected<void> done = take(marks.name, chart.x, marks.x, x); !done) return fail(done.error());
  const bool has_symbols = std::any_of(chart.series.begin(), chart.series.end(),
                                       [](const ChartSeries& series) { return series.symbol != Symbol::none; });
  const ChartScale x_scale = make_scale(chart.x.scale, x, !has_symbols);
  const ChartScale y_scale = make_scale(chart.y.scale, y, false);
  return Drawing(chart, x_scale, y_scale).draw();
}

Expected<void> write_chart(const std::filesystem::path& path, const Chart& chart) {
  const Expected<std::string> svg = chart_svg(chart);
  if (!svg) return fail(svg.error().at(path.string()));
  return write_atomically(path, *svg);
}

}  // namespace rhexis::result
