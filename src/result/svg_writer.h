#pragma once

/// What the figures have in common: text that grows, and words in it.

#include <iterator>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "mesh/io/xml_text.h"

namespace rhexis::result {

/// A coordinate in px: hundredths are finer than any screen.
[[nodiscard]] inline std::string px(double value) {
  std::string out = fmt::format("{:.2f}", value);
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

class SvgWriter {
 protected:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
  }
  /// `what` is escaped; `more` are attributes.
  void text(double x, double y, std::string_view classes, std::string_view what, std::string_view more = {}) {
    add("<text x=\"{}\" y=\"{}\" class=\"{}\"{}>{}</text>\n", px(x), px(y), classes, more, mesh::io::xml_escaped(what));
  }

  std::string out_;
};

}  // namespace rhexis::result
