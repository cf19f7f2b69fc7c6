#pragma once

/// The plate that the thesis tears (Table 5.3), at any fineness: 240 x 240 x 10 mm, E 1 MPa, nu 0.4, a crack of 60 mm
/// from the middle of y = 0 to +y, held at +x and pulled at the corner of the crack on the other side, as in
/// scenes/plate-tear.toml.

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/tet_mesh.h"
#include "session/tear_session.h"

namespace rhexis::studies {

struct StudyPlate {
  mesh::TetMesh mesh;
  session::TearSettings settings;
  std::vector<scene::CrackSettings> cracks;
  Vec3 at = Vec3::Zero();  ///< m, where it is held
  Vec3 by = Vec3::Zero();  ///< m, the whole pull
};

/// Errors: a number of nodes that no plate can have.
[[nodiscard]] Expected<StudyPlate> make_study_plate(int nodes);

/// The same plate with its crack as a scene that a session can open; it does not tear by itself, and nobody pulls.
[[nodiscard]] std::string plate_scene(std::string_view title, int nodes);

/// A session with the plate, held at its point. Errors as of TearSession::make.
[[nodiscard]] Expected<std::unique_ptr<session::TearSession>> start_tearing(const StudyPlate& plate);

}  // namespace rhexis::studies
