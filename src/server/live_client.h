#pragma once

/// One client at /live: frames out as fast as it takes them, what it says to the lobby.

#include <memory>
#include <string_view>

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket.hpp>

#include "server/connections.h"
#include "server/frame_queue.h"
#include "server/rate_limit.h"

namespace rhexis::server {

/// Keeps itself alive while something of it is under way.
class LiveClient : public Viewer, public std::enable_shared_from_this<LiveClient> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  /// `shared` and `connections` outlive it.
  LiveClient(boost::beast::tcp_stream&& stream, Shared& shared, Connections& connections);

  /// Answers the handshake, and comes into the lobby.
  void start(Request request);
  void send(const wire::SharedMessage& message) override;

 private:
  using ErrorCode = boost::beast::error_code;
  using CloseCode = boost::beast::websocket::close_code;
  /// `here`: in the lobby.
  enum class Stage { coming, here, leaving };

  void read();
  void took_in(ErrorCode error);
  void write();
  /// The server ends.
  void end();
  /// Takes leave with a reason, and hangs up when that takes too long. Once the handshake is done.
  void close(CloseCode code, std::string_view reason);
  /// Out of the lobby: the hand is free from here on.
  void leave();
  void hang_up();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  Shared& shared_;
  Connections::Place place_;
  boost::asio::steady_timer pause_;     ///< before the next frame is read
  boost::asio::steady_timer patience_;  ///< with its leave
  boost::beast::flat_buffer said_;
  RateLimit rate_;
  FrameQueue waiting_;
  wire::SharedMessage going_out_;  ///< null: nothing does
  Stage stage_ = Stage::coming;
};

}  // namespace rhexis::server
