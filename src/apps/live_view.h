#pragma once

/// What `rhexis play` and `rhexis replay` share: the page on a port, until Ctrl-C.

#include <functional>
#include <memory>
#include <string>

#include "apps/command.h"
#include "server/server.h"

namespace rhexis::apps {

struct LiveViewOptions {
  int port = 8080;
  std::string address = "127.0.0.1";
  std::string token;
  std::string page;  ///< folder; empty: beside the program
  std::string recordings = "out/recordings";
  bool no_browser = false;
};

[[nodiscard]] std::shared_ptr<LiveViewOptions> add_live_view_options(CLI::App& command);

/// Where the stream goes: to the server, which can only be made when there is something to serve.
class Relay final : public session::FrameSink {
 public:
  /// Before the stream begins.
  void set(session::FrameSink& to) { to_ = &to; }
  void take(const wire::SharedMessage& message) override { to_->take(message); }

 private:
  session::FrameSink* to_ = nullptr;
};

/// A server for the page that runs, and hears what goes through `relay`. Errors: of the options; a port that is taken.
[[nodiscard]] Expected<std::unique_ptr<server::Server>> listen(const LiveViewOptions& options,
                                                               session::CommandTarget& target, Relay& relay);
/// In a browser, unless the options say not to.
void show_page(const LiveViewOptions& options, const server::Server& server);

/// Listens, starts, says where, waits for Ctrl-C, stops. `start`: the stream begins.
int serve(const LiveViewOptions& options, const Common& common, session::CommandTarget& target, Relay& relay,
          const std::function<Expected<void>()>& start, const std::function<void()>& stop);

}  // namespace rhexis::apps
