#include "linalg/block_pool.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <vector>

#include "base/parallel.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace rhexis::linalg {
namespace {

constexpr std::size_t kPooledFrom = std::size_t{16} << 10;   // bytes; malloc is good at what is smaller
constexpr std::size_t kHugePage = std::size_t{2} << 20;      // and blocks of two such pages are worth asking for them
constexpr std::size_t kZeroedAtOnce = std::size_t{1} << 18;  // doubles that one thread sets to zero

double* allocate(std::size_t bytes) {
  const bool huge = bytes >= 2 * kHugePage;
  void* const data = huge ? std::aligned_alloc(kHugePage, (bytes + kHugePage - 1) / kHugePage * kHugePage)
                          : std::malloc(bytes);  // NOLINT(cppcoreguidelines-no-malloc)
  if (data == nullptr) throw std::bad_alloc();
#if defined(__linux__)
  if (huge) madvise(data, bytes, MADV_HUGEPAGE);  // advice: without it the block is as good
#endif
  return static_cast<double*>(data);
}

void release(double* data) { std::free(data); }  // NOLINT(cppcoreguidelines-no-malloc)

class BlockPool {
 public:
  /// Lives as long as the program: fronts may outlive any object of static storage.
  static BlockPool& instance() {
    static BlockPool& pool = *new BlockPool;  // NOLINT(cppcoreguidelines-owning-memory)
    return pool;
  }

  /// The smallest idle block of that many bytes or up to twice as many, or a new one.
  Block take(std::size_t bytes) {
    {
      const std::scoped_lock lock(mutex_);
      auto best = idle_.end();
      for (auto block = idle_.begin(); block != idle_.end(); ++block) {
        if (block->bytes < bytes || block->bytes > 2 * bytes) continue;
        if (best == idle_.end() || block->bytes <= best->bytes) best = block;
      }
      if (best != idle_.end()) {
        const Idle taken = *best;
        idle_.erase(best);
        idle_bytes_ -= taken.bytes;
        in_use_ += taken.bytes;
        return {taken.data, {taken.bytes}};
      }
    }
    Block fresh(allocate(bytes), {bytes});
    const std::scoped_lock lock(mutex_);
    in_use_ += bytes;
    return fresh;
  }

  void give_back(double* data, std::size_t bytes) {
    const std::scoped_lock lock(mutex_);
    in_use_ -= bytes;
    idle_.push_back({data, bytes});
    idle_bytes_ += bytes;
    // Those that nobody has asked for the longest go first.
    std::size_t gone = 0;
    for (; idle_bytes_ > std::max(kFewestIdleBytes, in_use_ / 4); ++gone) {
      idle_bytes_ -= idle_[gone].bytes;
      release(idle_[gone].data);
    }
    idle_.erase(idle_.begin(), idle_.begin() + static_cast<std::ptrdiff_t>(gone));
  }

  std::size_t idle_bytes() {
    const std::scoped_lock lock(mutex_);
    return idle_bytes_;
  }

 private:
  struct Idle {
    double* data;
    std::size_t bytes;
  };
  std::mutex mutex_;
  std::vector<Idle> idle_;  // in the order in which they came back
  std::size_t idle_bytes_ = 0;
  std::size_t in_use_ = 0;  // bytes
};

}  // namespace

void ReturnBlock::operator()(double* data) const {
  if (bytes < kPooledFrom) {
    release(data);
  } else {
    BlockPool::instance().give_back(data, bytes);
  }
}

Block make_block(std::size_t count) {
  const std::size_t bytes = std::max<std::size_t>(count, 1) * sizeof(double);
  return bytes < kPooledFrom ? Block(allocate(bytes), {bytes}) : BlockPool::instance().take(bytes);
}

Block make_zeroed(std::size_t count) {
  Block out = make_block(count);
  parallel_ranges(count, kZeroedAtOnce, [&](std::size_t begin, std::size_t end) {
    std::memset(out.get() + begin, 0, (end - begin) * sizeof(double));
  });
  return out;
}

std::size_t idle_block_bytes() { return BlockPool::instance().idle_bytes(); }

}  // namespace rhexis::linalg
