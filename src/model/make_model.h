#pragma once

/// The six models of docs/models.md by name.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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

/// A model that can be torn and led by a hand: on linear tets, one tangent a tet.
[[nodiscard]] constexpr bool is_live(ModelKind kind) {
  return kind != ModelKind::mass_spring && kind != ModelKind::taylor_hood;
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

/// Per tet of a mesh: nonzero where it is no part of the body, as a torn one leaves its tets in their places. Empty:
/// all are part of it.
using LeftOut = std::span<const std::uint8_t>;

/// The mesh must have passed mesh::find_defects. Nodes without a tet carry no stiffness: hold them. Tets left out keep
/// their numbers: their lambda has no force and has to stay zero, their J counts as 1. Not of mass-spring and
/// taylor-hood, which take whole meshes: RHEXIS_CHECK.
[[nodiscard]] std::unique_ptr<Model> make_model(const mesh::TetMesh& mesh, const ModelSettings& settings,
                                                LeftOut left_out = {});

}  // namespace rhexis::model
