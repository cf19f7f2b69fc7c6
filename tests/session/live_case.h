#pragma once

/// A live session in a test: its frames kept, its commands from the outside, on real threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "session/live_session.h"

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

/// A session of that plate, unless the settings are changed before it starts.
struct LiveCase {
  explicit LiveCase(const std::string& name) : folder(name) {
    settings.scene = folder.write("plate.toml", kLivePlate);
    settings.version = "test";
    settings.priority = 0;
  }
  void start() {
    Expected<std::unique_ptr<session::LiveSession>> opened = session::LiveSession::open(settings, frames);
    ASSERT_TRUE(opened.has_value()) << opened.error().message();
    live = std::move(*opened);
    const Expected<void> started = live->start();
    ASSERT_TRUE(started.has_value()) << started.error().message();
  }
  /// True: a notice with that part came, or comes in time.
  [[nodiscard]] bool hears(const std::string& part) const {
    return wait_until([&] {
      const std::vector<std::string> notices = frames.notices();
      return std::any_of(notices.begin(), notices.end(),
                         [&](const std::string& text) { return text.find(part) != std::string::npos; });
    });
  }
  [[nodiscard]] wire::StateT state() const {
    const wire::PayloadUnion last = frames.last(wire::Payload::State);
    return last.AsState() != nullptr ? *last.AsState() : wire::StateT();
  }
  /// Of the first body: a face whose corners are all near `at`.
  [[nodiscard]] wire::PayloadUnion grasp_near(const Vec3& at) const {
    const wire::PayloadUnion last = frames.last(wire::Payload::Body);
    const wire::BodyT& body = *last.AsBody();
    double best = 1e9;
    wire::GraspT grasp;
    for (std::uint32_t slot = 0; 3 * slot < body.faces.size(); ++slot) {
      Vec3 middle = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t vertex = body.faces[3 * slot + k];
        for (Eigen::Index c = 0; c < 3; ++c)
          middle[c] += body.positions[3 * vertex + static_cast<std::size_t>(c)] / 3.0;
      }
      if ((middle - at).norm() >= best) continue;
      best = (middle - at).norm();
      grasp.face = slot;
    }
    grasp.weights = std::make_unique<wire::Vec3>(0.5, 0.25, 0.25);
    return payload(std::move(grasp));
  }

  TestFolder folder;
  KeptFrames frames;
  session::LiveSettings settings;
  std::unique_ptr<session::LiveSession> live;
};

}  // namespace rhexis::test
