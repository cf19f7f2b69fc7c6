// The benchmarks: `make bench`, or rhexis_bench --benchmark_filter=NAME.

#include <benchmark/benchmark.h>

#include "linalg/blas_kernels.h"

int main(int argc, char** argv) {
  rhexis::linalg::begin_with_fitting_blas(argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
