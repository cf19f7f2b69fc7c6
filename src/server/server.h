#pragma once

/// The live view: one port, where a browser gets the page, and its WebSocket at /live the interaction. What it speaks,
/// and whom it lets in, is in docs/live-protocol.md.

#include <memory>
#include <string>

#include "base/error.h"
#include "server/settings.h"
#include "session/frame_sink.h"

namespace rhexis::server {

/// All of it runs on one thread of its own.
class Server : public session::FrameSink {
 public:
  /// Listens, but answers nobody before start(). `target` outlives the server. Errors: the port is taken or not ours,
  /// an address that is none, an address beyond this machine without a token, no page.
  static Expected<std::unique_ptr<Server>> listen(const ServerSettings& settings, session::CommandTarget& target);
  ~Server() override;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void start();
  /// Clients are told, and gone when it returns. Once stopped it does not start again.
  void stop();

  /// From any thread, also before start() and after stop(): never waits for a client.
  void take(const wire::SharedMessage& message) override;

  /// What a browser is to open, the token in it.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint16_t port() const;

 private:
  class Engine;
  explicit Server(std::unique_ptr<Engine> engine);

  std::unique_ptr<Engine> engine_;
};

}  // namespace rhexis::server
