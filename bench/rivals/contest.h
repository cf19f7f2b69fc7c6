#pragma once

/// One law at one size: what Rhexis has for it, what Bullet has, and the converged answers of both.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/rivals/bar.h"
#include "bench/rivals/bullet_bar.h"

namespace rhexis::rivals {

/// Settings of Bullet, and in how many moves the hand goes to its place.
struct BulletEntry {
  BulletSettings settings;
  int moves = 1;
};
/// Those that were the best at some size and error; with `every` all that was tried, these first.
[[nodiscard]] std::vector<BulletEntry> bullet_entries(BulletLaw law, bool every);
/// For a hand that moves on.
[[nodiscard]] std::vector<BulletSettings> bullet_followers();

/// Tables as arrays of flat objects; times in ms. Null: an error or a time that was not reached, by Bullet before it
/// was longer than the best so far.
struct ContestTables {
  nlohmann::ordered_json rest = nlohmann::ordered_json::array();
  nlohmann::ordered_json moving = nlohmann::ordered_json::array();
  nlohmann::ordered_json converged = nlohmann::ordered_json::array();
};

/// m, where the hand takes the bar's end.
[[nodiscard]] Vec3 hand_at_rest();

/// Adds the rows of one law, and prints them. `every`: all settings of Bullet.
void contest(const Bar& bar, BulletLaw law, bool every, ContestTables& tables);
/// The converged answers beside CalculiX, where it is.
void compare_answers(const Bar& bar, ContestTables& tables);

}  // namespace rhexis::rivals
