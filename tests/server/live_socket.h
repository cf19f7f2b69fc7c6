#pragma once

/// A WebSocket at /live, by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "tests/server/socket.h"
#include "wire/frame.h"

namespace rhexis::test {

/// A frame of a WebSocket.
struct SocketFrame {
  int kind = 0;  ///< 0 goes on, 1 text, 2 binary, 8 close, 9 ping, 10 pong
  bool last = true;
  Socket::Bytes bytes;
};

class LiveSocket {
 public:
  explicit LiveSocket(std::uint16_t port, int receive_buffer = 0) : port_(port), socket_(port, receive_buffer) {}

  /// Empty headers: of a client that is no browser. The status of the answer, 101 when it is one of us.
  int shake_hands(const std::string& headers = {}, const std::string& target = "/live", std::string host = {}) {
    if (host.empty()) host = "127.0.0.1:" + std::to_string(port_);
    socket_.send("GET " + target + " HTTP/1.1\r\nHost: " + host +
                 "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                 "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                 headers + "\r\n");
    return status_of(socket_.receive_until("\r\n\r\n"));
  }

  bool send(int kind, std::span<const std::uint8_t> bytes, bool last = true) {
    Socket::Bytes out{static_cast<std::uint8_t>(kind | (last ? 0x80 : 0))};
    if (bytes.size() < 126) {
      out.push_back(static_cast<std::uint8_t>(0x80 | bytes.size()));
    } else {
      const int width = bytes.size() < 65536 ? 2 : 8;
      out.push_back(static_cast<std::uint8_t>(0x80 | (width == 2 ? 126 : 127)));
      for (int k = width - 1; k >= 0; --k) out.push_back(static_cast<std::uint8_t>(bytes.size() >> (8 * k)));
    }
    const std::uint8_t mask[4] = {0x12, 0x34, 0x56, 0x78};
    out.insert(out.end(), mask, mask + 4);
    for (std::size_t k = 0; k < bytes.size(); ++k) out.push_back(bytes[k] ^ mask[k % 4]);
    return socket_.send(out);
  }
  template <typename PayloadT>
  bool say(PayloadT payload) {
    return send(2, wire::encode(std::move(payload))->bytes);
  }

  std::optional<SocketFrame> receive(milliseconds patience = milliseconds(5000)) {
    const auto head = socket_.receive(2, patience);
    if (!head) return std::nullopt;
    std::size_t size = (*head)[1] & 0x7f;
    if (size >= 126) {
      const auto more = socket_.receive(size == 126 ? 2 : 8, patience);
      if (!more) return std::nullopt;
      size = 0;
      for (const std::uint8_t byte : *more) size = size << 8 | byte;
    }
    auto bytes = socket_.receive(size, patience);
    if (!bytes) return std::nullopt;
    return SocketFrame{(*head)[0] & 0x0f, ((*head)[0] & 0x80) != 0, std::move(*bytes)};
  }

  /// The next frame of ours, pings answered. Null: none came in time, or the server took its leave (close_code).
  std::unique_ptr<wire::FrameT> hear(milliseconds patience = milliseconds(5000)) {
    Socket::Bytes whole;
    // Pings come as long as the server lives: they do not make the patience longer.
    const auto until = std::chrono::steady_clock::now() + patience;
    const auto left = [&] {
      return std::max(milliseconds(0),
                      std::chrono::duration_cast<milliseconds>(until - std::chrono::steady_clock::now()));
    };
    while (const auto part = receive(left())) {
      if (part->kind == 9) send(10, part->bytes);
      if (part->kind == 8) {
        if (part->bytes.size() >= 2) close_code = part->bytes[0] << 8 | part->bytes[1];
        if (part->bytes.size() > 2) close_reason.assign(part->bytes.begin() + 2, part->bytes.end());
        send(8, std::span(part->bytes).first(std::min<std::size_t>(2, part->bytes.size())));
        return nullptr;
      }
      if (part->kind > 2) continue;
      whole.insert(whole.end(), part->bytes.begin(), part->bytes.end());
      if (!part->last) continue;
      auto frame = wire::decode(whole);
      EXPECT_TRUE(frame.has_value());
      return frame ? std::move(*frame) : nullptr;
    }
    return nullptr;
  }
  /// The next of one kind; others on the way to it are thrown away.
  std::unique_ptr<wire::FrameT> hear(wire::Payload kind, milliseconds patience = milliseconds(5000)) {
    auto frame = hear(patience);
    while (frame != nullptr && frame->payload.type != kind) frame = hear(patience);
    return frame;
  }
  /// Reads until the server takes its leave.
  int hear_the_end(milliseconds patience = milliseconds(5000)) {
    while (hear(patience) != nullptr) {
    }
    return close_code;
  }

  Socket& socket() { return socket_; }

  int close_code = 0;  ///< 0: not closed yet
  std::string close_reason;

 private:
  std::uint16_t port_;
  Socket socket_;
};

}  // namespace rhexis::test
