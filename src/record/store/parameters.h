#pragma once

/// What is varied in a record (section 2.5 of the method; Table 5.5 of the thesis), and how its topologies are
/// numbered.

#include <cstdint>
#include <span>
#include <vector>

namespace rhexis::record::store {

/// The defaults are those of the thesis.
struct Parameters {
  int advances = 2;                     ///< Ncp
  int directions = 13;                  ///< Ncd, of an advance, evenly over 0 to 180 degrees; one alone: 90
  std::vector<double> lengths{0.0403};  ///< Ncl, of an advance, m, ascending
  int pull_directions = 36;             ///< Nmd, evenly around from 0 degrees
  double pull_length = 0.12;            ///< m

  friend bool operator==(const Parameters&, const Parameters&) = default;
};

/// Degrees: 0 along x of the record's frame, 90 as the crack of the scene points. Ascending.
[[nodiscard]] std::vector<double> direction_angles(const Parameters& parameters);
/// Degrees, from x of the record's frame, counter-clockwise about its z. Ascending.
[[nodiscard]] std::vector<double> pull_angles(const Parameters& parameters);

/// One advance of a record, by the numbers of its direction and its length.
struct Choice {
  int direction = 0;
  int length = 0;
  friend bool operator==(const Choice&, const Choice&) = default;
};

/// More advances or topologies than this are no record.
inline constexpr int kMostAdvances = 8;
inline constexpr std::int64_t kMostTopologies = 1'000'000;

/// 0 is the body before its first advance. Then come those of one advance, those of two, ...; each level in the order
/// of its first advance, then of its second, ...; of an advance in the order of directions, then of lengths.
class Numbering {
 public:
  /// RHEXIS_CHECK: at most kMostAdvances, and count_of at most kMostTopologies.
  explicit Numbering(const Parameters& parameters);
  /// 1 + sum over i = 1..Ncp of (Ncd Ncl)^i; kMostTopologies + 1 when it is more than that, or Ncd Ncl alone is.
  [[nodiscard]] static std::int64_t count_of(const Parameters& parameters);

  [[nodiscard]] int count() const { return first_.back(); }
  [[nodiscard]] int advances() const { return static_cast<int>(first_.size()) - 2; }
  /// How many follow from one by one more advance.
  [[nodiscard]] int per_advance() const { return per_advance_; }
  /// Of at most advances() choices.
  [[nodiscard]] int number(std::span<const Choice> choices) const;
  [[nodiscard]] std::vector<Choice> choices(int number) const;
  [[nodiscard]] int level(int number) const;
  [[nodiscard]] int parent(int number) const;  ///< -1 of 0
  /// The topology after one more advance; `number` is below the last level.
  [[nodiscard]] int child(int number, Choice next) const;

 private:
  int lengths_;
  int per_advance_;
  std::vector<int> first_;  ///< of each level, and one beyond the last
};

}  // namespace rhexis::record::store
