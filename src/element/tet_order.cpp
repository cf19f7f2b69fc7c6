#include "element/tet_order.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace rhexis::element {
namespace {

/// Tets at each node.
struct Incidence {
  std::vector<std::size_t> start;
  std::vector<std::int32_t> tet;
};

Incidence find_incidence(const mesh::TetMesh& mesh) {
  Incidence out;
  out.start.assign(mesh.node_count() + 1, 0);
  for (const mesh::Tet& tet : mesh.tets) {
    for (const NodeId node : tet) ++out.start[node.index() + 1];
  }
  std::partial_sum(out.start.begin(), out.start.end(), out.start.begin());
  out.tet.resize(4 * mesh.tet_count());
  std::vector<std::size_t> next(out.start.begin(), out.start.end() - 1);
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    for (const NodeId node : mesh.tets[t]) out.tet[next[node.index()]++] = static_cast<std::int32_t>(t);
  }
  return out;
}

/// Breadth-first levels of the nodes.
class Levels {
 public:
  Levels(const mesh::TetMesh& mesh, const Incidence& incidence) : mesh_(mesh), incidence_(incidence) {
    level_.assign(mesh.node_count(), -1);
    rank_.assign(mesh.node_count(), -1);
    std::int32_t base = 0;
    for (std::size_t n = 0; n < mesh.node_count(); ++n) {
      if (rank_[n] >= 0) continue;
      // The last node reached is far away: starting there makes the levels many and small.
      const std::int32_t far = spread(spread(static_cast<std::int32_t>(n), 0), 0);
      spread(far, base);
      for (const std::int32_t node : queue_) rank_[static_cast<std::size_t>(node)] = next_rank_++;
      base = level_[static_cast<std::size_t>(queue_.back())] + 1;
    }
  }
  [[nodiscard]] std::int32_t level(NodeId node) const { return level_[node.index()]; }
  [[nodiscard]] std::int32_t rank(NodeId node) const { return rank_[node.index()]; }

 private:
  /// Fills queue_ and the levels of the piece that holds `from`; returns the last node reached.
  std::int32_t spread(std::int32_t from, std::int32_t base) {
    for (const std::int32_t node : queue_) {
      if (rank_[static_cast<std::size_t>(node)] < 0) level_[static_cast<std::size_t>(node)] = -1;
    }
    queue_.assign(1, from);
    level_[static_cast<std::size_t>(from)] = base;
    for (std::size_t head = 0; head < queue_.size(); ++head) {
      const auto node = static_cast<std::size_t>(queue_[head]);
      for (std::size_t i = incidence_.start[node]; i < incidence_.start[node + 1]; ++i) {
        for (const NodeId other : mesh_.tets[static_cast<std::size_t>(incidence_.tet[i])]) {
          if (level_[other.index()] >= 0) continue;
          level_[other.index()] = level_[node] + 1;
          queue_.push_back(other.value());
        }
      }
    }
    return queue_.back();
  }

  const mesh::TetMesh& mesh_;
  const Incidence& incidence_;
  std::vector<std::int32_t> level_, rank_, queue_;
  std::int32_t next_rank_ = 0;
};

/// Some 32 chunks feed several threads. Each colour goes through the whole matrix once, so that colours cost memory
/// traffic, and chunks of fewer tets than this are not worth a thread.
std::size_t chunk_target(std::size_t tets) { return std::max<std::size_t>(tets / 32, 64); }

struct Chunks {
  std::vector<std::int32_t> tets;
  std::vector<std::size_t> start;
};

Chunks cut(const mesh::TetMesh& mesh) {
  const Incidence incidence = find_incidence(mesh);
  const Levels levels(mesh, incidence);
  struct Key {
    std::int32_t level, rank, tet;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys(mesh.tet_count());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const mesh::Tet& tet = mesh.tets[t];
    const NodeId first =
        *std::min_element(tet.begin(), tet.end(), [&](NodeId a, NodeId b) { return levels.rank(a) < levels.rank(b); });
    keys[t] = {levels.level(first), levels.rank(first), static_cast<std::int32_t>(t)};
  }
  std::sort(keys.begin(), keys.end());

  Chunks out;
  out.tets.reserve(keys.size());
  for (const Key& key : keys) out.tets.push_back(key.tet);
  out.start.push_back(0);
  const std::size_t target = chunk_target(keys.size());
  for (std::size_t begin = 0; begin < keys.size();) {
    std::size_t end = begin;
    while (end < keys.size() && keys[end].level == keys[begin].level) ++end;
    if (begin > out.start.back() && end - out.start.back() > target + target / 2) out.start.push_back(begin);
    const std::size_t from = out.start.back(), size = end - from;
    if (size >= target) {
      const std::size_t pieces = std::max<std::size_t>(1, size / (2 * target));
      for (std::size_t p = 1; p <= pieces; ++p) out.start.push_back(from + size * p / pieces);
    }
    begin = end;
  }
  if (out.start.back() != keys.size()) out.start.push_back(keys.size());
  return out;
}

/// Greedy: the smallest colour that no node of the chunk has seen. A node that has seen 64 (a star of thousands of
/// tets) gives its chunks colours of their own.
std::vector<std::size_t> colour(const mesh::TetMesh& mesh, const Chunks& chunks) {
  std::vector<std::uint64_t> seen(mesh.node_count(), 0);
  std::vector<std::size_t> colours;
  std::size_t own = 64;
  for (std::size_t c = 0; c + 1 < chunks.start.size(); ++c) {
    std::uint64_t taken = 0;
    const auto each_node = [&](const auto& body) {
      for (std::size_t i = chunks.start[c]; i < chunks.start[c + 1]; ++i) {
        for (const NodeId node : mesh.tets[static_cast<std::size_t>(chunks.tets[i])]) body(seen[node.index()]);
      }
    };
    each_node([&](std::uint64_t mask) { taken |= mask; });
    const int free = std::countr_one(taken);
    colours.push_back(free < 64 ? static_cast<std::size_t>(free) : own++);
    if (free < 64) each_node([&](std::uint64_t& mask) { mask |= std::uint64_t{1} << free; });
  }
  return colours;
}

}  // namespace

TetOrder order_tets(const mesh::TetMesh& mesh) {
  const Chunks chunks = cut(mesh);
  const std::vector<std::size_t> colours = colour(mesh, chunks);
  std::vector<std::size_t> by_colour(colours.size());
  std::iota(by_colour.begin(), by_colour.end(), std::size_t{0});
  std::stable_sort(by_colour.begin(), by_colour.end(),
                   [&](std::size_t a, std::size_t b) { return colours[a] < colours[b]; });

  TetOrder out;
  out.tets.reserve(chunks.tets.size());
  out.chunk_start.push_back(0);
  out.colour_start.push_back(0);
  for (std::size_t i = 0; i < by_colour.size(); ++i) {
    const std::size_t c = by_colour[i];
    if (i > 0 && colours[c] != colours[by_colour[i - 1]]) out.colour_start.push_back(i);
    for (std::size_t k = chunks.start[c]; k < chunks.start[c + 1]; ++k) out.tets.push_back(chunks.tets[k]);
    out.chunk_start.push_back(out.tets.size());
  }
  if (!by_colour.empty()) out.colour_start.push_back(by_colour.size());
  return out;
}

}  // namespace rhexis::element
