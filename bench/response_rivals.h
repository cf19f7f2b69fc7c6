#pragma once

/// Other ways to the exact compliance of a torn body, as they would be built with the same factor.

#include <Eigen/Dense>

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include "base/check.h"
#include "bench/response_pull.h"
#include "linalg/front_kernels.h"
#include "response/followed.h"

extern "C" {
void dgesv_(const int* n, const int* columns, double* A, const int* lda, int* pivot, double* b, const int* ldb,
            int* info);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
}

namespace rhexis::response::bench {

using linalg::FrontTree;

/// The tets inside of a capsule, or those outside.
class Part final : public linalg::ElementSource {
 public:
  Part(const mesh::TornMesh& mesh, const ElasticModel& model, const std::vector<char>& inside, bool take_inside)
      : all_(mesh, model), inside_(inside), take_inside_(take_inside) {}
  [[nodiscard]] std::int32_t node_count() const override { return all_.node_count(); }
  [[nodiscard]] std::int32_t element_count() const override { return all_.element_count(); }
  [[nodiscard]] bool is_active(std::int32_t element) const override {
    return all_.is_active(element) && (inside_[static_cast<std::size_t>(element)] != 0) == take_inside_;
  }
  [[nodiscard]] std::array<std::int32_t, 4> nodes(std::int32_t element) const override { return all_.nodes(element); }
  void stiffness(std::int32_t element, linalg::ElementMatrix& out) const override { all_.stiffness(element, out); }
  void load(std::int32_t element, linalg::ElementVector& out) const override { all_.load(element, out); }
  [[nodiscard]] Vec3 node_load(std::int32_t) const override { return Vec3::Zero(); }
  [[nodiscard]] unsigned free_components(std::int32_t node) const override { return all_.free_components(node); }

 private:
  ElasticElements all_;
  const std::vector<char>& inside_;
  bool take_inside_;
};

/// Condensation of the far field: the tets outside of a window about the crack are eliminated onto its rim, an advance
/// changes the tets inside, and the rim is factored again. The window moves when an advance would leave it.
class Condensed {
 public:
  /// m, ahead of the front.
  Condensed(const Pull& pull, const mesh::TornMesh& body, double ahead)
      : model_(pull.elastic, body.intact_node_count()), body_(body), hand_(pull.hand), ahead_(ahead) {
    inside_.assign(body.mesh().tet_count(), 0);
    outside_tree_ = FrontTree::make(Part(body_, model_, inside_, false), {});
    place(pull.focus[0], {});
  }

  Mat3 advance(const mesh::MeshEdit& edit, const Focus& focus) {
    linalg::ElementChange change;
    add_applied(body_, edit, change);
    const bool fits = std::all_of(change.touched.begin(), change.touched.end(),
                                  [&](std::int32_t tet) { return inside_[static_cast<std::size_t>(tet)] != 0; });
    if (fits) {
      change.kept = rim_;
      inside_tree_ = inside_tree_->updated(Part(body_, model_, inside_, true), change);
    } else {
      place(focus, change.touched);
    }
    return compliance();
  }

 private:
  void place(const Focus& focus, std::vector<std::int32_t> touched) {
    const std::vector<char> before = inside_;
    const double half_width = 0.9 * focus.radius + focus.half_length;
    std::vector<char> beyond(body_.mesh().node_count(), 0);
    std::vector<char> within(body_.mesh().node_count(), 0);
    for (std::size_t t = 0; t < inside_.size(); ++t) {
      const auto x = mesh::corners(body_.mesh(), TetId(t));
      const Vec3 from = 0.25 * (x[0] + x[1] + x[2] + x[3]) - focus.centre;
      const double along = std::clamp(from.dot(focus.direction), 0.0, ahead_);
      inside_[t] = (from - along * focus.direction).norm() < half_width ? 1 : 0;
      if (inside_[t] != before[t]) touched.push_back(static_cast<std::int32_t>(t));
      for (const NodeId node : body_.mesh().tets[t]) {
        if (body_.is_solved(TetId(t))) (inside_[t] != 0 ? within : beyond)[node.index()] = 1;
      }
    }
    rim_.clear();
    for (std::size_t i = 0; i < within.size(); ++i) {
      if (within[i] != 0 && beyond[i] != 0) rim_.push_back(static_cast<std::int32_t>(i));
    }
    outside_tree_ = outside_tree_->updated(Part(body_, model_, inside_, false), {{}, touched, rim_, {}});
    inside_tree_ = FrontTree::make(Part(body_, model_, inside_, true), rim_);
  }

  [[nodiscard]] Mat3 compliance() const {
    const std::vector<std::int32_t>& dofs = outside_tree_->kept_dofs();
    const auto n = static_cast<int>(dofs.size());
    Eigen::MatrixXd S = outside_tree_->schur();
    const std::vector<std::int32_t>& inner = inside_tree_->kept_dofs();
    std::vector<Eigen::Index> place;
    for (const std::int32_t dof : inner) {
      place.push_back(std::lower_bound(dofs.begin(), dofs.end(), dof) - dofs.begin());
    }
    for (std::size_t j = 0; j < place.size(); ++j) {
      for (std::size_t i = j; i < place.size(); ++i) {
        S(place[i], place[j]) += inside_tree_->schur()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
    std::vector<double> work(dofs.size() * linalg::kFactorWidth);
    std::vector<double> inverse((dofs.size() + linalg::kFactorWidth) * linalg::kFactorWidth);
    RHEXIS_CHECK(linalg::front_kernels().factor(S.data(), n, n, inverse.data(), work.data()), "not stable");
    const std::vector<std::int32_t> hand{3 * hand_.value(), 3 * hand_.value() + 1, 3 * hand_.value() + 2};
    const auto around = body_.tets_around(hand_);
    const bool is_inside = std::all_of(around.begin(), around.end(), [&](TetId t) { return inside_[t.index()] != 0; });
    const FrontTree::Forward forward = (is_inside ? inside_tree_ : outside_tree_)->forward(hand, Mat3::Identity());
    Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(n, 3);
    for (Eigen::Index i = 0; i < forward.kept.rows(); ++i) {
      Z.row(is_inside ? place[static_cast<std::size_t>(i)] : i) = forward.kept.row(i);
    }
    linalg::front_kernels().forward(S.data(), n, n, 0, Z.data(), n, 3);
    return forward.gram + Z.transpose() * Z;
  }

  ElasticModel model_;
  const mesh::TornMesh& body_;
  NodeId hand_;
  double ahead_;
  std::vector<char> inside_;
  std::vector<std::int32_t> rim_;
  std::shared_ptr<const FrontTree> outside_tree_, inside_tree_;
};

/// Low rank: K = K_0 + P dK P^T on the dofs D that the edits so far have touched; with G = P^T K_0^-1 P,
/// L_cc = G_cc - G_cD (I + dK G_DD)^-1 dK G_Dc. The augmented system of Yeung, Crouch and Pothen (2016) has the same
/// unknowns. Columns of new dofs go through the factor of the start as far as the tree carries them.
class LowRank {
 public:
  LowRank(const Pull& pull, const mesh::TornMesh& body)
      : model_(pull.elastic, body.intact_node_count()), body_(body), start_(body), hand_(pull.hand) {
    tree_ = FrontTree::make(ElasticElements(start_, model_), {});
    std::vector<std::int32_t> dofs;
    for (std::int32_t c = 0; c < 3; ++c) dofs.push_back(3 * hand_.value() + c);
    append(dofs);
  }

  Mat3 advance(const mesh::MeshEdit& edit) {
    linalg::ElementChange change;
    add_applied(body_, edit, change);
    std::vector<std::int32_t> fresh;
    for (const std::int32_t tet : change.touched) {
      touched_.push_back(tet);
      for (const NodeId node : body_.mesh().tet(TetId(tet))) {
        for (std::int32_t dof = 3 * node.value(); dof < 3 * node.value() + 3; ++dof) {
          if (place_.count(dof) == 0 && model_.held[static_cast<std::size_t>(dof)] == 0) fresh.push_back(dof);
        }
      }
    }
    const auto make_unique = [](auto& list) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    make_unique(touched_);
    make_unique(fresh);
    append(fresh);
    return solve();
  }

 private:
  void append(const std::vector<std::int32_t>& dofs) {
    const auto k = static_cast<Eigen::Index>(dofs.size());
    if (k == 0) return;
    FrontTree::Forward now = tree_->forward(dofs, Eigen::MatrixXd::Identity(k, k));
    const Eigen::Index before = G_.rows();
    Eigen::MatrixXd G(before + k, before + k);
    G.topLeftCorner(before, before) = G_;
    G.bottomRightCorner(k, k) = now.gram;
    Eigen::Index column = 0;
    for (const FrontTree::Forward& other : columns_) {
      Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(k, other.gram.cols());
      std::map<std::int32_t, std::size_t> at;
      for (std::size_t i = 0; i < other.front.size(); ++i) at[other.front[i]] = i;
      for (std::size_t i = 0; i < now.front.size(); ++i) {
        const auto found = at.find(now.front[i]);
        if (found == at.end()) continue;
        const Eigen::MatrixXd& a = now.y[i];
        const Eigen::MatrixXd& b = other.y[found->second];
        const int m = static_cast<int>(k), n = static_cast<int>(b.cols()), depth = static_cast<int>(a.rows());
        const double one = 1.0;
        if (depth > 0)
          dgemm_("T", "N", &m, &n, &depth, &one, a.data(), &depth, b.data(), &depth, &one, cross.data(), &m);
      }
      G.block(before, column, k, cross.cols()) = cross;
      G.block(column, before, cross.cols(), k) = cross.transpose();
      column += cross.cols();
    }
    for (Eigen::Index i = 0; i < k; ++i) place_[dofs[static_cast<std::size_t>(i)]] = before + i;
    columns_.push_back(std::move(now));
    G_ = std::move(G);
  }

  Mat3 solve() const {
    const Eigen::Index d = G_.rows();
    Eigen::MatrixXd dK = Eigen::MatrixXd::Zero(d, d);
    const ElasticElements now(body_, model_);
    const ElasticElements then(start_, model_);
    linalg::ElementMatrix K;
    for (const std::int32_t tet : touched_) {
      for (const ElasticElements* source : {&now, &then}) {
        if (!source->is_active(tet)) continue;
        source->stiffness(tet, K);
        const auto nodes = source->nodes(tet);
        for (int a = 0; a < 12; ++a) {
          for (int b = 0; b < 12; ++b) {
            const auto row = place_.find(3 * nodes[static_cast<std::size_t>(a / 3)] + a % 3);
            const auto col = place_.find(3 * nodes[static_cast<std::size_t>(b / 3)] + b % 3);
            if (row == place_.end() || col == place_.end()) continue;
            dK(row->second, col->second) += source == &now ? K(a, b) : -K(a, b);
          }
        }
      }
    }
    Eigen::MatrixXd A = Eigen::MatrixXd::Identity(d, d);
    const int n = static_cast<int>(d);
    const double one = 1.0;
    dgemm_("N", "N", &n, &n, &n, &one, dK.data(), &n, G_.data(), &n, &one, A.data(), &n);
    // A node that has lost its last tet is held where it is, else it would swing freely.
    Eigen::MatrixXd x = dK * G_.leftCols(3);
    for (const auto& [dof, at] : place_) {
      if (body_.is_alive(NodeId(dof / 3))) continue;
      A.row(at) = G_.row(at);
      x.row(at) = G_.row(at).head(3);
    }
    std::vector<int> pivot(static_cast<std::size_t>(d));
    const int three = 3;
    int info = 0;
    dgesv_(&n, &three, A.data(), &n, pivot.data(), x.data(), &n, &info);
    RHEXIS_CHECK(info == 0, "dgesv {}", info);
    return G_.topLeftCorner(3, 3) - G_.topRows(3) * x;
  }

  ElasticModel model_;
  const mesh::TornMesh& body_;
  mesh::TornMesh start_;
  NodeId hand_;
  std::shared_ptr<const FrontTree> tree_;
  std::vector<FrontTree::Forward> columns_;
  std::map<std::int32_t, Eigen::Index> place_;
  std::vector<std::int32_t> touched_;
  Eigen::MatrixXd G_;
};

}  // namespace rhexis::response::bench
