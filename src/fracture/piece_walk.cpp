#include "fracture/piece_walk.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <utility>

#include "fracture/face_neighbours.h"

namespace rhexis::fracture {
namespace {

/// By which walk each tet was met. Most walks meet a few hundred tets; one that goes through half of a large body gets
/// room for all, since hashing would take most of its time.
class Meetings {
 public:
  explicit Meetings(std::size_t tet_count) : tet_count_(tet_count) {}

  /// The walk that met the tet before; none when `walk` is the first.
  std::optional<std::size_t> meet(TetId tet, std::size_t walk) {
    if (all_.empty() && few_.size() < kFew) {
      const auto [at, is_new] = few_.try_emplace(tet, walk);
      return is_new ? std::nullopt : std::optional(at->second);
    }
    if (all_.empty()) {
      all_.assign(tet_count_, kNone);
      for (const auto& [known, by] : few_) all_[known.index()] = by;
    }
    std::size_t& by = all_[tet.index()];
    if (by != kNone) return by;
    by = walk;
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kFew = 8192;
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t tet_count_;
  std::unordered_map<TetId, std::size_t> few_;  // looked up, and copied to what has an order
  std::vector<std::size_t> all_;
};

/// Breadth-first walks, one from each seed, that become one where they meet.
class Walks {
 public:
  Walks(const mesh::TornMesh& body, const std::vector<TetId>& seeds)
      : body_(body), walks_(seeds.size()), met_(body.mesh().tet_count()) {
    for (std::size_t w = 0; w < seeds.size(); ++w) {
      walks_[w] = {w, {seeds[w]}, 0};
      met_.meet(seeds[w], w);
    }
  }

  [[nodiscard]] bool is_own(std::size_t walk) const { return walks_[walk].joined == walk; }
  [[nodiscard]] bool is_complete(std::size_t walk) const { return walks_[walk].done == walks_[walk].tets.size(); }
  [[nodiscard]] std::vector<TetId> take(std::size_t walk) { return std::move(walks_[walk].tets); }

  /// Looks at the neighbours of the next tet.
  void step(std::size_t walk) {
    const TetId tet = walks_[walk].tets[walks_[walk].done++];
    for (std::int8_t k = 0; k < 4; ++k) {
      const TetId next = tet_across(body_, {tet, k});
      if (!next.valid()) continue;
      const std::optional<std::size_t> before = met_.meet(next, walk);
      if (!before) {
        walks_[walk].tets.push_back(next);
        continue;
      }
      const std::size_t other = own(*before);
      if (other == walk) continue;
      walk = join(walk, other);
    }
  }

 private:
  struct Walk {
    std::size_t joined = 0;   ///< the walk that it has become part of, or itself
    std::vector<TetId> tets;  ///< in the order they were met
    std::size_t done = 0;     ///< of those, how many have been stepped from
  };

  std::size_t own(std::size_t walk) {
    while (walks_[walk].joined != walk) walk = walks_[walk].joined = walks_[walks_[walk].joined].joined;
    return walk;
  }

  /// The smaller is poured into the larger; its tets are stepped from once more, which costs less than keeping apart
  /// what was done.
  std::size_t join(std::size_t a, std::size_t b) {
    if (walks_[a].tets.size() < walks_[b].tets.size()) std::swap(a, b);
    walks_[a].tets.insert(walks_[a].tets.end(), walks_[b].tets.begin(), walks_[b].tets.end());
    walks_[b].tets.clear();
    walks_[b].done = 0;
    walks_[b].joined = a;
    return a;
  }

  const mesh::TornMesh& body_;
  std::vector<Walk> walks_;
  Meetings met_;
};

/// Walks from seeds that were in one piece.
void walk_piece(const mesh::TornMesh& body, const std::vector<TetId>& seeds, std::vector<std::vector<TetId>>& parts) {
  Walks walks(body, seeds);
  std::vector<std::size_t> going(seeds.size());
  for (std::size_t w = 0; w < going.size(); ++w) going[w] = w;
  while (going.size() > 1) {
    for (const std::size_t walk : going) {
      if (!walks.is_own(walk)) continue;
      if (!walks.is_complete(walk)) walks.step(walk);
    }
    std::erase_if(going, [&](std::size_t walk) { return !walks.is_own(walk); });
    for (auto at = going.begin(); at != going.end() && going.size() > 1;) {
      if (!walks.is_complete(*at)) {
        ++at;
        continue;
      }
      parts.push_back(walks.take(*at));
      at = going.erase(at);
    }
  }
}

}  // namespace

std::vector<std::vector<TetId>> parts_cut_off(const mesh::TornMesh& body, const Pieces& pieces,
                                              const std::vector<TetId>& seeds) {
  std::vector<TetId> by_piece = seeds;
  const auto piece = [&](TetId tet) { return pieces.of_tet[tet.index()]; };
  std::stable_sort(by_piece.begin(), by_piece.end(), [&](TetId a, TetId b) { return piece(a) < piece(b); });
  std::vector<std::vector<TetId>> parts;
  for (auto begin = by_piece.begin(); begin != by_piece.end();) {
    const auto end = std::find_if(begin, by_piece.end(), [&](TetId tet) { return piece(tet) != piece(*begin); });
    walk_piece(body, {begin, end}, parts);
    begin = end;
  }
  for (std::vector<TetId>& part : parts) std::sort(part.begin(), part.end());
  std::sort(parts.begin(), parts.end());
  return parts;
}

}  // namespace rhexis::fracture
