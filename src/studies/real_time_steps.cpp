#include "studies/real_time_steps.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "result/compare.h"
#include "solver/newton.h"

namespace rhexis::studies {
namespace {

constexpr double kDensity = 500.0;  // kg/m^3
constexpr int kLooks = 8;           // loads at which the state is held against equilibrium
constexpr int kTrial = 15;          // steps that are timed
/// A run with more steps than this says nothing more.
constexpr int kMostSteps = 20'000;

double longest_way(const LoadedBody& body) {
  double longest = 0.0;
  for (const SetSupport& support : body.supports)
    for (const std::optional<double>& value : support.displacement)
      longest = std::max(longest, std::abs(value.value_or(0.0)));
  return longest;
}

/// A Newton iteration and no more; what is left of the residual the next step takes up.
solver::Options one_iteration(const std::string& linear) {
  solver::Options options;
  options.linear = linear;
  options.max_iterations = 1;
  return options;
}

bool went_on(const solver::StepReport& step) {
  return solver::is_success(step.outcome) || step.outcome == solver::Outcome::too_many_iterations;
}

}  // namespace

RealTimeSteps step_in_real_time(const LoadedBody& body, const model::ModelSettings& settings, const std::string& linear,
                                double hand) {
  const std::unique_ptr<model::Model> model = model::make_model(body.mesh, settings);
  const model::Loading loading = loading_of(body, model->space(), kDensity);
  const solver::Options options = one_iteration(linear);
  const double seconds = longest_way(body) / hand;
  RealTimeSteps out;
  {
    solver::Newton newton(*model, loading, options);
    model::State state = model->initial_state();
    std::vector<double> taken;
    for (int k = 1; k <= kTrial; ++k) {
      const Stopwatch watch;
      newton.solve(0.002 * k, state);
      taken.push_back(watch.seconds());
    }
    std::nth_element(taken.begin() + 1, taken.begin() + 1 + (kTrial - 1) / 2, taken.end());
    out.step_seconds = taken[1 + (kTrial - 1) / 2];
  }
  out.steps = std::clamp(static_cast<int>(std::ceil(seconds / out.step_seconds)), 1, kMostSteps);

  solver::Newton newton(*model, loading, options);
  const solver::Options exact{.linear = linear, .tolerance = 1e-8, .steps = 1};
  model::State state = model->initial_state();
  model::State equilibrium = model->initial_state();
  int looked = 0;
  for (int k = 1; k <= out.steps && out.held; ++k) {
    const double load = static_cast<double>(k) / out.steps;
    out.held = went_on(newton.solve(load, state));
    if (!out.held || k * kLooks < (looked + 1) * out.steps) continue;
    looked = k * kLooks / out.steps;
    solver::Newton other(*model, loading, exact);
    if (!solver::is_success(other.solve(load, equilibrium).outcome)) {
      equilibrium = state;  // too long a way in one step; from here it is near
      if (!solver::is_success(other.solve(load, equilibrium).outcome)) continue;
    }
    const VectorX apart = state.u - equilibrium.u;
    double mean = 0.0;
    double largest = 0.0;
    for (Eigen::Index n = 0; n < apart.size() / 3; ++n) {
      mean += apart.segment<3>(3 * n).norm() * 3.0 / static_cast<double>(apart.size());
      largest = std::max(largest, apart.segment<3>(3 * n).norm());
    }
    out.mean_mm = std::max(out.mean_mm, 1e3 * mean);
    out.largest_mm = std::max(out.largest_mm, 1e3 * largest);
    const std::span<const double> ours(state.u.data(), static_cast<std::size_t>(state.u.size()));
    const std::span<const double> theirs(equilibrium.u.data(), ours.size());
    out.largest_percent =
        std::max(out.largest_percent, result::box_difference(body.box(), theirs, ours).largest.maxCoeff());
  }
  return out;
}

}  // namespace rhexis::studies
