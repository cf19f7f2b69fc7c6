#include "mesh/io/cursor.h"

#include <limits>

namespace rhexis::mesh::io {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

void Cursor::skip_blanks(bool over_lines) {
  const int line_before = line_;
  for (; position_ < bytes_.size() && is_blank(bytes_[position_]); ++position_) {
    if (bytes_[position_] != '\n') continue;
    if (!over_lines) return;
    ++line_;
  }
  if (position_ == bytes_.size()) line_ = line_before;  // what is missing at the end is missing behind the last word
}

bool Cursor::at_end() {
  skip_blanks(true);
  return position_ == bytes_.size();
}

std::string_view Cursor::word(std::string_view wanted) {
  skip_blanks(!in_record_);
  if (position_ == bytes_.size())
    refuse(fmt::format("the file ends where {} should be", wanted), "it may be cut short");
  const std::size_t begin = position_;
  while (position_ < bytes_.size() && !is_blank(bytes_[position_])) ++position_;
  if (begin == position_) refuse(fmt::format("the line ends where {} should be", wanted));
  return bytes_.substr(begin, position_ - begin);
}

std::string_view Cursor::peek() const {
  Cursor ahead = *this;
  ahead.in_record_ = false;
  return ahead.at_end() ? std::string_view() : ahead.word("a word");
}

bool Cursor::more_on_line() const {
  Cursor ahead = *this;
  ahead.skip_blanks(false);
  return ahead.position_ < bytes_.size() && bytes_[ahead.position_] != '\n';
}

std::string_view Cursor::rest_of_line() {
  in_record_ = false;
  const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  std::string_view rest = bytes_.substr(position_, end - position_);
  position_ = end;
  if (position_ < bytes_.size()) {
    ++position_;
    ++line_;
  }
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  return rest;
}

double Cursor::number(std::string_view wanted) {
  const std::string_view text = word(wanted);
  double value = 0.0;
  const char* first = text.data() + (text.size() > 1 && text.front() == '+' ? 1 : 0);
  const auto [end, code] = std::from_chars(first, text.data() + text.size(), value);
  if (end != text.data() + text.size() || code == std::errc::invalid_argument) {
    refuse(fmt::format("{} should be a number, not {}", wanted, in_quotes(text)));
  }
  if (code == std::errc::result_out_of_range) {
    // from_chars does not say which side was left: what is too small for a double is zero.
    const bool tiny = text.find("e-") != text.npos || text.find("E-") != text.npos;
    return tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return value;
}

void Cursor::begin_record(std::string_view what) {
  skip_blanks(true);
  if (position_ < bytes_.size() && bytes_[position_] == '$') {
    refuse(fmt::format("{} stands where {} should be", in_quotes(peek()), what), "is the count right?");
  }
  in_record_ = true;
}

void Cursor::end_record(std::string_view what) {
  skip_blanks(false);
  in_record_ = false;
  if (more_on_line()) {
    refuse(fmt::format("{} is followed by {} on its line", what, in_quotes(peek())));
  }
}

std::string_view Cursor::binary(std::size_t count, std::string_view wanted) {
  binary_passed_ = true;
  if (count > left()) {
    refuse(fmt::format("the file ends where {} should be: {} bytes are left of {}", wanted, left(), count),
           "it may be cut short");
  }
  position_ += count;
  return bytes_.substr(position_ - count, count);
}

bool Cursor::skip_past(std::string_view text) {
  const std::size_t found = bytes_.find(text, position_);
  if (found == bytes_.npos) return false;
  const std::size_t end = found + text.size();
  line_ += static_cast<int>(std::count(bytes_.begin() + static_cast<std::ptrdiff_t>(position_),
                                       bytes_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
  position_ = end;
  return true;
}

void Cursor::check_room(std::uint64_t count, std::size_t least_bytes, std::string_view things) const {
  const std::size_t room = left() / least_bytes + 1;  // the last one may lack its line end
  if (count > room) {
    refuse(fmt::format("{} {} are promised, the rest of the file has room for {}", count, things, room),
           "it may be cut short");
  }
}

}  // namespace rhexis::mesh::io
