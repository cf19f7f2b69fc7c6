#include "linalg/ordering.h"

#include <numeric>

#include "base/check.h"
#include "linalg/metis_turn.h"

namespace rhexis::linalg {
namespace {

/// Adds the nodes that have a free dof; returns the vertex of each node, -1 where there is none.
std::vector<std::int32_t> add_nodes(const BlockPattern& pattern, const FreeDofs& free, UnknownGraph& graph) {
  std::vector<std::int32_t> vertex(static_cast<std::size_t>(pattern.rows()), -1);
  for (std::size_t node = 0; node < vertex.size(); ++node) {
    std::int32_t count = 0;
    for (std::size_t c = 0; c < 3; ++c) count += free.index[3 * node + c] >= 0 ? 1 : 0;
    if (count == 0) continue;
    vertex[node] = static_cast<std::int32_t>(graph.unknown_start.size()) - 1;
    graph.unknown_start.push_back(graph.unknown_start.back() + count);
    for (std::int32_t k = pattern.row_start[node]; k < pattern.row_start[node + 1]; ++k) {
      const std::int32_t other = vertex[static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(k)])];
      if (other >= 0) graph.rows.index.push_back(other);
    }
    graph.rows.end_row();
  }
  return vertex;
}

}  // namespace

cholmod_sparse cholmod_view(const LowerRows& rows, const double* values) {
  cholmod_sparse out{};
  out.nrow = out.ncol = rows.start.size() - 1;
  out.nzmax = rows.index.size();
  out.p = const_cast<std::int32_t*>(rows.start.data());
  out.i = const_cast<std::int32_t*>(rows.index.data());
  out.x = const_cast<double*>(values);
  out.stype = 1;
  out.itype = CHOLMOD_INT;
  out.xtype = values != nullptr ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  out.dtype = CHOLMOD_DOUBLE;
  out.sorted = 1;
  out.packed = 1;
  return out;
}

UnknownGraph make_graph(const BlockPattern& pattern, const FreeDofs& free) {
  UnknownGraph graph;
  add_nodes(pattern, free, graph);
  return graph;
}

UnknownGraph make_graph(const CsrPattern& pattern) {
  UnknownGraph graph;
  if (pattern.rows() > 0) graph.rows = {pattern.row_start, pattern.column};
  graph.unknown_start.resize(static_cast<std::size_t>(pattern.rows()) + 1);
  std::iota(graph.unknown_start.begin(), graph.unknown_start.end(), 0);
  return graph;
}

UnknownGraph make_graph(const SaddleMatrix& K, const FreeDofs& free) {
  UnknownGraph graph;
  std::vector<std::int32_t> vertex;
  if (K.A.pattern) vertex = add_nodes(*K.A.pattern, free, graph);
  const auto first_pressure = static_cast<std::int32_t>(graph.unknown_start.size()) - 1;
  for (std::size_t p = 0; p < static_cast<std::size_t>(K.pressure_unknowns()); ++p) {
    const CsrPattern& b = *K.B.pattern;
    const CsrPattern& c = *K.C.pattern;
    for (auto k = static_cast<std::size_t>(b.row_start[p]); k < static_cast<std::size_t>(b.row_start[p + 1]); ++k) {
      const std::int32_t node = vertex[static_cast<std::size_t>(b.column[k])];
      if (node >= 0) graph.rows.index.push_back(node);
    }
    for (auto k = static_cast<std::size_t>(c.row_start[p]); k < static_cast<std::size_t>(c.row_start[p + 1]); ++k) {
      graph.rows.index.push_back(first_pressure + c.column[k]);
    }
    graph.rows.end_row();
    graph.unknown_start.push_back(graph.unknown_start.back() + 1);
  }
  return graph;
}

std::vector<std::int32_t> find_order(const UnknownGraph& graph, Ordering how) {
  RHEXIS_CHECK(how != Ordering::best, "an order by METIS or by AMD");
  cholmod_sparse rows = cholmod_view(graph.rows, nullptr);
  std::vector<std::int32_t> order;
  if (rows.nrow == 0) return order;
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  std::vector<std::int32_t> vertices(rows.nrow);
  const auto turn = how == Ordering::metis ? take_metis_turn() : std::unique_lock<std::mutex>();
  const int done = how == Ordering::metis ? cholmod_metis(&rows, nullptr, 0, 1, vertices.data(), &common)
                                          : cholmod_amd(&rows, nullptr, 0, vertices.data(), &common);
  cholmod_finish(&common);
  if (done == 0) return order;
  order.reserve(static_cast<std::size_t>(graph.unknown_start.back()));
  for (const std::int32_t vertex : vertices) {
    const auto at = static_cast<std::size_t>(vertex);
    for (std::int32_t i = graph.unknown_start[at]; i < graph.unknown_start[at + 1]; ++i) order.push_back(i);
  }
  return order;
}

}  // namespace rhexis::linalg
