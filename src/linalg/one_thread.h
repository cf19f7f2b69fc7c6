#pragma once

namespace rhexis::linalg {

/// Keeps OpenBLAS and CHOLMOD's OpenMP loops on the calling thread. Parallelism is ours, bits must not depend on it,
/// and CHOLMOD opens four threads around loops of microseconds: a body of 1400 nodes factors three times faster
/// without. The setting belongs to the thread, so it is made before every factorisation; it costs nothing.
void stay_on_one_thread();

}  // namespace rhexis::linalg
