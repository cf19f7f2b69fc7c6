/// The rotation nearest to F, batched. Included once per instruction set, inside its namespace.

/// The rotation R (det +1) that maximises tr(R^T F), also for inverted F, and t = tr(R^T F),
/// zeta = (t^2 - |F|^2)/2 t - det F = (s1 + s2)(s2 + s3)(s3 + s1) of the singular values, s3 signed.
struct Polar {
  Pack R[9];
  Pack t, zeta;
};

/// Below this zeta / t^3 the rotation is nearly arbitrary in a plane (s2 + s3 < 1e-3 s1 or so), and the closed form
/// loses digits: those lanes go the slow way.
inline constexpr double kPoorPolar = 1e-3;

/// Out of line: rare, and calls baseline code.
[[gnu::noinline]] void repair_poor_lanes(const Pack (&F)[9], Polar& polar) {
  for (int lane = 0; lane < kWidth; ++lane) {
    const double t = polar.t.v[lane];
    if (polar.zeta.v[lane] > kPoorPolar * t * t * t) continue;
    double f[9], r[9];
    for (int i = 0; i < 9; ++i) f[i] = F[i].v[lane];
    rotation_by_eigenvectors(f, r);
    double trace = 0.0, norm2 = 0.0;
    for (int i = 0; i < 9; ++i) {
      polar.R[i].v[lane] = r[i];
      trace += r[i] * f[i];
      norm2 += f[i] * f[i];
    }
    const double det =
        f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) + f[2] * (f[3] * f[7] - f[4] * f[6]);
    polar.t.v[lane] = trace;
    polar.zeta.v[lane] = 0.5 * (trace * trace - norm2) * trace - det;
  }
}

/// With t known, R = ((k + |F|^2) F + t cof F - F F^T F) / zeta, k = (t^2 - |F|^2)/2 (Markley 1993, the fast optimal
/// attitude matrix). t is the largest root of t^4 - 2 |F|^2 t^2 - 8 det(F) t + |F|^4 - 4 |cof F|^2, whose slope
/// there is 8 zeta; Newton from above falls towards it monotonically.
RHEXIS_INLINE Polar polar_of(const Pack (&F)[9], Pack det) {
  Pack cof[9];
  cofactor(F, cof);
  Pack a = F[0] * F[0], b = cof[0] * cof[0];
  RHEXIS_UNROLL
  for (int i = 1; i < 9; ++i) {
    a = a + F[i] * F[i];
    b = b + cof[i] * cof[i];
  }
  const Pack constant = a * a - 4.0 * b;
  // sqrt(3 |F|^2) >= t, from above by two of Heron's steps; exact where |F|^2 = 3.
  Pack t = 0.5 * (a + 3.0);
  t = 0.5 * (t + 3.0 * a / t);
  Pack zeta;
  const auto newton = [&]() __attribute__((always_inline)) {
    const Pack t2 = t * t;
    const Pack k = 0.5 * (t2 - a);
    zeta = k * t - det;
    const Pack value = t2 * (t2 - 2.0 * a) - 8.0 * det * t + constant;
    const Pack step = value / (8.0 * zeta);
    t = t - step;
    return step;
  };
  newton();
  newton();
  // Quadratic: after a step of 1e-9 t the error is at rounding. Lanes that are still far (F hundreds of times larger or
  // smaller than a rotation, or rank one) count as poor.
  Pack step = newton();
  for (int i = 0; i < 12 && !all_less(abs(step), 1e-9 * t); ++i) step = newton();
  const Pack k = 0.5 * (t * t - a);
  Polar out;
  out.t = t;
  out.zeta = zeta = where_less(abs(step), 1e-9 * t, k * t - det, 0.0);
  const Pack inverse = 1.0 / zeta;
  const Pack diagonal = k + a;
  // F F^T F, through the symmetric F F^T.
  const Pack b00 = F[0] * F[0] + F[1] * F[1] + F[2] * F[2], b11 = F[3] * F[3] + F[4] * F[4] + F[5] * F[5],
             b22 = F[6] * F[6] + F[7] * F[7] + F[8] * F[8], b10 = F[3] * F[0] + F[4] * F[1] + F[5] * F[2],
             b21 = F[6] * F[3] + F[7] * F[4] + F[8] * F[5], b20 = F[6] * F[0] + F[7] * F[1] + F[8] * F[2];
  RHEXIS_UNROLL
  for (int j = 0; j < 3; ++j) {
    const Pack x = F[j], y = F[3 + j], z = F[6 + j];
    out.R[j] = ((diagonal - b00) * x - b10 * y - b20 * z + t * cof[j]) * inverse;
    out.R[3 + j] = ((diagonal - b11) * y - b10 * x - b21 * z + t * cof[3 + j]) * inverse;
    out.R[6 + j] = ((diagonal - b22) * z - b20 * x - b21 * y + t * cof[6 + j]) * inverse;
  }
  if (!all_less(kPoorPolar * (t * t * t), zeta)) [[unlikely]]
    repair_poor_lanes(F, out);
  return out;
}
