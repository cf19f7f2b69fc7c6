#include "base/parallel.h"

#include <algorithm>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "base/check.h"

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace rhexis {
namespace {

// TBB orders the caller before every piece and every piece before the return. ThreadSanitizer cannot see that inside a
// library built without it, so its build is told.
void happens_before([[maybe_unused]] int& order) {
#ifdef __SANITIZE_THREAD__
  __tsan_release(&order);
#endif
}
void happens_after([[maybe_unused]] int& order) {
#ifdef __SANITIZE_THREAD__
  __tsan_acquire(&order);
#endif
}

struct Pool {
  int threads = tbb::info::default_concurrency();
  tbb::task_arena arena{threads};
  // Lifts TBB's own limit, the number of cores: without it more threads are asked for than ever come.
  std::optional<tbb::global_control> limit;
};

thread_local int one_thread_here = 0;

Pool& pool() {
  static Pool instance;
  return instance;
}

}  // namespace

void set_thread_count(int threads) {
  Pool& p = pool();
  p.threads = threads > 0 ? threads : tbb::info::default_concurrency();
  p.arena.terminate();
  p.limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(p.threads));
  p.arena.initialize(p.threads);
}

OneThreadHere::OneThreadHere() { ++one_thread_here; }
OneThreadHere::~OneThreadHere() { --one_thread_here; }

int thread_count() { return pool().threads; }

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  Pool& p = pool();
  if (p.threads == 1 || count < 2 || one_thread_here > 0) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  int fork = 0;
  int join = 0;
  happens_before(fork);
  p.arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1), [&](const tbb::blocked_range<std::size_t>& range) {
      happens_after(fork);
      for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
      happens_before(join);
    });
  });
  happens_after(join);
}

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  RHEXIS_CHECK(grain > 0, "grain is {}", grain);
  const std::size_t pieces = (count + grain - 1) / grain;
  parallel_for(pieces, [&](std::size_t i) { body(i * grain, std::min(count, (i + 1) * grain)); });
}

}  // namespace rhexis
