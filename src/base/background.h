#pragma once

/// One piece of work beside the caller, who goes on meanwhile and waits for it when its result is due. Data parallelism
/// is base/parallel.h.

#include <exception>
#include <functional>
#include <thread>

namespace rhexis {

class BackgroundTask {
 public:
  BackgroundTask() = default;
  ~BackgroundTask();  ///< waits
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;

  /// Nothing may be under way. With thread_count() one the work is done before this returns.
  void start(std::function<void()> work);
  /// Started, and not waited for.
  [[nodiscard]] bool under_way() const { return under_way_; }
  /// Returns when the work is done; throws what it threw.
  void wait();

 private:
  std::thread thread_;
  std::exception_ptr thrown_;
  bool under_way_ = false;
};

}  // namespace rhexis
