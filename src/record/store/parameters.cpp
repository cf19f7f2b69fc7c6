#include "record/store/parameters.h"

#include <algorithm>

#include "base/check.h"

namespace rhexis::record::store {

std::vector<double> direction_angles(const Parameters& parameters) {
  if (parameters.directions == 1) return {90.0};
  std::vector<double> out;
  for (int k = 0; k < parameters.directions; ++k) out.push_back(180.0 * k / (parameters.directions - 1));
  return out;
}

std::vector<double> pull_angles(const Parameters& parameters) {
  std::vector<double> out;
  for (int k = 0; k < parameters.pull_directions; ++k) out.push_back(360.0 * k / parameters.pull_directions);
  return out;
}

std::int64_t Numbering::count_of(const Parameters& parameters) {
  const auto each = std::int64_t{parameters.directions} * static_cast<std::int64_t>(parameters.lengths.size());
  if (each > kMostTopologies) return kMostTopologies + 1;
  std::int64_t level = 1;
  std::int64_t sum = 1;
  for (int k = 0; k < parameters.advances; ++k) {
    if (each == 0 || level > kMostTopologies / each) return kMostTopologies + 1;
    level *= each;
    sum += level;
  }
  return std::min(sum, kMostTopologies + 1);
}

Numbering::Numbering(const Parameters& parameters)
    : lengths_(static_cast<int>(parameters.lengths.size())), per_advance_(parameters.directions * lengths_) {
  RHEXIS_CHECK(parameters.advances <= kMostAdvances && count_of(parameters) <= kMostTopologies, "{} advances of {}",
               parameters.advances, per_advance_);
  first_ = {0, 1};
  for (int k = 0; k < parameters.advances; ++k)
    first_.push_back(first_.back() + (first_.back() - first_[first_.size() - 2]) * per_advance_);
}

int Numbering::number(std::span<const Choice> choices) const {
  int place = 0;
  for (const Choice& choice : choices) place = place * per_advance_ + choice.direction * lengths_ + choice.length;
  return first_[choices.size()] + place;
}

int Numbering::level(int number) const {
  return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), number) - first_.begin()) - 1;
}

int Numbering::parent(int number) const {
  const auto on = static_cast<std::size_t>(level(number));
  return on == 0 ? -1 : first_[on - 1] + (number - first_[on]) / per_advance_;
}

int Numbering::child(int number, Choice next) const {
  const auto on = static_cast<std::size_t>(level(number));
  return first_[on + 1] + (number - first_[on]) * per_advance_ + next.direction * lengths_ + next.length;
}

std::vector<Choice> Numbering::choices(int number) const {
  const auto on = static_cast<std::size_t>(level(number));
  std::vector<Choice> out(on);
  int place = number - first_[on];
  for (std::size_t k = on; k-- > 0; place /= per_advance_) out[k] = {place % per_advance_ / lengths_, place % lengths_};
  return out;
}

}  // namespace rhexis::record::store
