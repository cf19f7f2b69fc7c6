#pragma once

/// What an analysis was made for. Patterns are compared by address first and by content only when that differs: a
/// topology that was rebuilt without a change keeps its analysis.

#include <memory>

#include "linalg/saddle_matrix.h"

namespace rhexis::linalg {

class SystemKey {
 public:
  SystemKey() = default;
  SystemKey(const SaddleMatrix& K, const FreeDofs& free)
      : a_(K.A.pattern), b_(K.B.pattern), c_(K.C.pattern), free_(free), skew_(K.skew.has_value()), made_(true) {}

  [[nodiscard]] bool matches(const SaddleMatrix& K, const FreeDofs& free) const {
    return made_ && skew_ == K.skew.has_value() && free_.index.size() == free.index.size() && free_.dof == free.dof &&
           same(a_, K.A.pattern) && same(b_, K.B.pattern) && same(c_, K.C.pattern);
  }
  [[nodiscard]] const FreeDofs& free() const { return free_; }

 private:
  template <class Pattern>
  static bool same(const std::shared_ptr<const Pattern>& one, const std::shared_ptr<const Pattern>& other) {
    if (one == other) return true;
    return one && other && one->row_start == other->row_start && one->column == other->column;
  }

  std::shared_ptr<const BlockPattern> a_;  // held, so that an address is not given to another pattern
  std::shared_ptr<const CsrPattern> b_;
  std::shared_ptr<const CsrPattern> c_;
  FreeDofs free_;
  bool skew_ = false;
  bool made_ = false;
};

}  // namespace rhexis::linalg
