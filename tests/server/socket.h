#pragma once

/// A client of the server that shares no code with it: bytes on a socket, and WebSocket frames as RFC 6455 has them.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace rhexis::test {

using std::chrono::milliseconds;

class Socket {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// `receive_buffer`: bytes the kernel keeps for us unread; 0: as many as it likes.
  explicit Socket(std::uint16_t port, int receive_buffer = 0) : file_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) ::setsockopt(file_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
    const int at_once = 1;  // a second small frame does not wait for the answer to the first
    ::setsockopt(file_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~Socket() { hang_up(); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  Socket(Socket&& other) noexcept
      : file_(std::exchange(other.file_, -1)), connected_(other.connected_), read_(std::move(other.read_)) {}
  Socket& operator=(Socket&&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }
  void hang_up() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }
  /// False: the other side has hung up.
  bool send(std::span<const std::uint8_t> bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
    return true;
  }
  bool send(const std::string& text) const {
    return send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  /// `count` bytes; nothing: the other side hung up, or took too long.
  std::optional<Bytes> receive(std::size_t count, milliseconds patience = milliseconds(5000)) {
    if (!fill(count, patience)) return std::nullopt;
    Bytes bytes(read_.begin(), read_.begin() + static_cast<std::ptrdiff_t>(count));
    read_.erase(read_.begin(), read_.begin() + static_cast<std::ptrdiff_t>(count));
    return bytes;
  }
  /// All until the other side hangs up or is silent for so long.
  std::string receive_all(milliseconds patience = milliseconds(5000)) {
    while (more(patience)) {
    }
    return {read_.begin(), read_.end()};
  }
  /// Up to and with `end`; what was read when it did not come.
  std::string receive_until(const std::string& end, milliseconds patience = milliseconds(5000)) {
    while (true) {
      const std::string text(read_.begin(), read_.end());
      const std::size_t found = text.find(end);
      if (found != std::string::npos) {
        read_.erase(read_.begin(), read_.begin() + static_cast<std::ptrdiff_t>(found + end.size()));
        return text.substr(0, found + end.size());
      }
      if (!more(patience)) return text;
    }
  }
  /// True: the other side hung up within that time (what it sent before is read away).
  bool ends_within(milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (true) {
      const auto left = std::chrono::duration_cast<milliseconds>(end - std::chrono::steady_clock::now());
      if (left.count() <= 0) return false;
      if (!more(left)) return hung_up_;
    }
  }

 private:
  bool more(milliseconds patience) {
    pollfd ready{file_, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(patience.count())) <= 0) return false;
    std::uint8_t part[65536];
    const ssize_t count = ::recv(file_, part, sizeof(part), 0);
    hung_up_ = count <= 0;
    if (hung_up_) return false;
    read_.insert(read_.end(), part, part + count);
    return true;
  }
  bool fill(std::size_t count, milliseconds patience) {
    while (read_.size() < count)
      if (!more(patience)) return false;
    return true;
  }

  int file_;
  bool connected_ = false;
  bool hung_up_ = false;
  Bytes read_;
};

/// The other side's answer to one request, whole.
inline std::string ask(std::uint16_t port, const std::string& method, const std::string& target,
                       const std::string& headers = {}, std::string host = {}) {
  if (host.empty()) host = "127.0.0.1:" + std::to_string(port);
  Socket socket(port);
  socket.send(method + " " + target + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n" + headers + "\r\n");
  return socket.receive_all();
}

/// "200" of "HTTP/1.1 200 OK"; 0: no answer.
inline int status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") && answer.size() > 12 ? std::stoi(answer.substr(9, 3)) : 0;
}

inline std::string body_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  return end == std::string::npos ? std::string() : answer.substr(end + 4);
}

}  // namespace rhexis::test
