#include <cmath>

#include "mesh/body_request.h"
#include "tests/mesh/generate_support.h"

namespace rhexis::mesh {
namespace {

/// Factors from 1/10 to 10 and node counts from 30 to 6000, evenly spread on a logarithmic scale.
class RandomRequest {
 public:
  explicit RandomRequest(std::uint64_t seed) : seed_(seed) {}
  double fraction() { return hashed_fraction(seed_, ++drawn_); }
  double factor() { return std::pow(10.0, 2.0 * fraction() - 1.0); }
  int nodes() { return static_cast<int>(30.0 * std::pow(200.0, fraction())); }

 private:
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
};

void expect_sound_or_refused(const Expected<TetMesh>& mesh, int nodes, int& made) {
  if (!mesh) {
    EXPECT_FALSE(mesh.error().remedy.empty()) << mesh.error().message();
    return;
  }
  ++made;
  EXPECT_NEAR(static_cast<double>(mesh->node_count()), nodes, 0.02 * nodes);
  expect_sound(*mesh);
}

constexpr int kRequests = 100;

TEST(RandomBodies, BoxesAreSoundOrRefused) {
  int made = 0;
  for (int i = 0; i < kRequests; ++i) {
    SCOPED_TRACE(i);
    RandomRequest request(static_cast<std::uint64_t>(i));
    const int nodes = request.nodes();
    const BoxShape shape{Vec3(request.factor(), request.factor(), request.factor())};
    expect_sound_or_refused(make_plate(shape, nodes), nodes, made);
    expect_sound_or_refused(make_bar(shape, nodes), nodes, made);
  }
  EXPECT_GT(made, kRequests);  // of twice as many
}

TEST(RandomBodies, TubesAreSoundOrRefused) {
  int made = 0;
  for (int i = 0; i < kRequests; ++i) {
    SCOPED_TRACE(i);
    RandomRequest request(1000 + static_cast<std::uint64_t>(i));
    const int nodes = request.nodes();
    TubeShape shape{.radius = request.factor()};
    shape.length = shape.radius * 10.0 * request.factor();
    shape.wall = request.fraction() < 0.3 ? 0.0 : shape.radius * request.fraction();
    shape.bend = request.fraction() < 0.3 ? 0.0 : 720.0 * (request.fraction() - 0.5);
    expect_sound_or_refused(make_tube(shape, nodes), nodes, made);
  }
  EXPECT_GT(made, kRequests / 3);
}

}  // namespace
}  // namespace rhexis::mesh
