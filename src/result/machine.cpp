#include "result/machine.h"

#include <cmath>
#include <fstream>
#include <string>
#include <thread>

#include <sys/utsname.h>
#include <unistd.h>

#include "base/instruction_set.h"

namespace rhexis::result {
namespace {

/// As Linux names it; empty where it does not.
std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    return colon == std::string::npos ? std::string() : line.substr(colon + 2);
  }
  return {};
}

}  // namespace

nlohmann::ordered_json machine() {
  utsname system{};
  uname(&system);
  const double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return {{"processor", processor_name()},
          {"cores", std::thread::hardware_concurrency()},
          {"instruction_set", instruction_set()},
          {"memory_GB", std::round(1e-9 * bytes)},
          {"system", std::string(system.sysname) + " " + system.release + " " + system.machine}};
}

}  // namespace rhexis::result
