#include "base/log.h"

#include <gtest/gtest.h>

namespace rhexis {
namespace {

std::string printed(Verbosity verbosity) {
  set_up_log(verbosity);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  spdlog::debug("detail");
  spdlog::info("step 1");
  spdlog::warn("slow");
  spdlog::error("broken");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << "stdout is for results";
  return testing::internal::GetCapturedStderr();
}

TEST(Log, PrintsPlainLinesByVerbosity) {
  EXPECT_EQ(printed(Verbosity::quiet), "rhexis: broken\n");
  EXPECT_EQ(printed(Verbosity::normal), "step 1\nrhexis: warning: slow\nrhexis: broken\n");
  EXPECT_EQ(printed(Verbosity::verbose), "detail\nstep 1\nrhexis: warning: slow\nrhexis: broken\n");
}

}  // namespace
}  // namespace rhexis
