#include "result/chart_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "base/check.h"

namespace rhexis::result {
namespace {

/// Ticks are multiples of a step counted in 64 bits and labelled in decimal: a range below this part of its largest
/// number is widened.
constexpr double kNarrowest = 1e-9;
/// A tick that rounding puts this part of a step outside of the range still belongs to it.
constexpr double kTickSlack = 1e-6;
/// Whole numbers up to this are written out, and fractions of as many places; beyond comes a power of ten.
constexpr int kPlainDigits = 6;
constexpr int kPlainPlaces = 4;

std::string superscript(int exponent) {
  static constexpr std::array<std::string_view, 10> kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) out += kDigits[static_cast<std::size_t>(digit - '0')];
  return out;
}

/// With a true minus sign, and a thin space at every third digit of five and more.
std::string plain_number(double value, int places) {
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), places);
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  std::string out = value < 0.0 ? "−" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (whole > 4 && i > 0 && i < whole && (whole - i) % 3 == 0) out += "\u2009";
    out += digits[i];
  }
  return out;
}

/// log10, whole where it is whole but for rounding.
int floor_log10(double value) { return static_cast<int>(std::floor(std::log10(value) + kTickSlack)); }

/// 1, 2 or 5 times a power of ten, about `step`.
double round_step(double step) {
  const double power = std::pow(10.0, floor_log10(step));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= 0.7 * step) return factor * power;
  }
  return 10.0 * power;
}

std::string log_label(int factor, int exponent) {
  if (exponent >= -kPlainPlaces && exponent < kPlainDigits)
    return plain_number(factor * std::pow(10.0, exponent), std::max(0, -exponent));
  const std::string power = "10" + superscript(exponent);
  return factor == 1 ? power : fmt::format("{}·{}", factor, power);
}

}  // namespace

ChartScale::ChartScale(Scale scale, double low, double high) : scale_(scale), from_(low), to_(high) {
  RHEXIS_CHECK(low <= high && std::abs(low) <= kLargestDrawn && std::abs(high) <= kLargestDrawn, "from {} to {}", low,
               high);
  RHEXIS_CHECK(scale == Scale::linear || low > 0.0, "a logarithmic axis from {}", low);
  const double largest = std::max(std::abs(low), std::abs(high));
  if (scale == Scale::log) {
    if (high > low * (1.0 + kNarrowest)) return;
    from_ = low / 2.0;
    to_ = high * 2.0;
  } else if (largest <= 1.0 / kLargestDrawn) {
    from_ = -1.0;
    to_ = 1.0;
  } else if (high - low <= kNarrowest * largest) {
    from_ = low - 0.1 * largest;
    to_ = high + 0.1 * largest;
  }
}

double ChartScale::place(double value) const {
  if (scale_ == Scale::log) return std::log(value / from_) / std::log(to_ / from_);
  return (value - from_) / (to_ - from_);
}

std::vector<Tick> ChartScale::ticks(int wanted) const {
  return scale_ == Scale::log ? log_ticks(std::max(wanted, 1)) : linear_ticks(std::max(wanted, 1));
}

std::vector<Tick> ChartScale::linear_ticks(int wanted) const {
  const double step = round_step((to_ - from_) / wanted);
  const auto first = static_cast<std::int64_t>(std::ceil(from_ / step - kTickSlack));
  const auto last = static_cast<std::int64_t>(std::floor(to_ / step + kTickSlack));
  const int largest = floor_log10(std::max(std::abs(from_), std::abs(to_)));
  const int smallest = floor_log10(step);
  const bool plain = largest < kPlainDigits && smallest >= -kPlainPlaces;
  const double power = plain ? 1.0 : std::pow(10.0, largest);
  const int places = std::max(0, plain ? -smallest : largest - smallest);
  std::vector<Tick> out;
  for (std::int64_t k = first; k <= last; ++k) {
    const double value = static_cast<double>(k) * step;
    std::string label = k == 0 ? "0" : plain_number(value / power, places);
    if (!plain && k != 0) label += "·10" + superscript(largest);
    out.push_back({value, std::move(label)});
  }
  return out;
}

std::vector<Tick> ChartScale::log_ticks(int wanted) const {
  // Within a factor of two or so no power of ten need lie inside, and round numbers are as good as on a linear axis.
  if (to_ / from_ < 3.0) return linear_ticks(wanted);
  const int first = floor_log10(from_);
  const int last = floor_log10(to_);
  const double decades = std::log10(to_ / from_);
  const bool label_all = 3.0 * decades <= std::max(wanted, 3);
  const int every = std::max(1, static_cast<int>(std::ceil(decades / wanted)));
  std::vector<Tick> out;
  for (int exponent = first; exponent <= last; ++exponent) {
    for (int factor = 1; factor <= 9; ++factor) {
      const double value = factor * std::pow(10.0, exponent);
      if (place(value) < -kTickSlack || place(value) > 1.0 + kTickSlack) continue;
      if (factor != 1 && every > 1) continue;
      const bool labelled = factor == 1 ? exponent % every == 0 : label_all && (factor == 2 || factor == 5);
      out.push_back({value, labelled ? log_label(factor, exponent) : std::string()});
    }
  }
  return out;
}

}  // namespace rhexis::result
