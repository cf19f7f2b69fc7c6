// Ways to the exact compliance at the hand while a body tears, side by side on the plate 240 x 240 x 10 mm whose crack
// runs from y = 60 mm on in steps of one and a half edges. Each way gives the 3 x 3 compliance of the held node after
// each advance; the time of an advance is the mean, with all that a way has to do now and then. It is the processor's
// time on one thread, so that what else runs on the machine counts little. docs/exact-response.md quotes these numbers.
//
//   rhexis_bench --benchmark_filter=ResponseMethods

#include <benchmark/benchmark.h>

#include <Eigen/Dense>

#include <algorithm>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "fracture/incision.h"
#include "linalg/front_kernels.h"
#include "mesh/generate.h"
#include "mesh/quality.h"
#include "response/contact.h"
#include "response/exact_response.h"
#include "response/followed.h"
#include "response/publish.h"
#include "tests/support/torn_body_oracle.h"

extern "C" {
void dgesv_(const int* n, const int* columns, double* A, const int* lda, int* pivot, double* b, const int* ldb,
            int* info);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
}

namespace {

using namespace rhexis;            // NOLINT
using namespace rhexis::response;  // NOLINT
using linalg::FrontTree;

constexpr double kEdgesPerAdvance = 1.5;
constexpr double kLocalEdges = 4.0;
constexpr int kAdvances = 18;

/// Seconds of the processor since construction, all threads together.
class ProcessorWatch {
 public:
  [[nodiscard]] double seconds() const {
    return static_cast<double>(std::clock() - start_) / static_cast<double>(CLOCKS_PER_SEC);
  }

 private:
  std::clock_t start_ = std::clock();
};

/// The plate at its start, and the edits of its advances, made once.
struct Pull {
  mesh::TornMesh start;
  ElasticBody elastic;
  std::vector<mesh::MeshEdit> edits;
  std::vector<Focus> focus;  ///< before the first edit and after each
  NodeId hand;
};

const Pull& pull_of(int nodes) {
  static std::map<int, std::unique_ptr<Pull>> made;
  std::unique_ptr<Pull>& pull = made[nodes];
  if (pull) return *pull;
  const mesh::TetMesh mesh = mesh::make_plate({{0.24, 0.24, 0.01}}, nodes).value();
  const mesh::Quality quality = mesh::measure_quality(mesh);
  const double h = quality.edge.mean;
  pull = std::make_unique<Pull>(Pull{mesh::TornMesh(mesh), {}, {}, {}, {}});
  pull->elastic.elastic = {.young = 1.0e6, .poisson = 0.4};
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.node_count()); ++i) {
    if (mesh.nodes[static_cast<std::size_t>(i)][1] < 0.24 - 1e-9) continue;
    for (std::int32_t c = 0; c < 3; ++c) pull->elastic.supports.push_back({3 * i + c, 0.0});
  }
  for (const NodeId node : mesh.find_node_set("-y")->nodes) {
    const auto distance = [&](NodeId id) { return (mesh.node(id) - Vec3(0.1, 0.0, 0.005)).norm(); };
    if (!pull->hand.valid() || distance(node) < distance(pull->hand)) pull->hand = node;
  }
  fracture::IncisionSettings settings{fracture::IncisionMethod::keep_nodes, h, quality.radius_ratio.min,
                                      std::vector<std::uint8_t>(mesh.node_count(), 0)};
  settings.immovable[pull->hand.index()] = 1;
  fracture::Surroundings surroundings(mesh);
  const auto cut = [&](mesh::TornMesh& body, double from, double to) {
    const Vec3 a(0.1203, from, -0.01), b(0.1203, from, 0.02), c(0.1203, to, 0.02), d(0.1203, to, -0.01);
    mesh::MeshEdit edit = fracture::incise(body, surroundings, {{{a, b, c}, {a, c, d}}}, settings).edit;
    body.apply(edit);
    surroundings.follow(edit, body);
    return edit;
  };
  double front = 0.06;
  cut(pull->start, -0.01, front);
  mesh::TornMesh body = pull->start;
  const auto here = [&] { return Focus{{0.1203, front, 0.005}, Vec3::UnitY(), 0.005, kLocalEdges * h, Vec3::UnitZ()}; };
  pull->focus.push_back(here());
  while (pull->edits.size() < kAdvances && front + kEdgesPerAdvance * h < 0.23) {
    pull->edits.push_back(cut(body, front, front + kEdgesPerAdvance * h));
    front += kEdgesPerAdvance * h;
    pull->focus.push_back(here());
  }
  return *pull;
}

/// One way: what it has to set up, and what it does after each edit that `body` has taken.
struct Way {
  std::function<Mat3(const mesh::MeshEdit&, const Focus&)> advance;
  /// Where there is one: what the nodes of the local object do under a force.
  std::function<void(std::span<const NodeId>, const VectorX&, VectorX&)> displace;
};

std::vector<NodeId> nodes_around(const mesh::TornMesh& body, const Focus& focus) {
  std::vector<NodeId> out;
  for (std::size_t i = 0; i < body.mesh().node_count(); ++i) {
    const double distance = (body.mesh().nodes[i] - focus.centre).norm();
    if (body.is_alive(NodeId(i)) && distance < focus.radius) out.emplace_back(i);
  }
  return out;
}
using MakeWay = std::function<Way(const Pull&, mesh::TornMesh&)>;

/// `most` advances; every answer is held against the full refactorisation where that is quick.
void run(benchmark::State& state, const MakeWay& make, int most) {
  const Pull& pull = pull_of(static_cast<int>(state.range(0)));
  set_thread_count(1);
  mesh::TornMesh body = pull.start;
  const ProcessorWatch setup;
  const Way way = make(pull, body);
  state.counters["setup_ms"] = 1e3 * setup.seconds();
  const std::size_t advances = std::min(pull.edits.size(), static_cast<std::size_t>(most));
  double worst = 0.0;
  double tets = 0.0;
  double first = 0.0;  // s, of the displacement of the local object after an advance, and of another force on
  double again = 0.0;
  for (auto _ : state) {
    double seconds = 0.0;
    for (std::size_t i = 0; i < advances; ++i) {
      body.apply(pull.edits[i]);
      tets += static_cast<double>(pull.edits[i].removed.size());
      const ProcessorWatch watch;
      const Mat3 compliance = way.advance(pull.edits[i], pull.focus[i + 1]);
      seconds += watch.seconds();
      if (way.displace) {
        const std::vector<NodeId> local = nodes_around(body, pull.focus[i + 1]);
        VectorX u;
        for (int tick = 0; tick < 8; ++tick) {
          const VectorX force = Vec3(std::sin(tick), std::cos(tick), 1.0);
          const ProcessorWatch one;
          way.displace(local, force, u);
          (tick < 3 ? first : again) += one.seconds() / static_cast<double>(advances);
        }
      }
      if (state.range(0) > 20000 && i + 1 < advances) continue;
      rhexis::test::TornBodyOracle oracle(body, pull.elastic);
      const Eigen::MatrixXd expected = oracle.compliance({pull.hand});
      worst = std::max(worst, (compliance - expected).norm() / expected.norm());
    }
    state.SetIterationTime(seconds / static_cast<double>(advances));
  }
  set_thread_count(0);
  if (!(worst < 1e-7)) state.SkipWithError("not exact");
  state.counters["error"] = worst;
  state.counters["advances"] = static_cast<double>(advances);
  if (way.displace) {
    state.counters["local_ms"] = 1e3 * first;  // three forces, which make a basis
    state.counters["tick_ms"] = 1e3 * again / 5.0;
  }
  state.counters["tets"] = tets / static_cast<double>(advances);
}

/// Assembly, order of elimination and factor, all anew.
void full(benchmark::State& state) {
  run(
      state,
      [](const Pull& pull, mesh::TornMesh& body) {
        Way way;
        way.advance = [&](const mesh::MeshEdit&, const Focus&) {
          return Mat3(rhexis::test::TornBodyOracle(body, pull.elastic).compliance({pull.hand}));
        };
        return way;
      },
      state.range(0) > 20000 ? 1 : 3);
}

/// `is_known`: the dissection knows where the crack will run.
Way follow_tree(const Pull& pull, mesh::TornMesh& body, bool is_known) {
  ExactSettings settings;
  settings.body = pull.elastic;
  const std::span<const Focus> first(&pull.focus[0], is_known ? 1 : 0);
  const std::shared_ptr<ExactResponse> response = ExactResponse::make(body, settings, first);
  response->grasp(std::span(&pull.hand, 1));
  Way way;
  way.advance = [response](const mesh::MeshEdit& edit, const Focus& focus) {
    RHEXIS_CHECK(response->follow(edit, std::span(&focus, 1)).ok, "not stable");
    return Mat3(response->compliance());
  };
  way.displace = [response](std::span<const NodeId> nodes, const VectorX& force, VectorX& out) {
    response->displacement(nodes, force, out);
  };
  return way;
}

/// Partial refactorisation in a tree that knows the way of the crack.
void ours(benchmark::State& state) {
  run(
      state, [](const Pull& pull, mesh::TornMesh& body) { return follow_tree(pull, body, true); }, kAdvances);
}

/// The same in a tree as METIS makes it (Herholz and Sorkine-Hornung).
void partial(benchmark::State& state) {
  run(
      state, [](const Pull& pull, mesh::TornMesh& body) { return follow_tree(pull, body, false); },
      state.range(0) > 20000 ? 6 : kAdvances);
}

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
  [[nodiscard]] bool is_free(std::int32_t dof) const override { return all_.is_free(dof); }

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
    outside_tree_ = outside_tree_->updated(Part(body_, model_, inside_, false), {{}, touched, rim_});
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
    RHEXIS_CHECK(linalg::front_kernels().factor(S.data(), n, n, n, work.data()), "not stable");
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

void condense(benchmark::State& state, double edges_ahead) {
  run(
      state,
      [=](const Pull& pull, mesh::TornMesh& body) {
        const double h = pull.focus[0].radius / kLocalEdges;
        const auto own = std::make_shared<Condensed>(pull, body, edges_ahead * h);
        Way way;
        way.advance = [own](const mesh::MeshEdit& edit, const Focus& focus) { return own->advance(edit, focus); };
        return way;
      },
      kAdvances);
}
void one_window(benchmark::State& state) { condense(state, kEdgesPerAdvance * kAdvances); }
void moving_window(benchmark::State& state) { condense(state, 10.0); }

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

void low_rank(benchmark::State& state) {
  run(
      state,
      [](const Pull& pull, mesh::TornMesh& body) {
        const auto own = std::make_shared<LowRank>(pull, body);
        Way way;
        way.advance = [own](const mesh::MeshEdit& edit, const Focus&) { return own->advance(edit); };
        return way;
      },
      kAdvances);
}

void HeldPointTick(benchmark::State& state) {
  const Pull& pull = pull_of(static_cast<int>(state.range(0)));
  ExactSettings settings;
  settings.body = pull.elastic;
  const auto response = ExactResponse::make(pull.start, settings, {});
  const SurfacePoint point = *nearest_surface_point(pull.start, Vec3(0.1, 0.0, 0.0043));
  response->grasp({point.node.data(), static_cast<std::size_t>(point.count)});
  const ContactLaw law =
      make_contact_law(point, ContactRule::consistent, ContactMode::hold, response->compliance(), response->rest());
  double at = 0.0;
  for (auto _ : state) {
    // What a tick does: take the newest snapshot as bytes, and evaluate it.
    const ForceSnapshot snapshot = make_snapshot(law, 10.0, 1);
    benchmark::DoNotOptimize(force_at(snapshot, Vec3(at, -at, 1e-3)));
    benchmark::DoNotOptimize(law.nodal_forces(Vec3(at, -at, 1e-3)));
    at += 1e-9;
  }
}

void NearestSurfacePoint(benchmark::State& state) {
  const Pull& pull = pull_of(static_cast<int>(state.range(0)));
  double at = 0.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(nearest_surface_point(pull.start, Vec3(0.1 + at, 0.02, 0.012)));
    at += 1e-6;
  }
}

void all_sizes(benchmark::internal::Benchmark* of) {
  for (const int nodes : {506, 1270, 5000, 20000, 100000}) of->Arg(nodes);
  of->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(full)->Name("ResponseMethods/full")->Apply(all_sizes);
BENCHMARK(one_window)->Name("ResponseMethods/one_window")->Apply(all_sizes);
BENCHMARK(low_rank)->Name("ResponseMethods/low_rank")->Apply(all_sizes);
BENCHMARK(partial)->Name("ResponseMethods/partial")->Apply(all_sizes);
BENCHMARK(HeldPointTick)->Arg(506)->Arg(100000)->Unit(benchmark::kNanosecond);
BENCHMARK(NearestSurfacePoint)->Arg(506)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(moving_window)->Name("ResponseMethods/moving_window")->Apply(all_sizes);
BENCHMARK(ours)->Name("ResponseMethods/ours")->Apply(all_sizes);

}  // namespace
