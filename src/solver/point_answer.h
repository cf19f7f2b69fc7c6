#pragma once

/// Z = K^-1 N^T, the answer of a live body to the hand that holds a point of it, by columns: kept from frame to frame,
/// turned with the body, and solved for again where it no longer fits the tangent.

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "linalg/lanes.h"
#include "linalg/saddle_residual.h"
#include "model/model.h"
#include "solver/live_linear.h"

namespace rhexis::solver {

class PointAnswer {
 public:
  /// How far it is to be brought.
  struct Wanted {
    double residual = 0.0;  ///< of each column, relative to N^T
    int iterations = 0;     ///< at most
  };
  /// Another system of the same tangent that is solved beside the columns, which costs little more than they do.
  struct Beside {
    LiveOrder order;
    const VectorX& bu;
    const VectorX& bp;
    VectorX& xu;
    VectorX& xp;
    LiveSolve solve;
  };
  struct Report {
    int iterations = 0;
    bool worn = false;  ///< a column did not come nearer: the preconditioner does not fit any more
  };

  /// The first answer of `linear`, whose tangent has been set.
  void begin(const HeldPoint& point, LiveLinear& linear);
  /// The body has torn and has new nodes, copies of these.
  void follow(std::span<const std::int32_t> copied);
  /// As it would be of a body that has done nothing since but turn: T Z R^T, R the turn of the point.
  void turn(const LiveLinear& linear, const linalg::FreeDofs& free);
  /// K dZ = N^T - K Z, of all columns that need it, side by side.
  Report refresh(const linalg::SaddleMatrix& K, const linalg::FreeDofs& free, LiveLinear& linear,
                 const Wanted& wanted) {
    return refresh_columns<4>(0, K, free, linear, wanted, nullptr);
  }
  /// Of one column, if it needs it, and `beside` in any case.
  Report refresh(int column, const linalg::SaddleMatrix& K, const linalg::FreeDofs& free, LiveLinear& linear,
                 const Wanted& wanted, Beside& beside) {
    return refresh_columns<2>(column, K, free, linear, wanted, &beside);
  }

  /// N Z, m/N.
  [[nodiscard]] Mat3 compliance() const;
  /// (u, lambda) += Z f.
  void add(const Vec3& f, model::State& state) const;
  /// (u, lambda) += T Z f, T the turn of the nodes to `now`, f such that the point moves by `gap`, m.
  void add_turned(const std::vector<Mat3>& now, const Vec3& gap, const linalg::FreeDofs& free, model::State& state);
  /// Z^T r.
  [[nodiscard]] Vec3 dot(const model::Residual& r) const;

 private:
  /// Columns to a lane each, the last lane is for what is solved beside.
  template <int k>
  struct Work {
    linalg::Lanes<k> xu, xp, left_u, left_p, du, dp;
  };
  template <int k>
  Report refresh_columns(int first, const linalg::SaddleMatrix& K, const linalg::FreeDofs& free, LiveLinear& linear,
                         const Wanted& wanted, Beside* beside);
  /// Leaves N^T - K Z; gives the size of each column of it, relative to N^T.
  template <int k>
  linalg::PerLane<k> measure(int first, const linalg::SaddleMatrix& K, const linalg::FreeDofs& free, Work<k>& work);
  template <int k>
  int solve(LiveLinear& linear, const std::array<LiveOrder, k>& columns, Beside* beside, Work<k>& work);

  HeldPoint point_;
  linalg::FourLanes u_, lambda_;  ///< columns of Z, and one of zeros
  std::vector<Mat3> rotation_;    ///< per node, where Z belongs
  VectorX move_;                  ///< work space of add_turned, m
  linalg::SaddleResidual scale_;
  std::tuple<Work<2>, Work<4>> work_;
};

}  // namespace rhexis::solver
