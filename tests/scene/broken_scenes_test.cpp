// Every mistake that needs no mesh, with the very line that it prints.

#include "tests/scene/scene_text.h"

namespace rhexis::scene::test {
namespace {

struct Broken {
  std::string name;
  std::string old;   // piece of kGood
  std::string with;  // what stands there instead
  std::string line;  // what is printed
};

class BrokenScene : public testing::TestWithParam<Broken> {};

TEST_P(BrokenScene, PrintsItsLine) {
  const Broken& broken = GetParam();
  EXPECT_EQ(message_of(spoil(broken.old, broken.with)), broken.line);
}

const std::vector<Broken> kNames{
    {"unknown_key", "young = 1.0e6", "younf = 1.0e6",
     "s.toml:16: unknown key 'material.younf' (did you mean 'young'?)"},
    {"unknown_key_far_off", "steps = 4", "zzzzzzzzzz = 4",
     "s.toml:33: unknown key 'solver.zzzzzzzzzz' (known: linear, tolerance, steps, max_iterations, max_cuts, threads)"},
    {"unknown_root_key", "title =", "titel =", "s.toml:1: unknown key 'titel' (did you mean 'title'?)"},
    {"unknown_section", "[solver]", "[solvers]", "s.toml:32: unknown section 'solvers' (did you mean 'solver'?)"},
    {"unknown_key_in_set", "side = \"-x\"", "sides = \"-x\"",
     "s.toml:10: unknown key 'sets.wall.sides' (did you mean 'side'?)"},
    {"unknown_key_in_list", "z = \"-10%\"", "w = \"-10%\"",
     "s.toml:30: unknown key 'support.1.w' (known: set, x, y, z)"},
    {"unknown_key_in_box", "side = \"-x\"", "box = { form = [0, 0, 0], to = [1, 1, 1] }",
     "s.toml:10: unknown key 'sets.wall.box.form' (did you mean 'from'?)"},
    {"unknown_model", "\"hyperelastic\"", "\"hyperelastik\"",
     "s.toml:20: 'model.kind' is 'hyperelastik', an unknown name (did you mean 'hyperelastic'?)"},
    {"unknown_side", "\"-x\"", "\"left\"",
     "s.toml:10: 'sets.wall.side' is 'left', an unknown name (known: -x, +x, -y, +y, -z, +z)"},
    {"unknown_linear_solver", "steps = 4", "linear = \"gmres\"",
     "s.toml:33: 'solver.linear' is 'gmres', an unknown name (known: direct, cg, minres)"},
    {"unknown_shape", "\"bar\"", "\"bra\"",
     "s.toml:5: 'mesh.generate' is 'bra', an unknown name (did you mean 'bar'?)"},
    {"unknown_law", "young = 1.0e6", "law = \"money-rivlin\"",
     "s.toml:16: 'material.law' is 'money-rivlin', an unknown name (did you mean 'mooney-rivlin'?)"},
};

const std::vector<Broken> kForms{
    {"number_as_text", "young = 1.0e6", "young = \"soft\"",
     "s.toml:16: 'material.young' is text (give a number in Pa, 0.001 to 1e15)"},
    {"number_as_boolean", "density = 1000.0", "density = true",
     "s.toml:15: 'material.density' is a boolean (give a number in kg/m3, 0 to 1000000)"},
    {"integer_as_number", "steps = 4", "steps = 4.0",
     "s.toml:33: 'solver.steps' is a number (give an integer, 1 to 100000)"},
    {"text_as_number", "\"Bar\"", "7", "s.toml:1: 'title' is an integer (give text in quotes)"},
    {"choice_as_number", "\"hyperelastic\"", "3",
     "s.toml:20: 'model.kind' is an integer (give one of \"mass-spring\", \"linear\", \"corotated\", "
     "\"geometrically-nonlinear\", \"hyperelastic\", \"taylor-hood\")"},
    {"vector_as_number", "[0.0, 0.0, -9.81]", "-9.81",
     "s.toml:2: 'gravity' is a number (give three numbers in m/s2, each -1000000 to 1000000)"},
    {"vector_of_two", "[0.0, 0.0, -9.81]", "[0.0, -9.81]",
     "s.toml:2: 'gravity' is a list of 2 (give three numbers in m/s2, each -1000000 to 1000000)"},
    {"vector_with_text", "[0.0, 0.0, -9.81]", "[0.0, \"x\", -9.81]",
     "s.toml:2: 'gravity.1' is text (give three numbers in m/s2, each -1000000 to 1000000)"},
    {"vector_over_lines", "[0.0, 0.0, -9.81]", "[\n  0.0,\n  false,\n  -9.81]",
     "s.toml:4: 'gravity.1' is a boolean (give three numbers in m/s2, each -1000000 to 1000000)"},
    {"beta_as_text", "beta = 100.0", "beta = \"automatic\"",
     "s.toml:21: 'model.beta' is 'automatic' (give \"auto\" or a number, 0 to 1e9)"},
    {"length_as_text", "\"-10%\"", "\"-10\"",
     "s.toml:30: 'support.1.z' is '-10' (give a number in m, or a percentage of the body's box as \"50%\", -1000000 to "
     "1000000)"},
    {"length_not_a_percentage", "\"-10%\"", "\"1e400%\"",
     "s.toml:30: 'support.1.z' is '1e400%' (give a number in m, or a percentage of the body's box as \"50%\", -1000000 "
     "to 1000000)"},
    {"date", "density = 1000.0", "density = 2020-01-01",
     "s.toml:15: 'material.density' is a date or time (give a number in kg/m3, 0 to 1000000)"},
    {"section_as_value", "[solver]\nsteps = 4", "solver.steps = [1]",
     "s.toml:32: unknown key 'support.1.solver' (known: set, x, y, z)"},
    {"section_is_a_number", "title = \"Bar\"", "fracture = 3", "s.toml:1: 'fracture' is an integer (write [fracture])"},
    {"list_as_section", "", "[pull]\nat = [0, 0, 0]\n", "s.toml:34: 'pull' is a table (write [[pull]])"},
    {"list_of_numbers", "title = \"Bar\"", "pull = [1, 2]", "s.toml:1: 'pull' is a list (write [[pull]])"},
    {"section_as_list", "[solver]", "[[solver]]", "s.toml:32: 'solver' is a list (write [solver])"},
    {"set_without_name", "[sets.wall]", "[sets]",
     "s.toml:10: 'sets.side' is text (write [sets.NAME] and its keys below)"},
    {"nodes_not_integers", "side = \"-x\"", "nodes = [1, 2.5]",
     "s.toml:10: 'sets.wall.nodes.1' is a number (give a list of integers, each at least 0)"},
    {"control_character", "\"Bar\"", "\"Bar\\u0000\"",
     "s.toml:1: 'title' holds a control character (printable text in one line)"},
    {"empty_file_name", "generate = \"bar\"", "file = \"\"",
     "s.toml:5: 'mesh.file' is empty (give a file name in quotes)"},
};

const std::vector<Broken> kRanges{
    {"poisson_half", "poisson = 0.45", "poisson = 0.5",
     "s.toml:17: 'material.poisson' is 0.5 (give a number, more than -1 and less than 0.5)"},
    {"poisson_minus_one", "poisson = 0.45", "poisson = -1",
     "s.toml:17: 'material.poisson' is -1 (give a number, more than -1 and less than 0.5)"},
    {"density_negative", "density = 1000.0", "density = -1.0",
     "s.toml:15: 'material.density' is -1 (give a number in kg/m3, 0 to 1000000)"},
    {"young_zero", "young = 1.0e6", "young = 0.0",
     "s.toml:16: 'material.young' is 0 (give a number in Pa, 0.001 to 1e15)"},
    {"young_nan", "young = 1.0e6", "young = nan",
     "s.toml:16: 'material.young' is nan (give a number in Pa, 0.001 to 1e15)"},
    {"gravity_infinite", "-9.81]", "-inf]",
     "s.toml:2: 'gravity.2' is -inf (give three numbers in m/s2, each -1000000 to 1000000)"},
    {"beta_negative", "beta = 100.0", "beta = -1",
     "s.toml:21: 'model.beta' is -1 (give \"auto\" or a number, 0 to 1e9)"},
    {"no_steps", "steps = 4", "steps = 0", "s.toml:33: 'solver.steps' is 0 (give an integer, 1 to 100000)"},
    {"tolerance_one", "steps = 4", "tolerance = 1",
     "s.toml:33: 'solver.tolerance' is 1 (give a number, more than 0 and less than 1)"},
    {"too_many_nodes", "nodes = 200", "nodes = 9223372036854775807",
     "s.toml:7: 'mesh.nodes' is 9223372036854775807 (give an integer, 4 to 4000000)"},
    {"integer_overflow", "nodes = 200", "nodes = 9223372036854775808",
     "s.toml:7: '9223372036854775808' is a number too large (integers go up to 9223372036854775807, numbers with a "
     "point or an exponent to 1.7e308)"},
    {"number_overflow", "young = 1.0e6", "young = 1e400",
     "s.toml:16: '1e400' is a number too large (integers go up to 9223372036854775807, numbers with a point or an "
     "exponent to 1.7e308)"},
    {"number_overflow_in_list", "-9.81]", "-1.5e999]",
     "s.toml:2: '1.5e999' is a number too large (integers go up to 9223372036854775807, numbers with a point or an "
     "exponent to 1.7e308)"},
    {"size_negative", "[0.04, 0.01, 0.01]", "[0.04, -0.01, 0.01]",
     "s.toml:6: 'mesh.size.1' is -0.01 (give three numbers in m, each 1e-09 to 1000000)"},
    {"box_in_percent", "side = \"-x\"", "box = { from = [0, 0, 45], to = [1, 1, 55] }",
     "s.toml:10: 'sets.wall.box.from.2' is 45 (give { from = [x, y, z], to = [x, y, z] } in fractions of the bounding "
     "box, each 0 to 1)"},
    {"box_turned_around", "side = \"-x\"", "box = { from = [0, 0, 0.6], to = [1, 1, 0.5] }",
     "s.toml:10: 'sets.wall.box' ends before it begins ('from' at most 'to' in x, y and z)"},
    // Beyond any body: products of such numbers would leave a computer's.
    {"young_huge", "young = 1.0e6", "young = 1e300",
     "s.toml:16: 'material.young' is 1e+300 (give a number in Pa, 0.001 to 1e15)"},
    {"young_tiny", "young = 1.0e6", "young = 1e-300",
     "s.toml:16: 'material.young' is 1e-300 (give a number in Pa, 0.001 to 1e15)"},
    {"c1_huge", "poisson = 0.45", "c1 = 1e300",
     "s.toml:17: 'material.c1' is 1e+300 (give a number in Pa, -1e15 to 1e15)"},
    {"c2_huge", "poisson = 0.45", "c2 = -1e300",
     "s.toml:17: 'material.c2' is -1e+300 (give a number in Pa, -1e15 to 1e15)"},
    {"kappa_tiny", "poisson = 0.45", "kappa = 1e-300",
     "s.toml:17: 'material.kappa' is 1e-300 (give a number in Pa, 0.001 to 1e15)"},
    {"density_huge", "density = 1000.0", "density = 1e308",
     "s.toml:15: 'material.density' is 1e+308 (give a number in kg/m3, 0 to 1000000)"},
    {"gravity_huge", "-9.81]", "-1e300]",
     "s.toml:2: 'gravity.2' is -1e+300 (give three numbers in m/s2, each -1000000 to 1000000)"},
    {"beta_huge", "beta = 100.0", "beta = 1e300",
     "s.toml:21: 'model.beta' is 1e+300 (give \"auto\" or a number, 0 to 1e9)"},
    {"initial_lambda_huge", "beta = 100.0", "initial_lambda = 1e300",
     "s.toml:21: 'model.initial_lambda' is 1e+300 (give a number in Pa, -1e12 to 1e12)"},
    {"size_tiny", "[0.04, 0.01, 0.01]", "[1e-300, 0.01, 0.01]",
     "s.toml:6: 'mesh.size.0' is 1e-300 (give three numbers in m, each 1e-09 to 1000000)"},
    {"radius_huge", "nodes = 200", "radius = 1e7",
     "s.toml:7: 'mesh.radius' is 10000000 (give a number in m, 1e-09 to 1000000)"},
    {"wall_huge", "nodes = 200", "wall = 1e300", "s.toml:7: 'mesh.wall' is 1e+300 (give a number in m, 0 to 1000000)"},
    {"displacement_huge", "\"-10%\"", "-1e300",
     "s.toml:30: 'support.1.z' is -1e+300 (give a number in m, or a percentage of the body's box as \"50%\", -1000000 "
     "to 1000000)"},
    {"percentage_huge", "\"-10%\"", "\"1000001%\"",
     "s.toml:30: 'support.1.z' is '1000001%' (give a number in m, or a percentage of the body's box as \"50%\", "
     "-1000000 to 1000000)"},
    {"force_huge", "", "[[traction]]\nside = \"+x\"\nforce = [0, 1e300, 0]\n",
     "s.toml:36: 'traction.0.force.1' is 1e+300 (give three numbers in N, each -1e12 to 1e12)"},
    {"pressure_huge", "", "[[pressure]]\nside = \"+x\"\nvalue = -1e300\n",
     "s.toml:36: 'pressure.0.value' is -1e+300 (give a number in Pa, -1e12 to 1e12)"},
    {"toughness_tiny", "", "[fracture]\ntoughness = 1e-300\n",
     "s.toml:35: 'fracture.toughness' is 1e-300 (give a number in N/m, 1e-09 to 1e12)"},
    {"negative_node", "side = \"-x\"", "nodes = [4, -1]",
     "s.toml:10: 'sets.wall.nodes.1' is -1 (give a list of integers, each at least 0)"},
};

const std::vector<Broken> kTogether{
    {"no_mesh", "[mesh]\ngenerate = \"bar\"\nsize = [0.04, 0.01, 0.01]\nnodes = 200\n", "",
     "s.toml: [mesh] is missing (a section with file, unit, generate, size, nodes, radius, length, wall, bend)"},
    {"file_and_generate", "generate = \"bar\"", "generate = \"bar\"\nfile = \"a.msh\"",
     "s.toml:6: 'mesh.file' and 'mesh.generate' are both given (give one of them)"},
    {"no_file_no_generate", "generate = \"bar\"", "",
     "s.toml:4: 'mesh' says nothing of 'file' or 'generate' (give one of them)"},
    {"no_size", "size = [0.04, 0.01, 0.01]", "",
     "s.toml:4: 'mesh.size' is missing, which generate = \"bar\" needs (give three numbers in m, each 1e-09 to "
     "1000000)"},
    {"no_nodes", "nodes = 200", "",
     "s.toml:4: 'mesh.nodes' is missing, which generate = \"bar\" needs (give an integer, 4 to 4000000)"},
    {"cube_not_cubic", "\"bar\"", "\"cube\"",
     "s.toml:6: the edges of the cube differ (three times the same length, or generate = \"bar\")"},
    {"plate_on_edge", "\"bar\"\nsize = [0.04, 0.01, 0.01]", "\"plate\"\nsize = [0.01, 0.24, 0.24]",
     "s.toml:6: the plate is thicker than wide (its thickness is the third number, along z)"},
    {"tube_of_no_length", "\"bar\"\nsize = [0.04, 0.01, 0.01]", "\"tube\"\nradius = 0.005",
     "s.toml:4: 'mesh.length' is missing, which generate = \"tube\" needs (give a number in m, 1e-09 to 1000000)"},
    {"tube_not_round", "\"bar\"", "\"tube\"", "s.toml:6: the tube is not round (size = [2 radius, 2 radius, length])"},
    {"tube_said_twice", "\"bar\"\nsize = [0.04, 0.01, 0.01]", "\"tube\"\nsize = [0.01, 0.01, 0.04]\nradius = 0.005",
     "s.toml:7: 'mesh.size' and 'mesh.radius' are both given (a tube takes radius and length, or size = [2 radius, 2 "
     "radius, length])"},
    {"wall_too_thick", "\"bar\"\nsize = [0.04, 0.01, 0.01]", "\"tube\"\nradius = 0.005\nlength = 0.04\nwall = 0.005",
     "s.toml:8: the wall is 0.005 m thick (less than the radius, 0.005 m; 0 for a solid rod)"},
    {"set_says_nothing", "side = \"-x\"\n", "",
     "s.toml:9: 'sets.wall' says nothing of 'side', 'box', 'nearest' or 'nodes' (give one of them)"},
    {"set_says_two", "side = \"-x\"", "side = \"-x\"\nnodes = [1]",
     "s.toml:11: 'sets.wall.side' and 'sets.wall.nodes' are both given (give one of them)"},
    {"no_material", "[material]\ndensity = 1000.0\nyoung = 1.0e6\npoisson = 0.45\n", "",
     "s.toml: [material] is missing (a section with density, young, poisson, law, c1, c2, kappa)"},
    {"no_density_with_gravity", "density = 1000.0\n", "",
     "s.toml:14: 'material.density' is missing beside 'gravity' (give a number in kg/m3, 0 to 1000000)"},
    {"no_poisson", "poisson = 0.45\n", "",
     "s.toml:14: 'material.poisson' is missing beside 'young' (give a number, more than -1 and less than 0.5)"},
    {"no_stiffness", "young = 1.0e6\npoisson = 0.45\n", "",
     "s.toml:14: the material has no stiffness (give young and poisson, or law with its constants)"},
    {"half_a_law", "young = 1.0e6\npoisson = 0.45\n", "law = \"mooney-rivlin\"\nc1 = 1e4\nkappa = 1e6\n",
     "s.toml:14: 'material.c2' is missing beside 'c1' (give a number in Pa, -1e15 to 1e15)"},
    {"neo_hookean_with_c2", "young = 1.0e6\n",
     "law = \"neo-hookean\"\nc1 = 1e4\nc2 = 1e4\nkappa = 1e6\nyoung = 1.0e6\n",
     "s.toml:18: 'material.c2' is no constant of 'neo-hookean' (leave it out, or law = \"mooney-rivlin\")"},
    {"law_next_to_without_shear", "young = 1.0e6\npoisson = 0.45\n", "c1 = 1e-300\nc2 = 0\nkappa = 1e6\n",
     "s.toml:16: the law has no stiffness: c1 + c2 is 1e-300 (c1 + c2 at least 0.001 Pa)"},
    {"law_without_shear", "young = 1.0e6\npoisson = 0.45\n", "c1 = 1e4\nc2 = -1e4\nkappa = 1e6\n",
     "s.toml:16: the law has no stiffness: c1 + c2 is 0 (c1 + c2 at least 0.001 Pa)"},
    {"support_without_set", "set = \"tip\"\n", "",
     "s.toml:28: 'support.1.set' is missing (give the name of a set in quotes)"},
    {"support_of_nothing", "z = \"-10%\"\n", "", "s.toml:28: 'support.1' fixes nothing (give x, y or z)"},
    {"traction_without_faces", "", "[[traction]]\nforce = [0, 1, 0]\n",
     "s.toml:34: 'traction.0' says nothing of 'set' or 'side' (give one of them)"},
    {"traction_without_force", "", "[[traction]]\nside = \"+x\"\n",
     "s.toml:34: 'traction.0.force' is missing (give three numbers in N, each -1e12 to 1e12)"},
    {"pressure_without_value", "", "[[pressure]]\nside = \"+x\"\n",
     "s.toml:34: 'pressure.0.value' is missing (give a number in Pa, -1e12 to 1e12)"},
    {"fracture_without_strength", "", "[fracture]\nahead_only = true\n",
     "s.toml:34: 'fracture' says nothing of 'strength' or 'toughness' (give one of them)"},
    {"fracture_threshold_above_strength", "", "[fracture]\nstrength = 1e5\nadvance_threshold = 2e5\n",
     "s.toml:36: 'fracture.advance_threshold' is 200000 (at most the strength, 100000 Pa)"},
    {"fracture_criterion", "", "[fracture]\ncriterion = \"tresca\"\nstrength = 1\n",
     "s.toml:35: 'fracture.criterion' is 'tresca', an unknown name (known: maximum-principal, maximum-shear, "
     "von-mises, "
     "maximum-hoop)"},
    {"crack_of_no_length", "", "[[crack]]\nfrom = [0, 0, 0]\nto = [0, 0, 0]\n",
     "s.toml:36: the crack has no length ('to' away from 'from')"},
    {"crack_along_itself", "", "[[crack]]\nfrom = [0, 0, 0]\nto = [0, 0.1, 0]\nthrough = [0, 2, 0]\n",
     "s.toml:37: 'through' does not span a plane with the crack (a direction across 'to' - 'from')"},
    {"recorded_without_record", "", "[interaction]\nresponse = \"recorded\"\n",
     "s.toml:34: 'interaction.record' is missing, which response = \"recorded\" needs (give a file name in quotes)"},
    {"pull_without_end", "", "[[pull]]\nat = [0, 0, 0]\n",
     "s.toml:34: 'pull.0.by' is missing (give three numbers in m, each -1000000 to 1000000)"},
    {"pull_in_no_time", "", "[[pull]]\nat = [0, 0, 0]\nby = [0, 0, 1]\nseconds = 0\n",
     "s.toml:37: 'pull.0.seconds' is 0 (give a number in s, 0.001 to 3600)"},
};

const std::vector<Broken> kSyntax{
    {"no_value", "young = 1.0e6", "young =", "s.toml:16: not valid TOML: key-value pair: expected value, saw '\\n'"},
    {"key_twice", "young = 1.0e6", "young = 1.0e6\nyoung = 2.0e6",
     "s.toml:17: not valid TOML: key-value pair: cannot redefine existing floating-point 'young'"},
    {"section_twice", "[solver]", "[model]",
     "s.toml:32: not valid TOML: table header: cannot redefine existing table 'model'"},
    {"open_text", "\"Bar\"", "\"Bar",
     "s.toml:1: not valid TOML: string: unescaped control characters other than TAB (U+0009) are explicitly "
     "prohibited"},
    {"bad_number", "density = 1000.0", "density = 1,000.0",
     "s.toml:15: not valid TOML: key-value pair: expected a comment or whitespace, saw ','"},
    {"bad_utf8", "\"Bar\"", "\"\xff\"", "s.toml:1: not valid TOML: Encountered invalid utf-8 sequence"},
    {"section_and_list", "[solver]", "[support]",
     "s.toml:32: not valid TOML: table header: cannot redefine existing array 'support' as table"},
};

std::string name_of(const testing::TestParamInfo<Broken>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Names, BrokenScene, testing::ValuesIn(kNames), name_of);
INSTANTIATE_TEST_SUITE_P(Forms, BrokenScene, testing::ValuesIn(kForms), name_of);
INSTANTIATE_TEST_SUITE_P(Ranges, BrokenScene, testing::ValuesIn(kRanges), name_of);
INSTANTIATE_TEST_SUITE_P(Together, BrokenScene, testing::ValuesIn(kTogether), name_of);
INSTANTIATE_TEST_SUITE_P(Syntax, BrokenScene, testing::ValuesIn(kSyntax), name_of);

// Where toml++ 3.3 fails an assertion of its own.
TEST(BrokenScene, WhatTheParserDoesNotExpect) {
  EXPECT_EQ(message_of(spoil("[solver]", "[}]")), "s.toml:32: not valid TOML");
  EXPECT_EQ(message_of(spoil("[solver]", "[[[solver]]]")), "s.toml:32: not valid TOML");
  EXPECT_EQ(message_of("[="), "s.toml:1: not valid TOML");
  EXPECT_EQ(message_of(spoil("young", "\u00e4")),
            "s.toml:16: not valid TOML: root table: expected keys, tables, whitespace or comments, saw '\u00e4'");
  EXPECT_EQ(message_of(spoil("\"Bar\"", "\"\"\"B\u00e4r \\\n  \u00e4\"\"\"")), "good");
  EXPECT_EQ(message_of(kGood, {"[}]=3"}),
            "--set [}]=3: not a key before the '=' (a dotted name, as in --set model.beta=0)");
}

TEST(BrokenScene, FirstMistakeOfTheDocumentIsTold) {
  EXPECT_EQ(message_of(spoil("poisson = 0.45", "poisson = 0.7", spoil("side = \"-x\"", "side = \"-w\""))),
            "s.toml:10: 'sets.wall.side' is '-w', an unknown name (known: -x, +x, -y, +y, -z, +z)");
}

TEST(BrokenScene, LongNamesAreCut) {
  const std::string line = message_of(spoil("young", std::string(5000, 'y')));
  EXPECT_LT(line.size(), 300U);
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST(BrokenScene, LengthsOfARecordAscend) {
  const auto said = [](const std::string& lengths) {
    const std::string message = message_of(spoil("", "[record]\nlengths = " + lengths + "\n"));
    const std::size_t what = message.find("'record.lengths");
    return what == std::string::npos ? message : message.substr(what);
  };
  EXPECT_EQ(said("[0.02, 0.03]"), "good");
  EXPECT_EQ(said("[0.03, 0.02]"), "'record.lengths' do not ascend (each longer than the one before)");
  EXPECT_EQ(said("[0.02, 0.02]"), "'record.lengths' do not ascend (each longer than the one before)");
  EXPECT_EQ(said("[]"), "'record.lengths' is empty (one length at least)");
  EXPECT_EQ(said("[0.0]"), "'record.lengths.0' is 0 (give a list of numbers in m, each 1e-09 to 1000000)");
}

TEST(BrokenScene, HostileNestingIsRefused) {
  std::string dotted = "a";
  for (int i = 0; i < 200000; ++i) dotted += ".a";
  EXPECT_EQ(message_of(dotted + " = 1"), "s.toml: the scene nests too deep (at most 2000 dots in its keys)");
  std::string numbers = "1";
  for (int i = 0; i < 200000; ++i) numbers += ".1";
  EXPECT_EQ(message_of('[' + numbers + ']'), "s.toml: the scene nests too deep (at most 2000 dots in its keys)");
  EXPECT_NE(message_of("a = " + std::string(100000, '[')), "good");
  // The most that is let through, every other dot taken for a decimal point, is still taken apart within the stack.
  std::string most = "1";
  for (int i = 0; i < 1999; ++i) most += ".1a.1";
  EXPECT_EQ(message_of(most + " = 1"),
            "s.toml:1: unknown section '1' (known: mesh, sets, material, model, support, traction, pressure, solver, "
            "dynamics, fracture, crack, record, interaction, pull)");
}

TEST(BrokenScene, SizeIsBounded) {
  EXPECT_EQ(message_of(std::string(kMaxSceneBytes + 1, '\n')), "s.toml: the scene has 4194305 bytes (at most 4194304)");
  EXPECT_EQ(message_of(std::string(kMaxSceneBytes - kGood.size(), '\n') + kGood), "good");
}

TEST(BrokenScene, FilesThatAreNone) {
  EXPECT_EQ(read_scene("/no/such.toml").error().message(),
            "/no/such.toml: there is no such file (a scene, as in scenes/bar.toml)");
  EXPECT_EQ(read_scene("/tmp").error().message(), "/tmp: not a file (a scene, as in scenes/bar.toml)");
  EXPECT_EQ(read_scene("").error().message(), "there is no such file (a scene, as in scenes/bar.toml)");
}

}  // namespace
}  // namespace rhexis::scene::test
