#include "linalg/patches.h"

#include "base/check.h"

namespace rhexis::linalg {
namespace {

/// Both triangles, without the diagonal.
CsrPattern full_graph(const CsrPattern& lower) {
  const auto rows = static_cast<std::size_t>(lower.rows());
  CsrPattern graph;
  graph.row_start.assign(rows + 1, 0);
  const auto for_each = [&](const auto& use) {
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::int32_t k = lower.row_start[row]; k < lower.row_start[row + 1]; ++k) {
        const auto col = static_cast<std::size_t>(lower.column[static_cast<std::size_t>(k)]);
        if (col == row) continue;
        use(row, col);
        use(col, row);
      }
    }
  };
  for_each([&](std::size_t from, std::size_t) { ++graph.row_start[from + 1]; });
  for (std::size_t row = 0; row < rows; ++row) graph.row_start[row + 1] += graph.row_start[row];
  graph.column.resize(static_cast<std::size_t>(graph.row_start[rows]));
  std::vector<std::int32_t> next(graph.row_start.begin(), graph.row_start.end() - 1);
  for_each([&](std::size_t from, std::size_t to) {
    graph.column[static_cast<std::size_t>(next[from]++)] = static_cast<std::int32_t>(to);
  });
  return graph;
}

}  // namespace

std::vector<std::int32_t> cut_into_patches(const CsrPattern& pattern, std::int32_t size) {
  RHEXIS_CHECK(size > 0, "patches of {}", size);
  const CsrPattern graph = full_graph(pattern);
  std::vector<std::int32_t> patch(static_cast<std::size_t>(pattern.rows()), -1);
  std::vector<std::int32_t> members;
  std::int32_t count = 0;
  for (std::int32_t seed = 0; seed < pattern.rows(); ++seed) {
    const auto first = static_cast<std::size_t>(seed);
    if (patch[first] >= 0 || graph.row_start[first] == graph.row_start[first + 1]) continue;
    members.assign(1, seed);
    patch[first] = count;
    std::int32_t neighbour = -1;
    for (std::size_t at = 0; at < members.size(); ++at) {
      const auto row = static_cast<std::size_t>(members[at]);
      for (std::int32_t k = graph.row_start[row]; k < graph.row_start[row + 1]; ++k) {
        const std::int32_t other = graph.column[static_cast<std::size_t>(k)];
        std::int32_t& of = patch[static_cast<std::size_t>(other)];
        if (of < 0 && static_cast<std::int32_t>(members.size()) < size) {
          of = count;
          members.push_back(other);
        } else if (of >= 0 && of != count) {
          neighbour = of;
        }
      }
    }
    if (neighbour >= 0 && 2 * static_cast<std::int32_t>(members.size()) < size) {
      for (const std::int32_t row : members) patch[static_cast<std::size_t>(row)] = neighbour;
    } else {
      ++count;
    }
  }
  for (std::int32_t& of : patch) of = of < 0 ? count : of;
  return patch;
}

}  // namespace rhexis::linalg
