// rhexis precompute from outside: killed and resumed, on one rank and on two, the record is the same bytes.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

#include <nlohmann/json.hpp>

#include "tests/support/measured.h"
#include "tests/support/run_command.h"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::slurp;
using testing::HasSubstr;

const std::string kScene = "scenes/plate-tear.toml --set mesh.nodes=300 --set record.directions=5";

test::Ran precompute(const fs::path& out, const std::string& more = "") {
  return test::run_rhexis("precompute " + kScene + " --out '" + out.string() + "' " + more);
}

/// The same beside the test, as rank `rank` of `size`.
pid_t start(const fs::path& out, int rank, int size) {
  const pid_t process = ::fork();
  if (process != 0) return process;
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  ::setenv("OMPI_COMM_WORLD_RANK", std::to_string(rank).c_str(), 1);
  ::setenv("OMPI_COMM_WORLD_SIZE", std::to_string(size).c_str(), 1);
  const std::string path = out.string();
  if (::chdir(RHEXIS_SOURCE_DIR) == 0)
    ::execl(RHEXIS_COMMAND, RHEXIS_COMMAND, "precompute", "scenes/plate-tear.toml", "--set", "mesh.nodes=300", "--set",
            "record.directions=5", "--out", path.c_str(), nullptr);
  ::_exit(127);
}

/// Its exit code; -1 when it was killed.
int wait_for(pid_t process) {
  int status = 0;
  ::waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The record of one undisturbed run, made once.
const std::string& undisturbed(double* seconds = nullptr) {
  static double took = 0.0;
  static const std::string bytes = [] {
    const fs::path out = test::fresh_folder("undisturbed") / "plate.h5";
    const auto begun = std::chrono::steady_clock::now();
    const test::Ran ran = precompute(out, "--json");
    took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    EXPECT_EQ(ran.code, 0) << ran.err;
    return slurp(out);
  }();
  if (seconds != nullptr) *seconds = took;
  return bytes;
}

TEST(PrecomputeCommand, SaysWhatItMade) {
  const fs::path out = test::fresh_folder("precompute") / "deep" / "plate.h5";
  const test::Ran ran = precompute(out, "--json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json summary = json::parse(ran.out);
  EXPECT_EQ(summary["ending"], "complete");
  EXPECT_EQ(summary["topologies"], 31);
  EXPECT_EQ(summary["computed"], 31);
  EXPECT_EQ(summary["bytes"], fs::file_size(out));
  EXPECT_GT(summary["grasp_points"], 200);
  for (const auto& [way, bytes] : summary["bytes_of"].items())
    test::measured("{}: {:.2f} MB", way, 1e-6 * bytes.get<double>());
  const test::Ran again = precompute(out);
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.out, HasSubstr("is there already"));
  EXPECT_TRUE(slurp(out) == undisturbed());
}

TEST(PrecomputeCommand, MemoryChoosesTheAdvances) {
  const fs::path out = test::fresh_folder("precompute") / "plate.h5";
  const test::Ran ran = precompute(out, "--json --memory 10");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out)["advances"], 1);
  EXPECT_LT(fs::file_size(out), 10'000'000U);
  const test::Ran none = precompute(out, "--memory 0.1");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("--memory: a record of one advance takes"));
}

/// RHEXIS_KILLS asks for more.
TEST(PrecomputeCommand, KilledAtAnyMomentItGoesOn) {
  const char* asked = std::getenv("RHEXIS_KILLS");
  const int wanted = asked != nullptr ? std::atoi(asked) : 10;
  double seconds = 0.0;
  const std::string& whole = undisturbed(&seconds);
  std::mt19937_64 bits(42);
  const fs::path out = test::fresh_folder("precompute") / "plate.h5";
  int kills = 0;
  int records = 0;
  for (int ranks = 1; kills < wanted; ranks = 3 - ranks) {
    std::vector<pid_t> processes;
    for (int rank = 0; rank < ranks; ++rank) processes.push_back(start(out, rank, ranks));
    const double part = static_cast<double>(bits() >> 11U) * 0x1p-53;
    std::this_thread::sleep_for(std::chrono::duration<double>(part * seconds));
    ::kill(processes[bits() % processes.size()], SIGKILL);
    for (const pid_t process : processes) kills += wait_for(process) == -1 ? 1 : 0;
    if (!fs::exists(out)) continue;  // else it has come to its end, or the other one has
    EXPECT_TRUE(slurp(out) == whole) << "after " << kills << " kills";
    fs::remove(out);
    ++records;
  }
  EXPECT_EQ(wait_for(start(out, 0, 1)), 0);
  EXPECT_TRUE(slurp(out) == whole);
  EXPECT_FALSE(fs::exists(out.string() + ".parts"));
  test::measured("{} kills, {} records in spite of them", kills, records + 1);
}

TEST(PrecomputeCommand, TwoRanksShareAndOnePutsTogether) {
  const fs::path out = test::fresh_folder("precompute") / "plate.h5";
  const pid_t first = start(out, 0, 2);
  const pid_t second = start(out, 1, 2);
  EXPECT_EQ(wait_for(first), 0);
  EXPECT_EQ(wait_for(second), 0);
  EXPECT_TRUE(slurp(out) == undisturbed());
  EXPECT_FALSE(fs::exists(out.string() + ".parts"));
}

TEST(PrecomputeCommand, NamesWhatIsWrong) {
  const fs::path folder = test::fresh_folder("precompute");
  const auto refusal = [&](const std::string& arguments) {
    const test::Ran ran =
        test::run_rhexis("precompute " + arguments + " --out '" + (folder / "plate.h5").string() + "'");
    EXPECT_EQ(ran.code, 2) << arguments;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    return ran.err;
  };
  EXPECT_THAT(refusal(kScene + " --set fracture.incision=split"), HasSubstr("incision = \"keep-nodes\""));
  EXPECT_THAT(refusal(kScene + " --set crack="), HasSubstr("add a [[crack]]"));
  EXPECT_THAT(refusal(kScene + " --set model.kind=corotated"), HasSubstr("kind = \"linear\""));
  EXPECT_THAT(refusal(kScene + " --set record.lengths=[0.04,0.03]"), HasSubstr("'record.lengths' do not ascend"));
  EXPECT_THAT(refusal(kScene + " --set record.lengths=[]"), HasSubstr("'record.lengths' is empty"));
  EXPECT_THAT(refusal(kScene + " --set record.advances=8 --set record.directions=1441"),
              HasSubstr("more than 1000000 topologies"));
  EXPECT_THAT(refusal(kScene + " --set crack.0.to=[0.12,-0.1,0.0]"), HasSubstr("rhexis: "));
  std::ofstream(folder / "plate.h5") << "something else";
  EXPECT_THAT(refusal(kScene), HasSubstr("plate.h5: there is a file of that name, and not of this record"));
}

}  // namespace
}  // namespace rhexis
