#include "linalg/blas_kernels.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/instruction_set.h"

extern "C" char* openblas_get_corename();

namespace rhexis::linalg {

void begin_with_fitting_blas(char** argv) {
  constexpr const char* kNamed = "OPENBLAS_CORETYPE";
  constexpr std::string_view kOfUnknown = "Prescott";
  if (std::getenv(kNamed) != nullptr || openblas_get_corename() != kOfUnknown || !runs_instruction_set("avx2")) return;
  std::error_code unknown;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (unknown) return;
  setenv(kNamed, runs_instruction_set("avx512") ? "SkylakeX" : "Haswell", 1);
  execv(self.c_str(), argv);
}

}  // namespace rhexis::linalg
