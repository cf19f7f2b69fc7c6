#include "bench/rivals/calculix.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "base/clock.h"

namespace rhexis::rivals {
namespace {

namespace fs = std::filesystem;

/// A folder that goes when this does.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(fs::temp_directory_path() / fmt::format("rhexis-rivals-{}", ::getpid())) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Its nodes and elements count from 1, and its fields have 20 characters.
void write_deck(std::ostream& out, const Bar& bar, CalculixLaw law, const Vec3& hand) {
  fmt::print(out, "*NODE, NSET=ALL\n");
  for (std::size_t i = 0; i < bar.mesh.node_count(); ++i)
    fmt::print(out, "{}, {:.12e}, {:.12e}, {:.12e}\n", i + 1, bar.mesh.nodes[i][0], bar.mesh.nodes[i][1],
               bar.mesh.nodes[i][2]);
  fmt::print(out, "*ELEMENT, TYPE=C3D4, ELSET=BODY\n");
  for (std::size_t t = 0; t < bar.mesh.tet_count(); ++t) {
    const mesh::Tet& tet = bar.mesh.tets[t];
    fmt::print(out, "{}, {}, {}, {}, {}\n", t + 1, tet[0].value() + 1, tet[1].value() + 1, tet[2].value() + 1,
               tet[3].value() + 1);
  }
  fmt::print(out, "*MATERIAL, NAME=SOFT\n");
  if (law == CalculixLaw::neo_hookean) {
    const material::MooneyRivlin constants = material::to_mooney_rivlin(bar.elastic, true);
    fmt::print(out, "*HYPERELASTIC, NEO HOOKE\n{:.12e}, {:.12e}\n", constants.c1, 2.0 / constants.kappa);
  } else {
    fmt::print(out, "*ELASTIC\n{:.12e}, {:.12e}\n", bar.elastic.young, bar.elastic.poisson);
  }
  fmt::print(out, "*SOLID SECTION, ELSET=BODY, MATERIAL=SOFT\n");
  if (law == CalculixLaw::linear) {
    fmt::print(out, "*STEP\n*STATIC\n");
  } else {
    // Increments of a quarter, and residuals far below its own half a percent.
    fmt::print(out,
               "*STEP, NLGEOM, INC=100\n*STATIC\n0.25, 1., 1e-5, 0.25\n*CONTROLS, PARAMETERS=FIELD\n"
               "1e-8, 1e-8, , , 1e-8, 1e-20, 1e-8, 1e-20\n*CONTROLS, PARAMETERS=TIME INCREMENTATION\n"
               "20, 24, 9, 40, 20, 4, , 10\n");
  }
  fmt::print(out, "*BOUNDARY\n");
  for (const model::PrescribedDof& support : bar.led(hand).supports)
    fmt::print(out, "{0}, {1}, {1}, {2:.12e}\n", support.dof / 3 + 1, support.dof % 3 + 1, support.value);
  fmt::print(out, "*NODE PRINT, NSET=ALL, FREQUENCY=1000\nU\n*END STEP\n");
}

/// The displacements that *NODE PRINT leaves: lines of a node and three numbers, after some of words. Empty: not of
/// every node.
std::optional<VectorX> read_displacements(std::istream& in, Eigen::Index dofs) {
  VectorX u = VectorX::Zero(dofs);
  Eigen::Index nodes = 0;
  for (std::string line; std::getline(in, line);) {
    long node = 0;
    Vec3 of = Vec3::Zero();
    if (std::sscanf(line.c_str(), "%ld %lf %lf %lf", &node, &of[0], &of[1], &of[2]) != 4) continue;
    if (node < 1 || 3 * node > dofs || !of.allFinite()) return std::nullopt;
    u.segment<3>(3 * (node - 1)) = of;
    ++nodes;
  }
  return 3 * nodes == dofs ? std::optional(u) : std::nullopt;
}

}  // namespace

bool is_calculix_here() { return std::system("command -v ccx >/dev/null 2>&1") == 0; }

std::optional<CalculixAnswer> run_calculix(const Bar& bar, CalculixLaw law, const Vec3& hand) {
  const TemporaryFolder folder;
  {
    std::ofstream deck(folder.path() / "bar.inp");
    write_deck(deck, bar, law, hand);
  }
  const std::string command = fmt::format("cd '{}' && OMP_NUM_THREADS=1 ccx bar >log 2>&1", folder.path().string());
  const Stopwatch watch;
  if (std::system(command.c_str()) != 0) return std::nullopt;
  CalculixAnswer out;
  out.seconds = watch.seconds();
  std::ifstream printed(folder.path() / "bar.dat");
  std::optional<VectorX> u = read_displacements(printed, bar.dofs());
  if (!u) return std::nullopt;
  out.u = std::move(*u);
  return out;
}

}  // namespace rhexis::rivals
