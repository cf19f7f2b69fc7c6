#include "bench/rivals/bullet_bar.h"

#include <fmt/format.h>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>

namespace rhexis::rivals {
namespace {

btVector3 to_bullet(const Vec3& x) { return {btScalar(x[0]), btScalar(x[1]), btScalar(x[2])}; }
Vec3 from_bullet(const btVector3& x) { return {double(x[0]), double(x[1]), double(x[2])}; }

/// Bullet has no calls for its iterations, but keeps them where a derived class may set them.
class Solver final : public btDeformableBodySolver {
 public:
  explicit Solver(const BulletSettings& settings) {
    m_maxNewtonIterations = settings.newton;
    m_newtonTolerance = 0;  // goes on to the last of them
    m_cg.m_maxIterations = settings.iterations;
    m_cr.m_maxIterations = settings.iterations;
  }
};

std::unique_ptr<btDeformableLagrangianForce> make_force(BulletLaw law, const material::Elastic& elastic,
                                                        double damping) {
  const double mu = elastic.lame_mu();
  const double lambda = elastic.lame_lambda();
  if (law == BulletLaw::linear) {
    auto force = std::make_unique<btDeformableLinearElasticityForce>(btScalar(mu), btScalar(lambda));
    force->setDamping(0, btScalar(damping));
    return force;
  }
  // The constants with which the law is Hooke's at rest (Smith, de Goes, Kim 2018, section 3.4).
  auto force =
      std::make_unique<btDeformableNeoHookeanForce>(btScalar(4.0 / 3.0 * mu), btScalar(lambda + 5.0 / 6.0 * mu));
  force->setDamping(btScalar(damping));
  return force;
}

}  // namespace

std::string BulletSettings::name() const {
  return fmt::format("{}, {:g} kg/m^3, damping {:g}, {} x {} iterations{}{}", is_implicit ? "implicit" : "explicit",
                     density, damping, newton, iterations, line_search ? ", line search" : "",
                     steps > 1 ? fmt::format(", {} steps", steps) : "");
}

struct BulletBar::World {
  World(const Bar& of, BulletLaw law, const BulletSettings& chosen)
      : bar(of),
        settings(chosen),
        dispatcher(&configuration),
        solver(chosen),
        world(&dispatcher, &broadphase, &constraints, &configuration, &solver),
        force(make_force(law, of.elastic, chosen.damping)) {
    constraints.setDeformableSolver(&solver);
    world.setGravity({0, 0, 0});
    world.getWorldInfo().m_gravity.setZero();
    world.setImplicit(settings.is_implicit);
    world.setLineSearch(settings.line_search);
    world.setUseProjection(true);  // conjugate gradients, preconditioned by the masses
    add_body();
  }
  ~World() { world.removeSoftBody(body.get()); }

  void add_body() {
    std::vector<btVector3> x;
    for (const Vec3& node : bar.mesh.nodes) x.push_back(to_bullet(node));
    std::vector<double> mass(x.size());
    for (std::size_t t = 0; t < bar.mesh.tet_count(); ++t)
      for (const NodeId node : bar.mesh.tets[t])
        mass[node.index()] += settings.density * mesh::signed_volume(bar.mesh, TetId(t)) / 4.0;
    for (const NodeId node : bar.held) mass[node.index()] = 0.0;  // what has no mass stays
    mass[bar.hand.index()] = 0.0;
    const std::vector<btScalar> m(mass.begin(), mass.end());
    body = std::make_unique<btSoftBody>(&world.getWorldInfo(), static_cast<int>(x.size()), x.data(), m.data());
    for (const mesh::Tet& tet : bar.mesh.tets)
      body->appendTetra(tet[0].value(), tet[1].value(), tet[2].value(), tet[3].value());
    body->initializeDmInverse();
    btSoftBody::TetraScratch at_rest;
    for (btMatrix3x3* F : {&at_rest.m_F, &at_rest.m_cofF, &at_rest.m_corotation}) F->setIdentity();
    at_rest.m_trace = 3;
    at_rest.m_J = 1;
    body->m_tetraScratches.resize(body->m_tetras.size(), at_rest);
    body->m_tetraScratchesTn.resize(body->m_tetras.size(), at_rest);
    body->m_cfg.collisions = 0;
    body->setActivationState(DISABLE_DEACTIVATION);
    world.addSoftBody(body.get());
    world.addForce(body.get(), force.get());
  }

  const Bar& bar;
  BulletSettings settings;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btDbvtBroadphase broadphase;
  Solver solver;
  btDeformableMultiBodyConstraintSolver constraints;
  btDeformableMultiBodyDynamicsWorld world;
  std::unique_ptr<btDeformableLagrangianForce> force;
  std::unique_ptr<btSoftBody> body;
};

BulletBar::BulletBar(const Bar& bar, BulletLaw law, const BulletSettings& settings)
    : world_(std::make_unique<World>(bar, law, settings)) {}
BulletBar::~BulletBar() = default;

void BulletBar::frame(const Vec3& hand) {
  World& w = *world_;
  btSoftBody::Node& node = w.body->m_nodes[w.bar.hand.value()];
  node.m_v = (to_bullet(w.bar.mesh.node(w.bar.hand) + hand) - node.m_x) / btScalar(kFrame);
  node.m_vn = node.m_v;  // of the step before: the implicit solver begins there
  const btScalar step = btScalar(kFrame / w.settings.steps);
  for (int i = 0; i < w.settings.steps; ++i) w.world.stepSimulation(step, 0);
}

VectorX BulletBar::displacement() const {
  VectorX u(world_->bar.dofs());
  for (int i = 0; i < world_->body->m_nodes.size(); ++i)
    u.segment<3>(3 * i) =
        from_bullet(world_->body->m_nodes[i].m_x) - world_->bar.mesh.nodes[static_cast<std::size_t>(i)];
  return u;
}

VectorX BulletBar::elastic_force(const VectorX& u) {
  btSoftBody& body = *world_->body;
  const int count = body.m_nodes.size();
  btAlignedObjectArray<btVector3> kept, force;
  kept.resize(count);
  force.resize(count, btVector3(0, 0, 0));
  for (int i = 0; i < count; ++i) {
    kept[i] = body.m_nodes[i].m_q;
    body.m_nodes[i].m_q = to_bullet(world_->bar.mesh.nodes[static_cast<std::size_t>(i)] + u.segment<3>(3 * i));
    body.m_nodes[i].index = i;
  }
  body.updateDeformation();
  world_->force->addScaledExplicitForce(1, force);
  VectorX out(u.size());
  for (int i = 0; i < count; ++i) {
    out.segment<3>(3 * i) = from_bullet(force[i]);
    body.m_nodes[i].m_q = kept[i];
  }
  body.updateDeformation();
  return out;
}

}  // namespace rhexis::rivals
