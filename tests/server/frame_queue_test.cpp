#include "server/frame_queue.h"

#include <gtest/gtest.h>

#include <random>

namespace rhexis::server {
namespace {

wire::SharedMessage edit(std::uint32_t topology) {
  wire::EditT frame;
  frame.topology = topology;
  return wire::encode(std::move(frame));
}
wire::SharedMessage state(std::uint64_t tick) {
  wire::StateT frame;
  frame.tick = tick;
  return wire::encode(std::move(frame));
}

TEST(FrameQueue, OfStatesTheNewestStaysBehindWhatCameBeforeIt) {
  const std::vector<wire::SharedMessage> in{state(1), edit(1), state(2), edit(2), edit(3)};
  FrameQueue queue;
  for (const wire::SharedMessage& message : in) queue.push(message);
  EXPECT_EQ(queue.kept_frames(), 3U);
  EXPECT_EQ(queue.kept_bytes(), in[1]->bytes.size() + in[3]->bytes.size() + in[4]->bytes.size());
  for (const int k : {1, 2, 3, 4}) EXPECT_EQ(queue.pop(), in[static_cast<std::size_t>(k)]) << k;
  EXPECT_EQ(queue.pop(), nullptr);
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.kept_bytes(), 0U);
}

TEST(FrameQueue, HoweverItIsReadNoEditIsLostOrOvertakenByItsState) {
  std::mt19937_64 random(3);
  FrameQueue queue;
  std::vector<std::size_t> came;  // numbers of what came, in the order of its coming
  std::vector<wire::SharedMessage> all;
  for (int k = 0; k < 5000; ++k) {
    if (random() % 5 < 3) {
      all.push_back(random() % 3 == 0 ? edit(0) : state(0));
      queue.push(all.back());
    } else if (const wire::SharedMessage next = queue.pop()) {
      came.push_back(static_cast<std::size_t>(std::find(all.begin(), all.end(), next) - all.begin()));
    }
  }
  while (const wire::SharedMessage next = queue.pop())
    came.push_back(static_cast<std::size_t>(std::find(all.begin(), all.end(), next) - all.begin()));
  EXPECT_TRUE(std::is_sorted(came.begin(), came.end()));
  const auto edits_among = [&](const auto& messages) {
    return std::count_if(messages.begin(), messages.end(),
                         [](const wire::SharedMessage& message) { return message->kind == wire::Payload::Edit; });
  };
  std::vector<wire::SharedMessage> out;
  for (const std::size_t k : came) out.push_back(all[k]);
  EXPECT_EQ(edits_among(out), edits_among(all));
  EXPECT_LT(out.size(), all.size()) << "no state was dropped";
}

}  // namespace
}  // namespace rhexis::server
