#include <fmt/format.h>

#include "scene/declaration.h"
#include "scene/reference.h"
#include "scene/units.h"

namespace rhexis::scene {
namespace {

constexpr std::string_view kIntroduction = R"(# Scenes

<!-- Made from the declaration in src/scene; do not edit. `rhexis scene-reference` writes it. -->

A scene is one TOML file: a body, what it is made of, what holds it, what acts on it. `rhexis check SCENE` says whether
it is right and what it would do; `rhexis solve SCENE` finds the equilibrium. Everything is in SI units (m, kg, s, N, Pa), but for
the coordinates of a mesh file (`mesh.unit`) and angles, which are in degrees. Scenes that run as they are lie in `scenes/`.

Every mistake is told in one line, with where it is and what would be right:

    rhexis: vessel.toml:14: unknown key 'material.younf' (did you mean 'young'?)

`--set key=value` changes a value from the command line. Its errors name the `--set` in place of the line.

    rhexis solve vessel.toml --set model.beta=0 --set support.1.x=25% --set sets.top.side=+y

Entries of `[[...]]` are numbered from 0, so are the three numbers of a vector (`gravity.2=-1.6`). Text needs no quotes
there. An empty value takes a key out, an entry or a section too, and what is left out has its default: `--set mesh.generate= --set mesh.file=vessel.msh`,
`--set dynamics=`. One that is not there is out already.

Editors with TOML support complete and check scenes by the JSON Schema beside this page, `scene.schema.json`; with taplo (Even
Better TOML) a first line `#:schema ../docs/scene.schema.json` does it.

## A complete example

)";

constexpr std::string_view kCornerCases = R"(## Corner cases

* **Material.** Small-strain correspondence: c1 + c2 = E / (4 (1 + nu)), kappa = E / (3 (1 - 2 nu)); c1 : c2 is 1 : 1, or c2 = 0
  with `law = "neo-hookean"`. A literature case gives E = 1 MPa, nu = 0.49 beside kappa = 4.167e6 Pa, but the formula gives
  1.667e7 Pa, four times as much: its constants are those of E = 0.981 MPa, nu = 0.461. A conversion follows the formula;
  `scenes/vessel.toml` gives the published constants explicitly.
* **`mass-spring`** has a Poisson's ratio of 1/4 whatever is asked; a warning says so.
* **What is not read.** A key that is right in itself but has no effect on what was chosen, such as `beta` with `linear`,
  is a warning, not an error: one scene may be run with several models by `--set model.kind=...`. So are `[fracture]`,
  `[[crack]]`, `[interaction]` and `[[pull]]` before `rhexis solve`; `rhexis tear` reads them.
* **`beta`.** The stabilisation smooths lambda over a length that grows with beta and the tets; when that is more than a
  quarter of the body's thickness, a warning says so (docs/stabilisation.md).
* **Bounding box.** The box of sides, fractions and percentages is that of the nodes that belong to a tet. Nodes that belong
  to none stay in the numbering and are held.
* **`side`** takes what lies within a millionth of the box's longest edge of it. Where the body is round there, the set has nodes but no
  faces, and a load on it is an error.
* **`nearest`** takes the lowest number among equally near nodes.
* **Names.** A set of the scene stands in for a set of the mesh of the same name; a note says so.
* **Supports.** A component of a node may be fixed twice when both say the same value (to 1e-12 of the box). Models of second order
  (`taylor-hood`) also hold the middle of an edge whose two ends are in the set.
* **Rigid motions.** The supports must stop all six. What is left is named: "translation along y", "rotation about an axis along z
  through (0.02, 0, 0) m". A motion counts as stopped when some held component resists it by more than a millionth of what
  it moves the body.
* **Pressure** on a surface with a rim that is not held makes the system unsymmetric: `linear = "direct"` solves it, with `cg`
  and `minres` it is an error.
* **A mesh** with an inverted, flat, doubled or unconnected tet is refused; the error names the first, `rhexis mesh info` lists all.
* **Limits.** A scene has at most 4 MiB, a generated mesh at most 4,000,000 nodes.
)";

/// As a cell of a table: names as code.
std::string value_cell(const Key& key) {
  if (key.kind != Kind::choice) return wanted(key);
  std::string cell;
  for (const std::string& name : key.names) cell += (cell.empty() ? "`\"" : ", `\"") + name + "\"`";
  return cell;
}

std::string default_cell(const Section& section, const Key& key) {
  if (!key.fallback.empty()) return '`' + key.fallback + '`';
  if (!key.otherwise.empty()) return key.otherwise;
  if (key.required) return "**required**";
  for (const std::string& name : section.exactly_one)
    if (name == key.name) return "**one of** " + fmt::format("`{}`", fmt::join(section.exactly_one, "`, `"));
  return "";
}

std::string text_of(const Section& section) {
  const bool root = section.form == SectionForm::root;
  std::string text = fmt::format("## {}\n\n{}", root ? "Top level" : '`' + header_of(section) + '`', section.doc);
  if (section.required) text += " Required.";
  if (section.form == SectionForm::list || section.form == SectionForm::named) text += " Any number of them.";
  text += "\n\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
  for (const Key& key : section.keys)
    text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, value_cell(key), default_cell(section, key), key.doc);
  return text + '\n';
}

std::string units_table() {
  std::string text = "## Units of mesh files\n\n| `mesh.unit` | metres |\n| --- | --- |\n";
  for (const LengthUnit& unit : kLengthUnits) text += fmt::format("| `\"{}\"` | {} |\n", unit.name, unit.metres);
  return text + '\n';
}

}  // namespace

std::string scene_reference_markdown() {
  std::string text = std::string(kIntroduction) + "```toml\n" + scene_reference_example() + "```\n\n";
  for (const Section& section : scene_sections()) text += text_of(section);
  return text + units_table() + std::string(kCornerCases);
}

}  // namespace rhexis::scene
