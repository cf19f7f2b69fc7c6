#pragma once

/// zlib, with a bound on what a small file may grow to.

#include <string>
#include <string_view>

namespace rhexis::mesh::io {

/// What may be unpacked from `packed` bytes: 64 times as much and 64 MiB on top, and never more than 1 GiB. Meshes and
/// results pack by 3 to 20; deflate can reach 1000, which only a bomb needs.
[[nodiscard]] std::size_t unpacked_limit(std::size_t packed);

[[nodiscard]] bool is_gzip(std::string_view bytes);

/// Unpacks a .gz file (its members one after the other). Throws ReadFailure when it is damaged, cut short or too large.
[[nodiscard]] std::string gunzip(std::string_view packed);
[[nodiscard]] std::string gzip(std::string_view bytes);

/// Appends one zlib stream that unpacks to exactly `size` bytes. Throws ReadFailure otherwise. The caller has checked
/// that `size` may be allocated.
void append_inflated(std::string_view packed, std::size_t size, std::string& out);
[[nodiscard]] std::string deflate(std::string_view bytes);

}  // namespace rhexis::mesh::io
