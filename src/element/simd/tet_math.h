/// Small algebra on packs, and the way between global arrays and lanes. Included once per instruction set, inside its
/// namespace.

/// kWidth lanes of a batch, from lane `first` on: what every kernel starts from.
struct TetLanes {
  Pack G[3][3];  ///< gradients of local nodes 1, 2, 3
  Pack volume;
  Pack F[9], cof[9];  ///< I + grad u, row-major; dJ/dF
  Pack J, J_minus_1;  ///< J - 1 by the invariants of grad u: accurate where J is near 1
};

RHEXIS_INLINE TetLanes load_lanes(const TetBatch& batch, int first, const double* u) {
  TetLanes t;
  t.volume = Pack::load(batch.volume + first);
  RHEXIS_UNROLL
  for (int a = 0; a < 3; ++a) {
    RHEXIS_UNROLL
    for (int j = 0; j < 3; ++j) t.G[a][j] = Pack::load(batch.gradient[3 * a + j] + first);
  }
  alignas(64) double lanes[12][kWidth];
  for (int i = 0; i < kWidth; ++i) {
    RHEXIS_UNROLL
    for (int a = 0; a < 4; ++a) {
      const double* from = u + 3 * static_cast<std::ptrdiff_t>(batch.node[a][first + i]);
      lanes[3 * a][i] = from[0];
      lanes[3 * a + 1][i] = from[1];
      lanes[3 * a + 2][i] = from[2];
    }
  }
  Pack H[9];
  RHEXIS_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Pack origin = Pack::load(lanes[i]);
    const Pack d1 = Pack::load(lanes[3 + i]) - origin, d2 = Pack::load(lanes[6 + i]) - origin,
               d3 = Pack::load(lanes[9 + i]) - origin;
    RHEXIS_UNROLL
    for (int j = 0; j < 3; ++j) H[3 * i + j] = d1 * t.G[0][j] + d2 * t.G[1][j] + d3 * t.G[2][j];
  }
  RHEXIS_UNROLL
  for (int i = 0; i < 9; ++i) t.F[i] = (i % 4 == 0) ? H[i] + 1.0 : H[i];
  cofactor(t.F, t.cof);
  Pack cof_H[9];
  cofactor(H, cof_H);
  t.J_minus_1 =
      (H[0] + H[4] + H[8]) + (cof_H[0] + cof_H[4] + cof_H[8]) + (H[0] * cof_H[0] + H[1] * cof_H[1] + H[2] * cof_H[2]);
  t.J = 1.0 + t.J_minus_1;
  return t;
}

/// Asks for what the next batch will add to: the nodes of a chunk are near each other in space, not in memory.
RHEXIS_INLINE void prefetch_blocks(const BlockPlaces& places, const double* blocks) {
  for (const auto& pair : places.block) {
    RHEXIS_UNROLL
    for (int lane = 0; lane < kBatch; ++lane) {
      __builtin_prefetch(blocks + 9 * static_cast<std::ptrdiff_t>(pair[lane]), 1);
      __builtin_prefetch(blocks + 9 * static_cast<std::ptrdiff_t>(pair[lane]) + 8, 1);
    }
  }
}
RHEXIS_INLINE void prefetch_coupling(const TetBatch& batch, const double* coupling) {
  RHEXIS_UNROLL
  for (int lane = 0; lane < kBatch; ++lane) {
    __builtin_prefetch(coupling + 12 * static_cast<std::ptrdiff_t>(batch.tet[lane]), 1);
    __builtin_prefetch(coupling + 12 * static_cast<std::ptrdiff_t>(batch.tet[lane]) + 8, 1);
  }
}

/// Global values of the tets of the lanes.
RHEXIS_INLINE Pack load_by_tet(const TetBatch& batch, int first, const double* values) {
  alignas(64) double lanes[kWidth];
  for (int i = 0; i < kWidth; ++i) lanes[i] = values[batch.tet[first + i]];
  return Pack::load(lanes);
}

RHEXIS_INLINE int live_lanes(const TetBatch& batch, int first) {
  const int left = batch.count - first;
  return left < kWidth ? left : kWidth;
}

RHEXIS_INLINE void store_by_tet(const TetBatch& batch, int first, Pack values, double* to) {
  alignas(64) double lanes[kWidth];
  values.store(lanes);
  const int live = live_lanes(batch, first);
  for (int i = 0; i < live; ++i) to[batch.tet[first + i]] = lanes[i];
}

/// V P G of the nodes, from the first Piola-Kirchhoff stress P: added to the global force. Returns J, or NaN in the
/// lanes whose force is not finite.
RHEXIS_INLINE Pack add_forces(const TetBatch& batch, int first, const TetLanes& t, const Pack (&P)[9], double* force) {
  Pack f[4][3];
  Pack poison = 0.0;
  RHEXIS_UNROLL
  for (int i = 0; i < 3; ++i) {
    RHEXIS_UNROLL
    for (int a = 0; a < 3; ++a) {
      f[a + 1][i] = t.volume * (P[3 * i] * t.G[a][0] + P[3 * i + 1] * t.G[a][1] + P[3 * i + 2] * t.G[a][2]);
    }
    f[0][i] = -(f[1][i] + f[2][i] + f[3][i]);
    poison = poison + 0.0 * f[0][i];
  }
  alignas(64) double lanes[12][kWidth];
  RHEXIS_UNROLL
  for (int a = 0; a < 4; ++a) {
    RHEXIS_UNROLL
    for (int i = 0; i < 3; ++i) f[a][i].store(lanes[3 * a + i]);
  }
  const int live = live_lanes(batch, first);
  for (int lane = 0; lane < live; ++lane) {
    RHEXIS_UNROLL
    for (int a = 0; a < 4; ++a) {
      double* to = force + 3 * static_cast<std::ptrdiff_t>(batch.node[a][first + lane]);
      to[0] += lanes[3 * a][lane];
      to[1] += lanes[3 * a + 1][lane];
      to[2] += lanes[3 * a + 2][lane];
    }
  }
  return t.J + poison;
}

/// Element stiffness by blocks over the local nodes 1, 2, 3, lower triangle: K[pair][3 i + j] of pairs (1,1), (2,1),
/// (2,2), (3,1), (3,2), (3,3). Diagonal blocks: entries i >= j alone are read.
struct Stiffness {
  Pack K[6][9];
};

/// Completes the element stiffness by node 0, whose rows are minus the sum of the others (a translation leaves no
/// force), and adds its ten blocks to the global ones. Returns J, or NaN in lanes that are not finite.
RHEXIS_INLINE Pack add_stiffness(const TetBatch& batch, const BlockPlaces& places, int first, const TetLanes& t,
                                 const Stiffness& stiffness, double* blocks) {
  const auto& K = stiffness.K;
  alignas(64) double lanes[90][kWidth];  // ten blocks in the order of BlockPlaces
  Pack poison = 0.0;
  Pack sum[9];  // K_10 + K_20 + K_30, and by symmetry minus K_00
  RHEXIS_UNROLL
  for (int i = 0; i < 3; ++i) {
    RHEXIS_UNROLL
    for (int j = 0; j < 3; ++j) {
      const int at = 3 * i + j, transposed = 3 * j + i;
      const int low = i >= j ? at : transposed;
      const Pack k11 = K[0][low], k22 = K[2][low], k33 = K[5][low];
      const Pack k10 = -(k11 + K[1][transposed] + K[3][transposed]);
      const Pack k20 = -(K[1][at] + k22 + K[4][transposed]);
      const Pack k30 = -(K[3][at] + K[4][at] + k33);
      sum[at] = k10 + k20 + k30;
      k10.store(lanes[9 + at]);
      k11.store(lanes[18 + at]);
      k20.store(lanes[27 + at]);
      K[1][at].store(lanes[36 + at]);
      k22.store(lanes[45 + at]);
      k30.store(lanes[54 + at]);
      K[3][at].store(lanes[63 + at]);
      K[4][at].store(lanes[72 + at]);
      k33.store(lanes[81 + at]);
    }
  }
  RHEXIS_UNROLL
  for (int i = 0; i < 3; ++i) {
    RHEXIS_UNROLL
    for (int j = 0; j < 3; ++j) {
      // The mean of both triangles: symmetric to the last bit.
      const Pack k00 = -0.5 * (sum[3 * i + j] + sum[3 * j + i]);
      k00.store(lanes[3 * i + j]);
      poison = poison + 0.0 * k00;
    }
  }
  const int live = live_lanes(batch, first);
  for (int lane = 0; lane < live; ++lane) {
    RHEXIS_UNROLL
    for (int pair = 0; pair < 10; ++pair) {
      double* to = blocks + 9 * static_cast<std::ptrdiff_t>(places.block[pair][first + lane]);
      RHEXIS_UNROLL
      for (int k = 0; k < 9; ++k) to[k] += lanes[9 * pair + k][lane];
    }
  }
  return t.J + poison;
}

/// Sum over the tets of the lanes, in their order.
RHEXIS_INLINE double sum_of_live(const TetBatch& batch, int first, Pack values) {
  alignas(64) double lanes[kWidth];
  values.store(lanes);
  const int live = live_lanes(batch, first);
  double sum = 0.0;
  for (int i = 0; i < live; ++i) sum += lanes[i];
  return sum;
}

/// B^T of each tet: V cof(F) G by nodes, dV(J - 1)/du.
RHEXIS_INLINE void store_coupling(const TetBatch& batch, int first, const TetLanes& t, double* coupling) {
  alignas(64) double lanes[12][kWidth];
  RHEXIS_UNROLL
  for (int i = 0; i < 3; ++i) {
    Pack sum = 0.0;
    RHEXIS_UNROLL
    for (int a = 0; a < 3; ++a) {
      const Pack b =
          t.volume * (t.cof[3 * i] * t.G[a][0] + t.cof[3 * i + 1] * t.G[a][1] + t.cof[3 * i + 2] * t.G[a][2]);
      b.store(lanes[3 * (a + 1) + i]);
      sum = sum - b;
    }
    sum.store(lanes[i]);
  }
  const int live = live_lanes(batch, first);
  for (int lane = 0; lane < live; ++lane) {
    double* to = coupling + 12 * static_cast<std::ptrdiff_t>(batch.tet[first + lane]);
    RHEXIS_UNROLL
    for (int k = 0; k < 12; ++k) to[k] = lanes[k][lane];
  }
}
