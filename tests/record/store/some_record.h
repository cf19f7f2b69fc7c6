#pragma once

/// A record of made-up numbers.

#include <random>

#include "record/store/record.h"

namespace rhexis::record::store::test {

struct SomeRecord {
  RecordHead head;
  std::vector<TopologyData> topologies;

  /// As RecordFile::read_record gives it.
  [[nodiscard]] Record record() const {
    Record out{head, {}, {}, {}, {}, {}};
    const auto add = [](const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); };
    for (const TopologyData& one : topologies) {
      out.flags.push_back(one.flags);
      add(one.in_solve, out.in_solve);
      add(one.stiffness, out.stiffness);
      add(one.compliance, out.compliance);
      add(one.rest, out.rest);
    }
    return out;
  }
};

inline SomeRecord some_record(const Parameters& parameters, bool single_precision, bool has_loads) {
  std::mt19937_64 bits(7);
  const auto next = [&] { return static_cast<double>(bits() >> 11U) * 0x1p-53; };
  const auto fill = [&](std::size_t count) {
    std::vector<double> out(count);
    for (double& one : out) one = 0.5 + next();
    return out;
  };
  SomeRecord out;
  RecordHead& head = out.head;
  head.parameters = parameters;
  head.frame = {Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
  head.single_precision = single_precision;
  head.has_loads = has_loads;
  head.fingerprint = bits();
  head.program = "rhexis test";
  head.title = "Made up";
  head.nodes = fill(15);
  head.tets = {0, 1, 2, 3, 1, 2, 3, 4};
  head.points = {1, 2, 4};
  head.edges = {{0, 1}, {1, 2}};
  head.pattern = {{3, 4, 5, 6}, {0, 2, 4, 5, 6}, {0, 2, 1, 3, 2, 3}};
  for (int number = 0; number < Numbering(parameters).count(); ++number) {
    TopologyData one;
    one.flags = static_cast<std::uint8_t>(number % 3);
    one.in_solve = {1, static_cast<std::uint8_t>(number % 5 == 4 ? 0 : 1), 1};
    one.stiffness = fill(18);
    one.compliance = fill(18);
    if (has_loads) one.rest = fill(15);
    const std::vector<double> factor = fill(6);
    if (single_precision) {
      one.factor = std::vector<float>(factor.begin(), factor.end());
    } else {
      one.factor = factor;
    }
    for (int k = 0; k < number % 3; ++k) {
      one.moved_nodes.push_back(k + 1);
      for (int c = 0; c < 3; ++c) one.moved_to.push_back(next());
      one.gone_tets.push_back(k);
    }
    if (number == 2) one.frozen_tets = {1};
    out.topologies.push_back(std::move(one));
  }
  return out;
}

}  // namespace rhexis::record::store::test
