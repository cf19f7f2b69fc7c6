#pragma once

#include <algorithm>
#include <cstddef>

#include "linalg/block_pool.h"

namespace rhexis::linalg {

/// Columns that are worked on at once in a matrix of so many: wide ones read the matrix seldom, but there have to be
/// enough of them for several threads. A multiple of the least.
[[nodiscard]] constexpr int block_width(int size) {
  constexpr int kLeast = 64;
  constexpr int kMost = 4 * kLeast;
  constexpr int kBlocks = 10;
  return std::clamp((size / kBlocks + kLeast - 1) / kLeast * kLeast, kLeast, kMost);
}

/// The lower triangle of a symmetric matrix, in blocks of whole columns that each start at the diagonal: half the
/// memory of a square, and BLAS updates it block by block.
class LowerTriangle {
 public:
  LowerTriangle() = default;
  /// All zero.
  explicit LowerTriangle(int size) : size_(size), width_(block_width(size)) {
    std::size_t entries = 0;
    for (int b = 0; b < blocks(); ++b) entries += block_entries(b);
    data_ = make_zeroed(entries);
    entries_ = entries;
  }

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int blocks() const { return (size_ + width_ - 1) / width_; }
  /// Columns in a block; the last one may have fewer.
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int first_column(int block) const { return block * width_; }
  [[nodiscard]] int columns(int block) const { return std::min(width_, size_ - first_column(block)); }
  /// Rows of a block, from its first column down; also the distance from a column to the next.
  [[nodiscard]] int rows(int block) const { return size_ - first_column(block); }
  [[nodiscard]] double* block(int b) { return data_.get() + start(b); }

  /// column(j)[i] is the entry (i, j), i >= j.
  [[nodiscard]] double* column(int j) { return data_.get() + place(j); }
  [[nodiscard]] const double* column(int j) const { return data_.get() + place(j); }
  [[nodiscard]] std::size_t entries() const { return entries_; }

 private:
  [[nodiscard]] std::size_t block_entries(int b) const {
    return static_cast<std::size_t>(rows(b)) * static_cast<std::size_t>(columns(b));
  }
  [[nodiscard]] std::size_t start(int b) const {  // earlier blocks have all their columns: sum of width rows(k), k < b
    const auto n = static_cast<std::size_t>(b);
    const auto w = static_cast<std::size_t>(width_);
    return w * n * static_cast<std::size_t>(size_) + w * w * n / 2 - w * w * n * n / 2;
  }
  [[nodiscard]] std::ptrdiff_t place(int j) const {
    const int b = j / width_;
    return static_cast<std::ptrdiff_t>(start(b)) + std::ptrdiff_t{j - first_column(b)} * rows(b) - first_column(b);
  }

  int size_ = 0;
  int width_ = block_width(0);
  std::size_t entries_ = 0;
  Block data_;
};

}  // namespace rhexis::linalg
