#include "wire/frame.h"

#include <gtest/gtest.h>

#include <random>

namespace rhexis {
namespace {

wire::EditT small_edit() {
  wire::EditT edit;
  edit.topology = 3;
  edit.moved = {7, 9};
  edit.moved_to = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
  edit.slots = {2};
  edit.faces = {0, 1, 2};
  edit.advance = std::make_unique<wire::AdvanceT>();
  edit.advance->length = 0.0403;
  edit.advance->force_after = std::make_unique<wire::Vec3>(1.0, -2.0, 1e-300);
  return edit;
}

TEST(Frame, ComesBackAsItWentOut) {
  const wire::SharedMessage message = wire::encode(small_edit());
  EXPECT_EQ(message->kind, wire::Payload::Edit);
  const auto frame = wire::decode(message->bytes);
  ASSERT_TRUE(frame.has_value());
  const wire::EditT* edit = (*frame)->payload.AsEdit();
  ASSERT_NE(edit, nullptr);
  EXPECT_EQ(edit->topology, 3u);
  EXPECT_EQ(edit->moved, small_edit().moved);
  EXPECT_EQ(edit->moved_to, small_edit().moved_to);
  EXPECT_EQ(edit->advance->length, 0.0403);
  EXPECT_EQ(edit->advance->force_after->z(), 1e-300);
}

TEST(Frame, OnlyStatesMayBeDropped) {
  EXPECT_TRUE(wire::may_be_dropped(wire::Payload::State));
  for (const wire::Payload kind : {wire::Payload::Hello, wire::Payload::Body, wire::Payload::Edit})
    EXPECT_FALSE(wire::may_be_dropped(kind));
}

TEST(Frame, WithoutPayloadIsRefused) {
  EXPECT_FALSE(wire::decode(wire::encode_frame({})->bytes).has_value());
  EXPECT_FALSE(wire::decode({}).has_value());
}

TEST(Frame, CutOffOrGarbledNeverReadsPastItsEnd) {
  const std::vector<std::uint8_t> whole = wire::encode(small_edit())->bytes;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::uint8_t> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    (void)wire::decode(part);  // refused, or a frame that lost its tail of padding: no crash is what is asked
  }
  std::mt19937_64 random(5);
  int refused = 0;
  for (int k = 0; k < 20000; ++k) {
    std::vector<std::uint8_t> garbled = whole;
    for (int n = 0; n < 3; ++n) garbled[random() % garbled.size()] = static_cast<std::uint8_t>(random());
    refused += wire::decode(garbled).has_value() ? 0 : 1;
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace rhexis
