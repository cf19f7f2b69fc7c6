#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace rhexis {

/// FNV-1a over bytes: the fingerprint of a state or a scene in tests and files. Not for security.
class Hash {
 public:
  template <class T>
    requires std::is_trivially_copyable_v<T>
  Hash& add(std::span<const T> values) {
    for (const std::byte byte : std::as_bytes(values))
      value_ = (value_ ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3ULL;
    return *this;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace rhexis
