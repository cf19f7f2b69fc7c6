#include "linalg/saddle_solver.h"

#include "base/check.h"
#include "linalg/condensed_cg.h"
#include "linalg/direct_solver.h"
#include "linalg/displacement_cg.h"
#include "linalg/linear_reports.h"
#include "linalg/minres_solver.h"

namespace rhexis::linalg {
namespace {

/// Conjugate gradients, on A or condensed, as the matrix has pressures.
class ConjugateGradients final : public SaddleSolver {
 public:
  LinearReport factor(const SaddleMatrix& K, const FreeDofs& free) override {
    if (K.skew) return skew_not_supported("cg");
    active_ = K.pressure_unknowns() > 0 ? static_cast<SaddleSolver*>(&condensed_) : &displacement_;
    return active_->factor(K, free);
  }
  LinearReport solve(const VectorX& bu, const VectorX& bp, double tolerance, VectorX& xu, VectorX& xp) override {
    RHEXIS_CHECK(active_ != nullptr, "solve without a factor");
    return active_->solve(bu, bp, tolerance, xu, xp);
  }
  [[nodiscard]] std::size_t memory_bytes() const override {
    return condensed_.memory_bytes() + displacement_.memory_bytes();
  }

 private:
  CondensedCg condensed_;
  DisplacementCg displacement_;
  SaddleSolver* active_ = nullptr;
};

}  // namespace

std::unique_ptr<SaddleSolver> make_saddle_solver(std::string_view name, const BlockPreconditioner* blocks) {
  if (name == "direct") return std::make_unique<DirectSolver>();
  if (name == "cg") return std::make_unique<ConjugateGradients>();
  RHEXIS_CHECK(name == "minres", "no linear solver '{}'", name);
  RHEXIS_CHECK(blocks != nullptr, "minres needs its preconditioner blocks");
  return std::make_unique<MinresSolver>(*blocks);
}

}  // namespace rhexis::linalg
