#include "mesh/io/read_failure.h"

namespace rhexis::mesh::io {

void refuse(std::string what, std::string remedy, int line) {
  throw ReadFailure{Error{std::move(what), std::move(remedy), {}, line}};
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string out = "'";
  for (const char c : text.substr(0, kLongest)) {
    const auto code = static_cast<unsigned char>(c);
    out += code < 0x20 || code == 0x7f ? '?' : c;
  }
  return out + (text.size() > kLongest ? "...'" : "'");
}

}  // namespace rhexis::mesh::io
