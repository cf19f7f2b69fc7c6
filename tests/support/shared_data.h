#pragma once

/// Real meshes and other programs' solutions lie beside the checkout, not in it; tests that read them skip without.

#include <gtest/gtest.h>

#include <filesystem>

namespace rhexis::test {

inline std::filesystem::path shared_dir() { return RHEXIS_SHARED_DIR; }

}  // namespace rhexis::test

#define RHEXIS_SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not here: " << (path).string()
