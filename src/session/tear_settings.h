#pragma once

/// What an interaction with a body that tears is told at its start.

#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "fracture/incision.h"
#include "response/contact.h"
#include "response/elastic_elements.h"
#include "response/recorded_response.h"
#include "response/torn_model.h"
#include "solver/live_equilibrium.h"
#include "solver/options.h"

namespace rhexis::session {

struct TearSettings {
  response::ElasticBody body;
  /// Of large strain: any live model but `linear`; `body.elastic` is not read then. Empty: small strains.
  std::optional<model::ModelSettings> large_strain = std::nullopt;
  std::vector<response::SurfacePressure> pressures = {};    ///< this and what follows is read with large strain
  solver::Options solver = {};                              ///< how the equilibrium under the loads alone is found
  solver::LiveOptions live = {};                            ///< of a frame
  std::optional<solver::Dynamics> dynamics = std::nullopt;  ///< empty: the body has no mass
  int frames = 1;                                           ///< of a tick at most
  bool tears = true;      ///< false: it bends; what follows is not read, and its first cracks stay as they are
  std::string criterion;  ///< of fracture::kCriterionNames; empty: "maximum-principal" for a plate, else "maximum-hoop"
  std::optional<double> strength;   ///< Pa; this or toughness
  std::optional<double> toughness;  ///< N/m
  double advance_threshold = 0.0;   ///< Pa, read with strength
  bool ahead_only = true;
  double local_radius = 0.0;  ///< m, first and least; 0: four mean edges
  fracture::IncisionMethod incision = fracture::IncisionMethod::keep_nodes;
  /// The response is the recorded one, of this record of the body with its first crack; null: the exact one.
  response::SharedRecord record = nullptr;
  response::ContactRule contact = response::ContactRule::consistent;
  /// The response may make a new factor on another thread when cracks leave the corridor that it foresaw. Worth it for
  /// cracks that turn far (docs/restructuring.md); the same bits from run to run, other ones than without.
  bool background = false;
};

}  // namespace rhexis::session
