// Code for AVX must never reach a processor without it: what the linker could merge.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "base/instruction_set.h"
#include "element/tet_kernels.h"

namespace rhexis::test {
namespace {

TEST(InstructionSet, EachHasItsKernelsAndTheChosenOneIsInForce) {
  for (const std::string_view name : kInstructionSets) {
    const element::TetKernels* const kernels = element::find_tet_kernels(name);
    ASSERT_EQ(kernels != nullptr, runs_instruction_set(name)) << name;
    if (kernels == nullptr) continue;
    EXPECT_EQ(kernels->instruction_set, name);
  }
  EXPECT_EQ(element::find_tet_kernels("mmx"), nullptr);
  EXPECT_EQ(element::tet_kernels().instruction_set, instruction_set());
}

/// A weak or global function of these objects could be the copy that the linker keeps for everyone.
TEST(InstructionSet, KernelObjectsExportTheirTableAlone) {
  const std::filesystem::path library =
      std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "librhexis_element.a";
  if (!std::filesystem::exists(library)) GTEST_SKIP() << "not here: " << library;
  const std::string command = "nm -C --defined-only '" + library.string() + "' 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  ASSERT_NE(pipe, nullptr);
  std::array<char, 4096> line{};
  bool inside = false;
  int tables = 0, symbols = 0;
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe.get()) != nullptr) {
    const std::string text(line.data());
    if (text.find(".o:") != std::string::npos) {
      inside = text.find("_avx") != std::string::npos;
      continue;
    }
    if (!inside || text.size() < 20) continue;
    ++symbols;
    const char kind = text[17];
    if (std::string("tdrbn").find(kind) != std::string::npos) continue;  // local to its object
    // A pointer to the C++ runtime, not code; ThreadSanitizer, which sees exceptions off, brings it in.
    if (kind == 'V' && text.find(" DW.ref.") != std::string::npos) continue;
    EXPECT_NE(text.find("::make_tet_kernels()"), std::string::npos) << text;
    ++tables;
  }
  if (symbols == 0) GTEST_SKIP() << "nm said nothing, or not x86";
  EXPECT_EQ(tables, 2);
}

}  // namespace
}  // namespace rhexis::test
