#pragma once

/// One random body, crack, criterion and pull, all from a seed, torn until it falls apart; with everything checked that
/// must hold for each topology.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <string>
#include <vector>

#include "mesh/generate.h"
#include "mesh/quality.h"
#include "session/tear_session.h"
#include "tests/support/hinges.h"
#include "tests/support/random_draws.h"
#include "tests/support/torn_body_oracle.h"

namespace rhexis::test {

/// What a sweep of pulls has seen.
struct PullTally {
  int pulls = 0;
  int advances = 0;
  int fell_apart = 0;  ///< pulls that left more than one piece, or took what was held off
  int topologies_checked = 0;
  double worst_stiffness = 0.0;  ///< |K - K_oracle| / |K at the start of the pull|
  double worst_move = 0.0;       ///< largest |u - u_oracle| on the local boundary / the hand's way
  double worst_ratio = 1.0;      ///< smallest radius ratio of a changed tet / the least of the intact mesh
  int most_advances = 0;
  int kept = 0;    ///< pulls with keep-nodes
  int hinges = 0;  ///< nodes by which alone their bodies hang together at the end
  int hinged = 0;  ///< pulls that end with some
};

class RandomPull {
 public:
  explicit RandomPull(std::uint64_t seed) : seed_(seed), draws_(seed) {}

  /// What else watches the pull: called when the body is there, and after each edit that it takes or gives back.
  struct Watch {
    std::function<void(const session::TearSession&)> begins = [](const session::TearSession&) {};
    std::function<void(const session::TearSession&)> edited = [](const session::TearSession&) {};
    std::function<void(const session::TearSession&)> undone = [](const session::TearSession&) {};
  };
  void set_watch(Watch watch) { watch_ = std::move(watch); }

  /// `check_share`: part of the topologies that are held against the oracle.
  void run(PullTally& tally, double check_share) {
    make_body();
    const std::vector<scene::CrackSettings> cracks = choose_cracks();
    Expected<std::unique_ptr<session::TearSession>> made = session::TearSession::make(mesh_, settings_, cracks);
    if (!made) return;  // the crack misses the body, or takes its support: said in words, and no crash
    tear_ = std::move(*made);
    const std::size_t start = tear_->body().topology();
    const std::uint64_t bits = bits_of(tear_->body());
    ++tally.pulls;
    watch_.begins(*tear_);
    pull(tally, check_share);
    count_hinges(tally);
    while (tear_->body().topology() > start) {
      ASSERT_TRUE(tear_->undo()) << seed_;
      watch_.undone(*tear_);
    }
    EXPECT_EQ(bits_of(tear_->body()), bits) << "seed " << seed_;
  }

 private:
  double uniform(double from, double to) { return draws_.uniform(from, to); }
  std::size_t choose(std::size_t count) { return draws_.choose(count); }
  Vec3 vector(double from, double to) { return draws_.vector(from, to); }
  Vec3 direction() { return draws_.direction(); }

  void make_body() {
    const std::array<int, 4> plate_nodes{506, 765, 1012, 1270};
    std::vector<std::string> sides;
    switch (choose(4)) {
      case 0:
        mesh_ = *mesh::make_plate({Vec3(0.24, 0.24, 0.01)}, plate_nodes[choose(4)]);
        sides = {"-x", "+x", "+y"};
        plate_ = true;
        break;
      case 1:
        mesh_ = *mesh::make_bar({Vec3(0.04, 0.01, 0.01)}, 500 + static_cast<int>(choose(1000)));
        sides = {"-x", "+x"};
        break;
      case 2:
        mesh_ = *mesh::make_tube({.radius = 0.005, .length = 0.04}, static_cast<int>(600 + choose(900)));
        sides = {"bottom", "top"};
        break;
      default: {
        const double bend = uniform(0.0, 60.0);
        mesh_ = *mesh::make_tube({.radius = 0.005, .length = 0.03, .wall = 0.0015, .bend = bend},
                                 static_cast<int>(1500 + choose(1500)));
        sides = {"bottom", "top"};
      }
    }
    box_ = mesh::bounding_box(mesh_);
    std::vector<std::uint8_t> held(mesh_.node_count(), 0);
    const std::size_t first = choose(sides.size());
    const bool two = uniform(0, 1) < 0.4;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (k != first && !(two && k == (first + 1) % sides.size())) continue;
      for (const NodeId node : mesh_.find_node_set(sides[k])->nodes) held[node.index()] = 1;
    }
    settings_.body.elastic = {1.0e6, uniform(0.2, 0.45)};
    for (std::size_t node = 0; node < held.size(); ++node) {
      for (int c = 0; c < 3 && held[node] != 0; ++c)
        settings_.body.supports.push_back({static_cast<std::int32_t>(3 * node) + c, 0.0});
    }
    if (uniform(0, 1) < 0.3) {
      settings_.body.density = 1000.0;
      settings_.body.gravity = 9.81 * direction();
    }
    settings_.criterion = std::string(fracture::kCriterionNames[choose(fracture::kCriterionNames.size())]);
    settings_.strength = uniform(0.02e6, 0.3e6);
    settings_.advance_threshold = uniform(0.3, 1.0) * *settings_.strength;
    settings_.ahead_only = uniform(0, 1) < 0.8;
    settings_.incision = uniform(0, 1) < 0.5 ? fracture::IncisionMethod::split : fracture::IncisionMethod::keep_nodes;
    settings_.contact = uniform(0, 1) < 0.7 ? response::ContactRule::consistent : response::ContactRule::blend;
    settings_.background = uniform(0, 1) < 0.5;
  }

  std::vector<scene::CrackSettings> choose_cracks() {
    const Vec3 size = box_.size();
    if (plate_) {
      // From the middle of an edge inward, at a slant.
      const Vec3 from(uniform(0.2, 0.8) * size.x(), 0.0, 0.0);
      const double aside = uniform(-0.03, 0.03);
      const Vec3 to = from + Vec3(aside, uniform(0.02, 0.08), 0.0);
      return {{{from, to, Vec3::UnitZ()}}};
    }
    if (uniform(0, 1) < 0.3) return {};  // starts where it yields
    const Vec3 inside = box_.from + vector(0.3, 0.7).cwiseProduct(size);
    Vec3 way = direction();
    Vec3 through = direction();
    through = (through - through.dot(way) * way).normalized();
    return {{{inside - size.norm() * way, inside, through}}};
  }

  void pull(PullTally& tally, double check_share) {
    const Vec3 at = box_.from + vector(0, 1).cwiseProduct(box_.size());
    const auto mode = uniform(0, 1) < 0.85 ? response::ContactMode::hold : response::ContactMode::push;
    if (!tear_->grasp(at, mode)) return;  // a support holds that point
    const Mat3 stiffness = tear_->hand().law().stiffness;
    const double way = uniform(0.3, 1.5) * box_.size().maxCoeff();
    const Vec3 by = way * direction();
    constexpr int kTicks = 40;
    int advances = 0;
    bool apart = false;
    for (int k = 1; k <= kTicks && !apart && advances < 200; ++k) {
      const Vec3 hand = by * (static_cast<double>(k) / kTicks);
      const session::TickReport report = tear_->tick(hand, [&](const session::AdvanceRecord& advance) {
        ++advances;
        check_edit(tally);
        watch_.edited(*tear_);
        EXPECT_TRUE(advance.force_after.allFinite()) << "seed " << seed_;
        if (tear_->hand().holds() && uniform(0, 1) < check_share) check_response(stiffness, way, tally);
      });
      EXPECT_EQ(report.trouble, "") << "seed " << seed_ << " tick " << k;
      EXPECT_TRUE(report.force.allFinite()) << "seed " << seed_;
      apart = report.let_go || tear_->pieces() > 1 || !report.trouble.empty();
    }
    tally.advances += advances;
    tally.most_advances = std::max(tally.most_advances, advances);
    if (apart) ++tally.fell_apart;
  }

  void count_hinges(PullTally& tally) const {
    if (settings_.incision != fracture::IncisionMethod::keep_nodes) return;
    const std::vector<NodeId> hinges = hinges_of(tear_->body());
    ++tally.kept;
    tally.hinges += static_cast<int>(hinges.size());
    if (!hinges.empty()) ++tally.hinged;
  }

  /// Of every tet that the last edit changed.
  void check_edit(PullTally& tally) {
    const mesh::TornMesh& body = tear_->body();
    const mesh::MeshEdit& edit = body.history().back();
    const double least = mesh::measure_quality(mesh_).radius_ratio.min;
    const auto check = [&](TetId tet) {
      const double ratio =
          mesh::signed_volume(body.mesh(), tet) > 0.0 ? mesh::radius_ratio(mesh::corners(body.mesh(), tet)) : 0.0;
      EXPECT_GE(ratio, (1.0 - 1e-9) * fracture::kFlattestTet * least) << "seed " << seed_ << " tet " << tet.value();
      tally.worst_ratio = std::min(tally.worst_ratio, ratio / least);
    };
    for (const mesh::MovedNode& move : edit.moved) {
      for (const TetId tet : body.tets_around(move.node)) check(tet);
    }
    for (const mesh::RewiredTet& tet : edit.rewired) check(tet.tet);
  }

  void check_response(const Mat3& start, double way, PullTally& tally) {
    TornBodyOracle oracle(tear_->body(), settings_.body);
    ASSERT_TRUE(oracle.is_stable()) << "seed " << seed_ << " topology " << tear_->body().topology();
    const auto held = tear_->hand().nodes();
    const std::vector<NodeId> nodes(held.begin(), held.end());
    const response::ContactLaw law =
        response::make_contact_law(tear_->hand().point(), settings_.contact, tear_->hand().law().mode,
                                   oracle.compliance(nodes), oracle.rest(nodes));
    const double error = (tear_->hand().law().stiffness - law.stiffness).norm() / start.norm();
    EXPECT_LT(error, 1e-8) << "seed " << seed_ << " topology " << tear_->body().topology();
    tally.worst_stiffness = std::max(tally.worst_stiffness, error);
    VectorX u;
    tear_->displacement(u);
    const VectorX expected = oracle.displacement(nodes, tear_->hand().nodal_forces());
    for (const fracture::LocalObject& local : tear_->local_objects()) {
      for (const NodeId node : local.boundary()) {
        const Eigen::Index d = 3 * Eigen::Index{node.value()};
        const double move = (u.segment<3>(d) - expected.segment<3>(d)).norm() / way;
        EXPECT_LT(move, 1e-8) << "seed " << seed_ << " node " << node.value();
        tally.worst_move = std::max(tally.worst_move, move);
      }
    }
    ++tally.topologies_checked;
  }

  /// A hash of all that an edit can change.
  static std::uint64_t bits_of(const mesh::TornMesh& body) {
    std::uint64_t hash = 1469598103934665603U;
    const auto add = [&](std::uint64_t value) { hash = (hash ^ value) * 1099511628211U; };
    for (const Vec3& x : body.mesh().nodes) {
      for (int c = 0; c < 3; ++c) add(std::bit_cast<std::uint64_t>(x[c]));
    }
    for (std::size_t t = 0; t < body.mesh().tet_count(); ++t) {
      for (const NodeId node : body.mesh().tets[t]) add(node.index());
      add((body.is_alive(TetId(t)) ? 1U : 0U) + (body.is_frozen(TetId(t)) ? 2U : 0U));
    }
    return hash;
  }

  Watch watch_;
  std::uint64_t seed_;
  RandomDraws draws_;
  mesh::TetMesh mesh_;
  mesh::BoundingBox box_;
  bool plate_ = false;
  session::TearSettings settings_;
  std::unique_ptr<session::TearSession> tear_;
};

}  // namespace rhexis::test
