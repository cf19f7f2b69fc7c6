#pragma once

/// What the readers of MSH 2 and MSH 4 share: numbers that are text or binary, node tags, physical groups, elements.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mesh/io/cursor.h"
#include "mesh/io/raw_mesh.h"

namespace rhexis::mesh::io {

/// Gmsh numbers nodes by tags, which need not follow each other. Maps them to places in the file.
class NodeTags {
 public:
  void add(std::int64_t tag, int line);
  /// Refuses tags that occur twice. To be called when all are in, before find().
  void finish();
  /// An invalid id when there is no such node.
  [[nodiscard]] NodeId find(std::int64_t tag) const;
  [[nodiscard]] std::size_t size() const { return tags_.size(); }

 private:
  std::vector<std::int64_t> tags_;  ///< in the order of the file
  std::vector<int> lines_;
  std::vector<std::pair<std::int64_t, NodeId>> sorted_;  ///< empty while tags follow each other
};

struct ElementKind {
  int type;
  int dimension;
  std::size_t nodes;
  int order;         ///< of the shape functions
  const char* name;  ///< in the plural
};
/// Gmsh's element types. Refuses an unknown one.
[[nodiscard]] const ElementKind& element_kind(std::int64_t type, const Cursor& cursor);
/// Refuses volumes that are no linear tets, naming the element.
void check_kind(const ElementKind& kind, std::int64_t element, const Cursor& cursor);

struct MshInput {
  explicit MshInput(std::string_view bytes) : cursor(bytes) {}

  // Numbers are int32, uint64 and double where the file is binary.
  std::int64_t integer(std::string_view wanted);
  std::int64_t size(std::string_view wanted);
  double real(std::string_view wanted);
  /// Lines matter in text alone.
  void begin_record(std::string_view what);
  void end_record(std::string_view what);

  /// Reads three coordinates; refuses what is not finite. Positions go to `mesh.nodes`.
  void read_position(std::int64_t tag);
  /// Group of a physical tag; made when it is new, with a name from its tag unless there is one.
  RawGroup& group(int dimension, std::int64_t physical, std::string name = {});
  /// Adds an element to the mesh and to its groups, or counts it as left out.
  void add_element(const ElementKind& kind, const std::vector<NodeId>& nodes,
                   const std::vector<std::int64_t>& physicals);
  /// The node of a tag that an element names.
  NodeId node(std::int64_t tag, std::int64_t element);

  Cursor cursor;
  bool binary = false;
  bool swap = false;
  bool has_nodes = false;
  RawMesh mesh;
  NodeTags tags;

 private:
  std::map<std::pair<int, std::int64_t>, std::size_t> group_index_;  ///< by dimension and physical tag
};

// Contents of one section, from behind its opening line.
void read_msh2_nodes(MshInput& in);
void read_msh2_elements(MshInput& in);

/// Physical tags of Gmsh's geometric entities, by dimension and tag.
using MshEntities = std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>>;
[[nodiscard]] MshEntities read_msh4_entities(MshInput& in);
void read_msh4_nodes(MshInput& in);
void read_msh4_elements(MshInput& in, const MshEntities& entities);

}  // namespace rhexis::mesh::io
