#pragma once

#include <ctime>

namespace rhexis {

/// Seconds of the processor since construction, all threads together: on one thread what else runs on the machine
/// counts little.
class ProcessorWatch {
 public:
  [[nodiscard]] double seconds() const {
    return static_cast<double>(std::clock() - start_) / static_cast<double>(CLOCKS_PER_SEC);
  }

 private:
  std::clock_t start_ = std::clock();
};

}  // namespace rhexis
