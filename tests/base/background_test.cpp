#include "base/background.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "base/parallel.h"

namespace rhexis::test {
namespace {

TEST(BackgroundTask, RunsBesideTheCallerAndIsWaitedFor) {
  set_thread_count(2);
  BackgroundTask task;
  std::atomic<bool> go{false};
  int result = 0;
  std::thread::id where;
  EXPECT_FALSE(task.under_way());
  task.start([&] {
    while (!go) std::this_thread::yield();  // would hang if start did the work itself
    result = 7;
    where = std::this_thread::get_id();
  });
  EXPECT_TRUE(task.under_way());
  go = true;
  task.wait();
  EXPECT_FALSE(task.under_way());
  EXPECT_EQ(result, 7);
  EXPECT_NE(where, std::this_thread::get_id());
  task.start([&] { result = 8; });  // and again
  task.wait();
  EXPECT_EQ(result, 8);
  set_thread_count(0);
}

TEST(BackgroundTask, OnOneThreadTheWorkIsDoneAtOnce) {
  set_thread_count(1);
  BackgroundTask task;
  std::thread::id where;
  task.start([&] { where = std::this_thread::get_id(); });
  EXPECT_EQ(where, std::this_thread::get_id());
  EXPECT_TRUE(task.under_way()) << "as with more, until it is waited for";
  task.wait();
  EXPECT_FALSE(task.under_way());
  set_thread_count(0);
}

TEST(BackgroundTask, HandsOnWhatTheWorkThrows) {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    BackgroundTask task;
    task.start([] { throw std::runtime_error("no memory"); });
    EXPECT_THROW(task.wait(), std::runtime_error);
    task.start([] {});
    EXPECT_NO_THROW(task.wait());
  }
  set_thread_count(0);
}

TEST(BackgroundTask, IsWaitedForByItsEnd) {
  set_thread_count(2);
  bool done = false;
  {
    BackgroundTask task;
    task.start([&] { done = true; });
  }
  EXPECT_TRUE(done);
  set_thread_count(0);
}

}  // namespace
}  // namespace rhexis::test
