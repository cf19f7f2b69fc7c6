#pragma once

/// Which of several processes this one is, as mpirun or srun tells each that it starts. No MPI is linked: topologies
/// need no messages, files are enough.

namespace rhexis::record::build {

struct Rank {
  int rank = 0;
  int size = 1;  ///< at least 1
};

/// From OMPI_COMM_WORLD_RANK and _SIZE (Open MPI), PMI_RANK and PMI_SIZE (MPICH, Intel MPI), SLURM_PROCID and
/// SLURM_NTASKS (srun), the first pair that makes sense; alone without.
[[nodiscard]] Rank rank_of_this_process();

}  // namespace rhexis::record::build
