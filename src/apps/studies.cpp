// What `rhexis study` can run.

#include "apps/studies.h"

#include <fmt/format.h>

#include "apps/perception_page.h"
#include "studies/angle_perception.h"
#include "studies/beta_sweep.h"
#include "studies/identification.h"
#include "studies/iteration_timing.h"
#include "studies/live_models.h"
#include "studies/live_study.h"
#include "studies/model_comparison.h"
#include "studies/perception_answers.h"
#include "studies/reaction_error.h"
#include "studies/restructuring.h"
#include "studies/stability_map.h"

namespace rhexis::apps {
namespace {

template <class Options, class Run>
StudyFunction runs_with(std::shared_ptr<Options> options, Run run) {
  return [options, run](const studies::StudyFolder& folder, const studies::Progress& progress) {
    return run(*options, folder, progress);
  };
}

StudyFunction identification_options(CLI::App& command) {
  auto options = std::make_shared<studies::IdentificationOptions>();
  command.add_option("--nodes", options->nodes, "of the vessel; 401 unless given")->type_name("COUNT");
  command
      .add_option("--shared", options->shared,
                  "folder with reference/, solutions of other programs; ../shared unless given")
      ->type_name("DIR");
  return runs_with(options, studies::run_identification);
}

StudyFunction beta_sweep_options(CLI::App& command) {
  auto options = std::make_shared<studies::BetaSweepOptions>();
  command.add_option("--nodes", options->nodes, "of the vessel; 401 unless given")->type_name("COUNT");
  command.add_option("--density", options->density, "kg/m3; 500 unless given")->type_name("KG/M3");
  return runs_with(options, studies::run_beta_sweep);
}

StudyFunction model_comparison_options(CLI::App& command) {
  auto options = std::make_shared<studies::ModelComparisonOptions>();
  command.add_option("--nodes", options->nodes, "of the vessel; 401 unless given")->type_name("COUNT");
  command.add_option("--density", options->densities, "kg/m3; 500 and 5000 unless given")
      ->type_name("KG/M3")
      ->expected(-1);
  command.add_option("--shared", options->shared, "folder with data/, meshes of organs; ../shared unless given")
      ->type_name("DIR");
  command.add_option("--organ", options->organs, "of it, where they are; kidney_1k and liver_1k unless given")
      ->type_name("NAME")
      ->expected(-1);
  return runs_with(options, studies::run_model_comparison);
}

StudyFunction timing_options(CLI::App& command) {
  auto options = std::make_shared<studies::TimingOptions>();
  command.add_option("--nodes", options->nodes, "of the vessels; 401 to 30000 unless given")
      ->type_name("COUNT")
      ->expected(-1);
  command.add_option("--threads", options->threads, "1 and 2 unless given")->type_name("COUNT")->expected(-1);
  command.add_option("--linear", options->solvers, "direct, cg, minres")->type_name("NAME")->expected(-1);
  command.add_option("--hand", options->hand, "m/s, the speed of the load where each step is one iteration")
      ->type_name("M/S");
  return runs_with(options, studies::run_timing);
}

StudyFunction restructuring_options(CLI::App& command) {
  auto options = std::make_shared<studies::RestructuringOptions>();
  command.add_option("--nodes", options->nodes, "of the plates")->type_name("COUNT")->expected(-1);
  command.add_option("--mode", options->modes, fmt::format("{}", fmt::join(studies::kTearModes, ", ")))
      ->type_name("MODE")
      ->expected(-1);
  command.add_option("--way", options->ways, fmt::format("{}", fmt::join(studies::kWays, ", ")))
      ->type_name("WAY")
      ->expected(-1);
  command.add_option("--seconds", options->seconds_per_case, "a plate is torn anew from its start for about so long")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 3600.0));
  return runs_with(options, studies::run_restructuring);
}

StudyFunction reaction_error_options(CLI::App& command) {
  auto options = std::make_shared<studies::ReactionErrorOptions>();
  command.add_option("--nodes", options->nodes, "of the plate")->type_name("COUNT");
  command.add_option("--advances", options->advances, "1: Table 5.9 of the thesis, 2: Table 5.10")
      ->type_name("COUNT")
      ->expected(-1);
  command.add_option("--spacing", options->spacing, "between recorded cracks")->type_name("DEGREES");
  command.add_option("--spacings", options->spacings, "that are compared, at one advance")
      ->type_name("DEGREES")
      ->expected(-1);
  command.add_option("--step", options->step, "between the cracks that are asked for")->type_name("DEGREES");
  return runs_with(options, studies::run_reaction_error);
}

StudyFunction angle_perception_options(CLI::App& command) {
  auto options = std::make_shared<studies::AnglePerceptionOptions>();
  auto answers = std::make_shared<std::string>();
  command
      .add_option("--experiment", options->experiment, "points, directions and rule; those of the thesis unless given")
      ->type_name("FILE");
  command.add_option("--seed", options->seed, "of the order of trials, in place of the experiment's")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000'000'000'000}));
  CLI::Option* scripted =
      command.add_option("--answers", *answers, "of a script, A or B a line, in place of simulated observers")
          ->type_name("FILE");
  command.add_option("--observers", options->observers, "that are simulated, of each threshold and rule")
      ->type_name("COUNT");
  command.add_option("--threshold", options->thresholds, "of simulated observers; 8, 15 and 30 unless given")
      ->type_name("DEGREES")
      ->expected(-1);
  auto with = std::make_shared<std::string>("simulated");
  command.add_option("--with", *with, "simulated observers, or a person at the page; simulated unless given")
      ->type_name("WHOM")
      ->check(CLI::IsMember({"simulated", "person"}))
      ->excludes(scripted);
  auto person = std::make_shared<PersonOptions>();
  command.add_option("--device", person->device, "of the person: a name from `rhexis devices`; pointer unless given")
      ->type_name("NAME");
  command.add_option("--motion-scale", person->motion_scale, "m in the scene for a metre of the device")
      ->type_name("FACTOR");
  command
      .add_option("--force-scale", person->force_scale, "N at the device for a newton in the scene; 0.1 unless given")
      ->type_name("FACTOR");
  person->view = add_live_view_options(command);
  return [=](const studies::StudyFolder& folder, const studies::Progress& progress) {
    if (answers->empty() && *with != "person") return studies::run_angle_perception(*options, folder, progress);
    const Expected<studies::PerceptionSettings> settings = options->settings();
    if (!settings) return Expected<nlohmann::ordered_json>(fail(settings.error()));
    return answers->empty() ? run_with_person(*settings, *person, folder, progress)
                            : studies::run_scripted_answers(*settings, *answers, folder, progress);
  };
}

StudyFunction haptic_stability_options(CLI::App& command) {
  auto options = std::make_shared<studies::StabilityOptions>();
  command.add_option("--stiffness", options->stiffness, "N/m, of the coupling")->type_name("N/M")->expected(-1);
  command.add_option("--damping", options->damping, "N s/m, of the coupling")->type_name("NS/M");
  command.add_option("--delay", options->delay, "ms, whole ones, of the force")->type_name("MS")->expected(-1);
  command.add_option("--resolution", options->device.resolution, "m, of the position; 0: exact")->type_name("M");
  command.add_option("--mass", options->device.mass, "kg, of device and finger")->type_name("KG");
  command.add_option("--hand-damping", options->device.hand_damping, "N s/m, of the hand")->type_name("NS/M");
  command.add_option("--seconds", options->seconds, "of each run")->type_name("SECONDS")->check(CLI::Range(1.2, 600.0));
  return runs_with(options, studies::run_stability_map);
}

StudyFunction live_options(CLI::App& command) {
  auto options = std::make_shared<studies::LiveOptions>();
  command.add_option("--seconds", options->seconds, "to run; 600 unless given")
      ->type_name("SECONDS")
      ->check(CLI::Range(1.0, 86400.0));
  command.add_option("--nodes", options->nodes, "of the plate; 20000 unless given")
      ->type_name("COUNT")
      ->check(CLI::Range(100, 1'000'000));
  command.add_option("--clients", options->clients, "that watch; 3 unless given")
      ->type_name("COUNT")
      ->check(CLI::Range(1, 16));
  command.add_option("--device", options->device, "script or emulator; emulator unless given")->type_name("NAME");
  command.add_option("--priority", options->priority, "of the haptic loop under SCHED_FIFO; 80 unless given, 0: none")
      ->type_name("PRIORITY")
      ->check(CLI::Range(0, 99));
  return runs_with(options, studies::run_live_study);
}

StudyFunction live_models_options(CLI::App& command) {
  auto options = std::make_shared<studies::LiveModelsOptions>();
  command.add_option("--nodes", options->nodes, "of the bodies")->type_name("COUNT")->expected(-1);
  command.add_option("--model", options->models, "corotated, geometrically-nonlinear, hyperelastic")
      ->type_name("NAME")
      ->expected(-1);
  command.add_option("--speed", options->speeds, "of the hand")->type_name("M/S")->expected(-1);
  command.add_option("--seconds", options->seconds, "of each motion")->type_name("SECONDS");
  command.add_option("--samples", options->samples, "instants at which the converged force is computed")
      ->type_name("COUNT");
  command.add_option("--corrections", options->corrections, "Newton corrections a frame")->type_name("COUNT");
  command.add_option("--frame", options->frame, "that every frame counts as; as long as it takes unless given")
      ->type_name("SECONDS");
  return runs_with(options, studies::run_live_models);
}

}  // namespace

std::span<const Study> all_studies() {
  static const std::vector<Study> kStudies{
      {"identification",
       "Is the hyperelastic model what another program computes, and how near to the truth",
       "--out out/identification",
       {"body", "rho", "against", "mean_percent", "component_percent", "component_median_percent", "box_percent_max",
        "largest_mm"},
       identification_options},
      {"stabilisation",
       "Which factor of the pressure stabilisation to take, and why auto",
       "--nodes 800",
       {"choice", "beta", "pressure_jump", "volume_ratio", "error_u_percent", "error_lambda_percent", "iterations"},
       beta_sweep_options},
      {"models",
       "Where the six models part from each other and from the trusted answer",
       "--density 500",
       {"body", "rho", "model", "mean", "max", "mean_x", "mean_y", "mean_z", "load", "volume_ratio", "inverted_tets"},
       model_comparison_options},
      {"timing",
       "What a Newton iteration of each model costs, and what one iteration a step is good for",
       "--nodes 401 3000 --threads 2",
       {"nodes", "threads", "model", "linear", "outcome", "tangent_ms", "solve_ms", "tangent_ratio", "solve_ratio",
        "iteration_ratio"},
       timing_options},
      {"restructuring",
       "What an advance of a crack costs, by six ways",
       "--nodes 506 1270 5000 --mode slow-pull",
       {"nodes", "mode", "way", "advances", "ms_per_advance", "ms_median", "ms_most", "ms_per_tet", "sparse_over_this"},
       restructuring_options},
      {"reaction-error",
       "How far recorded forces are from the exact ones",
       "--advances 1 --step 5",
       {"advances", "way", "patterns", "better", "better_untied", "mean", "deviation", "mean_relative", "thesis_better",
        "thesis_mean", "thesis_deviation"},
       reaction_error_options},
      {"angle-perception",
       "Which crack angles a hand can tell apart, and which rule finds that out",
       "--answers answers.txt",
       {"source", "from", "to", "trials", "right", "critical", "told"},
       angle_perception_options},
      {"haptic-stability",
       "Which couplings an emulated haptic device bears",
       "--delay 0 1 2 --stiffness 500 1000 2000",
       {"stiffness", "delay_ms", "over_bound", "rests_free", "shake_mm_free", "rests_kept", "shake_mm_kept", "gain"},
       haptic_stability_options},
      {"live",
       "How punctual a live session is: haptic loop, laws, pictures of its clients",
       "--seconds 60 --nodes 5000",
       {"measure", "value", "unit", "note"},
       live_options},
      {"live-models",
       "How a body of each model keeps up with a hand",
       "--nodes 2100 --model hyperelastic --speed 0.05",
       {"tets", "model", "speed_mm_s", "frames_per_s", "frame_ms", "frame_ms_most", "late", "iterations", "residual",
        "error_mean", "error_most"},
       live_models_options},
  };
  return kStudies;
}

}  // namespace rhexis::apps
