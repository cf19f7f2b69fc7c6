#include "base/error.h"

namespace rhexis {

std::string Error::message() const {
  std::string text;
  if (!file.empty()) text += file + ':';
  if (!file.empty() && line > 0) text += std::to_string(line) + ':';
  if (!text.empty()) text += ' ';
  text += what;
  if (!remedy.empty()) text += " (" + remedy + ')';
  return text;
}

Error Error::at(const std::string& in_file, int in_line) const {
  Error placed = *this;
  if (placed.file.empty()) {
    placed.file = in_file;
    placed.line = in_line;
  }
  return placed;
}

}  // namespace rhexis
