#pragma once

/// A live session in a test: its frames kept, its commands from the outside, on real threads.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "session/frame_sink.h"

namespace rhexis::test {

/// Keeps what it is given, decoded.
class KeptFrames final : public session::FrameSink {
 public:
  void take(const wire::SharedMessage& message) override {
    Expected<std::unique_ptr<wire::FrameT>> frame = wire::decode(message->bytes);
    const std::lock_guard lock(mutex_);
    if (frame) frames_.push_back(std::move((*frame)->payload));
  }
  [[nodiscard]] std::vector<wire::PayloadUnion> all() const {
    const std::lock_guard lock(mutex_);
    return frames_;
  }
  [[nodiscard]] std::size_t count(wire::Payload kind) const {
    const std::lock_guard lock(mutex_);
    std::size_t n = 0;
    for (const wire::PayloadUnion& frame : frames_) n += frame.type == kind ? 1 : 0;
    return n;
  }
  /// The last of a kind; NONE: there is none.
  [[nodiscard]] wire::PayloadUnion last(wire::Payload kind) const {
    const std::lock_guard lock(mutex_);
    for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame)
      if (frame->type == kind) return *frame;
    return {};
  }
  [[nodiscard]] std::vector<std::string> notices() const {
    std::vector<std::string> out;
    for (const wire::PayloadUnion& frame : all())
      if (frame.type == wire::Payload::Notice) out.push_back(frame.AsNotice()->text);
    return out;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<wire::PayloadUnion> frames_;
};

/// True as soon as `holds` is; false after `seconds`.
inline bool wait_until(const std::function<bool()>& holds, double seconds = 20.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return holds();
}

template <class T>
wire::PayloadUnion payload(T value) {
  wire::PayloadUnion out;
  out.Set(std::move(value));
  return out;
}

inline wire::PayloadUnion move_to(double x, double y, double z) {
  wire::MoveT move;
  move.to = std::make_unique<wire::Vec3>(x, y, z);
  return payload(std::move(move));
}

/// A folder that goes with the test.
class TestFolder {
 public:
  explicit TestFolder(const std::string& name)
      : path_(std::filesystem::path(testing::TempDir()) / (name + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The one file in a folder below.
  [[nodiscard]] std::filesystem::path only_file(const std::string& folder) const {
    std::filesystem::path found;
    for (const auto& entry : std::filesystem::directory_iterator(path_ / folder)) found = entry.path();
    return found;
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

/// The plate of the thesis, smaller, with a pull that tears it in half a second.
inline const std::string kLivePlate = R"(title = "Plate"
[mesh]
generate = "plate"
size = [0.24, 0.24, 0.01]
nodes = 506
[material]
density = 1000.0
young = 1.0e6
poisson = 0.4
[model]
kind = "linear"
[[support]]
set = "+x"
x = 0.0
y = 0.0
z = 0.0
[fracture]
criterion = "maximum-principal"
strength = 0.4e6
[[crack]]
from = [0.12, 0.0, 0.0]
to = [0.12, 0.06, 0.0]
[[pull]]
at = [0.10, 0.0, 0.005]
by = [-0.12, 0.0, 0.0]
seconds = 0.5
)";

}  // namespace rhexis::test
