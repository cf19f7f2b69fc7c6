#pragma once

/// What a client may cost: every bound of the server, in one place. docs/live-protocol.md repeats them.

#include <chrono>
#include <cstddef>

namespace rhexis::server {

struct Limits {
  std::size_t connections = 128;        ///< at once, of every kind; one more is closed as it comes
  std::size_t clients = 16;             ///< of them, that follow the interaction
  std::size_t header_bytes = 8 * 1024;  ///< of a request
  std::size_t frame_bytes = 64 * 1024;  ///< of a client's frame
  double frames_per_second = 1000.0;    ///< of a client, in the long run; above it is read more slowly
  double frames_at_once = 2000.0;

  /// What waits for a slow client beside the one newest State; above it the client is closed.
  std::size_t waiting_frames = 4096;
  std::size_t waiting_bytes = 64 * 1024 * 1024;
  /// Of the kernel, for each connection: small, so that what waits does so here, where the old State makes way.
  int send_buffer_bytes = 256 * 1024;

  std::chrono::milliseconds request_time{10'000};  ///< from the first byte of a connection to a whole request
  std::chrono::milliseconds answer_time{60'000};   ///< for what was asked to be fetched; a recording is large
  std::chrono::milliseconds handshake_time{5'000};
  std::chrono::milliseconds silence{6'000};  ///< a client that is not heard of for so long is dead; pinged after half
  std::chrono::milliseconds close_time{1'000};  ///< for a client to take leave
};

}  // namespace rhexis::server
