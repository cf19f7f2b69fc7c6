#include "linalg/front_dissection.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/check.h"
#include "linalg/metis_turn.h"
#include "linalg/ordering.h"

namespace rhexis::linalg {
namespace {

// Pieces below this many nodes are not cut any more. Measured from 500 to 100,000 nodes: larger ones make updates of
// small bodies dearer, smaller ones make all fronts so narrow that their bookkeeping counts.
constexpr std::size_t kLeafNodes = 24;

/// The nodes that are eliminated and their neighbours.
struct NodeGraph {
  std::vector<std::int32_t> node;  // per vertex
  LowerRows rows;
};

NodeGraph make_node_graph(const ElementSource& elements, const std::vector<std::int32_t>& kept) {
  const auto nodes = static_cast<std::size_t>(elements.node_count());
  std::vector<std::int32_t> start(nodes + 1, 0);  // active elements of each node
  for (std::int32_t e = 0; e < elements.element_count(); ++e) {
    if (!elements.is_active(e)) continue;
    for (const std::int32_t node : elements.nodes(e)) ++start[static_cast<std::size_t>(node) + 1];
  }
  for (std::size_t i = 0; i < nodes; ++i) start[i + 1] += start[i];
  std::vector<std::int32_t> of_node(static_cast<std::size_t>(start.back()));
  std::vector<std::int32_t> at(start.begin(), start.end() - 1);
  for (std::int32_t e = 0; e < elements.element_count(); ++e) {
    if (!elements.is_active(e)) continue;
    for (const std::int32_t node : elements.nodes(e)) {
      of_node[static_cast<std::size_t>(at[static_cast<std::size_t>(node)]++)] = e;
    }
  }
  NodeGraph graph;
  std::vector<std::int32_t> vertex(nodes, -1);
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto node = static_cast<std::int32_t>(i);
    if (start[i] == start[i + 1] || !has_unknowns(elements, node)) continue;
    if (std::binary_search(kept.begin(), kept.end(), node)) continue;
    vertex[i] = static_cast<std::int32_t>(graph.node.size());
    graph.node.push_back(node);
    const auto row = static_cast<std::ptrdiff_t>(graph.rows.index.size());
    for (std::int32_t k = start[i]; k < start[i + 1]; ++k) {
      for (const std::int32_t other : elements.nodes(of_node[static_cast<std::size_t>(k)])) {
        if (other <= node && vertex[static_cast<std::size_t>(other)] >= 0) {
          graph.rows.index.push_back(vertex[static_cast<std::size_t>(other)]);
        }
      }
    }
    std::sort(graph.rows.index.begin() + row, graph.rows.index.end());
    graph.rows.index.erase(std::unique(graph.rows.index.begin() + row, graph.rows.index.end()), graph.rows.index.end());
    graph.rows.end_row();
  }
  return graph;
}

/// Cuts pieces of the graph in two by separators of small weight, until they are small. Components come before those of
/// the pieces that they part.
class Cutter {
 public:
  Cutter(const LowerRows& rows, std::vector<int> weight)
      : weight_(std::move(weight)), member_(weight_.size(), -1), place_(weight_.size(), -1) {
    cholmod_start(&common_);
    common_.print = 0;
    const std::size_t n = weight_.size();
    start_.assign(n + 1, 0);
    const auto each_pair = [&](auto&& use) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::int32_t k = rows.start[i]; k < rows.start[i + 1]; ++k) {
          const auto j = static_cast<std::size_t>(rows.index[static_cast<std::size_t>(k)]);
          if (j != i) use(i, j);
        }
      }
    };
    each_pair([&](std::size_t i, std::size_t j) { ++start_[i + 1], ++start_[j + 1]; });
    for (std::size_t i = 0; i < n; ++i) start_[i + 1] += start_[i];
    neighbour_.resize(static_cast<std::size_t>(start_[n]));
    std::vector<int> at(start_.begin(), start_.end() - 1);
    const auto add = [&](std::size_t i, std::size_t j) {
      neighbour_[static_cast<std::size_t>(at[i]++)] = static_cast<int>(j);
    };
    each_pair([&](std::size_t i, std::size_t j) { add(i, j), add(j, i); });
    std::vector<int> all(n);
    std::iota(all.begin(), all.end(), 0);
    cut_all(std::move(all));
  }
  ~Cutter() { cholmod_finish(&common_); }
  Cutter(const Cutter&) = delete;
  Cutter& operator=(const Cutter&) = delete;

  [[nodiscard]] const std::vector<std::int32_t>& parent() const { return parent_; }  ///< per component, -1: none
  [[nodiscard]] const std::vector<std::int32_t>& member() const { return member_; }  ///< per vertex, its component

 private:
  struct Piece {
    std::vector<int> vertices;
    std::int32_t above;
  };

  void cut_all(std::vector<int> vertices) {
    std::vector<Piece> open;
    if (!vertices.empty()) open.push_back({std::move(vertices), -1});
    while (!open.empty()) {
      const Piece piece = std::move(open.back());
      open.pop_back();
      const auto component = static_cast<std::int32_t>(parent_.size());
      parent_.push_back(piece.above);
      for (const int v : piece.vertices) member_[static_cast<std::size_t>(v)] = component;
      std::array<std::vector<int>, 3> part;  // the two sides, the separator
      if (piece.vertices.size() >= kLeafNodes) split(piece.vertices, part);
      if (part[0].empty() || part[1].empty()) continue;  // stays whole
      open.push_back({std::move(part[0]), component});
      open.push_back({std::move(part[1]), component});
    }
  }

  void split(const std::vector<int>& vertices, std::array<std::vector<int>, 3>& part) {
    std::vector<int> start{0};
    std::vector<int> index;
    std::vector<int> weight;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      place_[static_cast<std::size_t>(vertices[i])] = static_cast<int>(i);
    for (const int v : vertices) {
      const auto at = static_cast<std::size_t>(v);
      for (int k = start_[at]; k < start_[at + 1]; ++k) {
        const int other = place_[static_cast<std::size_t>(neighbour_[static_cast<std::size_t>(k)])];
        if (other >= 0) index.push_back(other);
      }
      std::sort(index.begin() + start.back(), index.end());
      start.push_back(static_cast<int>(index.size()));
      weight.push_back(weight_[at]);
    }
    for (const int v : vertices) place_[static_cast<std::size_t>(v)] = -1;

    cholmod_sparse graph{};
    graph.nrow = graph.ncol = vertices.size();
    graph.nzmax = index.size();
    graph.p = start.data();
    graph.i = index.data();
    graph.itype = CHOLMOD_INT;
    graph.xtype = CHOLMOD_PATTERN;
    graph.dtype = CHOLMOD_DOUBLE;
    graph.sorted = graph.packed = 1;
    std::vector<int> edge_weight(index.size(), 1);
    std::vector<int> side(vertices.size());
    const auto turn = take_metis_turn();
    const auto size = cholmod_metis_bisector(&graph, weight.data(), edge_weight.data(), side.data(), &common_);
    RHEXIS_CHECK(size >= 0, "CHOLMOD cannot dissect {} nodes: status {}", vertices.size(), common_.status);
    for (std::size_t i = 0; i < vertices.size(); ++i) part[static_cast<std::size_t>(side[i])].push_back(vertices[i]);
  }

  cholmod_common common_{};
  std::vector<int> start_, neighbour_, weight_;
  std::vector<std::int32_t> parent_;
  std::vector<std::int32_t> member_;
  std::vector<int> place_;  // work: of a vertex in the piece at hand, -1
};

/// Components in postorder under one root; `number` becomes the new number of each.
ComponentTree in_postorder(const std::vector<std::int32_t>& parent, std::vector<std::int32_t>& number) {
  const auto n = static_cast<std::int32_t>(parent.size());
  std::vector<std::vector<std::int32_t>> children(parent.size() + 1);  // the last: the root
  for (std::int32_t c = 0; c < n; ++c) {
    const std::int32_t p = parent[static_cast<std::size_t>(c)];
    children[static_cast<std::size_t>(p >= 0 ? p : n)].push_back(c);
  }
  ComponentTree tree;
  number.assign(parent.size() + 1, -1);
  std::vector<std::pair<std::int32_t, std::size_t>> stack{{n, 0}};  // component, children done
  while (!stack.empty()) {
    auto& [c, done] = stack.back();
    const std::vector<std::int32_t>& below = children[static_cast<std::size_t>(c)];
    if (done < below.size()) {
      stack.emplace_back(below[done++], 0);
      continue;
    }
    const std::int32_t own = tree.size();
    number[static_cast<std::size_t>(c)] = own;
    tree.parent.push_back(-1);
    tree.first.push_back(own);
    tree.children.emplace_back();
    for (const std::int32_t child : below) {
      const std::int32_t k = number[static_cast<std::size_t>(child)];
      tree.parent[static_cast<std::size_t>(k)] = own;
      tree.children.back().push_back(k);
      tree.first.back() = std::min(tree.first.back(), tree.first[static_cast<std::size_t>(k)]);
    }
    stack.pop_back();
  }
  return tree;
}

}  // namespace

bool has_unknowns(const ElementSource& elements, std::int32_t node) { return elements.free_components(node) != 0; }

Dissection dissect(const ElementSource& elements, const std::vector<std::int32_t>& kept,
                   std::span<const std::int32_t> weight) {
  RHEXIS_CHECK(weight.empty() || weight.size() == static_cast<std::size_t>(elements.node_count()),
               "{} weights for {} nodes", weight.size(), elements.node_count());
  const NodeGraph graph = make_node_graph(elements, kept);
  std::vector<int> vertex_weight;
  for (const std::int32_t node : graph.node) {
    vertex_weight.push_back(weight.empty() ? 1 : weight[static_cast<std::size_t>(node)]);
  }
  const Cutter cutter(graph.rows, std::move(vertex_weight));
  Dissection out;
  std::vector<std::int32_t> number;
  out.tree = in_postorder(cutter.parent(), number);
  out.home.assign(static_cast<std::size_t>(elements.node_count()), -1);
  for (std::size_t v = 0; v < graph.node.size(); ++v) {
    out.home[static_cast<std::size_t>(graph.node[v])] = number[static_cast<std::size_t>(cutter.member()[v])];
  }
  for (const std::int32_t node : kept) out.home[static_cast<std::size_t>(node)] = out.tree.root();
  return out;
}

}  // namespace rhexis::linalg
