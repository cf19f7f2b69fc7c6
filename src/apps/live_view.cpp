#include "apps/live_view.h"

#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <boost/asio/ip/address.hpp>

#include "apps/beside_program.h"
#include "apps/interrupt.h"
#include "server/gate.h"

namespace rhexis::apps {
namespace {

namespace fs = std::filesystem;

/// It stands in an address and in a cookie, and is quoted in neither.
bool is_plain(const std::string& token) {
  return std::all_of(token.begin(), token.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_' || c == '~';
  });
}

bool is_loopback(const std::string& address) {
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

/// Without a shell, which would read more into an address than is meant.
void open_browser(std::string url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::string program = "xdg-open";
  char* const arguments[] = {program.data(), url.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0)
    spdlog::debug("there is no xdg-open");
}

Expected<server::ServerSettings> settings_of(const LiveViewOptions& options) {
  server::ServerSettings settings;
  settings.address = options.address;
  settings.port = static_cast<std::uint16_t>(options.port);
  settings.token = options.token;
  if (!is_plain(options.token))
    return fail("the token has characters that an address cannot have as they are",
                "letters, digits and any of - . _ ~", "--token");
  if (settings.token.empty() && !is_loopback(options.address)) settings.token = server::make_token();
  settings.page = options.page.empty() ? share_folder() / "page" : fs::path(options.page);
  settings.recordings = options.recordings;
  std::error_code error;
  fs::create_directories(settings.recordings, error);
  if (error)
    return fail("cannot make the folder: " + error.message(), "--recordings names another", options.recordings);
  return settings;
}

}  // namespace

std::shared_ptr<LiveViewOptions> add_live_view_options(CLI::App& command) {
  auto options = std::make_shared<LiveViewOptions>();
  command.add_option("--port", options->port, "port of the page; 0: any that is free; 8080 unless given")
      ->check(CLI::Range(0, 65535));
  command.add_option("--address", options->address, "numerical address to listen at; 127.0.0.1 unless given");
  command.add_option("--token", options->token,
                     "asked of every visit; made up where the address is not this machine's");
  command.add_option("--page", options->page, "folder of the page, where it is not beside the program");
  command.add_option("--recordings", options->recordings, "folder of recordings; out/recordings unless given");
  command.add_flag("--no-browser", options->no_browser, "do not open a browser");
  return options;
}

Expected<std::unique_ptr<server::Server>> listen(const LiveViewOptions& options, session::CommandTarget& target,
                                                 Relay& relay) {
  const Expected<server::ServerSettings> settings = settings_of(options);
  if (!settings) return fail(settings.error());
  Expected<std::unique_ptr<server::Server>> made = server::Server::listen(*settings, target);
  if (!made) return made;
  relay.set(**made);
  (*made)->start();
  return made;
}

void show_page(const LiveViewOptions& options, const server::Server& server) {
  if (!options.no_browser) open_browser(server.url());
}

int serve(const LiveViewOptions& options, const Common& common, session::CommandTarget& target, Relay& relay,
          const std::function<Expected<void>()>& start, const std::function<void()>& stop) {
  const Interrupt interrupt;
  Expected<std::unique_ptr<server::Server>> made = listen(options, target, relay);
  if (!made) return report(made.error());
  server::Server& server = **made;
  if (const Expected<void> begun = start(); !begun) {
    server.stop();
    return report(begun.error());
  }
  say(common, "page      {}\nCtrl-C ends it\n", server.url());
  std::fflush(stdout);
  show_page(options, server);
  while (!interrupt.asked()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  stop();
  server.stop();
  return kDone;
}

}  // namespace rhexis::apps
