#pragma once

/// A scene that has met its mesh, for tearing: all that an interaction needs.

#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/tet_mesh.h"
#include "response/torn_model.h"
#include "scene/scene.h"
#include "solver/inertia.h"
#include "solver/options.h"

namespace rhexis::scene {

struct TearProblem {
  std::string title;                                 ///< of the scene; its file's name where it has none
  mesh::TetMesh mesh;                                ///< with the scene's sets
  response::ElasticBody body;                        ///< nodes that no tet has are held
  model::ModelSettings model = {};                   ///< with anything but `linear` the body is one of large strain
  std::vector<response::SurfacePressure> pressures;  ///< of such a body
  solver::Options solver;                            ///< the same: for its equilibrium under the loads alone
  std::optional<solver::Dynamics> dynamics = std::nullopt;  ///< of such a body; empty: without mass
  FractureSettings fracture;
  bool tears = true;  ///< false: the scene does not say when, and `fracture` is empty
  std::vector<CrackSettings> cracks;
  RecordSettings record;
  InteractionSettings interaction;
  std::vector<PullSettings> pulls;
  std::vector<std::string> warnings;  ///< one line each
  std::vector<std::string> notes;     ///< one line each
};

/// What makes a scene one for `rhexis tear`: it says when the body tears, and pulls at it.
[[nodiscard]] bool is_for_tearing(const Scene& scene);

/// Who asks. script: the scene alone says what happens, so that it has to say all. hand: someone holds the body, and a
/// scene made for `rhexis solve` opens too: without `[[pull]]` nothing is scripted, without `[fracture]` it bends and
/// does not tear, `mass-spring` and `taylor-hood` become `linear`, and with that a pressure acts on the surface as it
/// was at rest; warnings say so. record: the campaign of `rhexis precompute`, which needs a `[[crack]]` that runs on
/// and tets that are taken away.
enum class Puller { script, hand, record };

/// Reads or generates the mesh and holds the scene against it. Errors beside those of build_problem: for a script no
/// `[fracture]`, no `[[pull]]`; for a record, and whoever asks for `response = "recorded"`, other than one `[[crack]]`,
/// another incision than `keep-nodes`, more topologies than a record may have, a model other than `linear`, a pressure;
/// for a script `mass-spring` or `taylor-hood`, a pressure on a `linear` body; for all of them blended contact of a
/// body of large strain, and dynamics of one without a density.
[[nodiscard]] Expected<TearProblem> build_tear_problem(const Scene& scene, Puller puller = Puller::script);

}  // namespace rhexis::scene
