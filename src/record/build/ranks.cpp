#include "record/build/ranks.h"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace rhexis::record::build {
namespace {

std::optional<int> number_in(const char* variable) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  const char* const end = text + std::strlen(text);
  int value = 0;
  const auto [stop, code] = std::from_chars(text, end, value);
  return code == std::errc{} && stop == end ? std::optional<int>(value) : std::nullopt;
}

}  // namespace

Rank rank_of_this_process() {
  constexpr const char* kPairs[][2] = {
      {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, {"PMI_RANK", "PMI_SIZE"}, {"SLURM_PROCID", "SLURM_NTASKS"}};
  for (const auto& [rank_name, size_name] : kPairs) {
    const std::optional<int> rank = number_in(rank_name);
    const std::optional<int> size = number_in(size_name);
    if (rank && size && *rank >= 0 && *rank < *size) return {*rank, *size};
  }
  return {};
}

}  // namespace rhexis::record::build
