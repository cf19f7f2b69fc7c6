#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "model/make_model.h"

namespace rhexis::test {

/// As a suite of tests over models names its cases.
inline std::string model_case_name(const testing::TestParamInfo<model::ModelKind>& tested) {
  std::string name(model::kModelNames[static_cast<std::size_t>(tested.param)]);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace rhexis::test
