#include "linalg/front_dissection.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "linalg/ordering.h"

namespace rhexis::linalg {
namespace {

// Pieces below this many nodes are not cut any more. Their fronts of some hundred dofs are the smallest that BLAS
// handles well, and the deeper the tree, the more update matrices are stored.
constexpr std::size_t kLeafNodes = 60;

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

bool has_unknowns(const ElementSource& elements, std::int32_t node) {
  return elements.is_free(3 * node) || elements.is_free(3 * node + 1) || elements.is_free(3 * node + 2);
}

Dissection dissect(const ElementSource& elements, const std::vector<std::int32_t>& kept) {
  const NodeGraph graph = make_node_graph(elements, kept);
  const std::size_t n = graph.node.size();
  std::vector<std::int32_t> parent(n);
  std::vector<std::int32_t> member(n);
  std::vector<std::int32_t> order(n);
  std::ptrdiff_t components = 0;
  if (n > 0) {
    cholmod_sparse matrix = cholmod_view(graph.rows, nullptr);
    cholmod_common common;
    cholmod_start(&common);
    common.print = 0;
    common.method[0].nd_small = kLeafNodes;
    common.method[0].nd_camd = 0;  // the order within a component is nothing to a dense front
    components = static_cast<std::ptrdiff_t>(
        cholmod_nested_dissection(&matrix, nullptr, 0, order.data(), parent.data(), member.data(), &common));
    const int status = common.status;
    cholmod_finish(&common);
    RHEXIS_CHECK(components > 0, "CHOLMOD cannot dissect {} nodes: status {}", n, status);
  }
  parent.resize(static_cast<std::size_t>(components));
  Dissection out;
  std::vector<std::int32_t> number;
  out.tree = in_postorder(parent, number);
  out.home.assign(static_cast<std::size_t>(elements.node_count()), -1);
  for (std::size_t v = 0; v < n; ++v) {
    out.home[static_cast<std::size_t>(graph.node[v])] = number[static_cast<std::size_t>(member[v])];
  }
  for (const std::int32_t node : kept) out.home[static_cast<std::size_t>(node)] = out.tree.root();
  return out;
}

}  // namespace rhexis::linalg
