#include "linalg/saddle_triplets.h"

#include "base/check.h"

namespace rhexis::linalg {

SaddleTriplets::SaddleTriplets(const SaddleMatrix& K, const FreeDofs& free, bool general)
    : general_(general), size_(free.count() + K.pressure_unknowns()), free_count_(free.count()) {
  RHEXIS_CHECK(free.index.size() == static_cast<std::size_t>(K.displacement_unknowns()), "{} dofs for {} unknowns",
               free.index.size(), K.displacement_unknowns());
  if (K.A.pattern) add_a(*K.A.pattern, free);
  if (K.pressure_unknowns() > 0) add_b(*K.B.pattern, free);
  coupling_end_ = rows_.size();
  if (K.pressure_unknowns() > 0) add_c(*K.C.pattern);
}

void SaddleTriplets::add(std::int32_t row, std::int32_t column, std::size_t source) {
  rows_.push_back(row + 1);
  columns_.push_back(column + 1);
  source_.push_back(static_cast<std::uint32_t>(source));
}

void SaddleTriplets::add_a(const BlockPattern& pattern, const FreeDofs& free) {
  const auto for_each_entry = [&](const auto& use) {
    for (const std::int32_t dof : free.dof) {
      const auto node = static_cast<std::size_t>(dof / 3);
      for (auto k = static_cast<std::size_t>(pattern.row_start[node]);
           k < static_cast<std::size_t>(pattern.row_start[node + 1]); ++k) {
        for (std::int32_t b = 0; b < 3; ++b) {
          const std::int32_t other = 3 * pattern.column[k] + b;
          const std::int32_t column = free.index[static_cast<std::size_t>(other)];
          if (column < 0) continue;
          use(free.index[static_cast<std::size_t>(dof)], column, static_cast<std::int32_t>(node) == pattern.column[k],
              9 * k + static_cast<std::size_t>(3 * (dof % 3) + b));
        }
      }
    }
  };
  for_each_entry([&](std::int32_t row, std::int32_t column, bool diagonal, std::size_t source) {
    if (!diagonal || general_ || column <= row) add(row, column, source);
  });
  lower_end_ = rows_.size();
  if (general_) {
    for_each_entry([&](std::int32_t row, std::int32_t column, bool diagonal, std::size_t source) {
      if (!diagonal) add(column, row, source);
    });
  }
  upper_end_ = rows_.size();
}

void SaddleTriplets::add_b(const CsrPattern& pattern, const FreeDofs& free) {
  for (std::int32_t p = 0; p < pattern.rows(); ++p) {
    const std::int32_t row = free_count_ + p;
    for (auto k = static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(p)]);
         k < static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(p) + 1]); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::int32_t column = free.index[3 * static_cast<std::size_t>(pattern.column[k]) + c];
        if (column < 0) continue;
        add(row, column, 3 * k + c);
        if (general_) add(column, row, 3 * k + c);
      }
    }
  }
}

void SaddleTriplets::add_c(const CsrPattern& pattern) {
  for (std::int32_t p = 0; p < pattern.rows(); ++p) {
    for (auto k = static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(p)]);
         k < static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(p) + 1]); ++k) {
      add(free_count_ + p, free_count_ + pattern.column[k], k);
      if (general_ && pattern.column[k] != p) add(free_count_ + pattern.column[k], free_count_ + p, k);
    }
  }
}

void SaddleTriplets::gather(const SaddleMatrix& K, std::vector<double>& values) const {
  values.resize(source_.size());
  std::size_t i = 0;
  if (K.skew) {
    const std::vector<double>& skew = K.skew->values;
    for (; i < lower_end_; ++i) values[i] = K.A.values[source_[i]] + skew[source_[i]];
    for (; i < upper_end_; ++i) values[i] = K.A.values[source_[i]] - skew[source_[i]];
  }
  for (; i < upper_end_; ++i) values[i] = K.A.values[source_[i]];
  for (; i < coupling_end_; ++i) values[i] = K.B.values[source_[i]];
  for (; i < source_.size(); ++i) values[i] = -K.C.values[source_[i]];
}

std::size_t SaddleTriplets::memory_bytes() const {
  return sizeof(std::int32_t) * (rows_.capacity() + columns_.capacity() + source_.capacity());
}

}  // namespace rhexis::linalg
