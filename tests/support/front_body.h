#pragma once

/// An elastic body whose elements come, go, change and take copies of nodes, as FrontTree sees it, and the slow answers
/// to compare with: everything assembled again and factored by CHOLMOD.

#include <Eigen/Dense>

#include <array>
#include <memory>
#include <random>
#include <vector>

#include "linalg/cholesky_factor.h"
#include "linalg/front_tree.h"
#include "mesh/tet_mesh.h"

namespace rhexis::linalg::test {

class FrontBody : public ElementSource {
 public:
  /// Small strain, lambda = mu = 1 Pa on the mesh scaled to edges of about 1 m, and every node on a spring to the
  /// ground of `ground` times its share of the elements' trace: what comes loose stays positive definite, and the
  /// condition number below 1e4. The nodes with the smallest x are held, `rough` holds some more dofs at random.
  FrontBody(const mesh::TetMesh& mesh, double ground, bool rough = false) {
    double h = 0.0;
    for (std::size_t t = 0; t < mesh.tet_count(); ++t) h += mesh::longest_edge(mesh, TetId(t));
    h /= static_cast<double>(mesh.tet_count());
    const mesh::BoundingBox box = mesh::bounding_box(mesh);
    std::mt19937_64 random(7);
    for (const Vec3& X : mesh.nodes) {
      position.push_back((X - box.from) / h);
      const bool held = X[0] < box.from[0] + 1e-9 * h;
      for (int c = 0; c < 3; ++c) free.push_back(!held && !(rough && random() % 12 == 0));
      loads.emplace_back(1e-3 * Vec3(1.0, -2.0, static_cast<double>(random() % 5)));
    }
    for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
      std::array<std::int32_t, 4> nodes{};
      std::array<Vec3, 4> X;
      for (std::size_t a = 0; a < 4; ++a) {
        nodes[a] = mesh.tets[t][a].value();
        X[a] = position[static_cast<std::size_t>(nodes[a])];
      }
      tets.push_back(nodes);
      K.push_back(element_stiffness(X));
      const double spring = ground * K.back().trace() / 12.0;
      K.back().diagonal().array() += spring;
    }
    active.assign(tets.size(), true);
    scale.assign(tets.size(), 1.0);
  }

  static ElementMatrix element_stiffness(const std::array<Vec3, 4>& X) {
    Mat3 edges;
    for (int a = 0; a < 3; ++a) edges.row(a) = X[static_cast<std::size_t>(a) + 1] - X[0];
    Eigen::Matrix<double, 3, 4> G;
    G.rightCols<3>() = edges.inverse();
    G.col(0) = -G.rightCols<3>().rowwise().sum();
    const double volume = std::abs(edges.determinant()) / 6.0;
    ElementMatrix out;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        out.block<3, 3>(3 * a, 3 * b) = volume * (G.col(a) * G.col(b).transpose() + G.col(b) * G.col(a).transpose() +
                                                  G.col(a).dot(G.col(b)) * Mat3::Identity());
      }
    }
    return out;
  }

  [[nodiscard]] std::int32_t node_count() const override { return static_cast<std::int32_t>(position.size()); }
  [[nodiscard]] std::int32_t element_count() const override { return static_cast<std::int32_t>(tets.size()); }
  [[nodiscard]] bool is_active(std::int32_t e) const override { return active[static_cast<std::size_t>(e)]; }
  [[nodiscard]] std::array<std::int32_t, 4> nodes(std::int32_t e) const override {
    return tets[static_cast<std::size_t>(e)];
  }
  void stiffness(std::int32_t e, ElementMatrix& out) const override {
    out = scale[static_cast<std::size_t>(e)] * K[static_cast<std::size_t>(e)];
  }
  void load(std::int32_t e, ElementVector& out) const override {
    for (int i = 0; i < 12; ++i) out[i] = 1e-2 * scale[static_cast<std::size_t>(e)] * (i % 3 == 2 ? -1.0 : 0.25);
  }
  [[nodiscard]] Vec3 node_load(std::int32_t node) const override { return loads[static_cast<std::size_t>(node)]; }
  [[nodiscard]] unsigned free_components(std::int32_t node) const override {
    unsigned out = 0;
    for (unsigned c = 0; c < 3; ++c) out |= free[3 * static_cast<std::size_t>(node) + c] ? 1U << c : 0U;
    return out;
  }

  /// A copy of a node, with its supports and its load.
  std::int32_t copy_node(std::int32_t node) {
    const auto n = static_cast<std::size_t>(node);
    position.push_back(Vec3(position[n]));
    loads.push_back(Vec3(loads[n]));
    for (std::size_t c = 0; c < 3; ++c) free.push_back(free[3 * n + c]);
    return node_count() - 1;
  }

  [[nodiscard]] std::vector<std::int32_t> nodes_within(const Vec3& centre, double radius) const {
    std::vector<std::int32_t> out;
    for (std::int32_t i = 0; i < node_count(); ++i) {
      if ((position[static_cast<std::size_t>(i)] - centre).norm() < radius) out.push_back(i);
    }
    return out;
  }
  [[nodiscard]] Vec3 centroid(std::int32_t e) const {
    Vec3 sum = Vec3::Zero();
    for (const std::int32_t node : nodes(e)) sum += position[static_cast<std::size_t>(node)];
    return 0.25 * sum;
  }

  std::vector<Vec3> position;  // in mean edges
  std::vector<bool> free;
  std::vector<Vec3> loads;
  std::vector<std::array<std::int32_t, 4>> tets;
  std::vector<ElementMatrix> K;
  std::vector<bool> active;
  std::vector<double> scale;
};

/// The whole assembled and factored from the start.
class FrontOracle {
 public:
  explicit FrontOracle(const FrontBody& body) : factor_(Ordering::metis) {
    std::vector<std::int32_t> connectivity;
    for (std::int32_t e = 0; e < body.element_count(); ++e) {
      if (!body.is_active(e)) continue;
      for (const std::int32_t node : body.nodes(e)) connectivity.push_back(node);
    }
    auto pattern = std::make_shared<BlockPattern>(make_block_pattern(body.node_count(), connectivity, 4));
    SymmetricBlockMatrix A(pattern);
    std::vector<bool> out(3 * static_cast<std::size_t>(body.node_count()), true);  // held, or in no element
    load = VectorX::Zero(3 * Eigen::Index{body.node_count()});
    ElementMatrix K;
    ElementVector f;
    for (std::int32_t e = 0; e < body.element_count(); ++e) {
      if (!body.is_active(e)) continue;
      body.stiffness(e, K);
      body.load(e, f);
      const std::array<std::int32_t, 4> nodes = body.nodes(e);
      for (int a = 0; a < 4; ++a) {
        const std::int32_t row = nodes[static_cast<std::size_t>(a)];
        load.segment<3>(3 * Eigen::Index{row}) += f.segment<3>(3 * a);
        for (int b = 0; b < 4; ++b) {
          const std::int32_t col = nodes[static_cast<std::size_t>(b)];
          if (col > row) continue;
          Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(A.values.data() +
                                                                         9 * std::ptrdiff_t{pattern->find(row, col)});
          block += K.block<3, 3>(3 * a, 3 * b);
        }
        for (int c = 0; c < 3; ++c) {
          const auto dof = static_cast<std::size_t>(3 * row + c);
          out[dof] = !body.is_free(3 * row + c);
        }
      }
    }
    for (std::int32_t i = 0; i < body.node_count(); ++i) load.segment<3>(3 * Eigen::Index{i}) += body.node_load(i);
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (out[i]) load[static_cast<Eigen::Index>(i)] = 0.0;
    }
    free = make_free_dofs(out);
    ok = factor_.analyse(*pattern, free) == CholeskyOutcome::ok && factor_.factor(A.values) == CholeskyOutcome::ok;
    if (ok) {
      solution.resize(load.size());
      factor_.solve(load, solution);
    }
  }

  /// K^-1 e_i for each dof, columns.
  [[nodiscard]] Eigen::MatrixXd columns(const std::vector<std::int32_t>& dofs) {
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(load.size(), static_cast<Eigen::Index>(dofs.size()));
    for (std::size_t i = 0; i < dofs.size(); ++i) b(dofs[i], static_cast<Eigen::Index>(i)) = 1.0;
    factor_.solve(b, b);
    return b;
  }

  FreeDofs free;  ///< of the assembly
  VectorX load;
  VectorX solution;  ///< under the load
  bool ok = false;

 private:
  CholeskyFactor factor_;
};

}  // namespace rhexis::linalg::test
