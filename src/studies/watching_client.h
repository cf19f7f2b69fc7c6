#pragma once

/// A client of the live protocol, as a page is one: reads every frame, decodes it whole, notes when.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "wire/frame.h"

namespace rhexis::studies {

struct SeenState {
  std::int64_t at = 0;     ///< ns, when it was decoded
  std::uint64_t tick = 0;  ///< of the haptic loop that it contains
};

/// Of one client, all in all.
struct WatchRecord {
  std::vector<SeenState> states;
  std::size_t edits = 0;
  std::size_t bodies = 0;
  std::size_t bytes = 0;
  std::vector<std::string> notices;  ///< warnings and errors
  std::string trouble;               ///< why it did not stay to the end; empty: it did
};

/// What is known at the moment.
struct Glance {
  bool hand = false;  ///< it is this client that is heard
  std::size_t bodies = 0;
  std::size_t states = 0;  ///< of the last body
  std::uint32_t advances = 0;
  std::uint32_t pieces = 0;
  bool scripted = false;
  wire::RatesT rates;
  bool gone = false;  ///< the connection has ended
};

class WatchingClient {
 public:
  /// Errors: nobody listens, or does not speak the protocol.
  static Expected<std::unique_ptr<WatchingClient>> connect(std::uint16_t port);
  ~WatchingClient();
  WatchingClient(const WatchingClient&) = delete;
  WatchingClient& operator=(const WatchingClient&) = delete;

  /// From any thread.
  void say(wire::SharedMessage message);
  [[nodiscard]] Glance glance() const;
  /// Hangs up, if the server has not. Once.
  [[nodiscard]] WatchRecord end();

 private:
  class Link;
  explicit WatchingClient(std::unique_ptr<Link> link);
  std::unique_ptr<Link> link_;
};

}  // namespace rhexis::studies
