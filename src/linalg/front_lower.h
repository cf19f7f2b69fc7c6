#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace rhexis::linalg {

struct FreeZeroed {
  void operator()(double* data) const { std::free(data); }  // NOLINT(cppcoreguidelines-no-malloc)
};
using Zeroed = std::unique_ptr<double[], FreeZeroed>;

/// `count` zeros. By calloc: large pieces come from the system as zeros, and are not written twice.
[[nodiscard]] inline Zeroed make_zeroed(std::size_t count) {
  Zeroed out(static_cast<double*>(std::calloc(std::max<std::size_t>(count, 1), sizeof(double))));
  if (out == nullptr) throw std::bad_alloc();
  return out;
}

/// The lower triangle of a symmetric matrix, in blocks of whole columns that each start at the diagonal: half the
/// memory of a square, and BLAS updates it block by block.
class LowerTriangle {
 public:
  static constexpr int kBlock = 64;  ///< columns in a block; the last one may have fewer

  LowerTriangle() = default;
  /// All zero.
  explicit LowerTriangle(int size) : size_(size) {
    std::size_t entries = 0;
    for (int b = 0; b < blocks(); ++b) entries += block_entries(b);
    data_ = make_zeroed(entries);
    entries_ = entries;
  }

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int blocks() const { return (size_ + kBlock - 1) / kBlock; }
  [[nodiscard]] static int first_column(int block) { return block * kBlock; }
  [[nodiscard]] int columns(int block) const { return std::min(kBlock, size_ - first_column(block)); }
  /// Rows of a block, from its first column down; also the distance from a column to the next.
  [[nodiscard]] int rows(int block) const { return size_ - first_column(block); }
  [[nodiscard]] double* block(int b) { return data_.get() + start(b); }

  /// column(j)[i] is the entry (i, j), i >= j.
  [[nodiscard]] double* column(int j) { return data_.get() + place(j); }
  [[nodiscard]] const double* column(int j) const { return data_.get() + place(j); }
  [[nodiscard]] std::size_t memory_bytes() const { return entries_ * sizeof(double); }

 private:
  [[nodiscard]] std::size_t block_entries(int b) const {
    return static_cast<std::size_t>(rows(b)) * static_cast<std::size_t>(columns(b));
  }
  [[nodiscard]] std::size_t start(int b) const {  // earlier blocks have all their columns: sum of kBlock rows(k), k < b
    const auto n = static_cast<std::size_t>(b);
    return kBlock * n * static_cast<std::size_t>(size_) + kBlock * kBlock * n / 2 - kBlock * kBlock * n * n / 2;
  }
  [[nodiscard]] std::ptrdiff_t place(int j) const {
    const int b = j / kBlock;
    return static_cast<std::ptrdiff_t>(start(b)) + std::ptrdiff_t{j - first_column(b)} * rows(b) - first_column(b);
  }

  int size_ = 0;
  std::size_t entries_ = 0;
  Zeroed data_;
};

}  // namespace rhexis::linalg
