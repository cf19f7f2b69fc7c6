#pragma once

#include <string>
#include <string_view>

namespace rhexis::mesh::io {

/// Decodes base64 piece by piece. VTK encodes the header of an array and its data one after the other, each with its
/// own padding: padding and blanks inside the text are passed over.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view text) : text_(text) {}
  /// The next `count` bytes. Throws ReadFailure when the text ends before, or holds what is no base64.
  std::string read(std::size_t count);
  /// No more than this many bytes can follow.
  [[nodiscard]] std::size_t most_left() const { return (text_.size() - position_) / 4 * 3 + 3 + pending_.size(); }

 private:
  bool decode_group();

  std::string_view text_;
  std::size_t position_ = 0;
  std::string pending_;  ///< decoded, not yet handed out; at most 2 bytes
};

[[nodiscard]] std::string base64_encode(std::string_view bytes);

}  // namespace rhexis::mesh::io
