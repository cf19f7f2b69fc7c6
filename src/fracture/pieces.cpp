#include "fracture/pieces.h"

#include <algorithm>
#include <utility>

#include "fracture/face_neighbours.h"
#include "fracture/piece_support.h"
#include "fracture/piece_walk.h"

namespace rhexis::fracture {
namespace {

/// Alive tets that had a neighbour before the edit which they have no more, or may have; ascending.
std::vector<TetId> tets_beside(const mesh::TornMesh& body, const mesh::MeshEdit& edit) {
  std::vector<TetId> tets;
  const auto add_neighbours = [&](TetId tet, const mesh::Tet& nodes) {
    for (const auto& [i, j, k] : mesh::kTetFaces) {
      const auto at = [&](int n) { return nodes[static_cast<std::size_t>(n)]; };
      const TetId other = other_tet_with(body, tet, {at(i), at(j), at(k)});
      if (other.valid()) tets.push_back(other);
    }
  };
  for (const TetId tet : edit.removed) add_neighbours(tet, body.mesh().tet(tet));
  for (const mesh::RewiredTet& change : edit.rewired) {
    tets.push_back(change.tet);
    add_neighbours(change.tet, change.before);  // the neighbour keeps the old nodes, or is rewired itself
  }
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  return tets;
}

/// False when the edit is sure to have changed nothing that support depends on, pieces being what they were: the nodes
/// that are held, and where pieces touch.
bool touches_support(const mesh::TornMesh& body, const Pieces& before, const mesh::MeshEdit& edit,
                     const std::vector<std::uint8_t>& held) {
  // Every node of the edit with every piece that had or has a tet there: the tets that remain, and those removed.
  std::vector<std::pair<NodeId, std::int32_t>> seen;
  const auto see = [&](NodeId node) {
    for (const TetId tet : body.tets_around(node)) seen.emplace_back(node, before.of_tet[tet.index()]);
  };
  const auto see_corner = [&](TetId tet, NodeId node) {
    seen.emplace_back(node, before.of_tet[tet.index()]);
    see(node);
  };
  for (const TetId tet : edit.removed)
    for (const NodeId node : body.mesh().tet(tet)) see_corner(tet, node);
  for (const mesh::RewiredTet& change : edit.rewired)
    for (std::size_t k = 0; k < 4; ++k) {
      see_corner(change.tet, change.before[k]);
      see_corner(change.tet, change.after[k]);
    }
  for (const mesh::MovedNode& move : edit.moved) see(move.node);
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::size_t dof = 3 * seen[i].first.index();
    if ((held[dof] | held[dof + 1] | held[dof + 2]) != 0) return true;
    if (i > 0 && seen[i].first == seen[i - 1].first) return true;
  }
  return false;
}

/// The lowest tet of a piece, searched upwards from where it was; not valid when the piece has gone.
TetId first_tet(const std::vector<std::int32_t>& of_tet, std::int32_t piece, TetId from) {
  const auto at = std::find(of_tet.begin() + from.value(), of_tet.end(), piece);
  return at == of_tet.end() ? TetId() : TetId(static_cast<std::size_t>(at - of_tet.begin()));
}

/// Numbers the pieces by their lowest tets again; those without one drop out. Whether any number changed.
bool renumber(Pieces& pieces) {
  std::vector<std::int32_t> order;
  for (std::size_t piece = 0; piece < pieces.first.size(); ++piece)
    if (pieces.first[piece].valid()) order.push_back(static_cast<std::int32_t>(piece));
  const auto first = [&](std::int32_t piece) { return pieces.first[static_cast<std::size_t>(piece)]; };
  if (order.size() == pieces.first.size() && std::is_sorted(pieces.first.begin(), pieces.first.end())) return false;
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) { return first(a) < first(b); });
  std::vector<std::int32_t> number(pieces.first.size(), -1);
  std::vector<TetId> firsts;
  for (const std::int32_t piece : order) {
    number[static_cast<std::size_t>(piece)] = static_cast<std::int32_t>(firsts.size());
    firsts.push_back(first(piece));
  }
  pieces.first = std::move(firsts);
  for (std::int32_t& piece : pieces.of_tet)
    if (piece >= 0) piece = number[static_cast<std::size_t>(piece)];
  return true;
}

}  // namespace

Pieces find_pieces(const mesh::TornMesh& body, const std::vector<std::uint8_t>& held) {
  Pieces pieces;
  pieces.of_tet.assign(body.mesh().tet_count(), -1);
  std::vector<TetId> open;
  for (std::size_t tet = 0; tet < body.mesh().tet_count(); ++tet) {
    if (!body.is_alive(TetId(tet)) || pieces.of_tet[tet] >= 0) continue;
    const auto piece = static_cast<std::int32_t>(pieces.first.size());
    pieces.first.emplace_back(tet);
    pieces.of_tet[tet] = piece;
    open.assign(1, TetId(tet));
    while (!open.empty()) {
      const TetId at = open.back();
      open.pop_back();
      for (std::int8_t k = 0; k < 4; ++k) {
        const TetId next = tet_across(body, {at, k});
        if (!next.valid() || pieces.of_tet[next.index()] >= 0) continue;
        pieces.of_tet[next.index()] = piece;
        open.push_back(next);
      }
    }
  }
  pieces.supported = find_support(body, pieces, held);
  return pieces;
}

void update_pieces(Pieces& pieces, const mesh::TornMesh& body, const mesh::MeshEdit& edit,
                   const std::vector<std::uint8_t>& held) {
  const std::vector<std::vector<TetId>> parts = parts_cut_off(body, pieces, tets_beside(body, edit));
  const bool support_changes = !parts.empty() || touches_support(body, pieces, edit, held);

  for (const TetId tet : edit.removed) pieces.of_tet[tet.index()] = -1;
  for (const std::vector<TetId>& part : parts) {
    for (const TetId tet : part) pieces.of_tet[tet.index()] = static_cast<std::int32_t>(pieces.first.size());
    pieces.first.push_back(part.front());
  }
  for (std::size_t piece = 0; piece < pieces.first.size(); ++piece) {
    const auto number = static_cast<std::int32_t>(piece);
    TetId& first = pieces.first[piece];
    if (pieces.of_tet[first.index()] != number) first = first_tet(pieces.of_tet, number, first);
  }
  if (renumber(pieces) || support_changes) pieces.supported = find_support(body, pieces, held);
}

std::vector<TetId> unsupported_tets(const mesh::TornMesh& body, const Pieces& pieces) {
  std::vector<TetId> tets;
  if (std::find(pieces.supported.begin(), pieces.supported.end(), 0) == pieces.supported.end()) return tets;
  for (std::size_t tet = 0; tet < pieces.of_tet.size(); ++tet) {
    const std::int32_t piece = pieces.of_tet[tet];
    if (piece >= 0 && pieces.supported[static_cast<std::size_t>(piece)] == 0 && body.is_solved(TetId(tet)))
      tets.emplace_back(tet);
  }
  return tets;
}

}  // namespace rhexis::fracture
