#include "studies/perception_log.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <unistd.h>

namespace rhexis::studies {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kElsewhere = "--out names another folder";

ordered_json head_of(const PerceptionSettings& settings, std::uint64_t seed) {
  return {{"experiment", "angle-perception"},
          {"fingerprint", fmt::format("{:016x}", fingerprint_of(settings))},
          {"seed", seed}};
}

tl::unexpected<Error> cannot_write(const fs::path& path) {
  return fail(fmt::format("cannot be written: {}", std::strerror(errno)), kElsewhere, path.string());
}

/// Its answer goes to the experiment; false: it is no line of the trial that comes next.
bool take_up(const std::string& line, PerceptionExperiment& experiment) {
  const ordered_json said = ordered_json::parse(line, nullptr, false);
  if (!said.is_object() || !said.contains("answer") || experiment.current() == nullptr) return false;
  for (const Side side : {Side::a, Side::b}) {
    if (said["answer"] != std::string(1, letter_of(side))) continue;
    const ordered_json expected = trial_json({*experiment.current(), side});
    for (const auto& [key, value] : expected.items())
      if (!said.contains(key) || said[key] != value) return false;
    experiment.answer(side);
    return true;
  }
  return false;
}

/// Gives the bytes of the whole lines; 0: there is none yet, or only the first of another experiment.
Expected<std::uintmax_t> read_lines(const fs::path& path, const ordered_json& head, PerceptionExperiment& experiment) {
  std::ifstream file(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  std::size_t begin = 0;
  int number = 1;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin), ++number) {
    const std::string line = text.substr(begin, end - begin);
    if (number == 1) {
      const ordered_json said = ordered_json::parse(line, nullptr, false);
      const bool is_same = said == head;  // of what is no JSON != would be false too
      const bool is_log = said.is_object() && said.contains("experiment") && said["experiment"] == head["experiment"];
      if (!is_same && is_log && text.find('\n', end + 1) == std::string::npos) return 0;  // no answer is lost
      if (!is_same)
        return fail("these are the answers to another experiment, or by another seed", kElsewhere, path.string(), 1);
    }
    if (number > 1 && !take_up(line, experiment))
      return fail("this is not the trial that comes next", kElsewhere, path.string(), number);
    begin = end + 1;
  }
  return begin;
}

}  // namespace

ordered_json trial_json(const AnsweredTrial& answered) {
  const Trial& trial = answered.trial;
  return {{"trial", trial.number},
          {"run", trial.run},
          {"point", trial.point},
          {"direction", trial.direction},
          {"difference", trial.difference},
          {"same", std::string(1, letter_of(trial.same))},
          {"answer", std::string(1, letter_of(answered.answer))},
          {"right", answered.is_right()}};
}

Expected<TrialLog> TrialLog::open(const fs::path& path, const PerceptionSettings& settings, std::uint64_t seed,
                                  PerceptionExperiment& experiment) {
  const ordered_json head = head_of(settings, seed);
  std::error_code code;
  std::uintmax_t whole = 0;
  if (fs::exists(path, code)) {
    if (!fs::is_regular_file(path, code)) return fail("not a file", kElsewhere, path.string());
    const Expected<std::uintmax_t> read = read_lines(path, head, experiment);
    if (!read) return fail(read.error());
    whole = *read;
    fs::resize_file(path, whole, code);
    if (code) return fail("cannot be written: " + code.message(), kElsewhere, path.string());
  }
  std::FILE* file = std::fopen(path.c_str(), "ab");
  if (file == nullptr) return cannot_write(path);
  std::setvbuf(file, nullptr, _IONBF, 0);  // what could not be written is not to come with the next line
  TrialLog log(path, file, whole);
  if (whole == 0)
    if (Expected<void> written = log.write_line(head.dump()); !written) return fail(std::move(written.error()));
  return log;
}

Expected<void> TrialLog::append(const AnsweredTrial& answered, double seconds) {
  ordered_json line = trial_json(answered);
  line["seconds"] = seconds;
  return write_line(line.dump());
}

Expected<void> TrialLog::write_line(const std::string& line) {
  const std::string whole = line + '\n';
  const bool done = std::fwrite(whole.data(), 1, whole.size(), file_.get()) == whole.size() &&
                    std::fflush(file_.get()) == 0 && (::fdatasync(::fileno(file_.get())) == 0 || errno == EINVAL);
  if (done) {
    bytes_ += whole.size();
    return {};
  }
  Expected<void> error = cannot_write(path_);
  std::clearerr(file_.get());
  if (::ftruncate(::fileno(file_.get()), static_cast<off_t>(bytes_)) != 0) return cannot_write(path_);
  return error;
}

}  // namespace rhexis::studies
