#include <string_view>

#include "mesh/body_request.h"
#include "model/make_model.h"
#include "record/store/parameters.h"
#include "scene/declaration.h"
#include "scene/units.h"

namespace rhexis::scene {
namespace {

const std::vector<std::string> kSides{"-x", "+x", "-y", "+y", "-z", "+z"};

// Far beyond any body, and near enough that no product of a few of them leaves a computer's numbers.
constexpr Range kLength = within(1e-9, 1e6);      // m
constexpr Range kOffset = within(-1e6, 1e6);      // m; also m/s2, and a direction
constexpr Range kModulus = within(1e-3, 1e15);    // Pa
constexpr Range kConstant = within(-1e15, 1e15);  // Pa; c1 + c2 is a modulus
constexpr Range kLoad = within(-1e12, 1e12);      // N, Pa

template <class Names>
std::vector<std::string> strings(const Names& names) {
  return {std::begin(names), std::end(names)};
}

Section root() {
  return {.name = "",
          .form = SectionForm::root,
          .doc = "Keys before the first section.",
          .keys = {
              {.name = "title", .kind = Kind::text, .fallback = "\"\"", .doc = "A name for reports and pages."},
              {.name = "gravity",
               .kind = Kind::vector,
               .unit = "m/s2",
               .range = kOffset,
               .fallback = "[0.0, 0.0, 0.0]",
               .doc = "Acceleration; with `material.density` it is the body force."},
          }};
}

Section mesh() {
  return {
      .name = "mesh",
      .required = true,
      .exactly_one = {"file", "generate"},
      .doc =
          "The body: read from a file, or generated. `size` goes with `plate`, `bar` and `cube`; a `tube` takes "
          "`radius` and `length`, or a `size` of `[2 radius, 2 radius, length]`.",
      .keys = {
          {.name = "file",
           .kind = Kind::file,
           .doc =
               "`.msh` (2.2, 4.1), `.vtu`, `.vtk`, `.vtkhdf`, each also with `.gz` behind it; relative to the scene."},
          {.name = "unit",
           .kind = Kind::choice,
           .fallback = "\"m\"",
           .names = unit_names(),
           .doc = "Unit of the coordinates in the file. All else in the scene is SI."},
          {.name = "generate",
           .kind = Kind::choice,
           .names = {"plate", "bar", "tube", "cube"},
           .doc =
               "A body that needs no file. Sets made: the sides `-x` to `+z`; of a tube `bottom`, `top`, `outer`, and "
               "`inner` with a wall."},
          {.name = "size",
           .kind = Kind::vector,
           .unit = "m",
           .range = kLength,
           .otherwise = "needed by `plate`, `bar`, `cube`",
           .doc = "Of a generated body, which fills the box from the origin to `size`."},
          {.name = "nodes",
           .kind = Kind::integer,
           .range = within(4, mesh::kMaxGeneratedNodes),
           .otherwise = "needed to generate",
           .doc = "About how many nodes a generated body gets (within 2%)."},
          {.name = "radius",
           .kind = Kind::number,
           .unit = "m",
           .range = kLength,
           .otherwise = "needed by `tube` without `size`",
           .doc = "Outer radius of a tube."},
          {.name = "length",
           .kind = Kind::number,
           .unit = "m",
           .range = kLength,
           .otherwise = "needed by `tube` without `size`",
           .doc = "Of a tube, along its centre line."},
          {.name = "wall",
           .kind = Kind::number,
           .unit = "m",
           .range = within(0.0, kLength.max),
           .fallback = "0.0",
           .doc = "Thickness of a tube's wall; 0: a solid rod."},
          {.name = "bend",
           .kind = Kind::number,
           .unit = "degrees",
           .range = strictly_within(-360.0, 360.0),
           .fallback = "0.0",
           .doc = "By how much a tube's centre line turns in the x-z plane along its length."},
      }};
}

Section sets() {
  return {
      .name = "sets",
      .form = SectionForm::named,
      .exactly_one = {"side", "box", "nearest", "nodes"},
      .doc =
          "Node sets by name, besides those of the mesh: physical points, lines, surfaces and volumes of a file are "
          "sets by their names. A surface of the file and a `side` are face sets too.",
      .keys = {
          {.name = "side",
           .kind = Kind::choice,
           .names = kSides,
           .doc = "Nodes and faces within a millionth of that side of the bounding box (of its longest edge)."},
          {.name = "box",
           .kind = Kind::box,
           .range = within(0.0, 1.0),
           .doc = "Nodes in a box, `{ from = [0.0, 0.0, 0.45], to = [0.5, 1.0, 0.55] }`, in fractions of the bounding "
                  "box, its borders included."},
          {.name = "nearest",
           .kind = Kind::vector,
           .unit = "m",
           .range = kOffset,
           .doc = "The one node nearest to a point."},
          {.name = "nodes", .kind = Kind::indices, .range = at_least(0), .doc = "0-based, in the order of the file."},
      }};
}

Section material() {
  const auto stiffness = [](std::string name, Range range, std::string doc) {
    const bool elastic = name == "young";
    return Key{.name = std::move(name),
               .kind = Kind::number,
               .unit = "Pa",
               .range = range,
               .otherwise = elastic ? "from the law" : "from `young` and `poisson`",
               .doc = std::move(doc)};
  };
  return {
      .name = "material",
      .required = true,
      .doc =
          "Give `young` and `poisson`, or a `law` with its constants, or both. `mass-spring`, `linear`, `corotated` "
          "and "
          "`geometrically-nonlinear` read `young` and `poisson`; `hyperelastic` and `taylor-hood` read the law. "
          "Where only the other is given it is converted, and the summary says so.",
      .keys = {
          {.name = "density",
           .kind = Kind::number,
           .unit = "kg/m3",
           .range = within(0.0, 1e6),
           .otherwise = "0; needed with gravity",
           .doc = "Mass per volume of the undeformed body."},
          stiffness("young", kModulus, "Young's modulus E."),
          {.name = "poisson",
           .kind = Kind::number,
           .range = strictly_within(-1.0, 0.5),
           .otherwise = "from the law",
           .doc = "Poisson's ratio nu."},
          {.name = "law",
           .kind = Kind::choice,
           .otherwise = "mooney-rivlin",
           .names = {"mooney-rivlin", "neo-hookean"},
           .doc = "W = c1 (I1bar - 3) + c2 (I2bar - 3); `neo-hookean` is c2 = 0. A law without constants says how "
                  "`young` and `poisson` are converted."},
          stiffness("c1", kConstant, "First constant of the law; c1 + c2 is at least 0.001 Pa."),
          stiffness("c2", kConstant, "Second constant of the law, `mooney-rivlin` only."),
          stiffness("kappa", kModulus, "Bulk modulus of the law."),
      }};
}

Section model() {
  return {.name = "model",
          .doc = "How the body deforms.",
          .keys = {
              {.name = "kind",
               .kind = Kind::choice,
               .fallback = "\"hyperelastic\"",
               .names = strings(model::kModelNames),
               .doc = "The model, see docs/models.md."},
              {.name = "beta",
               .kind = Kind::number_or_auto,
               .range = within(0.0, 1e9),
               .fallback = "\"auto\"",
               .doc = "Factor of the pressure stabilisation; 0 switches it off, `\"auto\"` chooses it from the "
                      "material. Read by `hyperelastic`."},
              {.name = "initial_lambda",
               .kind = Kind::number,
               .unit = "Pa",
               .range = kLoad,
               .fallback = "0.0",
               .doc = "Mean stress to start from. Read by `hyperelastic` and `taylor-hood`."},
              {.name = "corotated_tangent",
               .kind = Kind::choice,
               .fallback = "\"exact\"",
               .names = {"exact", "warped"},
               .doc = "`warped` is R K_e R^T, which as a static iteration may diverge. Read by `corotated`."},
          }};
}

Section support() {
  const auto component = [](const std::string& name) {
    return Key{.name = name,
               .kind = Kind::length,
               .unit = "m",
               .range = kOffset,
               .otherwise = "free",
               .doc = "Displacement along " + name + ": metres, or a percentage of the body's box in that direction."};
  };
  return {
      .name = "support",
      .form = SectionForm::list,
      .doc =
          "Prescribed displacements of a set, reached in steps together with the loads. A component that is left out "
          "is free. All supports together must leave the body no rigid motion.",
      .keys = {
          {.name = "set", .kind = Kind::set, .required = true, .doc = "A set of nodes or faces."},
          component("x"),
          component("y"),
          component("z"),
      }};
}

const Key kFaceSet{.name = "set", .kind = Kind::set, .doc = "A set of faces: a surface of the mesh, or a `side`."};
const Key kFaceSide{.name = "side",
                    .kind = Kind::choice,
                    .names = kSides,
                    .doc = "The faces on that side of the bounding box, without a set."};

Section traction() {
  return {
      .name = "traction",
      .form = SectionForm::list,
      .exactly_one = {"set", "side"},
      .doc = "A dead load on a surface, spread evenly over its undeformed area.",
      .keys = {
          kFaceSet,
          kFaceSide,
          {.name = "force", .kind = Kind::vector, .unit = "N", .range = kLoad, .required = true, .doc = "In all."}}};
}

Section pressure() {
  return {.name = "pressure",
          .form = SectionForm::list,
          .exactly_one = {"set", "side"},
          .doc = "A load that follows the surface as it turns and stretches.",
          .keys = {kFaceSet,
                   kFaceSide,
                   {.name = "value",
                    .kind = Kind::number,
                    .unit = "Pa",
                    .range = kLoad,
                    .required = true,
                    .doc = "More than 0 pushes against the outward normal."}}};
}

Section solver() {
  return {.name = "solver",
          .doc = "How the equilibrium is found, see docs/solvers.md.",
          .keys = {
              {.name = "linear",
               .kind = Kind::choice,
               .fallback = "\"direct\"",
               .names = {"direct", "cg", "minres"},
               .doc = "The linear solver of a Newton step."},
              {.name = "tolerance",
               .kind = Kind::number,
               .range = strictly_within(0.0, 1.0),
               .fallback = "1e-8",
               .doc = "On the relative residuals of displacement and mean stress."},
              {.name = "steps",
               .kind = Kind::integer,
               .range = within(1, 100000),
               .fallback = "10",
               .doc = "Load steps; one that does not converge is cut."},
              {.name = "max_iterations",
               .kind = Kind::integer,
               .range = within(1, 100000),
               .fallback = "30",
               .doc = "Newton iterations a step."},
              {.name = "max_cuts",
               .kind = Kind::integer,
               .range = within(0, 50),
               .fallback = "12",
               .doc = "Halvings of a step before giving up."},
              {.name = "threads",
               .kind = Kind::integer,
               .range = within(0, 1024),
               .fallback = "0",
               .doc = "Worker threads; 0: all cores. The result does not depend on it."},
          }};
}

Section dynamics() {
  return {.name = "dynamics",
          .doc =
              "Gives a body of large strain that is held and torn its mass, `material.density`: let go, or torn, it "
              "swings, see docs/soft-tearing.md. Without this section it is always where it is in equilibrium. Not "
              "read by `rhexis solve`.",
          .keys = {
              {.name = "step",
               .kind = Kind::number,
               .unit = "s",
               .range = within(1e-3, 1.0),
               .fallback = "0.016",
               .doc = "The time step, one a frame of the physics. Long ones take more out of fast motion."},
              {.name = "mass_damping",
               .kind = Kind::number,
               .unit = "1/s",
               .range = within(0.0, 1e6),
               .fallback = "0.0",
               .doc = "Rayleigh's factor of the mass: a resistance to all motion."},
              {.name = "stiffness_damping",
               .kind = Kind::number,
               .unit = "s",
               .range = within(0.0, 1e3),
               .fallback = "0.0",
               .doc = "Rayleigh's factor of the stiffness: a resistance to deforming."},
          }};
}

Section fracture() {
  return {.name = "fracture",
          .exactly_one = {"strength", "toughness"},
          .doc = "When and how the body tears.",
          .keys = {
              {.name = "criterion",
               .kind = Kind::choice,
               .otherwise = "maximum-principal for a generated plate, else maximum-hoop",
               .names = {"maximum-principal", "maximum-shear", "von-mises", "maximum-hoop"},
               .doc = "What is compared with the strength."},
              {.name = "strength",
               .kind = Kind::number,
               .unit = "Pa",
               .range = kModulus,
               .doc = "Stress at which the body tears, Cauchy's with a model of large strain. It depends on the mesh: "
                      "stress at "
                      "a tip grows as h^(-1/2)."},
              {.name = "toughness",
               .kind = Kind::number,
               .unit = "N/m",
               .range = within(1e-9, 1e12),
               .doc = "Energy release per area at which the body tears, in place of `strength`."},
              {.name = "advance_threshold",
               .kind = Kind::number,
               .unit = "Pa",
               .range = kModulus,
               .otherwise = "half of `strength`",
               .doc = "The crack runs to the farthest tet above this, which is at most `strength`. Not read with "
                      "`toughness`."},
              {.name = "ahead_only",
               .kind = Kind::boolean,
               .fallback = "true",
               .doc = "Tets more than 90 degrees off the crack's direction do not count."},
              {.name = "local_radius",
               .kind = Kind::number,
               .unit = "m",
               .range = kLength,
               .otherwise = "four mean edge lengths",
               .doc = "Radius of the local object, the first and the least. With a `toughness` four mean edge lengths "
                      "or more."},
              {.name = "incision",
               .kind = Kind::choice,
               .fallback = "\"keep-nodes\"",
               .names = {"keep-nodes", "split"},
               .doc = "How the mesh is opened."},
          }};
}

Section crack() {
  return {.name = "crack",
          .form = SectionForm::list,
          .doc = "A crack to start with, from the surface to its front, through the body.",
          .keys = {
              {.name = "from",
               .kind = Kind::vector,
               .unit = "m",
               .range = kOffset,
               .required = true,
               .doc = "Where it starts on the surface."},
              {.name = "to",
               .kind = Kind::vector,
               .unit = "m",
               .range = kOffset,
               .required = true,
               .doc = "Where its front is."},
              {.name = "through",
               .kind = Kind::vector,
               .range = kOffset,
               .fallback = "[0.0, 0.0, 1.0]",
               .doc = "Direction along the front; not along the crack."},
          }};
}

Section interaction() {
  return {
      .name = "interaction",
      .doc = "What the hand feels.",
      .keys = {
          {.name = "response",
           .kind = Kind::choice,
           .fallback = "\"exact\"",
           .names = {"exact", "recorded"},
           .doc = "Forces of the torn body itself, or interpolated from a record."},
          {.name = "record",
           .kind = Kind::file,
           .otherwise = "needed by `recorded`",
           .doc = "Written by `rhexis precompute`; relative to the scene. With `exact`, what `rhexis play` can show "
                  "beside."},
          {.name = "max_force",
           .kind = Kind::number,
           .unit = "N",
           .range = within(1e-6, 1e6),
           .fallback = "8.9",
           .doc = "What the device can give."},
          {.name = "contact",
           .kind = Kind::choice,
           .fallback = "\"consistent\"",
           .names = {"consistent", "blend"},
           .doc = "Force of a point inside a surface triangle: one constraint on it, or the reactions of its vertices "
                  "blended with the area coordinates, of model `linear`."},
      }};
}

Section pull() {
  return {.name = "pull",
          .form = SectionForm::list,
          .doc = "A scripted hand, for `rhexis tear` and the demonstration in `rhexis play`. Pulls follow each other.",
          .keys = {
              {.name = "at",
               .kind = Kind::vector,
               .unit = "m",
               .range = kOffset,
               .required = true,
               .doc = "The nearest point of the surface is held."},
              {.name = "by",
               .kind = Kind::vector,
               .unit = "m",
               .range = kOffset,
               .required = true,
               .doc = "How far it is moved."},
              {.name = "seconds",
               .kind = Kind::number,
               .unit = "s",
               .range = within(1e-3, 3600.0),
               .fallback = "1.0",
               .doc = "How long the pull takes."},
              {.name = "hold",
               .kind = Kind::number,
               .unit = "s",
               .range = within(0.0, 3600.0),
               .fallback = "0.0",
               .doc = "Wait before the hand lets go."},
              {.name = "wait",
               .kind = Kind::number,
               .unit = "s",
               .range = within(0.0, 3600.0),
               .fallback = "0.0",
               .doc = "Wait after the hand has let go, before the next pull or the end."},
              {.name = "mode",
               .kind = Kind::choice,
               .fallback = "\"hold\"",
               .names = {"hold", "push"},
               .doc = "Held, the point follows the hand; pushed, it gives way only where the hand presses, without "
                      "friction."},
          }};
}

Section record() {
  return {.name = "record",
          .doc =
              "What `rhexis precompute` varies; the defaults are those of the thesis (its Table 5.5). Angles are those "
              "of the crack: 90 degrees is the way that `[[crack]]` points, see docs/record-format.md.",
          .keys = {
              {.name = "advances",
               .kind = Kind::integer,
               .range = within(1, record::store::kMostAdvances),
               .fallback = "2",
               .doc = "How often the crack runs on; each multiplies the topologies by directions times lengths."},
              {.name = "directions",
               .kind = Kind::integer,
               .range = within(1, 1441),
               .fallback = "13",
               .doc = "Of an advance, evenly over 0 to 180 degrees; one alone runs straight on."},
              {.name = "lengths",
               .kind = Kind::numbers,
               .unit = "m",
               .range = kLength,
               .fallback = "[0.0403]",
               .doc = "Of an advance, ascending."},
              {.name = "pull_directions",
               .kind = Kind::integer,
               .range = within(1, 3600),
               .fallback = "36",
               .doc = "In the plane across the front, evenly around. The model is linear: they take no room."},
              {.name = "pull_length",
               .kind = Kind::number,
               .unit = "m",
               .range = kLength,
               .fallback = "0.12",
               .doc = "Of a recorded pull, to which others are scaled."},
              {.name = "precision",
               .kind = Kind::choice,
               .fallback = "\"double\"",
               .names = {"double", "single"},
               .doc = "Of the global operators. Forces are kept in double in any case."},
          }};
}

}  // namespace

std::span<const Section> scene_sections() {
  static const std::vector<Section> sections{root(),     mesh(),     sets(),     material(),    model(),
                                             support(),  traction(), pressure(), solver(),      dynamics(),
                                             fracture(), crack(),    record(),   interaction(), pull()};
  return sections;
}

}  // namespace rhexis::scene
