#pragma once

/// One connection, request by request, until it becomes a client of the interaction or ends.

#include <memory>
#include <optional>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>

#include "server/connections.h"

namespace rhexis::server {

/// Keeps itself alive while something of it is under way.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  /// `shared` and `connections` outlive it.
  HttpConnection(boost::asio::ip::tcp::socket&& socket, Shared& shared, Connections& connections);
  void start() { read(); }

 private:
  using ErrorCode = boost::beast::error_code;
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  void read();
  void answer(Request request);
  void send_file(const Request& request, const ServedFile& file, const std::string& cookie);
  void send_text(const Request& request, boost::beast::http::status status, const std::string& text);
  /// Sends it, and reads the next request where the connection is kept.
  template <typename Body>
  void send(boost::beast::http::response<Body> response);
  void end();

  boost::beast::tcp_stream stream_;
  Shared& shared_;
  Connections& connections_;
  Connections::Place place_;
  boost::beast::flat_buffer said_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
};

}  // namespace rhexis::server
