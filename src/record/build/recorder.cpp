#include "record/build/recorder.h"

#include <algorithm>

#include <Eigen/LU>

#include "base/check.h"
#include "mesh/surface.h"

namespace rhexis::record::build {
namespace {

std::unique_ptr<const OperatorLayout> make_layout(const mesh::TetMesh& mesh, const response::ElasticModel& model) {
  std::vector<std::int32_t> connectivity;
  for (const mesh::Tet& tet : mesh.tets)
    for (const NodeId node : tet) connectivity.push_back(node.value());
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  std::vector<bool> held;
  for (const std::uint8_t one : model.held) held.push_back(one != 0);
  return std::make_unique<const OperatorLayout>(linalg::make_block_pattern(nodes, connectivity, 4),
                                                linalg::make_free_dofs(held));
}

/// Nodes that are elsewhere, tets that are gone or frozen, against the intact mesh.
void describe_edits(const mesh::TornMesh& body, const mesh::TetMesh& intact, store::TopologyData& out) {
  for (std::size_t i = 0; i < intact.node_count(); ++i) {
    const Vec3& x = body.mesh().nodes[i];
    if (x == intact.nodes[i]) continue;
    out.moved_nodes.push_back(static_cast<std::int32_t>(i));
    out.moved_to.insert(out.moved_to.end(), x.data(), x.data() + 3);
  }
  for (std::size_t t = 0; t < intact.tet_count(); ++t) {
    const TetId tet(t);
    if (!body.is_alive(tet)) out.gone_tets.push_back(tet.value());
    if (body.is_alive(tet) && body.is_frozen(tet)) out.frozen_tets.push_back(tet.value());
  }
}

}  // namespace

Recorder::Recorder(const mesh::TetMesh& mesh, response::ElasticBody elastic, bool single_precision)
    : mesh_(mesh),
      model_(std::move(elastic), mesh.node_count()),
      single_precision_(single_precision),
      layout_(make_layout(mesh_, model_)) {
  const response::ElasticBody& body = model_.body;
  has_loads_ = model_.moves_supports || !(body.density * body.gravity).isZero(0.0) ||
               (body.dead_force.size() > 0 && !body.dead_force.isZero(0.0));
  std::vector<std::int32_t> point_of(mesh.node_count(), -1);
  const std::vector<mesh::TetFace> surface = mesh::find_faces(mesh).boundary;
  for (const mesh::TetFace& face : surface) {
    for (const NodeId node : mesh::face_nodes(mesh, face)) {
      const std::uint8_t* held = model_.held.data() + 3 * node.index();
      if (std::all_of(held, held + 3, [](std::uint8_t one) { return one == 0; })) points_.push_back(node.value());
    }
  }
  std::sort(points_.begin(), points_.end());
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  for (std::size_t k = 0; k < points_.size(); ++k)
    point_of[static_cast<std::size_t>(points_[k])] = static_cast<std::int32_t>(k);
  for (const mesh::TetFace& face : surface) {
    const std::array<NodeId, 3> node = mesh::face_nodes(mesh, face);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(point_of[node[k].index()], point_of[node[(k + 1) % 3].index()]);
      if (a >= 0) edges_.push_back({a, b});
    }
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
}

void Recorder::describe(store::RecordHead& head) const {
  head.single_precision = single_precision_;
  head.has_loads = has_loads_;
  for (const Vec3& x : mesh_.nodes) head.nodes.insert(head.nodes.end(), x.data(), x.data() + 3);
  for (const mesh::Tet& tet : mesh_.tets)
    for (const NodeId node : tet) head.tets.push_back(node.value());
  head.points = points_;
  head.edges = edges_;
  head.pattern = layout_->pattern();
}

std::vector<double> Recorder::stiffness_of(const mesh::TornMesh& body) const {
  const response::ElasticElements elements(body, model_);
  std::vector<double> out(layout_->pattern().entries(), 0.0);
  linalg::ElementMatrix K;
  std::array<std::int32_t, 12> row{};
  for (std::int32_t e = 0; e < elements.element_count(); ++e) {
    if (!elements.is_active(e)) continue;
    elements.stiffness(e, K);
    const std::array<std::int32_t, 4> nodes = elements.nodes(e);
    for (std::size_t i = 0; i < 12; ++i) row[i] = layout_->row_of()[3 * static_cast<std::size_t>(nodes[i / 3]) + i % 3];
    for (std::size_t i = 0; i < 12; ++i) {
      for (std::size_t j = 0; j < 12; ++j) {
        if (row[j] < 0 || row[i] < row[j]) continue;
        const std::int64_t entry = layout_->entry(row[i], row[j]);
        out[static_cast<std::size_t>(entry)] += K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
  }
  const store::OperatorPattern& pattern = layout_->pattern();
  for (std::size_t j = 0; j < pattern.dof.size(); ++j) {
    if (!body.is_solved(NodeId(pattern.dof[j] / 3))) out[static_cast<std::size_t>(pattern.start[j])] = 1.0;
  }
  return out;
}

bool Recorder::factor(FactoredState& state) const { return state.factor.update(stiffness_of(state.torn.body.mesh())); }

std::vector<double> Recorder::rest_of(const FactoredState& state) const {
  const mesh::TornMesh& body = state.torn.body.mesh();
  const response::ElasticElements elements(body, model_);
  VectorX load = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh_.node_count()));
  linalg::ElementVector f;
  for (std::int32_t e = 0; e < elements.element_count(); ++e) {
    if (!elements.is_active(e)) continue;
    elements.load(e, f);
    const std::array<std::int32_t, 4> nodes = elements.nodes(e);
    for (int a = 0; a < 4; ++a)
      load.segment<3>(3 * Eigen::Index{nodes[static_cast<std::size_t>(a)]}) += f.segment<3>(3 * a);
  }
  for (std::int32_t i = 0; i < elements.node_count(); ++i) {
    if (body.is_solved(NodeId(i))) load.segment<3>(3 * Eigen::Index{i}) += elements.node_load(i);
  }
  VectorX u = store::displacement_by<double>(layout_->pattern(), state.factor.values(), load);
  for (std::int32_t i = 0; i < elements.node_count() && model_.moves_supports; ++i) {
    if (body.is_solved(NodeId(i))) u.segment<3>(3 * Eigen::Index{i}) += model_.value.segment<3>(3 * Eigen::Index{i});
  }
  return {u.data(), u.data() + u.size()};
}

Mat3 Recorder::compliance(const std::vector<double>& inverse, std::int32_t a, std::int32_t b) const {
  Mat3 out;
  for (std::int32_t i = 0; i < 3; ++i) {
    for (std::int32_t j = 0; j < 3; ++j) {
      const auto [low, high] = std::minmax(layout_->row_of()[static_cast<std::size_t>(3 * a + i)],
                                           layout_->row_of()[static_cast<std::size_t>(3 * b + j)]);
      const std::int64_t entry = layout_->entry(high, low);
      RHEXIS_CHECK(entry >= 0, "nodes {} and {} share no tet", a, b);
      out(i, j) = inverse[static_cast<std::size_t>(entry)];
    }
  }
  return out;
}

FactoredState Recorder::advanced(const FactoredState& before, const Vec3& direction, double length) const {
  FactoredState next = before;
  next.torn.advance(direction, length);
  if (factor(next)) return next;
  next = before;
  next.torn.flags = static_cast<std::uint8_t>(store::unstable | (before.torn.flags & store::came_through));
  return next;
}

std::vector<Mat3> Recorder::stiffnesses(const mesh::TornMesh& body, const std::vector<double>& inverse) const {
  std::vector<Mat3> out;
  out.reserve(points_.size());
  for (const std::int32_t node : points_) {
    if (!body.is_solved(NodeId(node))) {
      out.emplace_back(Mat3::Zero());
      continue;
    }
    const Mat3 k = compliance(inverse, node, node).inverse();
    out.emplace_back(0.5 * (k + k.transpose()));
  }
  return out;
}

std::vector<Mat3> Recorder::stiffnesses(const FactoredState& state) const {
  return stiffnesses(state.torn.body.mesh(), state.factor.selected_inverse());
}

store::TopologyData Recorder::record(const FactoredState& state) const {
  const mesh::TornMesh& body = state.torn.body.mesh();
  const std::vector<double> inverse = state.factor.selected_inverse();
  store::TopologyData out;
  out.flags = state.torn.flags;
  for (const std::int32_t node : points_) out.in_solve.push_back(body.is_solved(NodeId(node)) ? 1 : 0);
  for (const Mat3& s : stiffnesses(body, inverse)) {
    out.stiffness.insert(out.stiffness.end(), {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)});
  }
  for (const auto& [a, b] : edges_) {
    const bool in_solve =
        out.in_solve[static_cast<std::size_t>(a)] != 0 && out.in_solve[static_cast<std::size_t>(b)] != 0;
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block =
        in_solve ? compliance(inverse, points_[static_cast<std::size_t>(a)], points_[static_cast<std::size_t>(b)])
                 : Mat3(Mat3::Zero());
    out.compliance.insert(out.compliance.end(), block.data(), block.data() + 9);
  }
  if (has_loads_) out.rest = rest_of(state);
  const std::vector<double>& values = state.factor.values();
  if (single_precision_) {
    out.factor = std::vector<float>(values.begin(), values.end());
  } else {
    out.factor = values;
  }
  describe_edits(body, mesh_, out);
  return out;
}

}  // namespace rhexis::record::build
