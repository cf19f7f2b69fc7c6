#pragma once

/// The six models of docs/models.md by name.

#include <array>
#include <memory>
#include <optional>
#include <string_view>

#include "material/parameters.h"
#include "mesh/tet_mesh.h"
#include "model/model.h"

namespace rhexis::model {

enum class ModelKind { mass_spring, linear, corotated, geometrically_nonlinear, hyperelastic, taylor_hood };

inline constexpr std::array<std::string_view, 6> kModelNames{
    "mass-spring", "linear", "corotated", "geometrically-nonlinear", "hyperelastic", "taylor-hood"};
/// `name` must be one of kModelNames.
[[nodiscard]] ModelKind kind_named(std::string_view name);
/// Has lambda beside the displacement, and reads `law`; the others read `elastic`.
[[nodiscard]] constexpr bool is_mixed(ModelKind kind) {
  return kind == ModelKind::hyperelastic || kind == ModelKind::taylor_hood;
}

enum class CorotatedTangent { exact, warped };  ///< warped: the paper's R K_e R^T

struct ModelSettings {
  ModelKind kind = ModelKind::hyperelastic;
  material::Elastic elastic;    ///< read by mass_spring, linear, corotated, geometrically_nonlinear
  material::MooneyRivlin law;   ///< read by hyperelastic, taylor_hood; c2 = 0 is neo-Hookean
  double beta = 0.0;            ///< hyperelastic: the factor of the pressure stabilisation, no unit
  double initial_lambda = 0.0;  ///< Pa, mixed models
  CorotatedTangent corotated_tangent = CorotatedTangent::exact;
};

/// The mesh must have passed mesh::find_defects. Nodes without a tet carry no stiffness: hold them.
[[nodiscard]] std::unique_ptr<Model> make_model(const mesh::TetMesh& mesh, const ModelSettings& settings);

}  // namespace rhexis::model
