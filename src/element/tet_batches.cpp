#include "element/tet_batches.h"

#include <algorithm>

#include <Eigen/Dense>

#include "base/check.h"
#include "base/parallel.h"
#include "element/tet_order.h"

namespace rhexis::element {
namespace {

void fill_lane(const mesh::TetMesh& mesh, std::int32_t id, int lane, TetBatch& batch) {
  mesh::Tet tet = mesh.tets[static_cast<std::size_t>(id)];
  std::sort(tet.begin(), tet.end());
  const Vec3& origin = mesh.node(tet[0]);
  Mat3 edges;
  for (int a = 0; a < 3; ++a) edges.row(a) = mesh.node(tet[static_cast<std::size_t>(a + 1)]) - origin;
  const Mat3 gradients = edges.inverse();  // columns: grad N_1, N_2, N_3
  for (int a = 0; a < 3; ++a) {
    for (int j = 0; j < 3; ++j) batch.gradient[3 * a + j][lane] = gradients(j, a);
  }
  batch.volume[lane] = mesh::signed_volume(mesh, TetId(id));
  for (int a = 0; a < 4; ++a) batch.node[a][lane] = tet[static_cast<std::size_t>(a)].value();
  batch.tet[lane] = id;
}

/// Lanes beyond the last tet: harmless to compute with.
void repeat_first_lane(int lane, TetBatch& batch) {
  for (auto& row : batch.gradient) row[lane] = row[0];
  for (auto& row : batch.node) row[lane] = row[0];
  batch.volume[lane] = 0.0;
  batch.tet[lane] = batch.tet[0];
}

}  // namespace

TetBatches::TetBatches(const mesh::TetMesh& mesh, std::span<const std::uint8_t> left_out) {
  RHEXIS_CHECK(left_out.empty() || left_out.size() == mesh.tet_count(), "{} marks for {} tets", left_out.size(),
               mesh.tet_count());
  TetOrder order = order_tets(mesh);
  colour_start_ = std::move(order.colour_start);
  std::vector<std::int32_t> tets;
  for (std::size_t c = 0; c + 1 < order.chunk_start.size(); ++c) {
    tets.clear();
    for (std::size_t i = order.chunk_start[c]; i < order.chunk_start[c + 1]; ++i) {
      if (left_out.empty() || left_out[static_cast<std::size_t>(order.tets[i])] == 0) tets.push_back(order.tets[i]);
    }
    const std::size_t count = (tets.size() + kBatch - 1) / kBatch;
    chunks_.push_back({static_cast<std::int32_t>(batches_.size()), static_cast<std::int32_t>(count)});
    for (std::size_t first = 0; first < tets.size(); first += kBatch) {
      TetBatch& batch = batches_.emplace_back();
      batch.count = static_cast<std::int32_t>(std::min<std::size_t>(kBatch, tets.size() - first));
      for (int lane = 0; lane < kBatch; ++lane) {
        if (lane < batch.count) {
          fill_lane(mesh, tets[first + static_cast<std::size_t>(lane)], lane, batch);
        } else {
          repeat_first_lane(lane, batch);
        }
      }
    }
  }
  batches_.shrink_to_fit();
}

void TetBatches::place_blocks(const linalg::BlockPattern& pattern) {
  places_.resize(batches_.size());
  for (std::size_t i = 0; i < batches_.size(); ++i) {
    const TetBatch& batch = batches_[i];
    for (int lane = 0; lane < kBatch; ++lane) {
      int pair = 0;
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b <= a; ++b) {
          const std::int32_t block = pattern.find(batch.node[a][lane], batch.node[b][lane]);
          RHEXIS_CHECK(block >= 0, "the pattern has no block ({}, {})", batch.node[a][lane], batch.node[b][lane]);
          places_[i].block[pair++][lane] = block;
        }
      }
    }
  }
}

void TetBatches::for_each_chunk(const std::function<void(const TetRun&, std::size_t)>& body) const {
  for (std::size_t colour = 0; colour + 1 < colour_start_.size(); ++colour) {
    const std::size_t first = colour_start_[colour];
    parallel_for(colour_start_[colour + 1] - first, [&](std::size_t i) {
      const Chunk& chunk = chunks_[first + i];
      const auto at = static_cast<std::size_t>(chunk.first);
      body(TetRun{batches_.data() + at, places_.empty() ? nullptr : places_.data() + at, chunk.count}, first + i);
    });
  }
}

std::size_t TetBatches::memory_bytes() const {
  return batches_.capacity() * sizeof(TetBatch) + places_.capacity() * sizeof(BlockPlaces) +
         chunks_.capacity() * sizeof(Chunk) + colour_start_.capacity() * sizeof(std::size_t);
}

}  // namespace rhexis::element
