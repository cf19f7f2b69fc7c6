#include "server/server.h"

#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/log.h"
#include "server/connections.h"
#include "server/frame_queue.h"
#include "server/http_connection.h"

namespace rhexis::server {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

namespace {

/// Before the next connection is accepted when the system has none to give.
constexpr std::chrono::milliseconds kShortOfFiles{100};

/// What the thread of the physics hands over. Whoever holds the lock moves pointers and does nothing else.
class Inbox {
 public:
  /// True: it was empty of news, so that somebody has to be told.
  bool push(const wire::SharedMessage& message) {
    const std::lock_guard lock(mutex_);
    queue_.push(message);
    return !std::exchange(told_, true);
  }
  FrameQueue take_all() {
    const std::lock_guard lock(mutex_);
    told_ = false;
    return std::exchange(queue_, {});
  }

 private:
  std::mutex mutex_;
  FrameQueue queue_;
  bool told_ = false;
};

}  // namespace

class Server::Engine {
 public:
  Engine(const ServerSettings& settings, const asio::ip::address& address, ServedFiles files,
         session::CommandTarget& target)
      : shared_{.limits = settings.limits,
                .gate = Gate(address.is_loopback(), settings.token),
                .files = std::move(files),
                .lobby = Lobby(target)},
        address_(address),
        token_(settings.token),
        acceptor_(io_),
        breath_(io_) {}
  ~Engine() { stop(); }
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  ErrorCode listen(const tcp::endpoint& endpoint) {
    ErrorCode error;
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);  // a port that was ours a moment ago
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (!error) port_ = acceptor_.local_endpoint(error).port();
    return error;
  }
  [[nodiscard]] std::string url() const {
    ErrorCode no_name;
    std::string host = address_.is_unspecified() ? asio::ip::host_name(no_name) : address_.to_string();
    if (address_.is_v6() && !address_.is_unspecified()) host = fmt::format("[{}]", host);
    return fmt::format("http://{}:{}/{}{}", host, port_, token_.empty() ? "" : "?token=", token_);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }

  void start() {
    accept();
    thread_ = std::thread([this] { run(); });
  }

  void stop() {
    if (!thread_.joinable()) return;
    asio::post(io_, [this] {
      ErrorCode ignored;
      acceptor_.close(ignored);
      breath_.cancel();
      deliver();
      connections_.end_all();
      // Nothing new begins, and each of them hangs up in its time: then run() has no work left and returns.
    });
    thread_.join();
  }

  void take(const wire::SharedMessage& message) {
    if (inbox_.push(message)) asio::post(io_, [this] { deliver(); });
  }

 private:
  void run() {
    while (true) {
      try {
        io_.run();
        return;
      } catch (const std::exception& error) {
        // Memory, as far as we know: what was under way for one client is lost, the others go on.
        spdlog::error("server: {}", error.what());
      }
    }
  }

  void accept() {
    acceptor_.async_accept([this](ErrorCode error, tcp::socket socket) {
      if (!acceptor_.is_open()) return;
      if (error) {
        breath_.expires_after(kShortOfFiles);
        return breath_.async_wait([this](ErrorCode cancelled) {
          if (!cancelled) accept();
        });
      }
      accept();
      if (connections_.size() < shared_.limits.connections) welcome(std::move(socket));
    });
  }

  void welcome(tcp::socket socket) {
    ErrorCode ignored;  // one who has gone already is found out by the first read
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(asio::socket_base::send_buffer_size(shared_.limits.send_buffer_bytes), ignored);
    std::make_shared<HttpConnection>(std::move(socket), shared_, connections_)->start();
  }

  void deliver() {
    FrameQueue news = inbox_.take_all();
    while (const wire::SharedMessage message = news.pop()) {
      if (message->kind == wire::Payload::Recorded) announce(*message);
      shared_.lobby.take(message);
    }
  }

  void announce(const wire::Message& message) {
    const auto frame = wire::decode(message.bytes);
    if (frame) shared_.files.add_recording((*frame)->payload.AsRecorded()->file);
  }

  Inbox inbox_;
  Shared shared_;
  Connections connections_;
  asio::ip::address address_;
  std::string token_;
  asio::io_context io_{1};  // after what its handlers use: they go with it
  tcp::acceptor acceptor_;
  asio::steady_timer breath_;  ///< before it accepts again
  std::uint16_t port_ = 0;
  std::thread thread_;
};

Server::Server(std::unique_ptr<Engine> engine) : engine_(std::move(engine)) {}
Server::~Server() = default;

Expected<std::unique_ptr<Server>> Server::listen(const ServerSettings& settings, session::CommandTarget& target) {
  ErrorCode error;
  const asio::ip::address address = asio::ip::make_address(settings.address, error);
  if (error)
    return fail(fmt::format("'{}' is not an address", settings.address), "127.0.0.1, or 0.0.0.0 for every network");
  if (!address.is_loopback() && settings.token.empty())
    return fail(fmt::format("{} can be reached from other machines, and no token is asked", settings.address),
                "a token");
  Expected<ServedFiles> files = ServedFiles::open(settings.page, settings.recordings);
  if (!files) return fail(std::move(files.error()));
  auto engine = std::make_unique<Engine>(settings, address, std::move(*files), target);
  error = engine->listen({address, settings.port});
  if (error == asio::error::address_in_use)
    return fail(fmt::format("port {} is taken", settings.port), "end what listens there, or --port 0 for a free one");
  if (error)
    return fail(fmt::format("cannot listen at {}, port {}: {}", settings.address, settings.port, error.message()),
                "another --port or --address");
  return std::unique_ptr<Server>(new Server(std::move(engine)));
}

void Server::start() { engine_->start(); }
void Server::stop() { engine_->stop(); }
void Server::take(const wire::SharedMessage& message) { engine_->take(message); }
std::string Server::url() const { return engine_->url(); }
std::uint16_t Server::port() const { return engine_->port(); }

}  // namespace rhexis::server
