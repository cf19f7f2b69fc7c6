#include "mesh/io/base64.h"

#include <array>
#include <cstdint>

#include "mesh/io/read_failure.h"

namespace rhexis::mesh::io {
namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::int8_t kBlank = -1;
constexpr std::int8_t kPadding = -2;
constexpr std::int8_t kForeign = -3;

constexpr std::array<std::int8_t, 256> make_table() {
  std::array<std::int8_t, 256> table{};
  table.fill(kForeign);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i)
    table[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::int8_t>(i);
  for (const char c : {' ', '\t', '\r', '\n'}) table[static_cast<unsigned char>(c)] = kBlank;
  table[static_cast<unsigned char>('=')] = kPadding;
  return table;
}
constexpr std::array<std::int8_t, 256> kTable = make_table();

}  // namespace

bool Base64Reader::decode_group() {
  std::uint32_t bits = 0;
  int symbols = 0;
  int padding = 0;
  while (symbols + padding < 4) {
    if (position_ == text_.size()) {
      if (symbols + padding == 0) return false;
      refuse("base64 data end inside a group of four letters", "the file may be cut short");
    }
    const std::int8_t value = kTable[static_cast<unsigned char>(text_[position_++])];
    if (value == kBlank) continue;
    if (value == kPadding) {
      ++padding;
    } else if (value == kForeign || padding > 0) {
      refuse("base64 data hold " + in_quotes(text_.substr(position_ - 1, 1)) + " where no such letter can be");
    } else {
      ++symbols;
    }
    bits = (bits << 6) | static_cast<std::uint32_t>(value >= 0 ? value : 0);
  }
  for (int i = 0; i < 3 - padding; ++i) pending_ += static_cast<char>((bits >> (16 - 8 * i)) & 0xffU);
  return true;
}

std::string Base64Reader::read(std::size_t count) {
  if (count > most_left()) refuse("base64 data end early", "the file may be cut short");
  std::string out;
  out.reserve(count + 3);
  out.swap(pending_);
  while (out.size() < count) {
    if (!decode_group()) refuse("base64 data end early", "the file may be cut short");
    out += pending_;
    pending_.clear();
  }
  pending_ = out.substr(count);
  out.resize(count);
  return out;
}

std::string base64_encode(std::string_view bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) bits = (bits << 8) | (k < here ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= here ? kAlphabet[(bits >> (18 - 6 * k)) & 63U] : '=';
  }
  return out;
}

}  // namespace rhexis::mesh::io
