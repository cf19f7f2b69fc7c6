#include "studies/watching_client.h"

#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket.hpp>

#include "studies/probed_device.h"

namespace rhexis::studies {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

namespace {

/// Of one frame: the Body of the largest plate is a few of it.
constexpr std::size_t kMostBytes = std::size_t{1} << 28;

}  // namespace

class WatchingClient::Link {
 public:
  ErrorCode connect(std::uint16_t port) {
    ErrorCode error;
    tcp::socket& socket = beast::get_lowest_layer(socket_).socket();
    socket.connect({asio::ip::address_v4::loopback(), port}, error);
    if (!error) socket.set_option(tcp::no_delay(true), error);
    if (!error) socket_.handshake(fmt::format("127.0.0.1:{}", port), "/live", error);
    socket_.binary(true);
    socket_.read_message_max(kMostBytes);
    return error;
  }
  void start() {
    read();
    thread_ = std::thread([this] { io_.run(); });
  }
  WatchRecord end() {
    asio::post(io_, [this] {
      ends_ = true;
      ErrorCode ignored;
      beast::get_lowest_layer(socket_).socket().close(ignored);
    });
    thread_.join();
    return std::move(record_);
  }
  void say(wire::SharedMessage message) {
    asio::post(io_, [this, message = std::move(message)] {
      waiting_.push_back(message);
      if (waiting_.size() == 1) write();
    });
  }
  [[nodiscard]] Glance glance() const {
    const std::lock_guard lock(mutex_);
    return glance_;
  }
  [[nodiscard]] bool runs() const { return thread_.joinable(); }

 private:
  void read() {
    socket_.async_read(said_, [this](ErrorCode error, std::size_t bytes) {
      if (error) return lose(error.message());
      const auto frame = wire::decode({static_cast<const std::uint8_t*>(said_.data().data()), bytes});
      if (!frame) return lose(frame.error().message());
      record_.bytes += bytes;
      hear((*frame)->payload);
      said_.consume(bytes);
      read();
    });
  }
  void write() {
    socket_.async_write(asio::buffer(waiting_.front()->bytes), [this](ErrorCode error, std::size_t) {
      if (error) return;  // the read will say so
      waiting_.pop_front();
      if (!waiting_.empty()) write();
    });
  }
  void lose(const std::string& why) {
    if (!ends_) record_.trouble = why;
    const std::lock_guard lock(mutex_);
    glance_.gone = true;
  }
  void hear(const wire::PayloadUnion& said) {
    const std::lock_guard lock(mutex_);
    switch (said.type) {
      case wire::Payload::Role: glance_.hand = said.AsRole()->hand; break;
      case wire::Payload::Edit: ++record_.edits; break;
      case wire::Payload::Body:
        glance_.bodies = ++record_.bodies;
        glance_.states = 0;
        break;
      case wire::Payload::Notice:
        if (said.AsNotice()->level != wire::Level::info) record_.notices.push_back(said.AsNotice()->text);
        break;
      case wire::Payload::State: {
        const wire::StateT& state = *said.AsState();
        record_.states.push_back({.at = now_ns(), .tick = state.tick});
        ++glance_.states;
        glance_.advances = state.advances;
        glance_.pieces = state.pieces;
        glance_.scripted = state.scripted;
        if (state.rates) glance_.rates = *state.rates;
        break;
      }
      default: break;
    }
  }

  asio::io_context io_{1};
  beast::websocket::stream<beast::tcp_stream> socket_{io_};
  beast::flat_buffer said_;
  std::deque<wire::SharedMessage> waiting_;
  WatchRecord record_;
  bool ends_ = false;
  mutable std::mutex mutex_;
  Glance glance_;
  std::thread thread_;
};

WatchingClient::WatchingClient(std::unique_ptr<Link> link) : link_(std::move(link)) {}
WatchingClient::~WatchingClient() {
  if (link_->runs()) static_cast<void>(link_->end());
}

Expected<std::unique_ptr<WatchingClient>> WatchingClient::connect(std::uint16_t port) {
  auto link = std::make_unique<Link>();
  if (const ErrorCode error = link->connect(port); error)
    return fail(fmt::format("a client cannot connect to port {}: {}", port, error.message()));
  link->start();
  return std::unique_ptr<WatchingClient>(new WatchingClient(std::move(link)));
}

void WatchingClient::say(wire::SharedMessage message) { link_->say(std::move(message)); }
Glance WatchingClient::glance() const { return link_->glance(); }
WatchRecord WatchingClient::end() { return link_->end(); }

}  // namespace rhexis::studies
