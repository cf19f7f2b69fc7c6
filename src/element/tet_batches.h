#pragma once

/// The mesh as the kernels want it: batches of eight tets, cut into chunks that are coloured so that chunks of one
/// colour share no node. Colours run one after another, the chunks of a colour in parallel: every sum is added up in
/// one order, whatever the number of threads.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "element/tet_batch.h"
#include "element/tet_kernels.h"
#include "linalg/block_matrix.h"
#include "mesh/tet_mesh.h"

namespace rhexis::element {

class TetBatches {
 public:
  /// Tets must be positively oriented and not flat. `left_out`: per tet, nonzero where it is no part of the body;
  /// empty: all are.
  explicit TetBatches(const mesh::TetMesh& mesh, std::span<const std::uint8_t> left_out = {});

  /// Looks up where the blocks of each tet lie; before the first tangent.
  void place_blocks(const linalg::BlockPattern& pattern);

  /// Calls body(run, chunk) for every chunk: colours in order, chunks of a colour in parallel.
  void for_each_chunk(const std::function<void(const TetRun&, std::size_t chunk)>& body) const;

  [[nodiscard]] std::size_t chunk_count() const { return chunks_.size(); }
  [[nodiscard]] std::size_t colour_count() const { return colour_start_.size() - 1; }
  [[nodiscard]] const std::vector<TetBatch>& batches() const { return batches_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Chunk {
    std::int32_t first = 0;  ///< batch
    std::int32_t count = 0;  ///< batches
  };

  std::vector<TetBatch> batches_;
  std::vector<BlockPlaces> places_;        ///< per batch; empty before place_blocks
  std::vector<Chunk> chunks_;              ///< ordered by colour
  std::vector<std::size_t> colour_start_;  ///< colours + 1 offsets into chunks_
};

}  // namespace rhexis::element
