#pragma once

/// The bodies of the paper's experiments and their equilibria by any of the models.

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/tet_mesh.h"
#include "model/loading.h"
#include "model/make_model.h"
#include "result/fields.h"
#include "result/shape_picture.h"
#include "solver/equilibrium.h"

namespace rhexis::studies {

/// Components of a node set that are held where they are or moved, m at full load; kFree: not held.
struct SetSupport {
  std::string set;
  std::array<std::optional<double>, 3> displacement;
};

inline constexpr std::nullopt_t kFree = std::nullopt;

struct LoadedBody {
  std::string name;
  mesh::TetMesh mesh;
  std::vector<SetSupport> supports;
  [[nodiscard]] Vec3 box() const { return mesh::bounding_box(mesh).size(); }
};

/// The paper's vessel is not public: a tube of its size stands in, 10 x 10 x 40 mm with a wall of 1.5 mm.
inline constexpr int kVesselNodes = 401;
/// Fig. 2: the top held; the nodes half way up on the side that faces -x moved by `aside` of the width in x, the bottom
/// by `down` of the height downwards; what is left open is free. Errors: a tube of so many nodes cannot be.
[[nodiscard]] Expected<LoadedBody> make_vessel(int nodes, double aside = 0.5, double down = 0.3);

/// An organ from a mesh file, loaded in the same manner along y, its long side: the upper tenth of its height held, a
/// patch half way up moved by a tenth of the width in x, the lowest tenth moved down by a tenth of the height.
[[nodiscard]] Expected<LoadedBody> make_organ(const std::string& name, const std::filesystem::path& file);

/// The same body with edges half as long.
[[nodiscard]] LoadedBody refined(const LoadedBody& body);

/// Table 3 of the paper: E and nu for the models that read them, c1, c2 and kappa for the others. They are not the
/// same material: kappa is a quarter of what the paper's own formula gives (docs/models.md). `formula`: that kappa.
enum class Kappa { table3, formula };
[[nodiscard]] model::ModelSettings paper_material(model::ModelKind kind, double beta = 0.0,
                                                  Kappa kappa = Kappa::table3);

inline constexpr double kGravity = 9.81;  // m/s^2, towards -z

/// What acts, for a model's space. `density` in kg/m^3.
[[nodiscard]] model::Loading loading_of(const LoadedBody& body, const model::DisplacementSpace& space, double density);

struct Solution {
  solver::Report report;
  VectorX u;                   ///< m, 3 per node of the mesh
  std::vector<double> lambda;  ///< Pa, per tet
  std::vector<double> J;       ///< per tet
  result::Measures measures;
  double seconds = 0.0;
  [[nodiscard]] int iterations() const;
};

/// Called after each load step with its fraction and u of the mesh's nodes; false stops.
using StepWatch = std::function<bool(double load, const VectorX& u)>;

[[nodiscard]] Solution solve(const LoadedBody& body, const model::ModelSettings& settings, double density,
                             const solver::Options& options, const StepWatch& watch = {});

/// u and lambda on a refinement as the coarse mesh sees them: at its nodes, and as means over its tets.
[[nodiscard]] Solution seen_on(const LoadedBody& coarse, const LoadedBody& fine, const Solution& solution);

/// A panel of a picture: the surface moved by u, coloured by a value per tet (empty: grey).
[[nodiscard]] result::ShapePanel panel_of(const result::ShapeSurface& surface, std::string title, const VectorX& u,
                                          const std::vector<double>& per_tet);

/// |a - b| / |b| over all nodes (L2), percent.
[[nodiscard]] double percent_apart(const VectorX& a, const VectorX& b);
/// The same of lambda, weighted with the volumes of the tets.
[[nodiscard]] double percent_apart(const mesh::TetMesh& mesh, const std::vector<double>& a,
                                   const std::vector<double>& b);

}  // namespace rhexis::studies
