#include "linalg/metis_turn.h"

namespace rhexis::linalg {

std::unique_lock<std::mutex> take_metis_turn() {
  static std::mutex turn;
  return std::unique_lock(turn);
}

}  // namespace rhexis::linalg
