#include "session/recorder.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "session/recording_scene.h"
#include "session/recording_writer.h"

namespace rhexis::session {

struct Recorder::Core {
  Core(std::filesystem::path to, RecordingWriter file) : path(std::move(to)), writer(std::move(file)) {}

  std::filesystem::path path;
  RecordingWriter writer;  ///< of the thread

  std::mutex mutex;  ///< guards all below but the thread itself
  std::condition_variable something;
  RecordingBatch waiting;
  std::size_t scenes_waiting = 0;  ///< bytes of them in `waiting`
  std::uint64_t bytes_added = 0;   ///< where the next piece lies in the file's `bytes`
  bool ends = false;
  bool closes = false;
  std::string trouble;
  std::thread thread;

  enum class Rank { may_be_left_out, counts, always_fits };

  /// Calls add(batch) unless the recording has ended, or `size` more bytes would not fit.
  template <class Add>
  void queue(std::size_t size, Rank rank, const Add& add) {
    const std::lock_guard lock(mutex);
    if (ends) return;
    if (rank == Rank::always_fits) scenes_waiting += size;
    const std::size_t filled = waiting.size() + size - scenes_waiting;
    if (rank == Rank::may_be_left_out && filled > kMostWaiting / 2) return;
    if (filled > kMostWaiting) {
      ends = true;
      trouble = "the disk is too slow for the recording: it has ended";
      return;
    }
    add(waiting);
  }

  void queue_piece(std::vector<PieceRow> RecordingBatch::*table, PieceRow row, std::span<const std::uint8_t> bytes,
                   Rank rank) {
    queue(bytes.size() + sizeof(PieceRow), rank, [&](RecordingBatch& batch) {
      row.offset = bytes_added;
      row.size = bytes.size();
      bytes_added += bytes.size();
      batch.bytes.insert(batch.bytes.end(), bytes.begin(), bytes.end());
      (batch.*table).push_back(row);
    });
  }

  void run() {
    RecordingBatch batch;
    std::unique_lock lock(mutex);
    bool last = false;
    while (!last) {
      something.wait_for(lock, std::chrono::milliseconds(kFlushMilliseconds), [&] { return closes; });
      last = closes;
      std::swap(batch, waiting);
      scenes_waiting = 0;
      lock.unlock();
      Expected<void> written;
      if (batch.size() > 0) written = writer.append(batch);
      batch.clear();
      lock.lock();
      if (!written && !ends) {
        ends = true;
        trouble = written.error().message();
      }
    }
    writer.close();
  }
};

Recorder::Recorder(std::unique_ptr<Core> core) : core_(std::move(core)) {
  core_->thread = std::thread([raw = core_.get()] { raw->run(); });
}

Recorder::~Recorder() { close(); }

Expected<std::unique_ptr<Recorder>> Recorder::create(const std::filesystem::path& path, const RecordingHead& head) {
  Expected<RecordingWriter> writer = RecordingWriter::create(path, head);
  if (!writer) return fail(std::move(writer.error()));
  return std::unique_ptr<Recorder>(new Recorder(std::make_unique<Core>(path, std::move(*writer))));
}

void Recorder::add(const TickRow& tick) {
  core_->queue(sizeof(tick), Core::Rank::counts, [&](RecordingBatch& batch) { batch.ticks.push_back(tick); });
}

void Recorder::add(const StepRow& step) {
  core_->queue(sizeof(step), Core::Rank::counts, [&](RecordingBatch& batch) { batch.steps.push_back(step); });
}

void Recorder::add_command(std::uint64_t before_step, const wire::PayloadUnion& command) {
  wire::FrameT frame;
  frame.payload = command;
  const wire::SharedMessage message = wire::encode_frame(frame);
  core_->queue_piece(&RecordingBatch::commands,
                     {.at = before_step, .kind = static_cast<std::uint64_t>(command.type), .offset = 0, .size = 0},
                     message->bytes, Core::Rank::counts);
}

void Recorder::add_scene(std::uint64_t before_step, const SceneChoice& scene) {
  if (scene.mesh != nullptr && scene.mesh->bytes.size() > kMostMeshBytes)
    return end(fmt::format("the scene's mesh file is larger than {} MiB, which no recording takes: it has ended",
                           kMostMeshBytes >> 20));
  const std::vector<std::uint8_t> bytes = bytes_of(scene);
  core_->queue_piece(&RecordingBatch::scenes, {.at = before_step, .kind = 0, .offset = 0, .size = 0}, bytes,
                     Core::Rank::always_fits);
}

void Recorder::add_frame(std::uint64_t tick, const wire::SharedMessage& frame) {
  core_->queue_piece(
      &RecordingBatch::frames, {.at = tick, .kind = static_cast<std::uint64_t>(frame->kind), .offset = 0, .size = 0},
      frame->bytes, wire::may_be_dropped(frame->kind) ? Core::Rank::may_be_left_out : Core::Rank::counts);
}

std::string Recorder::trouble() const {
  const std::lock_guard lock(core_->mutex);
  return core_->trouble;
}

void Recorder::end(const std::string& why) {
  const std::lock_guard lock(core_->mutex);
  if (core_->ends) return;
  core_->ends = true;
  core_->trouble = why;
}

std::uint64_t Recorder::close() {
  {
    const std::lock_guard lock(core_->mutex);
    core_->closes = true;
  }
  core_->something.notify_one();
  if (core_->thread.joinable()) core_->thread.join();
  std::error_code code;
  const std::uintmax_t bytes = std::filesystem::file_size(core_->path, code);
  return code ? 0 : bytes;
}

const std::filesystem::path& Recorder::path() const { return core_->path; }

}  // namespace rhexis::session
