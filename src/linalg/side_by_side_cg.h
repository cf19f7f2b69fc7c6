#pragma once

/// Conjugate gradients (conjugate_gradients.h) on k systems side by side, a lane each. A lane that has come to its end
/// stays as it is while the others go on, its direction with it, and none knows of the others: the same bits whatever
/// they do.

#include <array>
#include <cmath>
#include <cstddef>

#include "linalg/conjugate_gradients.h"
#include "linalg/lanes.h"

namespace rhexis::linalg {

template <int k>
struct CgLanes {
  Lanes<k> z, p, q;
  void resize(Eigen::Index size) {
    for (Lanes<k>* v : {&z, &p, &q}) v->resize(size, k);
  }
};

struct LaneTarget {
  double norm = 0.0;  ///< of the residual
  int most = 0;       ///< iterations; 0: the lane is left alone
};

struct LaneResult {
  CgEnd end = CgEnd::converged;
  int iterations = 0;
  double slope = 0.0, curvature = 0.0;  ///< r^T M^-1 r and p^T S p where that curvature was met
};

/// As conjugate_gradients, lane by lane. took(step): x has gone on by step (a PerLane) times the direction that apply
/// was last called with.
template <int k, class Apply, class Precondition, class Took>
std::array<LaneResult, k> conjugate_gradients(const Apply& apply, const Precondition& precondition, const Took& took,
                                              const std::array<LaneTarget, k>& target, CgLanes<k>& work, Lanes<k>& r,
                                              Lanes<k>& x) {
  std::array<LaneResult, k> out;
  std::array<bool, k> active;
  bool any = false;
  const auto look = [&] {  // who has reached his target
    const PerLane<k> norm = dots<k>(r, r).sqrt();
    any = false;
    for (std::size_t l = 0; l < k; ++l) {
      if (!active[l]) continue;
      const bool reached = !(norm[static_cast<Eigen::Index>(l)] > target[l].norm);
      if (!reached && out[l].iterations >= target[l].most) out[l].end = CgEnd::too_many_iterations;
      active[l] = !reached && out[l].end == CgEnd::converged;
      any = any || active[l];
    }
  };
  for (std::size_t l = 0; l < k; ++l) active[l] = target[l].most > 0;
  look();
  if (!any) return out;
  precondition(r, work.z);
  work.p = work.z;
  PerLane<k> rz = dots<k>(r, work.z);
  while (true) {
    apply(work.p, work.q);
    const PerLane<k> curvature = dots<k>(work.p, work.q);
    PerLane<k> step = PerLane<k>::Zero();
    for (std::size_t l = 0; l < k; ++l) {
      if (!active[l]) continue;
      const auto lane = static_cast<Eigen::Index>(l);
      ++out[l].iterations;
      if (curvature[lane] > 0.0 && rz[lane] > 0.0) {
        step[lane] = rz[lane] / curvature[lane];
      } else {
        out[l].end = CgEnd::negative_curvature;
        out[l].slope = rz[lane];
        out[l].curvature = curvature[lane];
      }
    }
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      x.row(i).array() += step * work.p.row(i).array();
      r.row(i).array() -= step * work.q.row(i).array();
    }
    took(step);
    look();
    if (!any) return out;
    precondition(r, work.z);
    const PerLane<k> next = dots<k>(r, work.z);
    PerLane<k> fresh = PerLane<k>::Zero();
    PerLane<k> old = PerLane<k>::Ones();
    for (Eigen::Index lane = 0; lane < k; ++lane) {
      if (!active[static_cast<std::size_t>(lane)]) continue;
      fresh[lane] = 1.0;
      old[lane] = next[lane] / rz[lane];
      rz[lane] = next[lane];
    }
    for (Eigen::Index i = 0; i < r.rows(); ++i)
      work.p.row(i) = fresh * work.z.row(i).array() + old * work.p.row(i).array();
  }
}

}  // namespace rhexis::linalg
