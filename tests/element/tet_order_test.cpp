// Chunks and colours: every tet once, no node shared within a colour, nothing left to chance.

#include "element/tet_order.h"

#include <gtest/gtest.h>

#include <set>

#include "base/parallel.h"
#include "element/tet_batches.h"
#include "mesh/generate.h"

namespace rhexis::test {
namespace {

void expect_sound(const mesh::TetMesh& mesh, const element::TetOrder& order) {
  const std::set<std::int32_t> distinct(order.tets.begin(), order.tets.end());
  ASSERT_EQ(order.tets.size(), mesh.tet_count());
  ASSERT_EQ(distinct.size(), mesh.tet_count());
  EXPECT_EQ(order.chunk_start.back(), order.tets.size());
  EXPECT_EQ(order.colour_start.back() + 1, order.chunk_start.size());
  for (std::size_t colour = 0; colour + 1 < order.colour_start.size(); ++colour) {
    std::vector<std::size_t> owner(mesh.node_count(), order.chunk_start.size());
    for (std::size_t c = order.colour_start[colour]; c < order.colour_start[colour + 1]; ++c) {
      EXPECT_LT(order.chunk_start[c], order.chunk_start[c + 1]);
      for (std::size_t i = order.chunk_start[c]; i < order.chunk_start[c + 1]; ++i) {
        for (const NodeId node : mesh.tets[static_cast<std::size_t>(order.tets[i])]) {
          std::size_t& chunk = owner[node.index()];
          if (chunk == order.chunk_start.size()) chunk = c;
          ASSERT_EQ(chunk, c) << "two chunks of colour " << colour << " share node " << node.value();
        }
      }
    }
  }
}

TEST(TetOrder, LongBodiesNeedTwoColours) {
  const mesh::TetMesh mesh = mesh::make_structured_box(Vec3(0.1, 0.1, 0.4), {8, 8, 32});
  const element::TetOrder order = element::order_tets(mesh);
  expect_sound(mesh, order);
  EXPECT_EQ(order.colour_start.size() - 1, 2U);
  EXPECT_GE(order.chunk_start.size() - 1, 16U);
}

TEST(TetOrder, CompactTinyAndEmptyBodies) {
  for (const int n : {1, 2, 5, 12}) {
    const mesh::TetMesh mesh = mesh::make_structured_box(Vec3(1.0, 1.0, 1.0), {n, n, n});
    expect_sound(mesh, element::order_tets(mesh));
  }
  const element::TetOrder empty = element::order_tets({});
  EXPECT_TRUE(empty.tets.empty());
  EXPECT_EQ(element::TetBatches({}).chunk_count(), 0U);
}

TEST(TetOrder, PiecesAndLooseNodes) {
  mesh::TetMesh mesh = mesh::make_structured_box(Vec3(1.0, 1.0, 1.0), {3, 3, 3});
  const mesh::TetMesh other = mesh::make_structured_box(Vec3(1.0, 1.0, 2.0), {3, 3, 6});
  mesh.nodes.emplace_back(9.0, 9.0, 9.0);
  const auto shift = static_cast<std::int32_t>(mesh.node_count());
  mesh.nodes.insert(mesh.nodes.end(), other.nodes.begin(), other.nodes.end());
  for (mesh::Tet tet : other.tets) {
    for (NodeId& node : tet) node = NodeId(node.value() + shift);
    mesh.tets.push_back(tet);
  }
  expect_sound(mesh, element::order_tets(mesh));
}

TEST(TetOrder, AStarOfManyTetsRunsOutOfColours) {
  // 6,000 tets round one node: all chunks clash.
  mesh::TetMesh mesh;
  mesh.nodes.emplace_back(0.0, 0.0, 0.0);
  for (int i = 0; i < 6000; ++i) {
    const auto first = static_cast<std::int32_t>(mesh.node_count());
    mesh.nodes.insert(mesh.nodes.end(), {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0)});
    mesh.tets.push_back({NodeId(0), NodeId(first), NodeId(first + 1), NodeId(first + 2)});
  }
  const element::TetOrder order = element::order_tets(mesh);
  expect_sound(mesh, order);
  EXPECT_EQ(order.colour_start.size(), order.chunk_start.size());
}

TEST(TetOrder, DoesNotDependOnThreads) {
  const mesh::TetMesh mesh = mesh::make_structured_box(Vec3(1.0, 1.0, 1.0), {6, 6, 6});
  set_thread_count(1);
  const element::TetOrder one = element::order_tets(mesh);
  set_thread_count(4);
  const element::TetOrder four = element::order_tets(mesh);
  set_thread_count(0);
  EXPECT_EQ(one.tets, four.tets);
  EXPECT_EQ(one.chunk_start, four.chunk_start);
  EXPECT_EQ(one.colour_start, four.colour_start);
}

TEST(TetBatches, HoldEveryTetOnceWithItsVolume) {
  const mesh::TetMesh mesh = mesh::make_structured_box(Vec3(0.3, 0.2, 0.5), {3, 2, 5});
  const element::TetBatches batches(mesh);
  std::vector<int> seen(mesh.tet_count(), 0);
  double volume = 0.0;
  for (const element::TetBatch& batch : batches.batches()) {
    ASSERT_GE(batch.count, 1);
    for (int lane = 0; lane < element::kBatch; ++lane) {
      volume += batch.volume[lane];
      if (lane < batch.count) ++seen[static_cast<std::size_t>(batch.tet[lane])];
      for (int a = 0; a < 3; ++a) {
        EXPECT_LT(batch.node[a][lane], batch.node[a + 1][lane]);
        // Shape function a + 1 rises from 0 at node 0 to 1 at its own.
        const Vec3 gradient(batch.gradient[3 * a][lane], batch.gradient[3 * a + 1][lane],
                            batch.gradient[3 * a + 2][lane]);
        const Vec3 edge = mesh.nodes[static_cast<std::size_t>(batch.node[a + 1][lane])] -
                          mesh.nodes[static_cast<std::size_t>(batch.node[0][lane])];
        EXPECT_NEAR(gradient.dot(edge), 1.0, 1e-14);
      }
    }
  }
  EXPECT_EQ(seen, std::vector<int>(mesh.tet_count(), 1));
  EXPECT_NEAR(volume, 0.03, 1e-15);
}

}  // namespace
}  // namespace rhexis::test
