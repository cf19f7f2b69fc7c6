#include "bench/rivals/contestant.h"

#include <utility>

#include <Eigen/LU>

#include "base/check.h"
#include "mesh/torn_mesh.h"
#include "response/exact_response.h"
#include "solver/live_equilibrium.h"

namespace rhexis::rivals {
namespace {

class Live final : public Contestant {
 public:
  Live(const Bar& bar, std::shared_ptr<const model::Model> model)
      : hand_(bar.hand.value()), live_(model, bar.supported(), model->initial_state(), {}) {}
  void hold() override { live_.hold({.node = {hand_, 0, 0}, .weight = Vec3::UnitX(), .count = 1}); }
  void frame(const Vec3& hand) override { live_.step(hand); }
  VectorX displacement() override { return live_.state().u; }
  Vec3 force() override { return live_.force(); }

 private:
  std::int32_t hand_;
  solver::LiveEquilibrium live_;
};

class Linear final : public Contestant {
 public:
  explicit Linear(const Bar& bar) : hand_(bar.hand), mesh_(bar.mesh) {
    response::ExactSettings settings;
    settings.body.elastic = bar.elastic;
    settings.body.supports = bar.supported().supports;
    response_ = response::ExactResponse::make(mesh_, settings, {});
    RHEXIS_CHECK(response_ != nullptr, "the bar has a free motion");
  }
  void hold() override { response_->grasp(std::span(&hand_, 1)); }
  void frame(const Vec3& hand) override {
    force_ = response_->compliance().inverse() * hand;
    response_->whole_displacement(force_, 1.0, u_);
  }
  VectorX displacement() override { return u_; }
  Vec3 force() override { return force_; }

 private:
  NodeId hand_;
  mesh::TornMesh mesh_;
  std::unique_ptr<response::ExactResponse> response_;
  VectorX force_, u_;
};

class Bullet final : public Contestant {
 public:
  Bullet(const Bar& bar, BulletLaw law, const BulletSettings& settings)
      : hand_(3 * Eigen::Index{bar.hand.value()}), body_(bar, law, settings) {}
  void frame(const Vec3& hand) override { body_.frame(hand); }
  VectorX displacement() override { return body_.displacement(); }
  Vec3 force() override { return -body_.elastic_force(body_.displacement()).segment<3>(hand_); }

 private:
  Eigen::Index hand_;
  BulletBar body_;
};

}  // namespace

std::unique_ptr<Contestant> make_live(const Bar& bar, std::shared_ptr<const model::Model> model) {
  return std::make_unique<Live>(bar, std::move(model));
}
std::unique_ptr<Contestant> make_linear(const Bar& bar) { return std::make_unique<Linear>(bar); }
std::unique_ptr<Contestant> make_bullet(const Bar& bar, BulletLaw law, const BulletSettings& settings) {
  return std::make_unique<Bullet>(bar, law, settings);
}

}  // namespace rhexis::rivals
