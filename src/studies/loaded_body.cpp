#include "studies/loaded_body.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/check.h"
#include "base/clock.h"
#include "mesh/generate.h"
#include "mesh/io/mesh_file.h"
#include "model/refine.h"

namespace rhexis::studies {
namespace {

/// Nodes within fractions of the bounding box; a billionth of it is rounding.
void add_box_set(mesh::TetMesh& mesh, std::string name, const Vec3& from, const Vec3& to) {
  const mesh::BoundingBox box = mesh::bounding_box(mesh);
  const Vec3 slack = Vec3::Constant(1e-9);
  mesh::NodeSet set{std::move(name), {}};
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const Vec3 part = (mesh.nodes[n] - box.from).cwiseQuotient(box.size());
    if ((part.array() >= (from - slack).array()).all() && (part.array() <= (to + slack).array()).all())
      set.nodes.emplace_back(n);
  }
  mesh.node_sets.push_back(std::move(set));
}

/// The published constants (Table 3).
constexpr material::Elastic kElastic{1e6, 0.49};
constexpr material::MooneyRivlin kLaw{8.395e4, 8.395e4, 4.167e6};

}  // namespace

Expected<LoadedBody> make_vessel(int nodes, double aside, double down) {
  const mesh::TubeShape shape{.radius = 0.005, .length = 0.04, .wall = 0.0015};
  Expected<mesh::TetMesh> mesh = mesh::make_tube(shape, nodes);
  if (!mesh) return fail(std::move(mesh.error()));
  LoadedBody body{.name = "vessel", .mesh = std::move(*mesh), .supports = {}};
  // As fine meshes have layers that lie elsewhere, the layer nearest to the middle is taken where none lies in it.
  double half = 0.05;
  add_box_set(body.mesh, "patch", Vec3(0.0, 0.0, 0.5 - half), Vec3(0.5, 1.0, 0.5 + half));
  while (body.mesh.node_sets.back().nodes.empty()) {
    half *= 1.5;
    body.mesh.node_sets.pop_back();
    add_box_set(body.mesh, "patch", Vec3(0.0, 0.0, 0.5 - half), Vec3(0.5, 1.0, 0.5 + half));
  }
  const Vec3 box = body.box();
  body.supports = {{"top", {0.0, 0.0, 0.0}},
                   {"patch", {aside * box.x(), kFree, kFree}},
                   {"bottom", {kFree, kFree, -down * box.z()}}};
  return body;
}

Expected<LoadedBody> make_organ(const std::string& name, const std::filesystem::path& file) {
  Expected<mesh::MeshFile> read = mesh::read_mesh_file(file);
  if (!read) return fail(std::move(read.error()));
  LoadedBody body{.name = name, .mesh = std::move(read->mesh), .supports = {}};
  add_box_set(body.mesh, "upper", Vec3(0.0, 0.9, 0.0), Vec3(1.0, 1.0, 1.0));
  add_box_set(body.mesh, "belt", Vec3(0.0, 0.45, 0.0), Vec3(0.3, 0.55, 1.0));
  add_box_set(body.mesh, "lower", Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.1, 1.0));
  const Vec3 box = body.box();
  body.supports = {
      {"upper", {0.0, 0.0, 0.0}}, {"belt", {0.1 * box.x(), kFree, kFree}}, {"lower", {kFree, -0.1 * box.y(), kFree}}};
  for (const SetSupport& support : body.supports)
    if (body.mesh.find_node_set(support.set)->nodes.empty())
      return fail("no node lies in the part '" + support.set + "' of it", {}, file.string());
  return body;
}

LoadedBody refined(const LoadedBody& body) { return {body.name, model::refine(body.mesh), body.supports}; }

model::ModelSettings paper_material(model::ModelKind kind, double beta, Kappa kappa) {
  model::ModelSettings settings{.kind = kind, .elastic = kElastic, .law = kLaw, .beta = beta};
  if (kappa == Kappa::formula) settings.law.kappa = material::to_mooney_rivlin(kElastic).kappa;
  settings.initial_lambda = 300.0;  // Pa, as the paper starts
  return settings;
}

model::Loading loading_of(const LoadedBody& body, const model::DisplacementSpace& space, double density) {
  std::map<std::int32_t, double> held;
  for (const SetSupport& support : body.supports) {
    const mesh::NodeSet* set = body.mesh.find_node_set(support.set);
    RHEXIS_CHECK(set != nullptr, "set '{}'", support.set);
    for (const std::int32_t node : model::nodes_of_set(space, set->nodes))
      for (std::int32_t c = 0; c < 3; ++c)
        if (const auto& value = support.displacement[static_cast<std::size_t>(c)]) held[3 * node + c] = *value;
  }
  model::Loading loading;
  for (const auto& [dof, value] : held) loading.supports.push_back({dof, value});
  loading.dead_force = VectorX::Zero(static_cast<Eigen::Index>(space.dof_count()));
  model::add_body_force(body.mesh, space, density * Vec3(0.0, 0.0, -kGravity), loading.dead_force);
  return loading;
}

int Solution::iterations() const {
  int all = 0;
  for (const solver::StepReport& step : report.steps) all += step.iterations;
  return all;
}

Solution solve(const LoadedBody& body, const model::ModelSettings& settings, double density,
               const solver::Options& options, const StepWatch& watch) {
  const Stopwatch clock;
  const std::unique_ptr<model::Model> model = model::make_model(body.mesh, settings);
  const model::Loading loading = loading_of(body, model->space(), density);
  model::State state = model->initial_state();
  const auto dofs = static_cast<Eigen::Index>(3 * body.mesh.node_count());
  solver::StepObserver observer;
  if (watch)
    observer = [&](const solver::StepReport& step, const model::State& at, const VectorX&) {
      return watch(step.load, at.u.head(dofs));
    };
  Solution solution;
  solution.report = solver::solve_equilibrium(*model, loading, options, state, observer);
  const model::TetFields tets = model->fields(state);
  solution.u = state.u.head(dofs);
  solution.lambda = tets.lambda;
  solution.J = tets.J;
  solution.measures = result::measure(body.mesh, state, tets);
  solution.seconds = clock.seconds();
  return solution;
}

Solution seen_on(const LoadedBody& coarse, const LoadedBody& fine, const Solution& solution) {
  const std::size_t children = fine.mesh.tet_count() / coarse.mesh.tet_count();
  Solution out = solution;
  out.u = solution.u.head(static_cast<Eigen::Index>(3 * coarse.mesh.node_count()));
  const auto means = [&](const std::vector<double>& values) {
    std::vector<double> of_coarse;
    for (std::size_t t = 0; t < coarse.mesh.tet_count(); ++t) {
      double sum = 0.0;
      double volume = 0.0;
      for (std::size_t child = children * t; child < children * (t + 1); ++child) {
        const double v = mesh::signed_volume(fine.mesh, TetId(child));
        sum += v * values[child];
        volume += v;
      }
      of_coarse.push_back(sum / volume);
    }
    return of_coarse;
  };
  out.lambda = means(solution.lambda);
  out.J = means(solution.J);
  return out;
}

result::ShapePanel panel_of(const result::ShapeSurface& surface, std::string title, const VectorX& u,
                            const std::vector<double>& per_tet) {
  result::ShapePanel panel{.title = std::move(title), .displacement = {}, .values = {}};
  for (const NodeId node : surface.node) panel.displacement.push_back(u.segment<3>(3 * node.value()));
  if (per_tet.empty()) return panel;
  for (const TetId tet : surface.tet) panel.values.push_back(per_tet[tet.index()]);
  return panel;
}

double percent_apart(const VectorX& a, const VectorX& b) { return 100.0 * (a - b).norm() / b.norm(); }

double percent_apart(const mesh::TetMesh& mesh, const std::vector<double>& a, const std::vector<double>& b) {
  double apart = 0.0;
  double size = 0.0;
  for (std::size_t t = 0; t < mesh.tet_count(); ++t) {
    const double volume = mesh::signed_volume(mesh, TetId(t));
    apart += volume * (a[t] - b[t]) * (a[t] - b[t]);
    size += volume * b[t] * b[t];
  }
  return 100.0 * std::sqrt(apart / size);
}

}  // namespace rhexis::studies
