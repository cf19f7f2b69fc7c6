#include "server/http_connection.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "server/live_client.h"

namespace rhexis::server {

namespace beast = boost::beast;
namespace http = beast::http;

namespace {

std::string_view as_view(beast::string_view text) { return {text.data(), text.size()}; }

Visit visit_of(const http::request<http::empty_body>& request) {
  Visit visit;
  // Of two hosts nobody can say which is meant.
  if (request.count(http::field::host) == 1) visit.host = as_view(request[http::field::host]);
  if (request.count(http::field::origin) > 0) visit.origin = as_view(request[http::field::origin]);
  visit.target = as_view(request.target());
  visit.cookies = as_view(request[http::field::cookie]);
  return visit;
}

std::string_view refusal(Verdict verdict) {
  switch (verdict) {
    case Verdict::foreign_host: return "this server is not known by that name: open the address that `rhexis` printed";
    case Verdict::foreign_origin: return "a page of another server may not talk to this one";
    default: return "open the address that `rhexis` printed, with its token";
  }
}

/// What the page may load and who may show it. `token` is part of its address, which therefore is told to nobody.
void set_policy(http::fields& fields) {
  fields.set("Content-Security-Policy",
             "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; object-src 'none'; "
             "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("X-Frame-Options", "DENY");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
  fields.set("Cross-Origin-Opener-Policy", "same-origin");
  fields.set(http::field::server, "rhexis");
}

}  // namespace

HttpConnection::HttpConnection(boost::asio::ip::tcp::socket&& socket, Shared& shared, Connections& connections)
    : stream_(std::move(socket)),
      shared_(shared),
      connections_(connections),
      place_(connections, [this] { end(); }),
      said_(2 * shared.limits.header_bytes) {}

void HttpConnection::read() {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(shared_.limits.header_bytes));
  stream_.expires_after(shared_.limits.request_time);
  http::async_read_header(stream_, said_, *parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (!error) return self->answer(self->parser_->release());
    Request none;
    none.version(11);
    none.keep_alive(false);
    if (error == http::error::header_limit)
      return self->send_text(none, http::status::request_header_fields_too_large, "too long a request");
    // Of what is no HTTP a line says so; one who has gone, or never said anything, gets none.
    if (error.category() == make_error_code(http::error::bad_method).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message)
      return self->send_text(none, http::status::bad_request, "not a request");
    self->end();
  });
}

void HttpConnection::answer(Request request) {
  const Visit visit = visit_of(request);
  const Verdict verdict = shared_.gate.judge(visit);
  if (verdict != Verdict::let_in) return send_text(request, http::status::forbidden, std::string(refusal(verdict)));
  if (request.has_content_length() || request.chunked()) {
    request.keep_alive(false);  // what follows is not read
    return send_text(request, http::status::bad_request, "a request with a body");
  }
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return send_text(request, http::status::method_not_allowed, "only GET and HEAD");
  const std::string_view path = visit.target.substr(0, visit.target.find('?'));
  if (path == "/live") {
    if (!beast::websocket::is_upgrade(request))
      return send_text(request, http::status::upgrade_required, "a WebSocket is spoken here");
    return std::make_shared<LiveClient>(std::move(stream_), shared_, connections_)->start(std::move(request));
  }
  const std::optional<ServedFile> file = shared_.files.find(visit.target);
  if (!file) return send_text(request, http::status::not_found, "there is no such file");
  send_file(request, *file, shared_.gate.cookie(visit));
}

void HttpConnection::send_file(const Request& request, const ServedFile& file, const std::string& cookie) {
  const auto fill = [&](auto& response) {
    set_policy(response);
    response.version(request.version());
    response.keep_alive(request.keep_alive());
    response.set(http::field::etag, file.tag);
    response.set(http::field::cache_control, "no-cache");
    if (!cookie.empty()) response.set(http::field::set_cookie, cookie);
    if (file.download)
      response.set(http::field::content_disposition,
                   fmt::format("attachment; filename=\"{}\"", file.path.filename().string()));
  };
  if (as_view(request[http::field::if_none_match]) == file.tag) {
    http::response<http::empty_body> response(http::status::not_modified, request.version());
    fill(response);
    return send(std::move(response));
  }
  if (request.method() == http::verb::head) {
    http::response<http::empty_body> response(http::status::ok, request.version());
    fill(response);
    response.set(http::field::content_type, file.type);
    response.content_length(file.bytes);
    return send(std::move(response));
  }
  http::response<http::file_body> response(http::status::ok, request.version());
  ErrorCode error;
  response.body().open(file.path.c_str(), beast::file_mode::scan, error);
  if (error) return send_text(request, http::status::not_found, "there is no such file");
  fill(response);
  response.set(http::field::content_type, file.type);
  response.content_length(response.body().size());
  send(std::move(response));
}

void HttpConnection::send_text(const Request& request, http::status status, const std::string& text) {
  http::response<http::string_body> response(status, request.version());
  set_policy(response);
  response.keep_alive(request.keep_alive());
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.set(http::field::cache_control, "no-store");
  if (status == http::status::method_not_allowed) response.set(http::field::allow, "GET, HEAD");
  if (status == http::status::upgrade_required) response.set(http::field::upgrade, "websocket");
  response.body() = "rhexis: " + text + "\n";
  response.prepare_payload();
  if (request.method() == http::verb::head) response.body().clear();  // its length stays
  send(std::move(response));
}

template <typename Body>
void HttpConnection::send(http::response<Body> response) {
  stream_.expires_after(shared_.limits.answer_time);
  auto going_out = std::make_shared<http::response<Body>>(std::move(response));
  http::async_write(stream_, *going_out, [self = shared_from_this(), going_out](ErrorCode error, std::size_t) {
    if (error || going_out->need_eof()) return self->end();
    self->read();
  });
}

void HttpConnection::end() {
  ErrorCode ignored;
  stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  stream_.close();
}

}  // namespace rhexis::server
