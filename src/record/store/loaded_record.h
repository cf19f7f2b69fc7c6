#pragma once

/// A whole record in memory: what is looked up at the haptic rate, and the global operators.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "base/error.h"
#include "record/store/record.h"

namespace rhexis::record::store {

class LoadedRecord {
 public:
  /// Errors: as RecordFile.
  static Expected<std::shared_ptr<const LoadedRecord>> read(const std::filesystem::path& path);

  [[nodiscard]] const Record& record() const { return record_; }
  [[nodiscard]] const RecordHead& head() const { return record_.head; }

  /// Displacement (m) by forces (N) in a topology, (4.5): both 3 per node; held dofs come out zero. Forces on nodes out
  /// of the solve are not for it.
  [[nodiscard]] VectorX displacement_by(int topology, const VectorX& force) const;
  /// Of any node.
  [[nodiscard]] bool is_in_solve(int topology, std::int32_t node) const {
    return node_in_solve_[static_cast<std::size_t>(topology) * nodes() + static_cast<std::size_t>(node)] != 0;
  }
  /// Number of the grasp point that a node is; empty: none.
  [[nodiscard]] std::optional<int> point_of(std::int32_t node) const;
  /// L_ij between two grasp points in a topology, m/N; empty where they share no edge of the intact surface.
  [[nodiscard]] std::optional<Mat3> compliance(int topology, int point, int other) const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  LoadedRecord() = default;
  [[nodiscard]] std::size_t nodes() const { return record_.head.nodes.size() / 3; }

  Record record_;
  std::vector<std::variant<std::vector<double>, std::vector<float>>> factor_;  ///< per topology
  std::vector<std::uint8_t> node_in_solve_;                                    ///< topologies x nodes
};

}  // namespace rhexis::record::store
