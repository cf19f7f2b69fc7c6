/// The sections of MSH 4.1. Text and binary have the same structure.

#include "mesh/io/msh_input.h"

namespace rhexis::mesh::io {
namespace {

/// A count of things that take at least so many bytes each in text and in binary.
std::int64_t read_count(MshInput& in, std::string_view things, std::size_t shortest, std::size_t shortest_binary) {
  const std::int64_t count = in.size(fmt::format("the number of {}", things));
  check_count(static_cast<std::uint64_t>(count), things, in.cursor.line());
  in.cursor.check_room(static_cast<std::uint64_t>(count), in.binary ? shortest_binary : shortest, things);
  return count;
}

int read_dimension(MshInput& in) {
  const std::int64_t dimension = in.integer("the dimension of an entity");
  if (dimension < 0 || dimension > 3)
    in.cursor.refuse(fmt::format("the dimension of an entity is {}", dimension), "0 to 3");
  return static_cast<int>(dimension);
}

}  // namespace

MshEntities read_msh4_entities(MshInput& in) {
  MshEntities entities;
  std::int64_t counts[4];
  in.begin_record("the numbers of entities");
  for (std::int64_t& count : counts) count = read_count(in, "entities", 10, 36);
  in.end_record("the numbers of entities");
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::int64_t i = 0; i < counts[dimension]; ++i) {
      in.begin_record("an entity");
      const std::int64_t tag = in.integer("the tag of an entity");
      for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) (void)in.real("a bound of the entity");
      std::vector<std::int64_t>& physicals = entities[{dimension, tag}];
      const std::int64_t physical_count = read_count(in, "physical tags", 2, 4);
      for (std::int64_t k = 0; k < physical_count; ++k) {
        const std::int64_t physical = in.integer("a physical tag");
        physicals.push_back(physical < 0 ? -physical : physical);  // the sign is an orientation
      }
      if (dimension > 0) {
        const std::int64_t bounding = read_count(in, "bounding entities", 2, 4);
        for (std::int64_t k = 0; k < bounding; ++k) (void)in.integer("the tag of a bounding entity");
      }
      in.end_record(fmt::format("entity {}", tag));
    }
  }
  return entities;
}

void read_msh4_nodes(MshInput& in) {
  in.begin_record("the head of the nodes");
  const std::int64_t blocks = read_count(in, "node blocks", 8, 20);
  const std::int64_t count = read_count(in, "nodes", 8, 32);
  for (const char* wanted : {"the smallest node tag", "the largest node tag"}) (void)in.size(wanted);
  in.end_record("the head of the nodes");
  in.mesh.nodes.reserve(static_cast<std::size_t>(count));
  std::vector<std::int64_t> block_tags;
  for (std::int64_t block = 0; block < blocks; ++block) {
    in.begin_record("the head of a node block");
    const int dimension = read_dimension(in);
    (void)in.integer("the tag of an entity");
    const bool parametric = in.integer("whether nodes are parametric") != 0;
    const std::int64_t here = read_count(in, "nodes of a block", 8, 32);
    in.end_record("the head of a node block");
    if (here > count - static_cast<std::int64_t>(in.tags.size())) {
      in.cursor.refuse(fmt::format("the blocks hold more nodes than the {} of the section", count));
    }
    block_tags.clear();
    for (std::int64_t i = 0; i < here; ++i) {
      in.begin_record("the tag of a node");
      block_tags.push_back(in.size("the tag of a node"));
      in.tags.add(block_tags.back(), in.cursor.line());
      in.end_record("the tag of a node");
    }
    for (const std::int64_t tag : block_tags) {
      in.begin_record("a node");
      in.read_position(tag);
      for (int k = 0; parametric && k < dimension; ++k) (void)in.real("a parameter of the node");
      in.end_record("a node");
    }
  }
  if (static_cast<std::int64_t>(in.tags.size()) != count) {
    in.cursor.refuse(fmt::format("the section promises {} nodes, its blocks hold {}", count, in.tags.size()));
  }
  in.tags.finish();
}

void read_msh4_elements(MshInput& in, const MshEntities& entities) {
  in.begin_record("the head of the elements");
  const std::int64_t blocks = read_count(in, "element blocks", 8, 20);
  const std::int64_t count = read_count(in, "elements", 4, 16);
  for (const char* wanted : {"the smallest element tag", "the largest element tag"}) (void)in.size(wanted);
  in.end_record("the head of the elements");
  const std::vector<std::int64_t> no_physicals;
  std::vector<NodeId> nodes;
  std::int64_t done = 0;
  for (std::int64_t block = 0; block < blocks; ++block) {
    in.begin_record("the head of an element block");
    const int dimension = read_dimension(in);
    const std::int64_t entity = in.integer("the tag of an entity");
    const ElementKind& kind = element_kind(in.integer("an element type"), in.cursor);
    const std::int64_t here = read_count(in, "elements of a block", 4, 16);
    in.end_record("the head of an element block");
    if (kind.dimension != dimension) {
      in.cursor.refuse(fmt::format("{} in an entity of dimension {}", kind.name, dimension),
                       "the block's head is wrong");
    }
    const auto at = entities.find({dimension, entity});
    const std::vector<std::int64_t>& physicals = at != entities.end() ? at->second : no_physicals;
    for (std::int64_t i = 0; i < here; ++i) {
      in.begin_record("an element");
      const std::int64_t number = in.size("the tag of an element");
      check_kind(kind, number, in.cursor);
      nodes.clear();
      for (std::size_t k = 0; k < kind.nodes; ++k) nodes.push_back(in.node(in.size("a node of the element"), number));
      in.add_element(kind, nodes, physicals);
      in.end_record(fmt::format("element {}", number));
    }
    done += here;
  }
  if (done != count) in.cursor.refuse(fmt::format("the section promises {} elements, its blocks hold {}", count, done));
}

}  // namespace rhexis::mesh::io
