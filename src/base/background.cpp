#include "base/background.h"

#include <utility>

#include "base/check.h"
#include "base/parallel.h"

namespace rhexis {

BackgroundTask::~BackgroundTask() {
  if (thread_.joinable()) thread_.join();
}

void BackgroundTask::start(std::function<void()> work) {
  RHEXIS_CHECK(!under_way_, "a second piece of work before the first was waited for");
  under_way_ = true;
  thrown_ = nullptr;
  const auto run = [this, what = std::move(work)] {
    try {
      what();
    } catch (...) {
      thrown_ = std::current_exception();
    }
  };
  if (thread_count() == 1) {
    run();
  } else {
    thread_ = std::thread(run);
  }
}

void BackgroundTask::wait() {
  if (thread_.joinable()) thread_.join();
  under_way_ = false;
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

}  // namespace rhexis
