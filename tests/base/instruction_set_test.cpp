#include "base/instruction_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace rhexis {
namespace {

TEST(InstructionSet, PortableIsAlwaysThereAndNonsenseIsNot) {
  EXPECT_TRUE(runs_instruction_set("portable"));
  EXPECT_FALSE(runs_instruction_set("mmx"));
  EXPECT_FALSE(runs_instruction_set(""));
}

TEST(InstructionSet, TheChosenOneIsTheWidestOrTheOneAskedFor) {
  const char* const asked = std::getenv("RHEXIS_SIMD");
  std::string expected = "portable";
  for (const char* name : {"avx2", "avx512"})
    if (runs_instruction_set(name)) expected = name;
  if (asked != nullptr && runs_instruction_set(asked)) expected = asked;
  EXPECT_EQ(instruction_set(), expected);
}

}  // namespace
}  // namespace rhexis
