#include "response/carried_state.h"

#include <Eigen/LU>

#include "mesh/generate.h"
#include "response/torn_model.h"
#include "tests/fracture/cut_support.h"

namespace rhexis::response {
namespace {

/// Of the whole body a homogeneous deformation: turned far and stretched.
Mat3 some_deformation() {
  Mat3 F;
  F << 0.1, -1.3, 0.05, 0.8, 0.15, -0.1, 0.02, 0.1, 0.95;
  return F;
}

model::State state_of(const mesh::TetMesh& mesh, const Mat3& F) {
  model::State state{VectorX(static_cast<Eigen::Index>(3 * mesh.node_count())),
                     VectorX::Ones(static_cast<Eigen::Index>(mesh.tet_count()))};
  for (std::size_t i = 0; i < mesh.node_count(); ++i)
    state.u.segment<3>(3 * static_cast<Eigen::Index>(i)) = F * mesh.nodes[i] - mesh.nodes[i];
  return state;
}

TEST(CarriedState, AHomogeneousDeformationStaysOneWhereverTheCutMovesNodes) {
  ASSERT_GT(some_deformation().determinant(), 0.1);
  for (const auto method : {fracture::IncisionMethod::split, fracture::IncisionMethod::keep_nodes}) {
    fracture::test::CutBody cut(mesh::make_bar({{0.10, 0.04, 0.04}}, 300).value(), method);
    const model::DisplacementSpace before = model::make_p1_space(cut.body.mesh());
    const std::vector<std::uint8_t> out = tets_left_out(cut.body);
    const model::State state = state_of(cut.body.mesh(), some_deformation());
    const fracture::Incision incision = cut.cut(fracture::test::across_x(0.0473, -0.001, 0.03, -0.001, 0.041));
    ASSERT_FALSE(incision.edit.empty());
    ASSERT_FALSE(incision.edit.moved.empty());
    const auto carried = carried_state(before, out, state, cut.body, cut.body.history().back(), false);
    ASSERT_TRUE(carried.has_value());
    const model::State exact = state_of(cut.body.mesh(), some_deformation());
    EXPECT_LE((carried->u - exact.u).lpNorm<Eigen::Infinity>(), 1e-14);
    for (std::size_t t = 0; t < cut.body.mesh().tet_count(); ++t)
      EXPECT_EQ(carried->lambda[static_cast<Eigen::Index>(t)], cut.body.is_solved(TetId(t)) ? 1.0 : 0.0);
  }
}

TEST(CarriedState, ATetThatTheCutWouldTurnInsideOutIsOpenedByTheNodesThatMoved) {
  // Four tets around a node in the middle of a fifth; the node is moved close to a face in a body that is bent there.
  mesh::TetMesh mesh;
  mesh.nodes = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.25, 0.25, 0.25)};
  const auto tet = [](int a, int b, int c, int d) { return mesh::Tet{NodeId(a), NodeId(b), NodeId(c), NodeId(d)}; };
  mesh.tets = {tet(4, 1, 2, 3), tet(0, 4, 2, 3), tet(0, 1, 4, 3), tet(0, 1, 2, 4)};
  mesh::TornMesh body(mesh);
  const model::DisplacementSpace before = model::make_p1_space(mesh);
  model::State state{VectorX::Zero(15), VectorX::Zero(4)};
  state.u.segment<3>(12) = Vec3(0.0, 0.0, 0.4);  // the node itself: near to the face (1, 2, 3), inside
  state.u.segment<3>(3) = Vec3(-0.3, 0.0, 0.3);
  mesh::MeshEdit edit;
  edit.moved = {{NodeId(4), mesh.nodes[4], Vec3(0.1, 0.1, 0.6)}};
  body.apply(edit);
  const auto carried = carried_state(before, {0, 0, 0, 0}, state, body, edit, false);
  ASSERT_TRUE(carried.has_value());
  for (std::size_t t = 0; t < 4; ++t) {
    mesh::TetMesh moved = body.mesh();
    for (std::size_t i = 0; i < 5; ++i) moved.nodes[i] += carried->u.segment<3>(3 * static_cast<Eigen::Index>(i));
    EXPECT_GE(mesh::signed_volume(moved, TetId(t)),
              0.99 * kLeastVolumeLeft * mesh::signed_volume(body.mesh(), TetId(t)))
        << t;
  }
}

}  // namespace
}  // namespace rhexis::response
