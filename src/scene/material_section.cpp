#include "scene/sections.h"

namespace rhexis::scene {
namespace {

/// Below this the law counts as one without stiffness, Pa; the least of `young` and `kappa` too.
constexpr double kLeastStiffness = 1e-3;

/// The constants of the law; all of them must be there.
Expected<material::MooneyRivlin> read_law(const SectionValues& values, bool neo_hookean) {
  const std::string beside = values.given_key("c1") ? "'c1'" : values.given_key("c2") ? "'c2'" : "'kappa'";
  for (const std::string_view key : {"c1", "c2", "kappa"}) {
    if (neo_hookean && key == "c2") {
      if (values.given_key(key))
        return values.place_of(key).fail("'material.c2' is no constant of 'neo-hookean'",
                                         "leave it out, or law = \"mooney-rivlin\"");
    } else if (!values.given_key(key)) {
      return missing(values, key, " beside " + beside);
    }
  }
  const material::MooneyRivlin law{values.get<double>("c1"), neo_hookean ? 0.0 : values.get<double>("c2"),
                                   values.get<double>("kappa")};
  if (!(law.c1 + law.c2 >= kLeastStiffness))
    return values.place_of("c1").fail(fmt::format("the law has no stiffness: c1 + c2 is {}", law.c1 + law.c2),
                                      fmt::format("c1 + c2 at least {} Pa", kLeastStiffness));
  return law;
}

}  // namespace

Expected<MaterialSettings> read_material_section(const SectionValues& values, Scene& scene) {
  MaterialSettings settings;
  if (values.given_key("density")) settings.density = values.get<double>("density");
  if (!values.given_key("density") && !scene.gravity.isZero(0.0))
    return missing(values, "density", " beside 'gravity'");

  const bool has_elastic = values.given_key("young") || values.given_key("poisson");
  const bool has_law = values.given_key("c1") || values.given_key("c2") || values.given_key("kappa");
  const bool neo_hookean = values.given_key("law") && values.get<std::string>("law") == "neo-hookean";
  if (!has_elastic && !has_law)
    return values.place.fail("the material has no stiffness", "give young and poisson, or law with its constants");
  if (has_elastic) {
    if (!values.given_key("young")) return missing(values, "young", " beside 'poisson'");
    if (!values.given_key("poisson")) return missing(values, "poisson", " beside 'young'");
    settings.elastic = {values.get<double>("young"), values.get<double>("poisson")};
  }
  if (has_law) {
    Expected<material::MooneyRivlin> law = read_law(values, neo_hookean);
    if (!law) return fail(std::move(law.error()));
    settings.law = *law;
  }

  if (!has_law) {
    settings.law = material::to_mooney_rivlin(settings.elastic, neo_hookean);
    if (model::is_mixed(scene.model.kind))
      scene.notes.push_back(
          fmt::format("c1 = {:.6g} Pa, c2 = {:.6g} Pa, kappa = {:.6g} Pa converted from young and poisson",
                      settings.law.c1, settings.law.c2, settings.law.kappa));
  }
  if (!has_elastic) {
    settings.elastic = material::to_elastic(settings.law);
    if (!model::is_mixed(scene.model.kind))
      scene.notes.push_back(fmt::format("young = {:.6g} Pa, poisson = {:.6g} converted from c1, c2 and kappa",
                                        settings.elastic.young, settings.elastic.poisson));
  }
  if (scene.model.kind == model::ModelKind::mass_spring && settings.elastic.poisson != 0.25)
    scene.warnings.push_back(
        fmt::format("{}: 'mass-spring' has a Poisson's ratio of 1/4, not {:.6g}: springs on the edges have no other",
                    scene.file, settings.elastic.poisson));
  return settings;
}

}  // namespace rhexis::scene
