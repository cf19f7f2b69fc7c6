#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rhexis::linalg {

/// An array whose copies share what has not been written since: copying costs a pointer per 512 entries, and the first
/// write to a chunk copies that chunk. A copied-from array must not be written to any more (versions do not change).
template <typename T>
class SharedArray {
 public:
  SharedArray() = default;
  ~SharedArray() = default;
  SharedArray(const SharedArray& other)
      : chunks_(other.chunks_), own_(other.chunks_.size(), std::uint8_t{0}), size_(other.size_) {}
  SharedArray(SharedArray&&) noexcept = default;
  SharedArray& operator=(const SharedArray& other) { return *this = SharedArray(other); }
  SharedArray& operator=(SharedArray&&) noexcept = default;

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return (*chunks_[i / kChunk])[i % kChunk]; }

  void set(std::size_t i, const T& value) {
    std::shared_ptr<Chunk>& chunk = chunks_[i / kChunk];
    if (own_[i / kChunk] == 0) {
      chunk = std::make_shared<Chunk>(*chunk);
      own_[i / kChunk] = 1;
    }
    (*chunk)[i % kChunk] = value;
  }

  /// New entries are `value`.
  void resize(std::size_t size, const T& value) {
    const std::size_t old = size_;
    chunks_.resize((size + kChunk - 1) / kChunk);
    own_.resize(chunks_.size(), std::uint8_t{1});
    for (std::shared_ptr<Chunk>& chunk : chunks_) {
      if (!chunk) chunk = std::make_shared<Chunk>();
    }
    size_ = size;
    for (std::size_t i = old; i < size; ++i) set(i, value);
  }

  /// Counted as if nothing were shared.
  [[nodiscard]] std::size_t memory_bytes() const { return chunks_.size() * (sizeof(Chunk) + sizeof(void*)); }

 private:
  static constexpr std::size_t kChunk = 512;
  using Chunk = std::array<T, kChunk>;
  std::vector<std::shared_ptr<Chunk>> chunks_;
  std::vector<std::uint8_t> own_;  // 1: of this copy alone
  std::size_t size_ = 0;
};

}  // namespace rhexis::linalg
