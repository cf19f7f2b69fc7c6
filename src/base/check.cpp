#include "base/check.h"

#include <cstdio>
#include <cstdlib>

namespace rhexis {

void check_failed(const char* condition, const char* file, int line, const std::string& message) {
  fmt::print(stderr, "rhexis: {}:{}: internal check failed: {}: {}\n", file, line, condition, message);
  std::abort();
}

}  // namespace rhexis
