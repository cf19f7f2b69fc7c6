#include "studies/identification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include "result/compare.h"
#include "studies/loaded_body.h"
#include "studies/reference_solution.h"

namespace rhexis::studies {
namespace {

using nlohmann::ordered_json;

constexpr std::array<double, 2> kDensities{510.0, 5.1};  // kg/m^3
/// Components below this part of the largest one have no relative difference worth a mean.
constexpr double kNothing = 1e-6;

/// Of one component, percent; NaN where the reference has none.
double component_percent(const VectorX& ours, const VectorX& other, Eigen::Index i) {
  return 100.0 * std::abs(ours[i] - other[i]) / std::abs(other[i]);
}

ordered_json differences(const LoadedBody& body, double density, const std::string& against, const VectorX& ours,
                         const VectorX& other) {
  const double least = kNothing * other.cwiseAbs().maxCoeff();
  double of_nodes = 0.0;
  std::vector<double> of_components;
  int nodes = 0;
  for (Eigen::Index n = 0; n < ours.size() / 3; ++n) {
    const double size = other.segment<3>(3 * n).norm();
    if (size > least) {
      of_nodes += 100.0 * (ours - other).segment<3>(3 * n).norm() / size;
      ++nodes;
    }
    for (Eigen::Index i = 3 * n; i < 3 * n + 3; ++i) {
      if (std::abs(other[i]) <= least) continue;
      of_components.push_back(component_percent(ours, other, i));
    }
  }
  const auto middle = of_components.begin() + static_cast<std::ptrdiff_t>(of_components.size() / 2);
  std::nth_element(of_components.begin(), middle, of_components.end());
  const auto all = [](const VectorX& u) {
    return std::span<const double>(u.data(), static_cast<std::size_t>(u.size()));
  };
  const result::BoxDifference box = result::box_difference(body.box(), all(other), all(ours));
  return {{"body", body.name},
          {"rho", density},
          {"against", against},
          {"nodes", body.mesh.node_count()},
          {"tets", body.mesh.tet_count()},
          {"mean_percent", of_nodes / nodes},
          {"component_percent", std::accumulate(of_components.begin(), of_components.end(), 0.0) /
                                    static_cast<double>(of_components.size())},
          {"component_median_percent", *middle},
          {"box_percent_mean", box.mean.mean()},
          {"box_percent_max", box.largest.maxCoeff()},
          {"largest_mm", 1e3 * (ours - other).cwiseAbs().maxCoeff()}};
}

/// As Table 4 has them: nodes 1, 100, 200, ... counted from 1.
void add_nodes(ordered_json& rows, double density, const std::string& against, const VectorX& ours,
               const VectorX& other) {
  const auto count = static_cast<int>(ours.size() / 3);
  for (int node = 1; node <= count; node = node == 1 ? 100 : node + 100) {
    ordered_json row{{"rho", density}, {"against", against}, {"node", node}};
    for (int c = 0; c < 3; ++c) {
      const int i = 3 * (node - 1) + c;
      const std::string name(1, "xyz"[c]);
      row["ours_" + name + "_mm"] = 1e3 * ours[i];
      row[name + "_percent"] = other[i] == 0.0 ? ordered_json() : ordered_json(component_percent(ours, other, i));
    }
    rows.push_back(std::move(row));
  }
}

Expected<Solution> solved(const LoadedBody& body, model::ModelKind kind, double density) {
  Solution solution = solve(body, paper_material(kind), density, {.tolerance = 1e-11, .steps = 2});
  if (!solution.report.converged())
    return fail(fmt::format("{}, rho {}: {}", model::kModelNames[static_cast<std::size_t>(kind)], density,
                            solution.report.why));
  return solution;
}

/// Against the other programs' solutions of the same discrete problem on their mesh; empty where they are not here.
Expected<void> add_other_programs(const std::filesystem::path& shared, ordered_json& rows, ordered_json& node_rows) {
  const Expected<std::optional<LoadedBody>> vessel = read_reference_vessel(shared);
  if (!vessel) return fail(vessel.error());
  if (!*vessel) return {};
  struct Other {
    const char* program;
    double density;
    const char* file;
  };
  for (const Other& other : {Other{"DOLFINx", 510.0, "4_vessel_small/PSH_beta0_rho510_u.csv"},
                             Other{"DOLFINx", 5.1, "4_vessel_small/PSH_beta0_rho5.1_u.csv"},
                             Other{"CalculiX", 500.0, "5_calculix/vessel_small_MR_C3D4_u.csv"}}) {
    const Expected<std::optional<VectorX>> u =
        read_displacement(shared / "reference" / other.file, (*vessel)->mesh.node_count());
    if (!u) return fail(u.error());
    if (!*u) continue;
    const Expected<Solution> ours = solved(**vessel, model::ModelKind::hyperelastic, other.density);
    if (!ours) return fail(ours.error());
    rows.push_back(differences(**vessel, other.density, other.program, ours->u, **u));
    add_nodes(node_rows, other.density, other.program, ours->u, **u);
  }
  return {};
}

void beside_the_paper(const StudyFolder& folder, const LoadedBody& vessel, const ordered_json& rows) {
  folder.compare("identification.nodes", vessel.mesh.node_count(),
                 "The paper's mesh is not public; a generated tube of its size stands in.");
  folder.compare("identification.tets", vessel.mesh.tet_count(), "The same: another mesh of the same size.");
  for (const auto& [id, density] :
       {std::pair("identification.mean.rho510", 510.0), std::pair("identification.mean.rho5.1", 5.1)}) {
    ordered_json ours;
    for (const ordered_json& row : rows)
      if (row.at("against") == "DOLFINx" && row.at("rho") == density) ours = row.at("component_percent");
    folder.compare(id, ours,
                   ours.is_null()
                       ? "Not measured: no solution of another program lies beside this checkout."
                       : "Ours and DOLFINx solve the same discrete problem on the same mesh and agree to "
                         "rounding; the paper's other program has another element and its own stopping rule.");
  }
}

}  // namespace

Expected<ordered_json> run_identification(const IdentificationOptions& options, const StudyFolder& folder,
                                          const Progress& progress) {
  const Expected<LoadedBody> made = make_vessel(options.nodes);
  if (!made) return fail(made.error());
  const LoadedBody& vessel = *made;
  const LoadedBody fine = refined(vessel);
  ordered_json rows = ordered_json::array();
  ordered_json node_rows = ordered_json::array();
  const result::ShapeSurface surface = result::surface_of(vessel.mesh);
  result::ShapePicture picture{
      .title = "The vessel by the hyperelastic model without stabilisation, and the trusted answer",
      .subtitle = "Lines: the shape at rest. Colour: distance from the trusted answer",
      .surface = surface,
      .panels = {},
      .field = "distance from Taylor-Hood on the refined mesh",
      .unit = "m"};
  int done = 0;
  const auto goes_on = [&](const std::string& what) { return progress(++done / 7.0, what); };
  bool going = true;
  for (const double density : kDensities) {
    if (!going) break;
    const Expected<Solution> ours = solved(vessel, model::ModelKind::hyperelastic, density);
    if (!ours) return fail(ours.error());
    going = goes_on(fmt::format("beta 0, rho {}", density));
    for (const auto& [body, name] :
         {std::pair(&vessel, "taylor-hood, same mesh"), std::pair(&fine, "taylor-hood, refined")}) {
      if (!going) break;
      const Expected<Solution> answer = solved(*body, model::ModelKind::taylor_hood, density);
      if (!answer) return fail(answer.error());
      const VectorX trusted = answer->u.head(ours->u.size());
      rows.push_back(differences(vessel, density, name, ours->u, trusted));
      add_nodes(node_rows, density, name, ours->u, trusted);
      going = goes_on(fmt::format("{}, rho {}", name, density));
      if (body != &fine || density != kDensities.front()) continue;
      std::vector<double> apart;
      for (const mesh::Tet& tet : vessel.mesh.tets) {
        double sum = 0.0;
        for (const NodeId node : tet) sum += (ours->u - trusted).segment<3>(3 * node.value()).norm() / 4.0;
        apart.push_back(sum);
      }
      picture.panels.push_back(panel_of(surface, "beta = 0, rho 510", ours->u, apart));
      picture.panels.push_back(
          panel_of(surface, "Taylor-Hood, refined", trusted, std::vector<double>(vessel.mesh.tet_count(), 0.0)));
    }
  }
  if (Expected<void> added = add_other_programs(options.shared, rows, node_rows); !added) return fail(added.error());
  if (rows.empty()) return fail("stopped before there was a row");

  folder.note(fmt::format(
      "The paper holds its own hyperelastic model, beta = 0, against a commercial program on a vessel of 401 nodes and "
      "1101 tets, which is not public. Here a generated tube of {} nodes and {} tets, 10 x 10 x 40 mm with a wall of "
      "1.5 mm, is loaded as in its Fig. 2: the top fixed, nodes half way up moved by 50% of the width in x, the bottom "
      "moved down by 30% of the height.",
      vessel.mesh.node_count(), vessel.mesh.tet_count()));
  folder.note(
      "Against another program on the same mesh and elements the difference is rounding: that says the model is built "
      "right. Against Taylor-Hood it is not: that is what linear tets without stabilisation cost, and no fault of the "
      "program.");
  if (Expected<void> ok = folder.write_table("identification", rows, "Differences of the displacement."); !ok)
    return fail(ok.error());
  if (Expected<void> ok = folder.write_table("identification-nodes", node_rows, "Node by node, as the paper lists it.");
      !ok)
    return fail(ok.error());
  if (!picture.panels.empty())
    if (Expected<void> ok = folder.write_shapes("identification-shapes", picture); !ok) return fail(ok.error());
  beside_the_paper(folder, vessel, rows);
  progress(1.0, "done");
  return rows;
}

}  // namespace rhexis::studies
