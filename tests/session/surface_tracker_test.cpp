#include "session/surface_tracker.h"

#include <optional>
#include <set>

#include "tests/session/random_pull.h"

namespace rhexis::session {
namespace {

using Corners = std::array<std::int32_t, 3>;

/// The corners of every face that one alive tet has, turned so that the smallest comes first: by counting faces.
std::set<Corners> slow_surface(const mesh::TornMesh& body) {
  std::map<Corners, int> times;
  std::map<Corners, Corners> turned;
  for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
    if (!body.is_alive(TetId(t))) continue;
    for (std::int8_t vertex = 0; vertex < 4; ++vertex) {
      const auto nodes = mesh::face_nodes(body.mesh(), {TetId(t), vertex});
      Corners corners{nodes[0].value(), nodes[1].value(), nodes[2].value()};
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      Corners sorted = corners;
      std::sort(sorted.begin(), sorted.end());
      ++times[sorted];
      turned[sorted] = corners;
    }
  }
  std::set<Corners> out;
  for (const auto& [sorted, count] : times)
    if (count == 1) out.insert(turned[sorted]);
  return out;
}

/// What a client has: it knows nothing but the changes.
struct Client {
  std::vector<Vec3> position;
  std::vector<NodeId> node;
  std::vector<std::array<std::uint32_t, 3>> faces;

  Client(const SurfaceTracker& surface, const mesh::TetMesh& mesh) : node(surface.nodes()), faces(surface.faces()) {
    for (const NodeId n : node) position.push_back(mesh.node(n));
  }
  void take(const SurfaceChange& change, const SurfaceTracker& surface, const mesh::TetMesh& mesh) {
    for (const std::uint32_t vertex : change.moved) position[vertex] = mesh.node(node[vertex]);
    ASSERT_EQ(change.first_new, node.size());
    for (std::size_t vertex = node.size(); vertex < surface.nodes().size(); ++vertex) {
      node.push_back(surface.nodes()[vertex]);
      position.push_back(mesh.node(node.back()));
    }
    std::set<std::uint32_t> named;
    for (const std::uint32_t slot : change.gone) {
      EXPECT_TRUE(named.insert(slot).second);
      faces[slot] = {};
    }
    for (const std::uint32_t slot : change.filled) {
      EXPECT_TRUE(named.insert(slot).second);
      ASSERT_LE(slot, faces.size());
      if (slot == faces.size()) faces.emplace_back();
      faces[slot] = surface.faces()[slot];
    }
  }
  [[nodiscard]] std::set<Corners> shown() const {
    std::set<Corners> out;
    for (const auto& face : faces) {
      if (face[0] == face[1]) continue;
      Corners corners{node[face[0]].value(), node[face[1]].value(), node[face[2]].value()};
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      EXPECT_TRUE(out.insert(corners).second) << "a face twice";
    }
    return out;
  }
};

struct Seen {
  int edits = 0, copies = 0, frozen = 0, refilled = 0, undone = 0;
};

void watch(std::uint64_t seed, Seen& seen) {
  std::optional<SurfaceTracker> surface;
  std::optional<Client> client;
  const auto begin = [&](const TearSession& tear) {
    surface.emplace(tear.body());
    client.emplace(*surface, tear.body().mesh());
    ASSERT_EQ(client->shown(), slow_surface(tear.body())) << seed;
  };
  test::RandomPull pull(seed);
  pull.set_watch({.begins = begin,
                  .edited =
                      [&](const TearSession& tear) {
                        const mesh::MeshEdit& edit = tear.body().history().back();
                        const std::size_t slots = client->faces.size();
                        const SurfaceChange change = surface->follow(tear.body(), edit);
                        client->take(change, *surface, tear.body().mesh());
                        ASSERT_EQ(client->shown(), slow_surface(tear.body())) << seed;
                        for (std::size_t v = 0; v < client->node.size(); ++v)
                          ASSERT_EQ(client->position[v], tear.body().mesh().node(client->node[v])) << seed;
                        ++seen.edits;
                        seen.copies += static_cast<int>(edit.copied.size());
                        seen.frozen += static_cast<int>(edit.frozen.size());
                        for (const std::uint32_t slot : change.filled) seen.refilled += slot < slots ? 1 : 0;
                      },
                  .undone =
                      [&](const TearSession& tear) {
                        ++seen.undone;
                        begin(tear);
                      }});
  test::PullTally tally;
  pull.run(tally, 0.0);
}

TEST(SurfaceTracker, IsTheSurfaceOfAllAliveTetsAfterEveryEditOfRandomPulls) {
  Seen seen;
  for (std::uint64_t seed = 0; seed < 30; ++seed) watch(seed, seen);
  // The sweep has all kinds: nodes copied by `split`, pieces frozen, slots filled again, edits taken back.
  EXPECT_GT(seen.edits, 50);
  EXPECT_GT(seen.copies, 0);
  EXPECT_GT(seen.frozen, 0);
  EXPECT_GT(seen.refilled, 0);
  EXPECT_GT(seen.undone, 50);
}

TEST(SurfaceTracker, FindsASlotByItsFaceAndTheFaceByItsSlot) {
  const mesh::TornMesh body(*mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, 506));
  const SurfaceTracker surface(body);
  ASSERT_GT(surface.faces().size(), 0U);
  for (std::uint32_t slot = 0; slot < surface.faces().size(); ++slot) {
    ASSERT_FALSE(surface.is_empty(slot));
    EXPECT_EQ(surface.slot_of(surface.face(slot)), slot);
    const auto nodes = mesh::face_nodes(body.mesh(), surface.face(slot));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(surface.nodes()[surface.faces()[slot][k]], nodes[k]);
  }
}

}  // namespace
}  // namespace rhexis::session
