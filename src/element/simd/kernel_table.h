/// The loops over batches, and the table of function pointers. Included once per instruction set, inside its namespace,
/// after the responses.

template <class Response>
struct DisplacementLoops {
  using Model = Kernel<Response>;

  static double energy(const Response& response, const TetRun& run, const double* u) {
    double total = 0.0;
    for (std::int32_t i = 0; i < run.count; ++i) {
      const TetBatch& batch = run.batches[i];
      for (int first = 0; first < batch.count; first += kWidth) {
        const TetLanes t = load_lanes(batch, first, u);
        total += sum_of_live(batch, first, t.volume * Model::energy(response, t));
      }
    }
    return total;
  }

  static void residual(const Response& response, const TetRun& run, const double* u, double* force, double* J) {
    for (std::int32_t i = 0; i < run.count; ++i) {
      const TetBatch& batch = run.batches[i];
      for (int first = 0; first < batch.count; first += kWidth) {
        const TetLanes t = load_lanes(batch, first, u);
        Pack P[9];
        Model::stress(response, t, P);
        store_by_tet(batch, first, add_forces(batch, first, t, P, force), J);
      }
    }
  }

  static void tangent(const Response& response, const TetRun& run, const double* u, double* blocks, double* J) {
    for (std::int32_t i = 0; i < run.count; ++i) {
      const TetBatch& batch = run.batches[i];
      for (int first = 0; first < batch.count; first += kWidth) {
        const TetLanes t = load_lanes(batch, first, u);
        Stiffness stiffness;
        Model::stiffness(response, t, stiffness);
        store_by_tet(batch, first, add_stiffness(batch, run.places[i], first, t, stiffness, blocks), J);
      }
    }
  }

  static constexpr DisplacementKernels<Response> table() { return {&energy, &residual, &tangent}; }
};

/// Law + lambda (J - 1): S = S_law + lambda J C^-1.
template <class Law>
struct MixedLoops {
  static double energy(const Law& law, const TetRun& run, const double* u, const double* lambda) {
    double total = 0.0;
    for (std::int32_t i = 0; i < run.count; ++i) {
      const TetBatch& batch = run.batches[i];
      for (int first = 0; first < batch.count; first += kWidth) {
        const TetLanes t = load_lanes(batch, first, u);
        const Pack density = law.energy(material::deformation_of(t.F, t.J));
        const Pack mean = load_by_tet(batch, first, lambda);
        total += sum_of_live(batch, first, t.volume * (density + mean * t.J_minus_1));
      }
    }
    return total;
  }

  static void residual(const Law& law, const TetRun& run, const double* u, const double* lambda, double* force,
                       double* volume, double* J) {
    for (std::int32_t i = 0; i < run.count; ++i) {
      const TetBatch& batch = run.batches[i];
      for (int first = 0; first < batch.count; first += kWidth) {
        const TetLanes t = load_lanes(batch, first, u);
        const Pack mean = load_by_tet(batch, first, lambda);
        Pack P[9];
        first_piola(t.F, law.stress(material::deformation_of(t.F, t.J)), P);
        RHEXIS_UNROLL
        for (int k = 0; k < 9; ++k) P[k] = P[k] + mean * t.cof[k];
        store_by_tet(batch, first, add_forces(batch, first, t, P, force), J);
        const Pack before = load_by_tet(batch, first, volume);
        store_by_tet(batch, first, before + t.volume * t.J_minus_1, volume);
      }
    }
  }

  static void tangent(const Law& law, const TetRun& run, const double* u, const double* lambda, double* blocks,
                      double* coupling, double* J) {
    for (std::int32_t i = 0; i < run.count; ++i) {
      const TetBatch& batch = run.batches[i];
      if (i + 1 < run.count) {
        prefetch_blocks(run.places[i + 1], blocks);
        prefetch_coupling(run.batches[i + 1], coupling);
      }
      for (int first = 0; first < batch.count; first += kWidth) {
        const TetLanes t = load_lanes(batch, first, u);
        const Deformation<Pack> d = material::deformation_of(t.F, t.J);
        const Pack pull = load_by_tet(batch, first, lambda) * t.J;
        const Sym<Pack> S = material::plus_scaled(law.stress(d), pull, d.Cinv);
        // d(lambda J C^-1)/dE = lambda J (C^-1 (x) C^-1 - 2 C^-1 . C^-1)
        Sym66<Pack> D = law.tangent(d);
        material::add_symmetric_product(material::scaled(d.Cinv, Pack(0.5 * pull)), d.Cinv, D);
        material::add_square_product(Pack(-2.0 * pull), d.Cinv, D);
        Stiffness stiffness;
        total_lagrangian_stiffness(t, S, D, stiffness);
        store_by_tet(batch, first, add_stiffness(batch, run.places[i], first, t, stiffness, blocks), J);
        store_coupling(batch, first, t, coupling);
      }
    }
  }

  static constexpr MixedKernels<Law> table() { return {&energy, &residual, &tangent}; }
};

void polar_batch(const double* F, double* R) {
  for (int first = 0; first < kBatch; first += kWidth) {
    Pack f[9], cof[9];
    for (int i = 0; i < 9; ++i) f[i] = Pack::load(F + kBatch * i + first);
    cofactor(f, cof);
    const Polar polar = polar_of(f, f[0] * cof[0] + f[1] * cof[1] + f[2] * cof[2]);
    for (int i = 0; i < 9; ++i) polar.R[i].store(R + kBatch * i + first);
  }
}
