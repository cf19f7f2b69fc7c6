/// Energy density, first Piola-Kirchhoff stress and stiffness of each response, on packs. Included once per instruction
/// set, inside its namespace. Stiffness is per unit volume: the caller scales it by V.

template <class Response>
struct Kernel;

RHEXIS_INLINE Pack dot(const Pack (&a)[3], const Pack (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// calls body(pair, a, b) for the pairs of Stiffness, a >= b in 0..2 (local nodes less one).
template <class Body>
RHEXIS_INLINE void for_pairs(const Body& body) {
  body(0, 0, 0);
  body(1, 1, 0);
  body(2, 1, 1);
  body(3, 2, 0);
  body(4, 2, 1);
  body(5, 2, 2);
}

/// lambda g_a g_b^T + mu (g_b g_a^T + (g_a . g_b) I): small strain with the gradients g, which may be rotated.
RHEXIS_INLINE void small_strain_stiffness(const Pack (&g)[3][3], Pack volume, double lame_lambda, double lame_mu,
                                          Stiffness& out) {
  const Pack lambda = lame_lambda * volume, mu = lame_mu * volume;
  for_pairs([&](int pair, int a, int b) __attribute__((always_inline)) {
    const Pack diagonal = mu * dot(g[a], g[b]);
    RHEXIS_UNROLL
    for (int i = 0; i < 3; ++i) {
      const Pack left = lambda * g[a][i], right = mu * g[b][i];
      RHEXIS_UNROLL
      for (int j = 0; j < 3; ++j) {
        if (a == b && j > i) continue;
        const Pack k = left * g[b][j] + right * g[a][j];
        out.K[pair][3 * i + j] = i == j ? k + diagonal : k;
      }
    }
  });
}

template <>
struct Kernel<SmallStrain> {
  RHEXIS_INLINE static Pack energy(const SmallStrain& m, const TetLanes& t) {
    const Pack xx = t.F[0] - 1.0, yy = t.F[4] - 1.0, zz = t.F[8] - 1.0;
    const Pack xy = t.F[1] + t.F[3], yz = t.F[5] + t.F[7], xz = t.F[2] + t.F[6];
    const Pack tr = xx + yy + zz;
    return m.lame_mu * (xx * xx + yy * yy + zz * zz + 0.5 * (xy * xy + yz * yz + xz * xz)) +
           0.5 * m.lame_lambda * tr * tr;
  }
  RHEXIS_INLINE static void stress(const SmallStrain& m, const TetLanes& t, Pack (&P)[9]) {
    const Pack mean = m.lame_lambda * (t.F[0] + t.F[4] + t.F[8] - 3.0);
    const double mu = m.lame_mu;
    P[0] = mean + 2.0 * mu * (t.F[0] - 1.0);
    P[4] = mean + 2.0 * mu * (t.F[4] - 1.0);
    P[8] = mean + 2.0 * mu * (t.F[8] - 1.0);
    P[1] = P[3] = mu * (t.F[1] + t.F[3]);
    P[5] = P[7] = mu * (t.F[5] + t.F[7]);
    P[2] = P[6] = mu * (t.F[2] + t.F[6]);
  }
  RHEXIS_INLINE static void stiffness(const SmallStrain& m, const TetLanes& t, Stiffness& out) {
    small_strain_stiffness(t.G, t.volume, m.lame_lambda, m.lame_mu, out);
  }
};

/// g = R G.
RHEXIS_INLINE void rotate_gradients(const Pack (&R)[9], const Pack (&G)[3][3], Pack (&g)[3][3]) {
  RHEXIS_UNROLL
  for (int a = 0; a < 3; ++a) {
    RHEXIS_UNROLL
    for (int i = 0; i < 3; ++i) g[a][i] = R[3 * i] * G[a][0] + R[3 * i + 1] * G[a][1] + R[3 * i + 2] * G[a][2];
  }
}

/// P = 2 mu (F - R) + lambda tr(R^T F - I) R, which is R K_e (R^T x - X) by nodes.
struct CorotatedForce {
  RHEXIS_INLINE static Pack energy(const Corotated& m, const TetLanes& t) {
    const Polar polar = polar_of(t.F, t.J);
    Pack distance = 0.0;
    RHEXIS_UNROLL
    for (int i = 0; i < 9; ++i) distance = distance + (t.F[i] - polar.R[i]) * (t.F[i] - polar.R[i]);
    const Pack stretch = polar.t - 3.0;
    return m.lame_mu * distance + 0.5 * m.lame_lambda * stretch * stretch;
  }
  RHEXIS_INLINE static void stress(const Corotated& m, const TetLanes& t, Pack (&P)[9]) {
    const Polar polar = polar_of(t.F, t.J);
    const Pack stretch = m.lame_lambda * (polar.t - 3.0);
    RHEXIS_UNROLL
    for (int i = 0; i < 9; ++i) P[i] = 2.0 * m.lame_mu * (t.F[i] - polar.R[i]) + stretch * polar.R[i];
  }
};

template <>
struct Kernel<WarpedCorotated> : CorotatedForce {
  RHEXIS_INLINE static void stiffness(const WarpedCorotated& m, const TetLanes& t, Stiffness& out) {
    const Polar polar = polar_of(t.F, t.J);
    Pack g[3][3];
    rotate_gradients(polar.R, t.G, g);
    small_strain_stiffness(g, t.volume, m.lame_lambda, m.lame_mu, out);
  }
};

/// With V = F R^T the left stretch, H = tr(V) I - V, c = lambda tr(R^T F - I) - 2 mu and g = R G: differentiating P,
///     K_ab = 2 mu (G_a . G_b) I + lambda g_a g_b^T + c [g_a]x^T H^-1 [g_b]x,
/// since dR = [H^-1 sum_b g_b x du_b]x R. det H = zeta vanishes where the rotation is not unique (s2 + s3 = 0); there
/// it is held above a millionth of its scale, so that the tangent stays finite.
template <>
struct Kernel<Corotated> : CorotatedForce {
  RHEXIS_INLINE static void stiffness(const Corotated& m, const TetLanes& t, Stiffness& out) {
    const Polar polar = polar_of(t.F, t.J);
    Pack g[3][3];
    rotate_gradients(polar.R, t.G, g);
    const auto &F = t.F, &R = polar.R;
    const auto left = [&](int i, int j) __attribute__((always_inline)) {
      return F[3 * i] * R[3 * j] + F[3 * i + 1] * R[3 * j + 1] + F[3 * i + 2] * R[3 * j + 2];
    };
    // In degenerate lanes F R^T is symmetric to rounding of the slow way only; the mean is exact to second order.
    const Sym<Pack> H{polar.t - left(0, 0),
                      polar.t - left(1, 1),
                      polar.t - left(2, 2),
                      -0.5 * (left(0, 1) + left(1, 0)),
                      -0.5 * (left(1, 2) + left(2, 1)),
                      -0.5 * (left(0, 2) + left(2, 0))};
    const Pack floor = 1e-6 * (polar.t * polar.t * polar.t) + 1e-300;
    const Pack det = where_less(polar.zeta, floor, floor, polar.zeta);
    const Pack c = (m.lame_lambda * (polar.t - 3.0) - 2.0 * m.lame_mu) * t.volume / det;
    const Sym<Pack> Q = material::scaled(material::adjugate(H), c);
    const Pack lambda = m.lame_lambda * t.volume, two_mu = 2.0 * m.lame_mu * t.volume;
    Pack QX[3][9];  // Q [g_b]x
    RHEXIS_UNROLL
    for (int b = 0; b < 3; ++b) {
      const Pack x = g[b][0], y = g[b][1], z = g[b][2];
      const Pack row[3][3] = {{Q.xx, Q.xy, Q.xz}, {Q.xy, Q.yy, Q.yz}, {Q.xz, Q.yz, Q.zz}};
      RHEXIS_UNROLL
      for (int i = 0; i < 3; ++i) {
        QX[b][3 * i] = row[i][1] * z - row[i][2] * y;
        QX[b][3 * i + 1] = row[i][2] * x - row[i][0] * z;
        QX[b][3 * i + 2] = row[i][0] * y - row[i][1] * x;
      }
    }
    for_pairs([&](int pair, int a, int b) __attribute__((always_inline)) {
      const Pack diagonal = two_mu * dot(t.G[a], t.G[b]);
      const Pack x = g[a][0], y = g[a][1], z = g[a][2];
      RHEXIS_UNROLL
      for (int j = 0; j < 3; ++j) {
        const Pack q0 = QX[b][j], q1 = QX[b][3 + j], q2 = QX[b][6 + j];
        const Pack along = lambda * g[b][j];
        Pack k[3] = {along * x + (z * q1 - y * q2), along * y + (x * q2 - z * q0), along * z + (y * q0 - x * q1)};
        k[j] = k[j] + diagonal;
        RHEXIS_UNROLL
        for (int i = 0; i < 3; ++i) {
          if (a == b && j > i) continue;
          out.K[pair][3 * i + j] = k[i];
        }
      }
    });
  }
};

/// P = F S.
RHEXIS_INLINE void first_piola(const Pack (&F)[9], const Sym<Pack>& S, Pack (&P)[9]) {
  RHEXIS_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Pack x = F[3 * i], y = F[3 * i + 1], z = F[3 * i + 2];
    P[3 * i] = x * S.xx + y * S.xy + z * S.xz;
    P[3 * i + 1] = x * S.xy + y * S.yy + z * S.yz;
    P[3 * i + 2] = x * S.xz + y * S.yz + z * S.zz;
  }
}

/// K_ab = B_a^T D B_b + (G_a . S G_b) I with dE = B_b du_b, for any S and D = dS/dE.
RHEXIS_INLINE void total_lagrangian_stiffness(const TetLanes& t, const Sym<Pack>& S, const Sym66<Pack>& D,
                                              Stiffness& out) {
  const auto& F = t.F;
  Pack B[3][6][3], SG[3][3];
  RHEXIS_UNROLL
  for (int a = 0; a < 3; ++a) {
    const Pack x = t.G[a][0], y = t.G[a][1], z = t.G[a][2];
    RHEXIS_UNROLL
    for (int i = 0; i < 3; ++i) {
      const Pack f0 = F[3 * i], f1 = F[3 * i + 1], f2 = F[3 * i + 2];
      B[a][0][i] = f0 * x;
      B[a][1][i] = f1 * y;
      B[a][2][i] = f2 * z;
      B[a][3][i] = f0 * y + f1 * x;
      B[a][4][i] = f1 * z + f2 * y;
      B[a][5][i] = f0 * z + f2 * x;
    }
    SG[a][0] = t.volume * (S.xx * x + S.xy * y + S.xz * z);
    SG[a][1] = t.volume * (S.xy * x + S.yy * y + S.yz * z);
    SG[a][2] = t.volume * (S.xz * x + S.yz * y + S.zz * z);
  }
  RHEXIS_UNROLL
  for (int b = 0; b < 3; ++b) {
    RHEXIS_UNROLL
    for (int j = 0; j < 3; ++j) {
      Pack DB[6];
      RHEXIS_UNROLL
      for (int r = 0; r < 6; ++r) {
        Pack sum = D(r, 0) * B[b][0][j];
        RHEXIS_UNROLL
        for (int s = 1; s < 6; ++s) sum = sum + D(r, s) * B[b][s][j];
        DB[r] = t.volume * sum;
      }
      RHEXIS_UNROLL
      for (int a = 0; a < 3; ++a) {
        if (a < b) continue;
        const int pair = a * (a + 1) / 2 + b;
        RHEXIS_UNROLL
        for (int i = 0; i < 3; ++i) {
          if (a == b && j > i) continue;
          Pack k = B[a][0][i] * DB[0];
          RHEXIS_UNROLL
          for (int r = 1; r < 6; ++r) k = k + B[a][r][i] * DB[r];
          out.K[pair][3 * i + j] = i == j ? k + dot(t.G[a], SG[b]) : k;
        }
      }
    }
  }
}

/// A law that holds the volume change as well: pure displacement.
template <>
struct Kernel<material::StVenantKirchhoffLaw> {
  using Law = material::StVenantKirchhoffLaw;
  RHEXIS_INLINE static Pack energy(const Law& law, const TetLanes& t) {
    return law.energy(material::deformation_of(t.F, t.J));
  }
  RHEXIS_INLINE static void stress(const Law& law, const TetLanes& t, Pack (&P)[9]) {
    first_piola(t.F, law.stress(material::deformation_of(t.F, t.J)), P);
  }
  RHEXIS_INLINE static void stiffness(const Law& law, const TetLanes& t, Stiffness& out) {
    const Deformation<Pack> d = material::deformation_of(t.F, t.J);
    total_lagrangian_stiffness(t, law.stress(d), law.tangent(d), out);
  }
};
