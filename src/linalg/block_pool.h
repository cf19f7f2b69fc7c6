#pragma once

/// Blocks of doubles for the fronts, kept when a version goes and handed to the next one. A front at the size of some
/// megabytes would else come from the system page by page and go back to it with every update of the factor, which took
/// a quarter of the time of an update.

#include <cstddef>
#include <memory>

namespace rhexis::linalg {

/// Gives a block back to the pool.
struct ReturnBlock {
  std::size_t bytes = 0;  ///< of the block, which may have room for more than was asked for
  void operator()(double* data) const;
};
using Block = std::unique_ptr<double[], ReturnBlock>;

/// `count` doubles without a value. Errors: std::bad_alloc.
[[nodiscard]] Block make_block(std::size_t count);
/// `count` zeros. Errors: as above.
[[nodiscard]] Block make_zeroed(std::size_t count);

/// Bytes that the pool holds and nobody uses: at most a quarter of what is in use, and kFewestIdleBytes.
[[nodiscard]] std::size_t idle_block_bytes();
inline constexpr std::size_t kFewestIdleBytes = std::size_t{64} << 20;

}  // namespace rhexis::linalg
