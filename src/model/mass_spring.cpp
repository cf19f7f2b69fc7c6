#include "model/mass_spring.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

#include "base/parallel.h"
#include "model/evaluation.h"

// The stiffness of a spring. Let each tet t lend each of its edges k = E V_t / L^2. Under a uniform small strain eps an
// edge along n becomes longer by L n.eps.n, so that the tet stores per volume
//
//     W = 1/2 E sum over its 6 edges of (n.eps.n)^2 .
//
// Over isotropic directions the mean of (n.eps.n)^2 is (tr(eps)^2 + 2 eps:eps) / 15, hence on the average
// W = 1/2 (2 E / 5) tr(eps)^2 + (2 E / 5) eps:eps: lambda = mu = 2 E / 5, which is Young's modulus
// mu (3 lambda + 2 mu) / (lambda + mu) = E and Poisson's ratio lambda / (2 (lambda + mu)) = 1/4. This is the average at
// uniform strain (Voigt's), an upper bound: a real mesh, whose inner nodes give way, is somewhat softer.

namespace rhexis::model {
namespace {

using BlockMap = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

constexpr std::size_t kNodeGrain = 512;
constexpr std::size_t kTetGrain = 1024;

/// A spring shorter than this part of its rest length has no direction that could be trusted: it is taken as that long,
/// which bounds its stiffness by k over this number and lets its force vanish at length zero instead of jumping.
constexpr double kLeastStretch = 1e-6;

struct Spring {
  std::array<std::int32_t, 2> node;  ///< smaller, larger
  double rest_length = 0.0;          ///< L, m
  double stiffness = 0.0;            ///< k, N/m
};

/// A node's spring and the node at its other end.
struct Incidence {
  std::int32_t spring = 0;
  std::int32_t neighbour = 0;
};

/// A spring under load, seen from one of its ends.
struct Stretch {
  Vec3 direction = Vec3::Zero();  ///< to the other end
  double length = 0.0;            ///< l, m; not below kLeastStretch L
  double extension = 0.0;         ///< l - L, m
};

class MassSpring final : public Model {
 public:
  MassSpring(const mesh::TetMesh& mesh, double young)
      : space_(make_p1_space(mesh)),
        young_(young),
        pattern_(std::make_shared<linalg::BlockPattern>(
            linalg::make_block_pattern(static_cast<std::int32_t>(mesh.node_count()), space_.connectivity, 4))) {
    lay_springs(mesh);
    list_springs_of_nodes();
  }

  std::string_view name() const override { return "mass-spring"; }
  const DisplacementSpace& space() const override { return space_; }
  bool allows_inversion() const override { return true; }

  State initial_state() const override {
    return {VectorX::Zero(static_cast<Eigen::Index>(space_.dof_count())), VectorX()};
  }

  std::unique_ptr<Scratch> make_scratch() const override {
    auto scratch = std::make_unique<Scratch>();
    scratch->J.setOnes(static_cast<Eigen::Index>(tet_springs_.size()));
    return scratch;
  }

  linalg::SaddleMatrix make_tangent() const override {
    linalg::SaddleMatrix out;
    out.A = linalg::SymmetricBlockMatrix(pattern_);
    return out;
  }

  Evaluation residual(const State& state, Scratch& scratch, Residual& out) const override {
    parallel_ranges(space_.node_count(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        Vec3 force = Vec3::Zero();
        for_each_spring(node, [&](const Spring& spring, std::int32_t neighbour) {
          const Stretch s = stretch(spring, static_cast<std::int32_t>(node), neighbour, state.u);
          force -= spring.stiffness * s.extension * s.direction;
        });
        out.u.segment<3>(3 * static_cast<Eigen::Index>(node)) = force;
      }
    });
    return evaluate_volumes(state, scratch);
  }

  Evaluation tangent(const State& state, Scratch& scratch, linalg::SaddleMatrix& out) const override {
    out.skew.reset();
    write_tangent(state.u, out.A);
    return evaluate_volumes(state, scratch);
  }

  double energy(const State& state) const override {
    double sum = 0.0;
    for (const Spring& spring : springs_) {
      const double extension = stretch(spring, spring.node[0], spring.node[1], state.u).extension;
      sum += 0.5 * spring.stiffness * extension * extension;
    }
    return sum;
  }

  /// The virial of each tet's share of its springs, sum of f (x) x over the current volume |J| V; V cancels against the
  /// share's stiffness.
  TetFields fields(const State& state) const override {
    const std::size_t tets = tet_springs_.size();
    TetFields out = make_tet_fields(tets);
    parallel_ranges(tets, kTetGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        Mat3 virial = Mat3::Zero();
        for (const std::int32_t index : tet_springs_[t]) {
          const Spring& spring = springs_[static_cast<std::size_t>(index)];
          const Stretch s = stretch(spring, spring.node[0], spring.node[1], state.u);
          const double weight = young_ * s.extension * s.length / (spring.rest_length * spring.rest_length);
          virial += weight * s.direction * s.direction.transpose();
        }
        const double J = volume_ratio(t, state.u);
        const Mat3 stress = virial / std::max(std::abs(J), kLeastVolumeRatio);
        set_tet(out, t, J, stress.trace() / 3.0, stress);
      }
    });
    return out;
  }

  /// A0 is the tangent at rest: its null space is that of the rigid motions, since the six bars of a tet are rigid.
  linalg::BlockPreconditioner preconditioner() const override {
    linalg::BlockPreconditioner out;
    out.A0 = linalg::SymmetricBlockMatrix(pattern_);
    write_tangent(initial_state().u, out.A0);
    return out;
  }

  std::size_t memory_bytes() const override {
    return space_.nodes.size() * sizeof(Vec3) + space_.connectivity.size() * sizeof(std::int32_t) +
           springs_.size() * sizeof(Spring) + tet_springs_.size() * (sizeof(tet_springs_[0]) + sizeof(double)) +
           incidence_.size() * sizeof(Incidence) + incidence_start_.size() * sizeof(std::size_t) +
           pattern_->block_count() * 3 * sizeof(std::int32_t);
  }

 private:
  void lay_springs(const mesh::TetMesh& mesh) {
    EdgeTable table = find_edges(mesh);
    springs_.reserve(table.edges.size());
    for (const auto& [a, b] : table.edges) {
      springs_.push_back({{a.value(), b.value()}, (mesh.node(b) - mesh.node(a)).norm(), 0.0});
    }
    tet_springs_ = std::move(table.of_tet);
    rest_volume_.reserve(mesh.tet_count());
    for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
      rest_volume_.push_back(mesh::signed_volume(mesh, TetId(t)));
      for (const std::int32_t index : tet_springs_[t]) {
        Spring& spring = springs_[static_cast<std::size_t>(index)];
        spring.stiffness += young_ * rest_volume_[t] / (spring.rest_length * spring.rest_length);
      }
    }
  }

  /// Springs come in the order of (smaller, larger) end, so every list ascends by neighbour: the smaller ones first, in
  /// the order of the pattern's blocks of that row.
  void list_springs_of_nodes() {
    incidence_start_.assign(space_.node_count() + 1, 0);
    for (const Spring& spring : springs_) {
      for (const std::int32_t node : spring.node) ++incidence_start_[static_cast<std::size_t>(node) + 1];
    }
    for (std::size_t i = 1; i < incidence_start_.size(); ++i) incidence_start_[i] += incidence_start_[i - 1];
    incidence_.resize(2 * springs_.size());
    std::vector<std::size_t> next(incidence_start_.begin(), incidence_start_.end() - 1);
    for (std::size_t i = 0; i < springs_.size(); ++i) {
      const auto [a, b] = springs_[i].node;
      incidence_[next[static_cast<std::size_t>(a)]++] = {static_cast<std::int32_t>(i), b};
      incidence_[next[static_cast<std::size_t>(b)]++] = {static_cast<std::int32_t>(i), a};
    }
  }

  template <class Use>
  void for_each_spring(std::size_t node, const Use& use) const {
    for (std::size_t i = incidence_start_[node]; i < incidence_start_[node + 1]; ++i) {
      use(springs_[static_cast<std::size_t>(incidence_[i].spring)], incidence_[i].neighbour);
    }
  }

  Vec3 reference(std::int32_t node) const { return space_.nodes[static_cast<std::size_t>(node)]; }

  /// The extension without cancellation: l^2 - L^2 = (2 D + d).d, with D the spring at rest and d = u_to - u_from.
  Stretch stretch(const Spring& spring, std::int32_t from, std::int32_t to, const VectorX& u) const {
    const Vec3 rest = reference(to) - reference(from);
    const Vec3 change = u.segment<3>(3 * to) - u.segment<3>(3 * from);
    const Vec3 now = rest + change;
    const double L = spring.rest_length;
    const double l = std::max(now.norm(), kLeastStretch * L);
    return {now / l, l, (2.0 * rest + change).dot(change) / (l + L)};
  }

  /// K = k (d (x) d + (l - L) / l (I - d (x) d)), the exact derivative; indefinite where springs are compressed.
  /// Gathered row by row, so that every block is written by one thread, in one order.
  void write_tangent(const VectorX& u, linalg::SymmetricBlockMatrix& A) const {
    parallel_ranges(space_.node_count(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        const auto node = static_cast<std::int32_t>(row);
        double* block = A.values.data() + 9 * std::ptrdiff_t{pattern_->row_start[row]};
        Mat3 diagonal = Mat3::Zero();
        for_each_spring(row, [&](const Spring& spring, std::int32_t neighbour) {
          const Stretch s = stretch(spring, node, neighbour, u);
          const double across = s.extension / s.length;
          const Mat3 k =
              spring.stiffness * (across * Mat3::Identity() + (1.0 - across) * s.direction * s.direction.transpose());
          diagonal += k;
          if (neighbour < node) {
            BlockMap{block} = -k;
            block += 9;
          }
        });
        BlockMap{block} = diagonal;
      }
    });
  }

  double volume_ratio(std::size_t t, const VectorX& u) const {
    const std::int32_t* tet = &space_.connectivity[4 * t];
    Mat3 edges;
    const Vec3 x0 = reference(tet[0]) + u.segment<3>(3 * tet[0]);
    for (int i = 0; i < 3; ++i) edges.col(i) = reference(tet[i + 1]) + u.segment<3>(3 * tet[i + 1]) - x0;
    return edges.determinant() / (6.0 * rest_volume_[t]);
  }

  Evaluation evaluate_volumes(const State& state, Scratch& scratch) const {
    parallel_ranges(tet_springs_.size(), kTetGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) scratch.J[static_cast<Eigen::Index>(t)] = volume_ratio(t, state.u);
    });
    return evaluation_of(scratch.J);
  }

  DisplacementSpace space_;
  double young_ = 0.0;                                    ///< E, Pa
  std::shared_ptr<const linalg::BlockPattern> pattern_;   ///< of A
  std::vector<Spring> springs_;                           ///< in the order of find_edges
  std::vector<std::array<std::int32_t, 6>> tet_springs_;  ///< per tet: index into springs_
  std::vector<double> rest_volume_;                       ///< per tet, m^3
  std::vector<std::size_t> incidence_start_;              ///< nodes + 1 offsets into incidence_
  std::vector<Incidence> incidence_;                      ///< per node ascending by neighbour
};

}  // namespace

std::unique_ptr<Model> make_mass_spring(const mesh::TetMesh& mesh, const ModelSettings& settings) {
  return std::make_unique<MassSpring>(mesh, settings.elastic.young);
}

}  // namespace rhexis::model
