#include "server/live_client.h"

#include <string>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/post.hpp>

#include "server/client_frame.h"

namespace rhexis::server {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;

namespace {

/// Of one write: what is longer goes in parts, between which a ping finds its place.
constexpr std::size_t kPartBytes = 64 * 1024;
/// Of a reason to close: what a control frame of a WebSocket holds.
constexpr std::size_t kReasonBytes = 123;

}  // namespace

LiveClient::LiveClient(beast::tcp_stream&& stream, Shared& shared, Connections& connections)
    : socket_(std::move(stream)),
      shared_(shared),
      place_(connections, [this] { end(); }),
      pause_(socket_.get_executor()),
      patience_(socket_.get_executor()),
      said_(shared.limits.frame_bytes),
      rate_(shared.limits.frames_per_second, shared.limits.frames_at_once, RateLimit::Clock::now()) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own
  socket_.set_option(websocket::stream_base::timeout{.handshake_timeout = shared.limits.handshake_time,
                                                     .idle_timeout = shared.limits.silence,
                                                     .keep_alive_pings = true});
  socket_.set_option(websocket::stream_base::decorator(
      [](websocket::response_type& response) { response.set(beast::http::field::server, "rhexis"); }));
  socket_.read_message_max(shared.limits.frame_bytes);
  socket_.write_buffer_bytes(kPartBytes);
  socket_.binary(true);
}

void LiveClient::start(Request request) {
  // The request has to live as long as its answer takes.
  auto asked = std::make_shared<Request>(std::move(request));
  socket_.async_accept(*asked, [self = shared_from_this(), asked](ErrorCode error) {
    if (error) return self->hang_up();
    if (self->shared_.lobby.size() >= self->shared_.limits.clients)
      return self->close(CloseCode::try_again_later,
                         fmt::format("{} clients are here, more are not taken", self->shared_.limits.clients));
    self->stage_ = Stage::here;
    self->shared_.lobby.join(*self);
    self->read();
  });
}

void LiveClient::read() {
  socket_.async_read(said_, [self = shared_from_this()](ErrorCode error, std::size_t) { self->took_in(error); });
}

void LiveClient::took_in(ErrorCode error) {
  if (error) return hang_up();
  if (stage_ != Stage::here) {
    said_.clear();  // taking leave: it is read only to find its answer to that
    return read();
  }
  if (!socket_.got_binary()) return close(CloseCode::unknown_data, "frames are binary");
  Expected<wire::PayloadUnion> frame =
      read_client_frame({static_cast<const std::uint8_t*>(said_.data().data()), said_.size()});
  if (!frame) return close(CloseCode::bad_payload, frame.error().message());
  said_.clear();
  shared_.lobby.hear(*this, std::move(*frame));
  const RateLimit::Clock::duration wait = rate_.count(RateLimit::Clock::now());
  if (wait <= RateLimit::Clock::duration::zero()) return read();
  pause_.expires_after(wait);
  pause_.async_wait([self = shared_from_this()](ErrorCode) { self->read(); });
}

void LiveClient::send(const wire::SharedMessage& message) {
  if (stage_ != Stage::here) return;
  waiting_.push(message);
  const Limits& limits = shared_.limits;
  if (waiting_.kept_frames() > limits.waiting_frames || waiting_.kept_bytes() > limits.waiting_bytes) {
    const std::string reason = fmt::format("too slow: {} frames wait", waiting_.kept_frames());
    // Not now: the lobby is going through its guests.
    return asio::post(socket_.get_executor(),
                      [self = shared_from_this(), reason] { self->close(CloseCode::try_again_later, reason); });
  }
  write();
}

void LiveClient::write() {
  if (going_out_ != nullptr || stage_ != Stage::here) return;
  going_out_ = waiting_.pop();
  if (going_out_ == nullptr) return;
  socket_.async_write(asio::buffer(going_out_->bytes), [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->going_out_ = nullptr;
    if (error) return self->hang_up();
    self->write();
  });
}

void LiveClient::end() {
  if (stage_ == Stage::coming) return hang_up();
  close(CloseCode::going_away, "rhexis ends");
}

void LiveClient::close(CloseCode code, std::string_view reason) {
  if (stage_ == Stage::leaving) return;
  leave();
  patience_.expires_after(shared_.limits.close_time);
  patience_.async_wait([self = shared_from_this()](ErrorCode cancelled) {
    if (!cancelled) self->hang_up();
  });
  const std::string_view short_enough = reason.substr(0, kReasonBytes);
  const websocket::close_reason why(code, beast::string_view(short_enough.data(), short_enough.size()));
  socket_.async_close(why, [self = shared_from_this()](ErrorCode) { self->hang_up(); });
}

void LiveClient::leave() {
  stage_ = Stage::leaving;
  shared_.lobby.leave(*this);
}

void LiveClient::hang_up() {
  leave();
  pause_.cancel();
  patience_.cancel();
  ErrorCode ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
}

}  // namespace rhexis::server
