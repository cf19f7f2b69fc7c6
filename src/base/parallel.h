#pragma once

/// The one place that knows how work is spread over cores (oneTBB). Bodies are handed fixed index ranges, so a result
/// may depend on the ranges but never on which thread took which: the same input gives the same bits whatever the
/// number of threads.

#include <cstddef>
#include <functional>

namespace rhexis {

/// Number of worker threads from now on; 0 asks for all cores. Not to be called while parallel work runs.
void set_thread_count(int threads);
[[nodiscard]] int thread_count();

/// While it lives, what its thread calls in parallel runs on that thread alone. For work beside other work, each on a
/// core of its own, where a fork would wait for a thread that is busy.
class OneThreadHere {
 public:
  OneThreadHere();
  ~OneThreadHere();
  OneThreadHere(const OneThreadHere&) = delete;
  OneThreadHere& operator=(const OneThreadHere&) = delete;
};

/// Calls body(i) for i in [0, count), in any order, on thread_count() threads; runs inline when that is one.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

/// Calls body(begin, end) over [0, count) cut into pieces of `grain` (the last one shorter), in any order. The cut
/// depends on count and grain alone.
void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace rhexis
