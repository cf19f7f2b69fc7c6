#pragma once

namespace rhexis::linalg {

/// For the first line of a main: OpenBLAS chooses its kernels before that, from a list of processors, and takes those
/// of 2004 for a processor that is newer than itself; products of matrices run at a tenth of the speed. Where that has
/// happened this begins the program anew, with the kernels named that fit the processor (OPENBLAS_CORETYPE); what the
/// user has named stays. Does nothing else, and nothing where the program cannot begin anew.
void begin_with_fitting_blas(char** argv);

}  // namespace rhexis::linalg
