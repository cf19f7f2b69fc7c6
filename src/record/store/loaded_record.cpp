#include "record/store/loaded_record.h"

#include <algorithm>
#include <utility>

#include "record/store/record_reader.h"

namespace rhexis::record::store {
namespace {

/// 1 per node that has a tet which is neither gone nor frozen.
void add_nodes_in_solve(const RecordHead& head, const TopologyData& topology, std::vector<std::uint8_t>& out) {
  std::vector<std::uint8_t> solved(head.tets.size() / 4, 1);
  for (const std::int32_t tet : topology.gone_tets) solved[static_cast<std::size_t>(tet)] = 0;
  for (const std::int32_t tet : topology.frozen_tets) solved[static_cast<std::size_t>(tet)] = 0;
  const std::size_t from = out.size();
  out.resize(from + head.nodes.size() / 3, 0);
  for (std::size_t k = 0; k < head.tets.size(); ++k) {
    if (solved[k / 4] != 0) out[from + static_cast<std::size_t>(head.tets[k])] = 1;
  }
}

}  // namespace

Expected<std::shared_ptr<const LoadedRecord>> LoadedRecord::read(const std::filesystem::path& path) {
  const Expected<RecordFile> file = RecordFile::open(path);
  if (!file) return fail(file.error());
  Expected<Record> record = file->read_record();
  if (!record) return fail(std::move(record.error()));
  std::shared_ptr<LoadedRecord> out(new LoadedRecord);
  out->record_ = std::move(*record);
  for (int number = 0; number < file->topologies(); ++number) {
    Expected<TopologyData> topology = file->read_topology(number);
    if (!topology) return fail(std::move(topology.error()));
    add_nodes_in_solve(out->head(), *topology, out->node_in_solve_);
    out->factor_.push_back(std::move(topology->factor));
  }
  return std::shared_ptr<const LoadedRecord>(std::move(out));
}

VectorX LoadedRecord::displacement_by(int topology, const VectorX& force) const {
  return std::visit(
      [&](const auto& values) { return store::displacement_by(head().pattern, std::span(values), force); },
      factor_[static_cast<std::size_t>(topology)]);
}

std::optional<int> LoadedRecord::point_of(std::int32_t node) const {
  const std::vector<std::int32_t>& points = head().points;
  const auto found = std::lower_bound(points.begin(), points.end(), node);
  if (found == points.end() || *found != node) return std::nullopt;
  return static_cast<int>(found - points.begin());
}

std::optional<Mat3> LoadedRecord::compliance(int topology, int point, int other) const {
  const std::array<std::int32_t, 2> edge{std::min(point, other), std::max(point, other)};
  const auto& edges = head().edges;
  const auto found = std::find(edges.begin(), edges.end(), edge);
  if (found == edges.end()) return std::nullopt;
  const std::size_t at =
      static_cast<std::size_t>(topology) * edges.size() + static_cast<std::size_t>(found - edges.begin());
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(record_.compliance.data() + 9 * at);
  return point < other ? Mat3(block) : Mat3(block.transpose());
}

std::size_t LoadedRecord::memory_bytes() const {
  std::size_t bytes = node_in_solve_.size() + record_.in_solve.size() + record_.flags.size() +
                      sizeof(double) * (record_.stiffness.size() + record_.compliance.size() + record_.rest.size());
  for (const auto& one : factor_)
    bytes += std::visit([](const auto& values) { return values.size() * sizeof(values.front()); }, one);
  return bytes;
}

}  // namespace rhexis::record::store
