// Any bytes as a precomputed record. The first bit chooses: the file itself, where HDF5 is met first (see vtkhdf.cpp),
// or what a good file holds (the second bit: in single precision), so that mutations reach what our own reader does
// with it. What is let through has to bear being used: looked up, and displaced.

#include <algorithm>
#include <cmath>
#include <functional>

#include "fuzz/record_parts.h"
#include "record/store/reaction.h"
#include "record/store/record_reader.h"

namespace {

using namespace rhexis;
using namespace rhexis::record;

/// Each is as much work as the whole file is.
constexpr int kMostTopologies = 8;

void check_topology(const store::RecordHead& head, const store::TopologyData& data) {
  const auto ascend_below = [](const std::vector<std::int32_t>& list, std::size_t end) {
    return std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end() &&
           (list.empty() || (list.front() >= 0 && static_cast<std::size_t>(list.back()) < end));
  };
  RHEXIS_CHECK(
      ascend_below(data.moved_nodes, head.nodes.size() / 3) && data.moved_to.size() == 3 * data.moved_nodes.size() &&
          ascend_below(data.gone_tets, head.tets.size() / 4) && ascend_below(data.frozen_tets, head.tets.size() / 4),
      "edits of what does not exist");
  std::visit(
      [&]<class Value>(const std::vector<Value>& factor) {
        RHEXIS_CHECK(factor.size() == head.pattern.entries(), "a factor of another pattern");
        for (std::int32_t j = 0; j < head.pattern.rows(); ++j)
          RHEXIS_CHECK(factor[static_cast<std::size_t>(head.pattern.start[static_cast<std::size_t>(j)])] > 0,
                       "a factor that is none");
        const VectorX force = VectorX::Ones(static_cast<Eigen::Index>(head.nodes.size()));
        (void)store::displacement_by<Value>(head.pattern, factor, force);
      },
      data.factor);
}

void look_up(const store::Record& record) {
  const store::Lookup lookup(record);
  const std::vector<store::Advanced> advances{{80.0, record.head.parameters.lengths.front()}, {200.0, 1.0}, {0.0, 0.0}};
  for (std::size_t count = 0; count <= advances.size(); ++count) {
    const std::span some(advances.data(), count);
    RHEXIS_CHECK(lookup.nearest(some).topology < static_cast<int>(record.flags.size()),
                 "a topology that does not exist");
    for (std::size_t point = 0; point < record.head.points.size(); ++point)
      (void)lookup.reaction(some, static_cast<int>(point), {0.01, -0.02, 0.03});
  }
}

void read_record(const std::string& path) {
  const Expected<store::RecordFile> file = store::RecordFile::open(path);
  if (!file) {
    RHEXIS_CHECK(!file.error().what.empty() && file.error().file == path, "an error without a place");
    return;
  }
  const store::RecordHead& head = file->head();
  for (const double x : head.nodes) RHEXIS_CHECK(std::isfinite(x), "a node that is nowhere");
  for (const std::int32_t node : head.tets)
    RHEXIS_CHECK(node >= 0 && static_cast<std::size_t>(node) < head.nodes.size() / 3, "a node that does not exist");
  if (const Expected<store::Record> record = file->read_record()) look_up(*record);
  for (int t = 0; t < std::min(file->topologies(), kMostTopologies); ++t) {
    if (const Expected<store::TopologyData> data = file->read_topology(t)) check_topology(head, *data);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto write = [](const std::string& path, std::uint8_t form, std::span<const std::uint8_t> input) {
    fuzz::write_record(path, fuzz::record_parts_of(input), (form & 2) != 0);
  };
  fuzz::read_as_file({data, size}, write, read_record);
  return 0;
}
