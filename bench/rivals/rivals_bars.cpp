// Rhexis beside what one would use instead: Bullet's deformable bodies for the rate at equal error, CalculiX for the
// converged answer. The same bars, the same hand, the same machine, one run. docs/rivals.md quotes it.
//
//   make rivals, or rhexis_rivals --nodes 2000 --law linear --out out/rivals.json

#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/rivals/bar.h"
#include "bench/rivals/contest.h"
#include "linalg/blas_kernels.h"

using namespace rhexis;          // NOLINT
using namespace rhexis::rivals;  // NOLINT

int main(int argc, char** argv) {
  linalg::begin_with_fitting_blas(argv);
  CLI::App app("Rhexis beside Bullet and CalculiX on bars");
  std::vector<int> nodes{2000, 8000};
  std::vector<std::string> laws{"linear", "neo-hookean", "answers"};
  material::Elastic elastic{.young = 1e5, .poisson = 0.45};
  bool every = false;
  std::string out;
  app.add_option("--nodes", nodes, "sizes of the bar")->check(CLI::Range(100, 100000))->capture_default_str();
  app.add_option("--law", laws, "what is compared")
      ->check(CLI::IsMember({"linear", "neo-hookean", "answers"}))
      ->capture_default_str();
  app.add_option("--poisson", elastic.poisson)->check(CLI::Range(0.0, 0.499))->capture_default_str();
  app.add_flag("--every", every, "try all settings of Bullet, which takes long");
  app.add_option("--out", out, "writes the tables as JSON");
  CLI11_PARSE(app, argc, argv);

  ContestTables tables;
  for (const int count : nodes) {
    const Expected<Bar> bar = Bar::make(count, elastic);
    if (!bar) {
      fmt::print(stderr, "rhexis_rivals: {}\n", bar.error().message());
      return 2;
    }
    for (const std::string& law : laws) {
      if (law == "answers") compare_answers(*bar, tables);
      if (law == "linear") contest(*bar, BulletLaw::linear, every, tables);
      if (law == "neo-hookean") contest(*bar, BulletLaw::neo_hookean, every, tables);
      std::fflush(stdout);
    }
  }
  if (!out.empty()) {
    std::ofstream file(out);
    file << nlohmann::ordered_json{{"rest", tables.rest}, {"moving", tables.moving}, {"converged", tables.converged}}
                .dump(2)
         << '\n';
    if (!file) {
      fmt::print(stderr, "rhexis_rivals: cannot write {} (a file in a folder that exists)\n", out);
      return 2;
    }
  }
  return 0;
}
