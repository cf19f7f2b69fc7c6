#pragma once

/// A server that runs, with a small page and somebody behind it who only listens.

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <vector>

#include "server/server.h"
#include "tests/support/run_command.h"

namespace rhexis::test {

/// Keeps what was posted.
class Listener : public session::CommandTarget {
 public:
  void post(wire::PayloadUnion command) override {
    const std::lock_guard lock(mutex_);
    posted_.push_back(command.type);
    news_.notify_all();
  }
  [[nodiscard]] wire::SharedMessage hello() const override {
    wire::HelloT hello;
    hello.version = "test";
    return wire::encode(std::move(hello));
  }
  /// True: so many of that kind are there, or come within that time.
  bool gets(wire::Payload kind, int count = 1, std::chrono::milliseconds patience = std::chrono::milliseconds(5000)) {
    std::unique_lock lock(mutex_);
    return news_.wait_for(lock, patience, [&] { return std::count(posted_.begin(), posted_.end(), kind) >= count; });
  }
  [[nodiscard]] std::vector<wire::Payload> posted() {
    const std::lock_guard lock(mutex_);
    return posted_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  std::vector<wire::Payload> posted_;
};

struct Served {
  explicit Served(const std::string& name, const std::function<void(server::ServerSettings&)>& change = {}) {
    folder = fresh_folder(name);
    std::filesystem::create_directories(folder / "page/assets");
    std::filesystem::create_directories(folder / "out");
    std::ofstream(folder / "page/index.html") << "<title>Rhexis</title>";
    std::ofstream(folder / "page/assets/app.js") << "export {};";
    std::ofstream(folder / "page/.hidden") << "secret";
    std::ofstream(folder / "secret.txt") << "secret";
    std::ofstream(folder / "out/run.h5") << "recording";
    server::ServerSettings settings;
    settings.port = 0;
    settings.page = folder / "page";
    settings.recordings = folder / "out";
    if (change) change(settings);
    auto made = server::Server::listen(settings, target);
    EXPECT_TRUE(made.has_value()) << made.error().message();
    server = std::move(*made);
    server->start();
    port = server->port();
  }

  std::filesystem::path folder;
  Listener target;
  std::unique_ptr<server::Server> server;
  std::uint16_t port = 0;
};

}  // namespace rhexis::test
