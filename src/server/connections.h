#pragma once

/// Everything that one connection shares with all others. Used on the one thread of the server.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>

#include "server/gate.h"
#include "server/limits.h"
#include "server/lobby.h"
#include "server/served_files.h"

namespace rhexis::server {

struct Shared {
  Limits limits;
  Gate gate;
  ServedFiles files;
  Lobby lobby;
};

/// Which connections are open, and how to end each.
class Connections {
 public:
  /// One of them, as long as it lives.
  class Place {
   public:
    Place(Connections& all, std::function<void()> end) : all_(&all), number_(all.next_++) {
      all.open_.emplace(number_, std::move(end));
    }
    ~Place() { all_->open_.erase(number_); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

   private:
    Connections* all_;
    std::uint64_t number_;
  };

  [[nodiscard]] std::size_t size() const { return open_.size(); }
  void end_all() const {
    for (const auto& [number, end] : std::map(open_)) end();
  }

 private:
  std::map<std::uint64_t, std::function<void()>> open_;
  std::uint64_t next_ = 0;
};

}  // namespace rhexis::server
