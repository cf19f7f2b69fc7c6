#include "studies/beta_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "model/stabilisation.h"
#include "studies/loaded_body.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;
using result::Symbol;

constexpr std::array<double, 5> kPaper{0.0, 1.0, 10.0, 100.0, 1000.0};
constexpr std::array<double, 4> kBetween{0.1, 0.3, 3.0, 30.0};

struct Beta {
  std::string choice;
  double value;
  [[nodiscard]] std::string name() const {
    return choice == "auto" ? fmt::format("auto ({:.3g})", value) : fmt::format("beta = {:g}", value);
  }
};

std::vector<Beta> betas_of(const material::MooneyRivlin& law) {
  std::vector<Beta> out;
  for (const double beta : kPaper) out.push_back({"paper", beta});
  for (const double beta : kBetween) out.push_back({"sweep", beta});
  out.push_back({"auto", model::auto_beta(law)});
  std::stable_sort(out.begin(), out.end(), [](const Beta& a, const Beta& b) { return a.value < b.value; });
  return out;
}

ordered_json row_of(const LoadedBody& body, const model::ModelSettings& settings, const Beta& beta,
                    const Solution& solution, const Solution& trusted) {
  double mean = 0.0;
  for (std::size_t t = 0; t < body.mesh.tet_count(); ++t)
    mean += mesh::signed_volume(body.mesh, TetId(t)) * std::abs(solution.lambda[t]) / mesh::total_volume(body.mesh);
  return {{"kappa", settings.law.kappa},
          {"choice", beta.choice},
          {"beta", beta.value},
          {"converged", solution.report.converged()},
          {"pressure_jump", solution.measures.pressure_jump},
          {"lambda_mean", mean},
          {"volume_ratio", solution.measures.volume_ratio},
          {"min_J", *std::min_element(solution.J.begin(), solution.J.end())},
          {"max_J", *std::max_element(solution.J.begin(), solution.J.end())},
          {"error_u_percent", percent_apart(solution.u, trusted.u)},
          {"error_lambda_percent", percent_apart(body.mesh, solution.lambda, trusted.lambda)},
          {"iterations", solution.iterations()},
          {"smoothing_mm", beta.value > 0.0
                               ? ordered_json(1e3 * model::smoothing_length(body.mesh, settings.law, beta.value))
                               : ordered_json()}};
}

/// |lambda| of the tets in the order of the trusted answer's, as Fig. 4 shows it, which has another order.
result::Chart lambda_chart(const Beta& beta, const Solution& solution, const Solution& trusted) {
  std::vector<std::size_t> order(trusted.lambda.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(trusted.lambda[a]) < std::abs(trusted.lambda[b]);
  });
  result::Chart chart;
  chart.title = fmt::format("|lambda| over the tets, {}", beta.name());
  chart.subtitle = "Tets in the order of the trusted answer, which is Taylor-Hood on the refined mesh";
  chart.x = {.label = "tet"};
  chart.y = {.label = "|lambda| / Pa", .scale = result::Scale::log};
  chart.height = 320;
  result::ChartSeries ours{.name = beta.name(), .colour = 1};
  result::ChartSeries theirs{.name = "Taylor-Hood", .colour = 0};
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto take = [&](result::ChartSeries& series, const Solution& of) {
      series.x.push_back(static_cast<double>(k));
      series.y.push_back(std::max(1.0, std::abs(of.lambda[order[k]])));
    };
    take(ours, solution);
    take(theirs, trusted);
  }
  chart.series = {std::move(ours), std::move(theirs)};
  return chart;
}

std::string jumps_in_words(const ordered_json& rows) {
  std::string out = "pressure_jump";
  for (const ordered_json& row : rows)
    if (row.at("choice") == "paper")
      out += fmt::format("{} {:.3g} at {:g}", out.back() == 'p' ? "" : ",", row.at("pressure_jump").get<double>(),
                         row.at("beta").get<double>());
  return out;
}

}  // namespace

Expected<ordered_json> run_beta_sweep(const BetaSweepOptions& options, const StudyFolder& folder,
                                      const Progress& progress) {
  const Expected<LoadedBody> made = make_vessel(options.nodes);
  if (!made) return fail(made.error());
  const LoadedBody& vessel = *made;
  const LoadedBody fine = refined(vessel);
  const solver::Options solving{.tolerance = 1e-9, .steps = 2};
  const result::ShapeSurface surface = result::surface_of(vessel.mesh);
  ordered_json rows = ordered_json::array();
  ordered_json shown = ordered_json::array();
  double done = 0.0;
  const auto goes_on = [&](double cost, const std::string& what) { return progress((done += cost) / 40.0, what); };
  bool going = true;
  for (const Kappa kappa : {Kappa::table3, Kappa::formula}) {
    if (!going) break;
    const Solution answer =
        solve(fine, paper_material(model::ModelKind::taylor_hood, 0.0, kappa), options.density, solving);
    if (!answer.report.converged()) return fail("taylor-hood: " + answer.report.why);
    const Solution trusted = seen_on(vessel, fine, answer);
    going = goes_on(10.0, "taylor-hood on the refined mesh");
    result::ShapePicture picture{.title = "The vessel as beta grows",
                                 .subtitle = "Lines: the shape at rest. Colour: lambda, the mean stress of each tet",
                                 .surface = surface,
                                 .panels = {},
                                 .field = "lambda",
                                 .unit = "Pa",
                                 .has_sign = true};
    double of_kappa = 0.0;
    for (const Beta& beta : betas_of(paper_material(model::ModelKind::hyperelastic, 0.0, kappa).law)) {
      if (!going) break;
      const model::ModelSettings settings = paper_material(model::ModelKind::hyperelastic, beta.value, kappa);
      of_kappa = settings.law.kappa;
      const Solution solution = solve(vessel, settings, options.density, solving);
      rows.push_back(row_of(vessel, settings, beta, solution, trusted));
      going = goes_on(1.0, fmt::format("kappa {:.3g} Pa, {}", settings.law.kappa, beta.name()));
      if (kappa != Kappa::table3 || beta.choice == "sweep") continue;
      shown.push_back(rows.back());
      picture.panels.push_back(panel_of(surface, beta.name(), solution.u, solution.lambda));
      if (beta.value == 0.0 || beta.choice == "auto" || beta.value == kPaper.back()) {
        const std::string name =
            "stabilisation-lambda-" + (beta.choice == "auto" ? "auto" : fmt::format("{:g}", beta.value));
        if (Expected<void> ok = folder.write_figure(name, lambda_chart(beta, solution, trusted)); !ok)
          return fail(ok.error());
      }
    }
    if (rows.empty()) return fail("stopped before there was a row");
    if (Expected<void> ok =
            folder.write_table("stabilisation", rows, "Every beta, with kappa of Table 3 and of the formula.");
        !ok)
      return fail(ok.error());
    const std::string figure = kappa == Kappa::table3 ? "stabilisation-errors" : "stabilisation-errors-formula";
    if (Expected<void> ok = folder.write_figure(figure, beta_chart(rows, of_kappa),
                                                "Which beta to take: the mark is auto. Levels of beta = 0 dashed.");
        !ok)
      return fail(ok.error());
    if (kappa != Kappa::table3) continue;
    picture.panels.push_back(panel_of(surface, "Taylor-Hood, refined", trusted.u, trusted.lambda));
    if (Expected<void> ok = folder.write_shapes("stabilisation-shapes", picture); !ok) return fail(ok.error());
  }
  folder.note(fmt::format(
      "Fig. 3 and 4 of the paper on a generated tube of {} nodes and {} tets (its own mesh is not public), density {} "
      "kg/m3. The trusted answer is Taylor-Hood on the same body with edges half as long.",
      vessel.mesh.node_count(), vessel.mesh.tet_count(), options.density));
  folder.note(
      "beta smooths lambda over about sqrt(beta) edges: too little leaves the oscillation and locks, too much smears "
      "what "
      "is real and softens the body. Where the best beta lies moves with kappa over the shear modulus (the second "
      "figure "
      "has four times the kappa), so that no fixed number is right; auto follows it, from kappa, c1 and c2 alone.");
  folder.compare("stabilisation.oscillation", jumps_in_words(shown),
                 "The same trend, on another mesh; the paper shows it in a picture without numbers.");
  return shown;
}

result::Chart beta_chart(const ordered_json& rows, double kappa) {
  result::Chart chart;
  chart.title = fmt::format("Errors over beta, kappa = {:.4g} MPa", 1e-6 * kappa);
  chart.subtitle = "From Taylor-Hood on the refined mesh; beta = 0, which a logarithmic axis has not, is dashed";
  chart.x = {.label = "beta", .scale = result::Scale::log};
  chart.y = {.label = "percent; jump: percent of the mean |lambda|", .scale = result::Scale::log};
  struct Line {
    const char* key;
    const char* name;
    double factor;
    Symbol symbol;
    int colour;
  };
  result::ChartMarks mark{.name = "auto", .x = {}};
  for (const Line& line : {Line{"error_u_percent", "displacement", 1.0, Symbol::circle, 0},
                           Line{"error_lambda_percent", "lambda", 1.0, Symbol::square, 1},
                           Line{"pressure_jump", "jump of lambda from tet to tet", 100.0, Symbol::triangle, 2}}) {
    result::ChartSeries series{.name = line.name, .symbol = line.symbol, .colour = line.colour};
    result::ChartSeries without{.dashed = true, .colour = line.colour};
    for (const ordered_json& row : rows) {
      if (row.at("kappa") != kappa) continue;
      const double y = line.factor * row.at(line.key).get<double>();
      const double beta = row.at("beta");
      if (beta == 0.0) {
        without.y = {y, y};
        continue;
      }
      series.x.push_back(beta);
      series.y.push_back(y);
      if (row.at("choice") == "auto") mark.x = {beta};
    }
    if (series.x.empty()) continue;
    without.x = {series.x.front(), series.x.back()};
    chart.series.push_back(std::move(series));
    if (!without.y.empty()) chart.series.push_back(std::move(without));
  }
  chart.marks.push_back(std::move(mark));
  return chart;
}

}  // namespace rhexis::studies
