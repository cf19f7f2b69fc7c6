// rhexis tear from outside: exit codes, streams, files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/vec.h"
#include "mesh/io/mesh_file.h"
#include "tests/support/measured.h"
#include "tests/support/run_command.h"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

test::Ran tear(const std::string& arguments, const fs::path& out) {
  return test::run_rhexis("tear scenes/plate-tear.toml " + arguments + " --out '" + out.string() + "'");
}

const mesh::Field& field_of(const mesh::MeshFile& file, const std::string& name) {
  const auto found =
      std::find_if(file.fields.begin(), file.fields.end(), [&](const mesh::Field& f) { return f.name == name; });
  EXPECT_NE(found, file.fields.end()) << name;
  return *found;
}

Vec3 vector_of(const json& list) { return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()}; }

/// Once its force grew to a million newtons, and then was no number.
TEST(TearCommand, ASoftBarNearIncompressibilityHasTheForceOfASoftBar) {
  const fs::path out = test::fresh_folder("tear");
  const test::Ran ran =
      test::run_rhexis("tear scenes/bar-soft.toml --set material.poisson=0.49 --json --out '" + out.string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json summary = json::parse(ran.out);
  EXPECT_EQ(summary["response"], "live");
  EXPECT_GE(summary["advances"].size(), 3U);
  EXPECT_GT(summary["largest_force"].get<double>(), 0.1);
  EXPECT_LT(summary["largest_force"].get<double>(), 1.0);  // 0.37 N
  EXPECT_THAT(test::slurp(out / "force.csv"), testing::Not(HasSubstr("nan")));
}

/// Pulled aside, torn some way and let go, it swings to the other side and back, and rings down.
TEST(TearCommand, ABarWithMassThatIsLetGoSwingsAndIsShown) {
  const fs::path out = test::fresh_folder("swing");
  const test::Ran ran = test::run_rhexis("tear scenes/bar-swing.toml --json --out '" + out.string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json summary = json::parse(ran.out);
  EXPECT_EQ(summary["pieces"], 1);
  EXPECT_GE(summary["advances"].size(), 2U);
  const std::string series = test::slurp(out / "released.pvd");
  std::vector<double> aside;  // m, of the middle of the end, across the way of the crack
  for (int k = 1; k <= 50; ++k) {
    const std::string name = fmt::format("steps/released_{:04}.vtu", k);
    EXPECT_THAT(series, HasSubstr(name));
    EXPECT_THAT(series, HasSubstr(fmt::format("timestep=\"{}\"", (1000 + 20 * k) / 1000.0)));
    const Expected<mesh::MeshFile> state = mesh::read_mesh_file(out / name);
    ASSERT_TRUE(state) << state.error().message();
    double sum = 0.0;
    int count = 0;
    for (std::size_t node = 0; node < state->mesh.node_count(); ++node) {
      if (state->mesh.nodes[node][0] < 0.0399) continue;
      sum += field_of(*state, "displacement").values[3 * node + 2];
      ++count;
    }
    aside.push_back(sum / count);
  }
  EXPECT_FALSE(fs::exists(out / "steps/released_0051.vtu"));
  const double rest = std::accumulate(aside.end() - 10, aside.end(), 0.0) / 10.0;
  int turns = 0;
  for (std::size_t k = 1; k < aside.size(); ++k) turns += (aside[k] > rest) != (aside[k - 1] > rest) ? 1 : 0;
  const auto spread = [&](auto from, auto to) {
    const auto [least, most] = std::minmax_element(from, to);
    return *most - *least;
  };
  const double first = spread(aside.begin(), aside.begin() + 10);
  const double last = spread(aside.end() - 10, aside.end());
  test::measured("bar-swing: {} times through its rest, swings of {:.1f} mm in the first 0.2 s and {:.1f} in the last",
                 turns, 1e3 * first, 1e3 * last);
  EXPECT_GE(turns, 4);
  EXPECT_GT(first, 3e-3);
  EXPECT_LT(last, 0.5 * first);
  // Nobody holds it: no force; and a line a tick.
  std::ifstream trace(out / "force.csv");
  std::string line;
  int ticks = -1;
  while (std::getline(trace, line)) {
    if (++ticks > 1000) {
      EXPECT_THAT(line, HasSubstr(",0,0,0,0,0,0,"));
    }
  }
  EXPECT_EQ(ticks, 2000);
}

TEST(TearCommand, ASoftVesselTearsByItsToughness) {
  const fs::path out = test::fresh_folder("tear");
  const test::Ran ran = test::run_rhexis(
      "tear scenes/vessel-soft.toml --set fracture.strength= --set fracture.toughness=3 --set mesh.nodes=600 "
      "--set pull.0.seconds=0.1 --json --out '" +
      out.string() + "'");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json summary = json::parse(ran.out);
  ASSERT_GE(summary["advances"].size(), 3U);
  for (std::size_t k = 1; k < summary["advances"].size(); ++k)
    EXPECT_GE(summary["advances"][k]["value"].get<double>(), 3.0) << k;
}

TEST(TearCommand, WritesEveryTopologyTheTraceAndTheSummary) {
  const fs::path out = test::fresh_folder("tear");
  const test::Ran ran = tear("", out);
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("advances"));

  const json summary = json::parse(test::slurp(out / "summary.json"));
  EXPECT_TRUE(summary["converged"]);
  const json& advances = summary["advances"];
  ASSERT_GE(advances.size(), 6U);  // the scene's crack and five more
  for (const json& advance : advances) {
    for (const char* key : {"length", "angle", "tets_removed", "nodes_moved", "volume_lost", "pieces", "milliseconds",
                            "front_before", "front_after"})
      EXPECT_TRUE(advance.contains(key)) << key;
  }
  const std::string series = test::slurp(out / "steps.pvd");
  for (std::size_t topology = 1; topology <= advances.size(); ++topology) {
    const std::string name = fmt::format("steps/topology_{:04}", topology);
    EXPECT_TRUE(fs::exists(out / (name + ".vtkhdf"))) << name;
    EXPECT_TRUE(fs::exists(out / (name + ".vtu"))) << name;
    EXPECT_THAT(series, HasSubstr(name + ".vtu"));
  }
  EXPECT_TRUE(fs::exists(out / "force.svg"));
  const Expected<mesh::MeshFile> result = mesh::read_mesh_file(out / "result.vtkhdf");
  ASSERT_TRUE(result) << result.error().message();
  // As it stands at the last tick: the hand has moved by 0.12 m, and its point with it.
  const std::vector<double>& u = field_of(*result, "displacement").values;
  double most = 0.0;
  for (std::size_t n = 0; n < u.size(); n += 3) most = std::max(most, Vec3(u[n], u[n + 1], u[n + 2]).norm());
  EXPECT_GT(most, 0.1);
  EXPECT_GE(summary["max_displacement"].get<double>(), most);
  EXPECT_GE(summary["largest_force"].get<double>(), vector_of(advances[1]["force_before"]).norm());

  std::ifstream trace(out / "force.csv");
  std::string line;
  std::getline(trace, line);
  EXPECT_EQ(line,
            "time_s,pull_x_m,pull_y_m,pull_z_m,force_x_N,force_y_N,force_z_N,advances,hand_work_J,stored_energy_J,"
            "crack_area_m2");
  int ticks = 0;
  while (std::getline(trace, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 10) << line;
    ++ticks;
  }
  EXPECT_EQ(ticks, 2000);  // 2 s in ticks of 1 ms
}

TEST(TearCommand, ReactionsOfATornBodyBalanceTheHand) {
  for (const auto& [incision, strength] : {std::pair{"keep-nodes", "0.4e6"}, std::pair{"split", "0.25e6"}}) {
    const fs::path out = test::fresh_folder(std::string("balance-") + incision);
    const test::Ran ran =
        tear(fmt::format("--set fracture.incision={} --set fracture.strength={}", incision, strength), out);
    ASSERT_EQ(ran.code, 0) << ran.err;
    const json summary = json::parse(test::slurp(out / "summary.json"));
    const json& last = summary["advances"].back();
    const Expected<mesh::MeshFile> file =
        mesh::read_mesh_file(out / fmt::format("steps/topology_{:04}.vtkhdf", last["topology"].get<int>()));
    ASSERT_TRUE(file) << file.error().message();
    const mesh::Field& reaction = field_of(*file, "reaction");
    Vec3 sum = Vec3::Zero();
    for (std::size_t n = 0; n < reaction.values.size(); n += 3)
      sum += Vec3(reaction.values[n], reaction.values[n + 1], reaction.values[n + 2]);
    const Vec3 on_hand = vector_of(last["force_after"]);
    ASSERT_GT(on_hand.norm(), 0.1);
    // The body is at rest between its supports and the hand: internal forces cancel to the rounding of the solve.
    EXPECT_LT((sum - on_hand).norm(), 1e-9 * on_hand.norm()) << incision;
    const mesh::Field& alive = field_of(*file, "alive");
    const auto gone = std::count(alive.values.begin(), alive.values.end(), 0.0);
    int removed = 0;
    for (const json& advance : summary["advances"]) removed += advance["tets_removed"].get<int>();
    EXPECT_EQ(gone, removed);
    EXPECT_EQ(file->mesh.node_count(), summary["nodes"].get<std::size_t>());
  }
}

TEST(TearCommand, BadInputIsOneLineAndWritesNothing) {
  struct Bad {
    std::string set, says;
  };
  for (const Bad& bad :
       {Bad{"--set model.kind=taylor-hood",
            "--set model.kind=taylor-hood: a body with model 'taylor-hood' cannot be torn"},
        Bad{"--set pull.0.at=[0.24,0.1,0.005]", "a support holds the point that the hand takes hold of"},
        Bad{"--set crack.0.from=[0.3,0,0] --set crack.0.to=[0.3,0.06,0]", "crack"},
        Bad{"--set fracture.advance_threshold=1e6", "'fracture.advance_threshold' is 1000000"},
        Bad{"--set fracture.criterion=maximum-hop", "maximum-hoop"},
        Bad{"--set pull.0.seconds=nan", "pull.0.seconds"}}) {
    const fs::path out = test::fresh_folder("bad") / "out";
    const test::Ran ran = tear(bad.set, out);
    EXPECT_EQ(ran.code, 2) << bad.set << '\n' << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(bad.says)) << bad.set;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_FALSE(fs::exists(out)) << bad.set;
  }
}

TEST(TearCommand, CheckRefusesWhatTearRefuses) {
  for (const char* set : {"--set crack.0.to=[0.5,0.5,0]", "--set pull.0.at=[0.24,0.1,0]"}) {
    const test::Ran ran = test::run_rhexis(std::string("check scenes/plate-tear.toml ") + set);
    EXPECT_EQ(ran.code, 2) << set;
    EXPECT_THAT(ran.err, HasSubstr("rhexis: ")) << set;
  }
  EXPECT_EQ(test::run_rhexis("check scenes/plate-tear.toml").code, 0);
}

TEST(TearCommand, SaysWhenTheHandLetsGo) {
  const fs::path out = test::fresh_folder("tear-let-go");
  const test::Ran ran = tear(
      "--set fracture.criterion=maximum-hoop --set fracture.strength=0.02e6 --set "
      "fracture.advance_threshold=0.02e6",
      out);
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("s: the hand has let go"));
}

TEST(TearCommand, JsonIsAllThatStdoutHolds) {
  const fs::path out = test::fresh_folder("tear-json");
  const test::Ran ran = tear("--json --set pull.0.seconds=0.2", out);
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out), json::parse(test::slurp(out / "summary.json")));
}

TEST(TearCommand, IsAnsweredByARecordAndSaysWhereItEnds) {
  const fs::path out = test::fresh_folder("recorded");
  const std::string scene = "scenes/plate-recorded.toml --set mesh.nodes=300 --set record.directions=5";
  const std::string record = (out / "plate.h5").string();
  const std::string command = "tear " + scene + " --set interaction.record=" + record + " --out " + out.string();
  const test::Ran none = test::run_rhexis(command);
  EXPECT_EQ(none.code, 2);
  EXPECT_EQ(none.err, "rhexis: " + record +
                          ": there is no such file (rhexis precompute scenes/plate-recorded.toml --out " + record +
                          ")\n");

  ASSERT_EQ(test::run_rhexis("precompute " + scene + " --out " + record).code, 0);
  const test::Ran ran = test::run_rhexis(command + " --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json summary = json::parse(ran.out);
  EXPECT_EQ(summary["response"], "recorded");
  const json& advances = summary["advances"];
  ASSERT_GE(advances.size(), 4U);
  EXPECT_TRUE(advances[0]["record"].is_null());  // the scene's crack is the record's topology 0
  EXPECT_GT(advances[1]["record"]["topology"], 0);
  EXPECT_FALSE(advances[2]["record"]["past_last"]);
  EXPECT_TRUE(advances[3]["record"]["past_last"]);
  EXPECT_EQ(advances[3]["record"]["topology"], advances[2]["record"]["topology"]);
  const std::string said = "the crack has run on more often than the record knows";
  const std::size_t first = ran.err.find(said);
  ASSERT_NE(first, std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find(said, first + 1), std::string::npos) << "said once";

  const test::Ran other = test::run_rhexis(command + " --set material.young=2e6");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr(record + ": the record of another material"));
}

}  // namespace
}  // namespace rhexis
