#pragma once

/// Preconditioned conjugate gradients for any symmetric operator; Hestenes and Stiefel's recurrence, without
/// allocation.

#include <utility>

#include "base/vec.h"

namespace rhexis::linalg {

/// Vectors of the recurrence, kept between solves.
struct CgWorkspace {
  VectorX z;
  VectorX p;
  VectorX q;
  void resize(Eigen::Index size) {
    for (VectorX* v : {&z, &p, &q}) v->resize(size);
  }
};

enum class CgEnd { converged, too_many_iterations, negative_curvature };

struct CgResult {
  CgEnd end = CgEnd::converged;
  int iterations = 0;
};

/// apply(x, y): y = S x. precondition(r, z): z = M^-1 r. On entry r = b - S x, on return that residual as the
/// recurrence knows it. Stops when |r| <= target. p^T S p <= 0 or r^T M^-1 r <= 0 shows that S or M is not positive
/// definite.
template <class Apply, class Precondition>
CgResult conjugate_gradients(const Apply& apply, const Precondition& precondition, double target, int max_iterations,
                             CgWorkspace& work, VectorX& r, VectorX& x) {
  CgResult result;
  if (r.norm() <= target) return result;
  precondition(r, work.z);
  work.p = work.z;
  double rz = r.dot(work.z);
  for (; result.iterations < max_iterations;) {
    ++result.iterations;
    apply(work.p, work.q);
    const double curvature = work.p.dot(work.q);
    if (!(curvature > 0.0) || !(rz > 0.0)) {
      result.end = CgEnd::negative_curvature;
      return result;
    }
    const double step = rz / curvature;
    x += step * work.p;
    r -= step * work.q;
    if (r.norm() <= target) return result;
    precondition(r, work.z);
    const double next = r.dot(work.z);
    work.p = work.z + (next / rz) * work.p;
    rz = next;
  }
  result.end = CgEnd::too_many_iterations;
  return result;
}

}  // namespace rhexis::linalg
