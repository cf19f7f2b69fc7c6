#pragma once

#include <string>
#include <string_view>

namespace rhexis::mesh::io {

/// `text` as it may stand inside an XML attribute; control characters, which no XML can hold, become '?'.
[[nodiscard]] inline std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out;
}

}  // namespace rhexis::mesh::io
