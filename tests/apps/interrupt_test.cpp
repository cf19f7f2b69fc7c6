// Ctrl-C, SIGTERM, and worse, during a run: what was done so far stays, every file is whole, nothing piles up.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include <nlohmann/json.hpp>

#include "mesh/io/mesh_file.h"
#include "tests/support/measured.h"
#include "tests/support/run_command.h"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// `rhexis ARGUMENTS`, going on beside the test.
class Running {
 public:
  Running(fs::path errors, std::vector<std::string> arguments) : errors_(std::move(errors)) {
    std::vector<std::string> words{RHEXIS_COMMAND};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    process_ = ::fork();
    if (process_ != 0) return;
    const int file = ::open(errors_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    if (::chdir(RHEXIS_SOURCE_DIR) == 0 && ::dup2(file, STDERR_FILENO) >= 0) ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~Running() {
    if (ended()) return;
    send(SIGKILL);
    wait();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send(int signal) const { ::kill(process_, signal); }
  bool ended() {
    int status = 0;
    if (!status_ && ::waitpid(process_, &status, WNOHANG) == process_) status_ = status;
    return status_.has_value();
  }
  /// True when the file is there before the run has ended.
  bool wait_for(const fs::path& file) {
    while (!ended()) {
      if (fs::exists(file)) return true;
      std::this_thread::sleep_for(milliseconds(1));
    }
    return false;
  }
  /// True when a file of the folder is half-written at the moment. Asks without a pause: it is so for moments only.
  bool wait_till_it_writes_in(const fs::path& folder) {
    const std::string temporary = ".part" + std::to_string(process_);
    std::error_code not_there_yet;
    while (!ended())
      for (const fs::directory_entry& entry : fs::directory_iterator(folder, not_there_yet))
        if (entry.path().native().ends_with(temporary)) return true;
    return false;
  }
  /// How it ended, as waitpid tells it.
  int wait() {
    while (!ended()) std::this_thread::sleep_for(milliseconds(1));
    return *status_;
  }
  [[nodiscard]] std::string errors() const { return test::slurp(errors_); }

 private:
  fs::path errors_;
  pid_t process_ = -1;
  std::optional<int> status_;
};

/// `rhexis solve scenes/vessel.toml ARGUMENTS --out OUT`.
class Solving : public Running {
 public:
  Solving(const fs::path& out, const std::vector<std::string>& arguments)
      : Running(out.parent_path() / "errors", all(out, arguments)) {}

 private:
  static std::vector<std::string> all(const fs::path& out, const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"solve", "scenes/vessel.toml", "--quiet", "--out", out.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return words;
  }
};

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

int count_temporaries(const fs::path& folder) {
  const std::vector<fs::path> files = files_in(folder);
  return static_cast<int>(std::count_if(files.begin(), files.end(), [](const fs::path& file) {
    return file.filename().string().find(".part") != std::string::npos;
  }));
}

/// Every file under its own name can be read, and steps.pvd lists the steps that are there. How many they are.
int check_whole(const fs::path& out) {
  const std::string series = test::slurp(out / "steps.pvd");
  if (fs::exists(out / "steps.pvd")) {
    EXPECT_THAT(series, HasSubstr("</VTKFile>"));
  }
  int steps = 0;
  for (const fs::path& file : files_in(out)) {
    if (file.extension() == ".json") {
      EXPECT_TRUE(json::accept(test::slurp(file))) << file;
    }
    if (file.extension() != ".vtu" && file.extension() != ".vtkhdf") continue;
    const Expected<mesh::MeshFile> read = mesh::read_mesh_file(file);
    EXPECT_TRUE(read) << (read ? "" : read.error().message());
    if (file.extension() == ".vtu") ++steps;
  }
  int listed = 0;
  for (std::size_t at = series.find("step_"); at != std::string::npos; at = series.find("step_", at + 1)) {
    EXPECT_TRUE(fs::exists(out / "steps" / series.substr(at, sizeof("step_0001.vtu") - 1)));
    ++listed;
  }
  // A step that has been written when the end comes may not be listed yet.
  EXPECT_TRUE(listed == steps || listed + 1 == steps) << listed << " of " << steps;
  return steps;
}

/// By Ctrl-C, or by whoever watches over programs.
class InterruptBy : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Signals, InterruptBy, testing::Values(SIGINT, SIGTERM),
                         [](const auto& test) { return test.param == SIGINT ? "SIGINT" : "SIGTERM"; });

TEST_P(InterruptBy, OnceTheStepInFlightIsFinishedAndTheResultsWritten) {
  const fs::path out = test::fresh_folder("once") / "out";
  Solving solving(out, {"--set", "solver.steps=1000", "--set", "mesh.nodes=200"});
  ASSERT_TRUE(solving.wait_for(out / "steps/step_0002.vtu")) << solving.errors();
  solving.send(GetParam());
  const int status = solving.wait();
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(solving.errors(), HasSubstr("not converged: stopped at load fraction"));

  const json summary = json::parse(test::slurp(out / "summary.json"));
  EXPECT_FALSE(summary["converged"]);
  EXPECT_EQ(summary["outcome"], "stopped");
  const int steps = check_whole(out);
  EXPECT_GE(steps, 2);
  EXPECT_LT(steps, 1000);
  EXPECT_EQ(summary["steps"].size(), static_cast<std::size_t>(steps));
  EXPECT_DOUBLE_EQ(summary["load"].get<double>(), 1e-3 * steps);
  EXPECT_EQ(count_temporaries(out), 0);
  const test::Ran compared = test::run_rhexis(fmt::format(
      "--json compare '{}' '{}'", (out / fmt::format("steps/step_{:04}.vtu", steps)).string(), out.string()));
  for (const json& field : json::parse(compared.out)["comparisons"][0]["fields"]) EXPECT_EQ(field["largest"], 0.0);
}

TEST_P(InterruptBy, AgainTheProgramEndsAtOnce) {
  const fs::path out = test::fresh_folder("twice") / "out";
  // One step of this takes many times longer than what is waited below.
  Solving solving(out, {"--set", "model.kind=taylor-hood", "--set", "model.beta=", "--set", "mesh.nodes=3000"});
  ASSERT_TRUE(solving.wait_for(out / "steps.pvd")) << solving.errors();
  std::this_thread::sleep_for(milliseconds(50));
  solving.send(GetParam());
  std::this_thread::sleep_for(milliseconds(50));
  solving.send(GetParam());
  const int status = solving.wait();
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), GetParam());
  check_whole(out);
  EXPECT_FALSE(fs::exists(out / "summary.json"));
}

TEST_P(InterruptBy, ATearEndsAfterItsTickWithWhatWasTorn) {
  const fs::path folder = test::fresh_folder("tear");
  const fs::path out = folder / "out";
  Running tearing(folder / "errors", {"tear", "scenes/plate-tear.toml", "--quiet", "--out", out.string()});
  ASSERT_TRUE(tearing.wait_for(out / "steps/topology_0002.vtu")) << tearing.errors();
  tearing.send(GetParam());
  const int status = tearing.wait();
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(tearing.errors(), HasSubstr("scenes/plate-tear.toml: stopped at 0."));
  const json summary = json::parse(test::slurp(out / "summary.json"));
  EXPECT_FALSE(summary["converged"]);
  EXPECT_GE(summary["advances"].size(), 2U);
  EXPECT_TRUE(fs::exists(out / "result.vtkhdf"));
  EXPECT_EQ(count_temporaries(out), 0);
}

TEST_P(InterruptBy, ALiveSceneEndsWellWithItsRecordingClosed) {
  const fs::path folder = test::fresh_folder("play");
  const fs::path page = folder / "page";
  fs::create_directories(page);
  std::ofstream(page / "index.html") << "<html></html>";
  const fs::path recordings = folder / "recordings";
  Running playing(folder / "errors",
                  {"play", "scenes/plate-tear.toml", "--no-browser", "--port", "0", "--device", "script", "--record",
                   "--page", page.string(), "--recordings", recordings.string()});
  ASSERT_TRUE(playing.wait_for(recordings)) << playing.errors();
  std::this_thread::sleep_for(milliseconds(700));
  playing.send(GetParam());
  const int status = playing.wait();
  ASSERT_TRUE(WIFEXITED(status)) << playing.errors();
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const std::vector<fs::path> files = files_in(recordings);
  ASSERT_EQ(files.size(), 1U) << playing.errors();
  const test::Ran checked = test::run_rhexis("replay --check '" + files.front().string() + "'");
  EXPECT_EQ(checked.code, 0) << checked.err;
}

TEST(Interrupt, KilledWhileItWritesWhatIsThereIsWholeAndTheNextRunSweepsUp) {
  const fs::path out = test::fresh_folder("killed") / "out";
  const auto arguments = [](const std::string& steps) {
    return std::vector<std::string>{"--set", "model.kind=linear", "--set", "model.beta=",
                                    "--set", "mesh.nodes=400",    "--set", "solver.steps=" + steps};
  };
  for (const fs::path& folder : {out / "steps", out, out / "steps"}) {
    Solving solving(out, arguments("2000"));
    solving.wait_till_it_writes_in(folder);
    solving.send(SIGKILL);
    ASSERT_TRUE(WIFSIGNALED(solving.wait())) << solving.errors();
    check_whole(out);
    EXPECT_LE(count_temporaries(out), 1) << "what the run before left is swept up";
    test::measured("{} half-written when killed", count_temporaries(out));
  }
  for (const char* name :
       {"result.vtkhdf.part1", "summary.json.part22", "steps.pvd.part3", "steps/step_0009.vtu.part4"})
    std::ofstream(out / name) << "half";
  std::ofstream(out / "notes.part1") << "not ours";
  Solving last(out, arguments("2"));
  ASSERT_TRUE(WIFEXITED(last.wait()));
  EXPECT_EQ(check_whole(out), 2);
  std::vector<std::string> names;
  for (const fs::path& file : files_in(out)) names.push_back(file.filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre("notes.part1", "result.vtkhdf", "summary.json", "steps.pvd",
                                                   "step_0001.vtu", "step_0002.vtu"));
}

}  // namespace
}  // namespace rhexis
