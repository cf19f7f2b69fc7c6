#include "fracture/piece_support.h"

#include <algorithm>

#include "model/rigid_motion.h"

namespace rhexis::fracture {
namespace {

/// Where pieces touch without sharing a face.
struct Contact {
  NodeId node;
  std::vector<std::int32_t> pieces;  ///< two or more, ascending
};

std::size_t largest_piece(const Pieces& pieces) {
  std::vector<std::size_t> size(pieces.first.size(), 0);
  for (const std::int32_t piece : pieces.of_tet)
    if (piece >= 0) ++size[static_cast<std::size_t>(piece)];
  return static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
}

/// Every contact has a piece that is not the largest, so only those are searched.
std::vector<Contact> find_contacts(const mesh::TornMesh& body, const Pieces& pieces) {
  const auto largest = static_cast<std::int32_t>(largest_piece(pieces));
  std::vector<NodeId> nodes;
  for (std::size_t tet = 0; tet < pieces.of_tet.size(); ++tet) {
    if (pieces.of_tet[tet] < 0 || pieces.of_tet[tet] == largest) continue;
    for (const NodeId node : body.mesh().tets[tet]) nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());

  std::vector<Contact> contacts;
  for (const NodeId node : nodes) {
    std::vector<std::int32_t> touching = pieces_around(body, pieces, node);
    if (touching.size() > 1) contacts.push_back({node, std::move(touching)});
  }
  return contacts;
}

}  // namespace

std::vector<std::int32_t> pieces_around(const mesh::TornMesh& body, const Pieces& pieces, NodeId node) {
  std::vector<std::int32_t> around;
  for (const TetId tet : body.tets_around(node)) around.push_back(pieces.of_tet[tet.index()]);
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  return around;
}

std::vector<std::uint8_t> find_support(const mesh::TornMesh& body, const Pieces& pieces,
                                       const std::vector<std::uint8_t>& held) {
  const std::size_t count = pieces.first.size();
  std::vector<std::vector<model::HeldComponent>> holds(count);
  for (std::size_t node = 0; node < body.mesh().node_count(); ++node) {
    if ((held[3 * node] | held[3 * node + 1] | held[3 * node + 2]) == 0) continue;
    for (const std::int32_t piece : pieces_around(body, pieces, NodeId(node)))
      for (int axis = 0; axis < 3; ++axis)
        if (held[3 * node + static_cast<std::size_t>(axis)] != 0)
          holds[static_cast<std::size_t>(piece)].push_back({body.mesh().nodes[node], axis});
  }

  const mesh::BoundingBox box = mesh::bounding_box(body.mesh());
  const std::vector<Contact> contacts = count > 1 ? find_contacts(body, pieces) : std::vector<Contact>{};
  std::vector<std::uint8_t> supported(count, 0);
  std::vector<std::uint8_t> to_test(count, 1);
  // A piece that has found support lends it to what it touches, which is looked at again.
  for (bool again = true; again;) {
    again = false;
    for (std::size_t piece = 0; piece < count; ++piece) {
      if (to_test[piece] == 0) continue;
      to_test[piece] = 0;
      if (model::free_motions(holds[piece], 0.5 * (box.from + box.to), box.size().norm()).cols() != 0) continue;
      supported[piece] = 1;
      for (const Contact& contact : contacts) {
        if (!std::binary_search(contact.pieces.begin(), contact.pieces.end(), static_cast<std::int32_t>(piece)))
          continue;
        for (const std::int32_t other : contact.pieces) {
          const auto at = static_cast<std::size_t>(other);
          if (supported[at] != 0) continue;
          for (int axis = 0; axis < 3; ++axis) holds[at].push_back({body.mesh().node(contact.node), axis});
          to_test[at] = 1;
          again = true;
        }
      }
    }
  }
  return supported;
}

}  // namespace rhexis::fracture
