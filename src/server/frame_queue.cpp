#include "server/frame_queue.h"

#include <utility>

namespace rhexis::server {

void FrameQueue::push(const wire::SharedMessage& message) {
  if (wire::may_be_dropped(message->kind)) {
    state_ = message;
    before_state_ = kept_.size();
    return;
  }
  kept_.push_back(message);
  kept_bytes_ += message->bytes.size();
}

wire::SharedMessage FrameQueue::pop() {
  if (state_ != nullptr && before_state_ == 0) return std::exchange(state_, nullptr);
  if (kept_.empty()) return nullptr;
  wire::SharedMessage next = std::move(kept_.front());
  kept_.pop_front();
  kept_bytes_ -= next->bytes.size();
  if (state_ != nullptr) --before_state_;
  return next;
}

}  // namespace rhexis::server
