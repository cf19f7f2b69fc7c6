/// The sections of MSH 2 (2.0 to 2.2) that differ from MSH 4.

#include <algorithm>
#include <map>

#include "mesh/io/msh_input.h"

namespace rhexis::mesh::io {
namespace {

constexpr std::size_t kShortestNode = 8;  // "1 0 0 0\n"
constexpr std::size_t kBinaryNode = 4 + 24;
constexpr std::size_t kShortestElement = 8;  // "1 15 0 1", a point
constexpr std::size_t kBinaryElement = 8;    // number and one node

/// Gmsh 2 writes an element once for each physical group that it belongs to. A tet that comes again with the same
/// nodes in another group is the same tet.
class TetFilter {
 public:
  /// False when the tet is a repetition.
  void add(const Tet& tet, std::int64_t physical) { seen_.push_back({tet, physical, seen_.size()}); }
  /// For each tet, in order, whether it stays.
  [[nodiscard]] std::vector<bool> keep() {
    std::vector<bool> kept(seen_.size(), true);
    const bool one_group =
        std::all_of(seen_.begin(), seen_.end(), [&](const Seen& s) { return s.physical == seen_.front().physical; });
    if (one_group) return kept;
    std::sort(seen_.begin(), seen_.end());
    for (std::size_t i = 1; i < seen_.size(); ++i) {
      const bool repeated = seen_[i].tet == seen_[i - 1].tet && seen_[i].physical != seen_[i - 1].physical;
      if (repeated) kept[seen_[i].place] = false;
    }
    return kept;
  }

 private:
  struct Seen {
    Tet tet;
    std::int64_t physical;
    std::size_t place;
    friend auto operator<=>(const Seen&, const Seen&) = default;
  };
  std::vector<Seen> seen_;
};

class ElementReader {
 public:
  explicit ElementReader(MshInput& in) : in_(in) {}

  /// What follows the type (and, in text, the number of tags): tags, then nodes.
  void read(const ElementKind& kind, std::int64_t number, std::int64_t tag_count) {
    check_kind(kind, number, in_.cursor);
    physicals_.clear();
    for (std::int64_t t = 0; t < tag_count; ++t) {
      const std::int64_t tag = in_.integer("a tag of the element");
      if (t == 0 && tag != 0) physicals_.push_back(tag < 0 ? -tag : tag);  // the sign is an orientation
    }
    nodes_.clear();
    for (std::size_t k = 0; k < kind.nodes; ++k)
      nodes_.push_back(in_.node(in_.integer("a node of the element"), number));
    const std::size_t before = in_.mesh.tets.size();
    in_.add_element(kind, nodes_, physicals_);
    if (in_.mesh.tets.size() > before) filter_.add(in_.mesh.tets.back(), physicals_.empty() ? 0 : physicals_.front());
  }

  void drop_repeated_tets() {
    const std::vector<bool> keep = filter_.keep();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < keep.size(); ++i) {
      if (keep[i]) in_.mesh.tets[kept++] = in_.mesh.tets[i];
    }
    in_.mesh.tets.resize(kept);
  }

 private:
  MshInput& in_;
  std::vector<std::int64_t> physicals_;
  std::vector<NodeId> nodes_;
  TetFilter filter_;
};

std::int64_t read_count(MshInput& in, std::string_view things, std::size_t shortest, std::size_t shortest_binary) {
  const std::int64_t count = in.cursor.integer(fmt::format("the number of {}", things));
  if (count < 0) in.cursor.refuse(fmt::format("the number of {} is {}", things, count));
  if (in.binary) in.cursor.rest_of_line();
  check_count(static_cast<std::uint64_t>(count), things, in.cursor.line());
  in.cursor.check_room(static_cast<std::uint64_t>(count), in.binary ? shortest_binary : shortest, things);
  return count;
}

}  // namespace

void read_msh2_nodes(MshInput& in) {
  const std::int64_t count = read_count(in, "nodes", kShortestNode, kBinaryNode);
  in.mesh.nodes.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    in.begin_record("a node");
    const std::int64_t tag = in.integer("the number of a node");
    in.tags.add(tag, in.cursor.line());
    in.read_position(tag);
    in.end_record("a node");
  }
  in.tags.finish();
}

void read_msh2_elements(MshInput& in) {
  const std::int64_t count = read_count(in, "elements", kShortestElement, kBinaryElement);
  ElementReader reader(in);
  std::int64_t done = 0;
  while (done < count) {
    in.begin_record("an element");
    if (in.binary) {
      // Runs of elements of one type share a header.
      const ElementKind& kind = element_kind(in.integer("an element type"), in.cursor);
      const std::int64_t run = in.integer("the length of a run of elements");
      const std::int64_t tag_count = in.integer("the number of tags");
      if (run < 1 || run > count - done) {
        in.cursor.refuse(fmt::format("a run of {} elements after {} of {}", run, done, count));
      }
      if (tag_count < 0) in.cursor.refuse(fmt::format("the number of tags is {}", tag_count));
      for (std::int64_t i = 0; i < run; ++i) reader.read(kind, in.integer("the number of an element"), tag_count);
      done += run;
    } else {
      const std::int64_t number = in.integer("the number of an element");
      const ElementKind& kind = element_kind(in.integer("an element type"), in.cursor);
      const std::int64_t tag_count = in.integer("the number of tags");
      if (tag_count < 0) in.cursor.refuse(fmt::format("the number of tags is {}", tag_count));
      reader.read(kind, number, tag_count);
      in.end_record(fmt::format("element {}", number));
      ++done;
    }
  }
  reader.drop_repeated_tets();
}

}  // namespace rhexis::mesh::io
