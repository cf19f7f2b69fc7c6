/// make_bar: a body-centred lattice. Nodes sit at the corners and centres of cells; four tets surround each line from
/// centre to centre, and none has a diagonal across a cell. At the surface a pyramid is left on each square, cut in
/// two, or in four around a node in the square's middle: as many middles are used as the wanted node count asks for.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "mesh/body_request.h"
#include "mesh/generate.h"
#include "mesh/generated_sets.h"

namespace rhexis::mesh {
namespace {

/// Cells may be longer in one direction than in another by this factor.
constexpr double kMaxCellAspect = 2.0;

struct Lattice {
  std::array<std::int64_t, 3> cells{};
  std::int64_t middles = 0;  ///< squares of the surface that get a node in their middle
};

/// Corners and centres.
std::int64_t node_count(const std::array<std::int64_t, 3>& n) {
  return (n[0] + 1) * (n[1] + 1) * (n[2] + 1) + n[0] * n[1] * n[2];
}
double aspect(const Vec3& size, const std::array<std::int64_t, 3>& n) {
  const Vec3 cell(size[0] / static_cast<double>(n[0]), size[1] / static_cast<double>(n[1]),
                  size[2] / static_cast<double>(n[2]));
  return cell.maxCoeff() / cell.minCoeff();
}

/// The lattice of exactly this many nodes whose cells are nearest to cubes.
std::optional<Lattice> plan(const Vec3& size, int nodes) {
  // The longest direction is solved for, the two others are searched.
  int longest = 0;
  size.maxCoeff(&longest);
  const std::size_t c = static_cast<std::size_t>(longest);
  const std::size_t a = (c + 1) % 3;
  const std::size_t b = (c + 2) % 3;
  const auto length = [&](std::size_t axis) { return size[static_cast<int>(axis)]; };
  std::optional<Lattice> best;
  double best_aspect = kMaxCellAspect;
  // Cells in direction c are at most twice as long as in direction a, which bounds nc from below; and na * nc <= nodes.
  const double least_nc = length(c) / length(a) / kMaxCellAspect;
  for (std::int64_t na = 1; static_cast<double>(na * na) * least_nc <= nodes; ++na) {
    const double side = length(a) / static_cast<double>(na);
    const double nb_most = static_cast<double>(nodes) / static_cast<double>(na + 1);
    const double nb_from = std::max(1.0, std::floor(length(b) / side / kMaxCellAspect));
    if (nb_from > nb_most) break;
    const auto nb_to = static_cast<std::int64_t>(std::min(std::ceil(length(b) / side * kMaxCellAspect), nb_most));
    for (auto nb = static_cast<std::int64_t>(nb_from); nb <= nb_to; ++nb) {
      // Both counts are linear in the cells of the third direction: nodes = fixed + slope * nc.
      const std::int64_t fixed = (na + 1) * (nb + 1);
      const std::int64_t slope = fixed + na * nb;
      const std::int64_t nc_to = (nodes - fixed) / slope;
      const std::int64_t all = fixed + 2 * na * nb;
      const std::int64_t nc_from =
          std::max<std::int64_t>(1, (nodes - all + slope + 2 * (na + nb) - 1) / (slope + 2 * (na + nb)));
      if (nodes < fixed || nc_to < nc_from) continue;
      const double cell = std::sqrt(side * length(b) / static_cast<double>(nb));
      const double wanted = std::min(std::round(length(c) / cell), 1.0 * nodes);
      Lattice lattice;
      lattice.cells[a] = na;
      lattice.cells[b] = nb;
      lattice.cells[c] = std::clamp(static_cast<std::int64_t>(wanted), nc_from, nc_to);
      const double stretched = aspect(size, lattice.cells);
      if (stretched >= best_aspect && best) continue;
      if (stretched > kMaxCellAspect) continue;
      lattice.middles = nodes - node_count(lattice.cells);
      best = lattice;
      best_aspect = stretched;
    }
  }
  return best;
}

class LatticeMesher {
 public:
  LatticeMesher(const Vec3& size, const Lattice& lattice) : size_(size), lattice_(lattice), n_(lattice.cells) {}

  TetMesh make() {
    add_nodes();
    std::vector<Square> squares;
    for (std::int64_t k = 0; k < n_[2]; ++k)
      for (std::int64_t j = 0; j < n_[1]; ++j)
        for (std::int64_t i = 0; i < n_[0]; ++i)
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const Index cell{i, j, k};
            if (cell[axis] == 0) squares.push_back({cell, axis, false});
            if (cell[axis] + 1 == n_[axis])
              squares.push_back({cell, axis, true});
            else
              add_ring(cell, axis);
          }
    add_pyramids(squares);
    return std::move(mesh_);
  }

 private:
  using Index = std::array<std::int64_t, 3>;
  /// A side of a cell at the surface.
  struct Square {
    Index cell;
    std::size_t axis;
    bool upper;
  };

  [[nodiscard]] Vec3 position(const Index& doubled) const {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      x[axis] = part_of(size_[axis], doubled[i], 2 * n_[i]);
    }
    return x;
  }
  [[nodiscard]] NodeId corner(const Index& i) const {
    return NodeId(static_cast<std::size_t>((i[2] * (n_[1] + 1) + i[1]) * (n_[0] + 1) + i[0]));
  }
  [[nodiscard]] NodeId centre(const Index& i) const {
    return NodeId(
        static_cast<std::size_t>((n_[0] + 1) * (n_[1] + 1) * (n_[2] + 1) + (i[2] * n_[1] + i[1]) * n_[0] + i[0]));
  }

  void add_nodes() {
    for (std::int64_t k = 0; k <= n_[2]; ++k)
      for (std::int64_t j = 0; j <= n_[1]; ++j)
        for (std::int64_t i = 0; i <= n_[0]; ++i) mesh_.nodes.push_back(position({2 * i, 2 * j, 2 * k}));
    for (std::int64_t k = 0; k < n_[2]; ++k)
      for (std::int64_t j = 0; j < n_[1]; ++j)
        for (std::int64_t i = 0; i < n_[0]; ++i) mesh_.nodes.push_back(position({2 * i + 1, 2 * j + 1, 2 * k + 1}));
  }

  /// The four corners of a side of a cell, in turn around it.
  [[nodiscard]] std::array<NodeId, 4> side(const Index& cell, std::size_t axis, bool upper) const {
    Index at = cell;
    if (upper) ++at[axis];
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    std::array<NodeId, 4> corners;
    corners[0] = corner(at);
    ++at[u];
    corners[1] = corner(at);
    ++at[v];
    corners[2] = corner(at);
    --at[u];
    corners[3] = corner(at);
    return corners;
  }

  /// The four tets around the line from the centre of a cell to that of the next one.
  void add_ring(const Index& cell, std::size_t axis) {
    Index next = cell;
    ++next[axis];
    const auto corners = side(cell, axis, true);
    for (std::size_t i = 0; i < 4; ++i)
      add_oriented_tet(mesh_, {centre(cell), centre(next), corners[i], corners[(i + 1) % 4]});
  }

  void add_pyramids(const std::vector<Square>& squares) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t s = 0; s < squares.size(); ++s) order.emplace_back(hashed_fraction(s, 0), s);
    std::sort(order.begin(), order.end());
    std::vector<char> has_middle(squares.size(), 0);
    for (std::int64_t i = 0; i < lattice_.middles; ++i) has_middle[order[static_cast<std::size_t>(i)].second] = 1;
    for (std::size_t s = 0; s < squares.size(); ++s) {
      const auto& [cell, axis, upper] = squares[s];
      const auto corners = side(cell, axis, upper);
      if (has_middle[s]) {
        Index doubled{2 * cell[0] + 1, 2 * cell[1] + 1, 2 * cell[2] + 1};
        doubled[axis] += upper ? 1 : -1;
        const NodeId middle(mesh_.node_count());
        mesh_.nodes.push_back(position(doubled));
        for (std::size_t i = 0; i < 4; ++i)
          add_oriented_tet(mesh_, {centre(cell), middle, corners[i], corners[(i + 1) % 4]});
      } else {
        // Diagonals alternate like the colours of a chess board, which no direction is preferred by.
        const std::size_t turn = static_cast<std::size_t>((cell[0] + cell[1] + cell[2]) % 2);
        add_oriented_tet(mesh_, {centre(cell), corners[turn], corners[turn + 1], corners[turn + 2]});
        add_oriented_tet(mesh_, {centre(cell), corners[turn], corners[turn + 2], corners[(turn + 3) % 4]});
      }
    }
  }

  Vec3 size_;
  Lattice lattice_;
  Index n_;
  TetMesh mesh_;
};

}  // namespace

Expected<TetMesh> make_bar(const BoxShape& shape, int nodes) {
  if (auto good = check_box(shape.size); !good) return fail(good.error());
  const auto lattice = nodes > kMaxGeneratedNodes ? std::nullopt : plan(shape.size, nodes);
  if (!lattice) return no_such_count("bar", nodes, [&](int count) { return plan(shape.size, count).has_value(); });
  TetMesh mesh = LatticeMesher(shape.size, *lattice).make();
  add_box_sides(mesh, shape.size);
  return mesh;
}

}  // namespace rhexis::mesh
