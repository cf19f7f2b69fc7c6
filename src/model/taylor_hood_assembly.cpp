#include "model/taylor_hood_assembly.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/parallel.h"

namespace rhexis::model::taylor_hood {
namespace {

using BlockMap = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
using ConstBlockMap = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

/// Tets handed to a thread at once: some hundred microseconds of work.
constexpr std::size_t kTetGrain = 32;

/// Rows of columns, each sorted and without repetitions, as one pattern.
linalg::CsrPattern to_pattern(std::vector<std::vector<std::int32_t>> rows) {
  linalg::CsrPattern out;
  out.row_start.push_back(0);
  for (std::vector<std::int32_t>& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    out.column.insert(out.column.end(), row.begin(), row.end());
    out.row_start.push_back(static_cast<std::int32_t>(out.column.size()));
  }
  return out;
}

/// For each vertex the nodes of its tets.
linalg::CsrPattern coupling_pattern(const DisplacementSpace& space) {
  std::vector<std::vector<std::int32_t>> rows(space.vertex_count());
  for (std::size_t first = 0; first < space.connectivity.size(); first += 10) {
    const std::span<const std::int32_t> tet(&space.connectivity[first], 10);
    for (const std::int32_t vertex : tet.first(4)) {
      auto& row = rows[static_cast<std::size_t>(vertex)];
      row.insert(row.end(), tet.begin(), tet.end());
    }
  }
  return to_pattern(std::move(rows));
}

/// Lower triangle of the vertex pairs that share a tet: the edges, and the diagonal last.
linalg::CsrPattern vertex_pattern(const DisplacementSpace& space) {
  std::vector<std::vector<std::int32_t>> rows(space.vertex_count());
  for (const auto& [low, high] : space.edges) rows[high.index()].push_back(low.value());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(static_cast<std::int32_t>(i));
  return to_pattern(std::move(rows));
}

std::int32_t place_of(const linalg::CsrPattern& pattern, std::int32_t row, std::int32_t column) {
  const auto first = pattern.column.begin() + pattern.row_start[static_cast<std::size_t>(row)];
  const auto last = pattern.column.begin() + pattern.row_start[static_cast<std::size_t>(row) + 1];
  return static_cast<std::int32_t>(std::lower_bound(first, last, column) - pattern.column.begin());
}

}  // namespace

Assembly::Assembly(const mesh::TetMesh& mesh) : space_(make_p2_space(mesh)) {
  geometry_.reserve(mesh.tet_count());
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) geometry_.push_back(geometry_of(mesh::corners(mesh, TetId(t))));
  A_pattern_ = std::make_shared<linalg::BlockPattern>(
      linalg::make_block_pattern(static_cast<std::int32_t>(space_.node_count()), space_.connectivity, 10));
  B_pattern_ = std::make_shared<linalg::CsrPattern>(coupling_pattern(space_));
  C_pattern_ = std::make_shared<linalg::CsrPattern>(vertex_pattern(space_));
  find_places();
  colour_tets();
}

void Assembly::find_places() {
  A_place_.resize(tet_count());
  B_place_.resize(tet_count());
  for (std::size_t t = 0; t < tet_count(); ++t) {
    const std::int32_t* const nodes = nodes_of(t);
    std::size_t pair = 0;
    for (std::size_t a = 0; a < 10; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        const bool transposed = nodes[a] < nodes[b];
        const std::int32_t block =
            transposed ? A_pattern_->find(nodes[b], nodes[a]) : A_pattern_->find(nodes[a], nodes[b]);
        A_place_[t][pair++] = transposed ? ~block : block;
      }
    }
    for (std::size_t v = 0; v < 4; ++v) {
      for (std::size_t a = 0; a < 10; ++a) B_place_[t][10 * v + a] = place_of(*B_pattern_, nodes[v], nodes[a]);
    }
  }
}

/// Greedy, a colour at a time: a tet joins when none of its vertices has been met in this colour. Tets that share a
/// node share a vertex.
void Assembly::colour_tets() {
  std::vector<std::int32_t> waiting(tet_count());
  for (std::size_t t = 0; t < waiting.size(); ++t) waiting[t] = static_cast<std::int32_t>(t);
  std::vector<std::int32_t> last_colour(space_.vertex_count(), -1);
  tet_order_.reserve(waiting.size());
  colour_start_.push_back(0);
  for (std::int32_t colour = 0; !waiting.empty(); ++colour) {
    std::erase_if(waiting, [&](std::int32_t tet) {
      const std::span<const std::int32_t> vertices(nodes_of(static_cast<std::size_t>(tet)), 4);
      const auto met = [&](std::int32_t v) { return last_colour[static_cast<std::size_t>(v)] == colour; };
      if (std::any_of(vertices.begin(), vertices.end(), met)) return false;
      for (const std::int32_t v : vertices) last_colour[static_cast<std::size_t>(v)] = colour;
      tet_order_.push_back(tet);
      return true;
    });
    colour_start_.push_back(tet_order_.size());
  }
}

linalg::SaddleMatrix Assembly::make_matrix() const {
  linalg::SaddleMatrix out;
  out.A = linalg::SymmetricBlockMatrix(A_pattern_);
  out.B = linalg::CouplingMatrix(B_pattern_);
  out.C = linalg::SymmetricCsr(C_pattern_);
  return out;
}

bool Assembly::has_tet(std::int32_t vertex) const {
  const auto row = static_cast<std::size_t>(vertex);
  return B_pattern_->row_start[row] != B_pattern_->row_start[row + 1];
}

linalg::SymmetricCsr Assembly::vertex_mass() const {
  linalg::SymmetricCsr mass(C_pattern_);
  double total = 0.0;
  for (std::size_t t = 0; t < tet_count(); ++t) {
    const std::int32_t* const nodes = nodes_of(t);
    const double share = geometry_[t].volume / 20.0;  // int L_v L_w = V (1 + delta_vw) / 20
    total += 8.0 * share;
    for (std::size_t v = 0; v < 4; ++v) {
      for (std::size_t w = 0; w <= v; ++w) {
        const auto [low, high] = std::minmax(nodes[v], nodes[w]);
        mass.values[static_cast<std::size_t>(place_of(*C_pattern_, high, low))] += v == w ? 2.0 * share : share;
      }
    }
  }
  std::int32_t used = 0;
  for (std::int32_t v = 0; v < vertex_count(); ++v) used += has_tet(v) ? 1 : 0;
  for (std::int32_t v = 0; v < vertex_count(); ++v) {
    if (!has_tet(v)) mass.values[static_cast<std::size_t>(place_of(*C_pattern_, v, v))] = total / used;
  }
  return mass;
}

void Assembly::for_each_tet(const std::function<void(std::size_t)>& body) const {
  for (std::size_t colour = 0; colour + 1 < colour_start_.size(); ++colour) {
    const std::size_t first = colour_start_[colour];
    parallel_ranges(colour_start_[colour + 1] - first, kTetGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(static_cast<std::size_t>(tet_order_[first + i]));
    });
  }
}

void Assembly::gather(std::size_t tet, const State& state, NodeColumns& u, VertexValues& lambda) const {
  const std::int32_t* const nodes = nodes_of(tet);
  for (Eigen::Index a = 0; a < 10; ++a) u.col(a) = state.u.segment<3>(3 * nodes[a]);
  for (Eigen::Index v = 0; v < 4; ++v) lambda[v] = state.lambda[nodes[v]];
}

void Assembly::scatter(std::size_t tet, const NodeColumns& force, VectorX& out) const {
  const std::int32_t* const nodes = nodes_of(tet);
  for (Eigen::Index a = 0; a < 10; ++a) out.segment<3>(3 * nodes[a]) += force.col(a);
}

void Assembly::scatter(std::size_t tet, const VertexValues& values, VectorX& out) const {
  const std::int32_t* const nodes = nodes_of(tet);
  for (Eigen::Index v = 0; v < 4; ++v) out[nodes[v]] += values[v];
}

void Assembly::scatter(std::size_t tet, const PairBlocks& K, linalg::SymmetricBlockMatrix& A) const {
  for (std::size_t pair = 0; pair < K.size(); ++pair) {
    const std::int32_t place = A_place_[tet][pair];
    const ConstBlockMap block(K[pair].data());
    if (place >= 0) {
      BlockMap(A.values.data() + 9 * std::ptrdiff_t{place}) += block;
    } else {
      BlockMap(A.values.data() + 9 * std::ptrdiff_t{~place}) += block.transpose();
    }
  }
}

void Assembly::scatter(std::size_t tet, const std::array<NodeColumns, 4>& columns, linalg::CouplingMatrix& B) const {
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t a = 0; a < 10; ++a) {
      Eigen::Map<Vec3>(B.values.data() + 3 * std::ptrdiff_t{B_place_[tet][10 * v + a]}) +=
          columns[v].col(static_cast<Eigen::Index>(a));
    }
  }
}

std::size_t Assembly::memory_bytes() const {
  const auto bytes = [](const auto& vector) { return vector.size() * sizeof(vector[0]); };
  const linalg::BlockPattern& A = *A_pattern_;
  return bytes(space_.nodes) + bytes(space_.connectivity) + bytes(space_.edges) + bytes(geometry_) +
         bytes(A.row_start) + bytes(A.column) + bytes(A.below_start) + bytes(A.below_row) + bytes(A.below_block) +
         bytes(B_pattern_->row_start) + bytes(B_pattern_->column) + bytes(C_pattern_->row_start) +
         bytes(C_pattern_->column) + bytes(A_place_) + bytes(B_place_) + bytes(tet_order_) + bytes(colour_start_);
}

}  // namespace rhexis::model::taylor_hood
