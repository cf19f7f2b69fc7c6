// What has to hold of any incision, of any body by any surface: random cracks that run on, advance by advance, until
// the bodies are in bits, by both methods. Five seeds a body always; with RHEXIS_FULL=1 in the environment hundreds.

#include "fracture/incision.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "mesh/generate.h"
#include "tests/fracture/cut_support.h"
#include "tests/support/measured.h"

namespace rhexis::fracture::test {
namespace {

enum class Shape { plate, bar, cube, tube, rod };

mesh::TetMesh make(Shape shape, int nodes) {
  switch (shape) {
    case Shape::plate: return mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, nodes).value();
    case Shape::bar: return mesh::make_bar({Vec3(0.2, 0.05, 0.05)}, nodes).value();
    case Shape::cube: return mesh::make_bar({Vec3(0.1, 0.1, 0.1)}, nodes).value();
    case Shape::tube: return mesh::make_tube({0.005, 0.04, 0.0015, 40.0}, nodes).value();
    case Shape::rod: return mesh::make_tube({0.005, 0.03, 0.0, 0.0}, nodes).value();
  }
  return {};
}

/// A polyline across a body whose points run on, each its own way, never turning by more than 60 degrees.
struct RandomFront {
  std::vector<Vec3> points;
  std::vector<Vec3> direction;

  RandomFront(Dice& dice, const mesh::BoundingBox& box) {
    const Vec3 at = dice.inside(box);
    const Vec3 along = dice.direction();
    const Vec3 ahead = along.cross(dice.direction()).normalized();
    const double reach = box.size().norm() * dice.between(0.2, 1.2);
    const int count = 2 + static_cast<int>(dice.between(0.0, 5.0));
    for (int k = 0; k < count; ++k) {
      const double part = 2.0 * k / (count - 1) - 1.0;
      points.push_back(at + reach * (part * along - dice.between(0.0, 0.1) * ahead));
      direction.push_back(ahead);
    }
  }

  CutSurface advance(Dice& dice, double edge) {
    const std::vector<Vec3> before = points;
    const double length = edge * dice.between(0.1, 3.0);
    const Vec3 turn = dice.between(0.0, 0.8) * dice.direction();
    for (std::size_t k = 0; k < points.size(); ++k) {
      direction[k] = (direction[k] + turn + 0.2 * dice.direction()).normalized();
      points[k] += length * dice.between(0.5, 1.0) * direction[k];
    }
    return strip(before, points);
  }
};

struct Tally {
  int advances = 0;
  int ends = 0;
  int off_plane = 0;
  int most_pieces = 0;
  double volume = 0.0;  ///< the intact volumes, m^3
  double lost = 0.0;
};

class Incisions : public testing::TestWithParam<std::tuple<IncisionMethod, Shape>> {
 protected:
  /// Tears one body by three cracks; everything is checked after every advance.
  void tear(std::uint64_t seed, Tally& tally) {
    const auto [method, shape] = GetParam();
    Dice dice(seed);
    CutBody cut(make(shape, 450 + static_cast<int>(dice.between(0, 3)) * 50), method);
    const mesh::BoundingBox box = mesh::bounding_box(cut.body.mesh());
    const double ledge = box.from[2] + 0.1 * box.size()[2];
    const double side = box.from[0] + 0.06 * box.size()[0];
    cut.hold([&](const Vec3& x) { return shape == Shape::tube || shape == Shape::rod ? x[2] < ledge : x[0] < side; });
    const std::vector<Vec3> intact = cut.body.mesh().nodes;
    tally.volume += cut.body.volume();

    std::vector<std::uint64_t> fingerprints{fingerprint(cut.body)};
    Pieces pieces = find_pieces(cut.body, cut.held);
    const auto take = [&](const mesh::MeshEdit& edit) {
      cut.apply(edit);
      update_pieces(pieces, cut.body, edit, cut.held);
      fingerprints.push_back(fingerprint(cut.body));
    };
    for (int crack = 0; crack < 3; ++crack) {
      RandomFront front(dice, box);
      for (int step = 0; step < 12; ++step) {
        const CutSurface surface = front.advance(dice, cut.settings.mean_edge);
        const Incision incision = cut.incise(surface);
        if (incision.edit.empty()) continue;
        const double volume = cut.body.volume();
        take(incision.edit);
        check(cut, incision, volume);
        if (testing::Test::HasFatalFailure()) return;
        const Pieces found = find_pieces(cut.body, cut.held);
        ASSERT_EQ(pieces.first, found.first);
        ASSERT_EQ(pieces.supported, found.supported);
        ASSERT_EQ(pieces.of_tet, found.of_tet);
        mesh::MeshEdit freeze;
        freeze.frozen = unsupported_tets(cut.body, pieces);
        if (!freeze.empty()) take(freeze);
        ASSERT_TRUE(pieces == find_pieces(cut.body, cut.held));
        ++tally.advances;
        tally.ends += static_cast<int>(incision.edit.moved.size()) + incision.nodes_off_plane;
        tally.off_plane += incision.nodes_off_plane;
        tally.lost += incision.volume_lost;
      }
    }
    tally.most_pieces = std::max(tally.most_pieces, static_cast<int>(pieces.count()));
    for (std::size_t node = 0; node < cut.body.mesh().node_count(); ++node) {
      const NodeId original = cut.body.original(NodeId(node));
      if (cut.settings.immovable[node] == 0) continue;
      ASSERT_EQ(cut.body.mesh().nodes[node], intact[original.index()]);
    }
    for (; cut.body.topology() > 0; fingerprints.pop_back()) {
      ASSERT_EQ(fingerprint(cut.body), fingerprints.back());
      cut.undo();
    }
    ASSERT_EQ(fingerprint(cut.body), fingerprints.front());
  }

  static void check(const CutBody& cut, const Incision& incision, double volume_before) {
    const mesh::MeshEdit& edit = incision.edit;
    ASSERT_GT(incision.edges_cut, 0);
    ASSERT_TRUE(edit.frozen.empty());
    ASSERT_TRUE(std::is_sorted(edit.removed.begin(), edit.removed.end()));
    ASSERT_TRUE(std::is_sorted(edit.moved.begin(), edit.moved.end(),
                               [](const auto& a, const auto& b) { return a.node < b.node; }));
    ASSERT_TRUE(std::is_sorted(edit.rewired.begin(), edit.rewired.end(),
                               [](const auto& a, const auto& b) { return a.tet < b.tet; }));
    if (cut.settings.method == IncisionMethod::split) {
      ASSERT_TRUE(edit.removed.empty());
      ASSERT_FALSE(edit.copied.empty() || edit.rewired.empty());
    } else {
      ASSERT_FALSE(edit.removed.empty());
      ASSERT_TRUE(edit.copied.empty() && edit.rewired.empty());
    }
    // Sums of a few thousand volumes, each right to some 1e-16 of products of coordinates.
    ASSERT_NEAR(cut.body.volume(), volume_before - incision.volume_lost, 1e-12 * cut.body.volume());
    expect_round(cut);
    if (testing::Test::HasFatalFailure()) return;
    expect_manifold_faces(cut.body);
  }
};

TEST_P(Incisions, LeaveSoundBodies) {
  const int seeds = std::getenv("RHEXIS_FULL") == nullptr ? 5 : 300;
  Tally tally;
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    tear(static_cast<std::uint64_t>(seed), tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.advances, 5 * seeds);
  EXPECT_GT(tally.most_pieces, 1);
  rhexis::test::measured(
      "{} advances, {:.2f} nodes off the plane for one that it called, {:.3f} of the volume lost, "
      "{} pieces at most",
      tally.advances, static_cast<double>(tally.off_plane) / tally.ends, tally.lost / tally.volume, tally.most_pieces);
}

/// The mesh and a surface in the mirror x -> -x; numbers of nodes and tets stay.
mesh::TetMesh mirrored(mesh::TetMesh mesh) {
  for (Vec3& x : mesh.nodes) x[0] = -x[0];
  for (mesh::Tet& tet : mesh.tets) std::swap(tet[2], tet[3]);
  return mesh;
}

CutSurface mirrored(CutSurface surface) {
  for (CutSurface::Triangle& t : surface.triangles) {
    for (Vec3* corner : {&t.a, &t.b, &t.c}) (*corner)[0] = -(*corner)[0];
    std::swap(t.b, t.c);  // what was above stays above
  }
  return surface;
}

TEST_P(Incisions, MirrorWhenTheMeshIsMirrored) {
  const auto [method, shape] = GetParam();
  const mesh::TetMesh body = make(shape, 600);
  const mesh::BoundingBox box = mesh::bounding_box(body);
  const double size = box.size().norm();
  CutBody cut(body, method);
  CutBody image(mirrored(body), method);
  Dice dice(7);
  int compared = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const Vec3 at = dice.inside(box);
    const Vec3 across = size * dice.direction();
    const Vec3 along = size * dice.direction().cross(across).normalized();
    const CutSurface surface =
        strip({at - across, at + across}, {at - across + 0.5 * along, at + across + 0.4 * along});
    const mesh::MeshEdit one = cut.incise(surface).edit;
    const mesh::MeshEdit other = image.incise(mirrored(surface)).edit;
    EXPECT_EQ(one.removed, other.removed);
    EXPECT_EQ(one.copied, other.copied);
    EXPECT_EQ(one.rewired.size(), other.rewired.size());
    ASSERT_EQ(one.moved.size(), other.moved.size());
    for (std::size_t i = 0; i < one.moved.size(); ++i) {
      const Vec3 to = other.moved[i].to;
      EXPECT_EQ(one.moved[i].node, other.moved[i].node);
      // A projection is some ten operations on numbers of the size of the body.
      EXPECT_LT((one.moved[i].to - Vec3(-to[0], to[1], to[2])).norm(), 1e-14 * size);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

class CracksThatTurn : public Incisions {};

/// The largest two pieces, in tets.
std::array<std::ptrdiff_t, 2> largest_pieces(const Pieces& pieces) {
  std::vector<std::ptrdiff_t> sizes{0};
  for (std::int32_t piece = 0; piece < static_cast<std::int32_t>(pieces.count()); ++piece)
    sizes.push_back(std::count(pieces.of_tet.begin(), pieces.of_tet.end(), piece));
  std::sort(sizes.rbegin(), sizes.rend());
  return {sizes[0], sizes[1]};
}

// A crack that turns at every step, by steps down to a fifth of an edge, and comes out on the far side: the body is in
// two, whatever the front looked like on its way.
TEST_P(CracksThatTurn, ComeRightThrough) {
  const auto [method, shape] = GetParam();
  const int trials = std::getenv("RHEXIS_FULL") == nullptr ? 6 : 200;
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    Dice dice(static_cast<std::uint64_t>(1000 + trial));
    CutBody cut(make(shape, 500), method);
    const mesh::BoundingBox box = mesh::bounding_box(cut.body.mesh());
    const double edge = cut.settings.mean_edge;
    const bool round = shape == Shape::rod;
    const int ahead_axis = round ? 0 : 1;
    const Vec3 along = round ? Vec3::UnitY() : Vec3::UnitZ();
    const Vec3 ahead = Vec3::Unit(ahead_axis);
    const Vec3 aside = along.cross(ahead);
    const double largest = trial % 2 == 0 ? 2.0 : 0.6;  // steps, in edges

    std::vector<Vec3> front;
    const Vec3 start = 0.5 * (box.from + box.to) - (0.5 * box.size()[ahead_axis] + 0.5 * edge) * ahead;
    const int points = 2 + trial % 4;
    for (int k = 0; k < points; ++k)
      front.push_back(start + (2.0 * k / (points - 1) - 1.0) * box.size().norm() * along);
    double angle = 0.0;
    CutSurface surface;  // what no edge was met by is taken along
    for (int step = 0; step < 400; ++step) {
      angle = std::clamp(angle + dice.between(-0.8, 0.8), -0.4, 0.4);  // not out at a side
      const std::vector<Vec3> before = front;
      const double length = edge * dice.between(0.2, largest);
      bool out = true;
      for (Vec3& point : front) {
        point += length * dice.between(0.8, 1.0) * (std::cos(angle) * ahead + std::sin(angle) * aside);
        out = out && point[ahead_axis] > box.to[ahead_axis] + 0.2 * edge;
      }
      const CutSurface swept = strip(before, front);
      surface.triangles.insert(surface.triangles.end(), swept.triangles.begin(), swept.triangles.end());
      const Incision incision = cut.incise(surface);
      if (!incision.edit.empty()) {
        cut.apply(incision.edit);
        surface.triangles.clear();
      }
      if (out) break;
    }
    expect_round(cut);
    expect_manifold_faces(cut.body);
    EXPECT_GT(largest_pieces(find_pieces(cut.body, cut.held))[1], 30);
  }
}

std::string name_of(const testing::TestParamInfo<Incisions::ParamType>& info) {
  const char* const shapes[] = {"plate", "bar", "cube", "tube", "rod"};
  return std::string(std::get<0>(info.param) == IncisionMethod::split ? "split_" : "keep_nodes_") +
         shapes[static_cast<std::size_t>(std::get<1>(info.param))];
}

constexpr auto kMethods = {IncisionMethod::keep_nodes, IncisionMethod::split};

INSTANTIATE_TEST_SUITE_P(Bodies, Incisions,
                         testing::Combine(testing::ValuesIn(kMethods),
                                          testing::Values(Shape::plate, Shape::bar, Shape::cube, Shape::tube,
                                                          Shape::rod)),
                         name_of);
// A straight front would meet a bent tube in several places.
INSTANTIATE_TEST_SUITE_P(Bodies, CracksThatTurn,
                         testing::Combine(testing::ValuesIn(kMethods),
                                          testing::Values(Shape::plate, Shape::bar, Shape::cube, Shape::rod)),
                         name_of);

}  // namespace
}  // namespace rhexis::fracture::test
