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

TEST(Frame, OfAKindWithoutItsTableIsRefused) {
  flatbuffers::FlatBufferBuilder builder;
  // Of a kind that is known, and of one that is not.
  for (const int kind : {static_cast<int>(wire::Payload::Grasp), 200}) {
    builder.Clear();
    wire::FinishFrameBuffer(builder, wire::CreateFrame(builder, static_cast<wire::Payload>(kind)));
    EXPECT_FALSE(wire::decode({builder.GetBufferPointer(), builder.GetSize()}).has_value()) << kind;
  }
  builder.Clear();
  wire::FinishFrameBuffer(
      builder, wire::CreateFrame(builder, static_cast<wire::Payload>(200), wire::CreateReset(builder).Union()));
  EXPECT_FALSE(wire::decode({builder.GetBufferPointer(), builder.GetSize()}).has_value());
}

TEST(Frame, ThatWouldUnpackToFarMoreThanItsBytesIsRefused) {
  constexpr std::size_t kMany = 10'000;
  const auto refuses = [](flatbuffers::FlatBufferBuilder& builder, wire::Payload kind,
                          flatbuffers::Offset<void> payload) {
    wire::FinishFrameBuffer(builder, wire::CreateFrame(builder, kind, payload));
    const auto frame = wire::decode({builder.GetBufferPointer(), builder.GetSize()});
    return !frame && frame.error().what == "a frame whose lists share their entries";
  };
  {
    flatbuffers::FlatBufferBuilder builder;
    const auto front = wire::CreateFront(builder, builder.CreateVectorOfStructs(std::vector<wire::Vec3>(kMany)));
    const auto fronts = builder.CreateVector(std::vector(kMany, front));
    wire::EditBuilder edit(builder);
    edit.add_fronts(fronts);
    const auto whole = edit.Finish();
    EXPECT_TRUE(refuses(builder, wire::Payload::Edit, whole.Union()));
  }
  {
    flatbuffers::FlatBufferBuilder builder;
    const auto scenes = builder.CreateVector(std::vector(kMany, builder.CreateString(std::string(kMany, 'x'))));
    wire::HelloBuilder hello(builder);
    hello.add_scenes(scenes);
    const auto whole = hello.Finish();
    EXPECT_TRUE(refuses(builder, wire::Payload::Hello, whole.Union()));
  }
  wire::HelloT honest;
  honest.scenes.assign(kMany, std::string(100, 'x'));
  EXPECT_TRUE(wire::decode(wire::encode(std::move(honest))->bytes).has_value());
}

TEST(Frame, WithNumbersThatAreNotAlignedIsRefused) {
  wire::TimelineT timeline;
  timeline.marks = {1.0, 2.0, 3.0};
  std::vector<std::uint8_t> bytes = wire::encode(std::move(timeline))->bytes;
  const wire::Frame* frame = wire::GetFrame(bytes.data());
  const std::uint8_t* list = reinterpret_cast<const std::uint8_t*>(frame->payload_as_Timeline()->marks());
  const auto at = static_cast<std::size_t>(list - bytes.data());
  // The list's length goes to where its first number was, and all that points to it after it.
  const std::size_t points_to_it = [&] {
    for (std::size_t k = 0; k < at; k += 4)
      if (flatbuffers::ReadScalar<flatbuffers::uoffset_t>(&bytes[k]) == at - k) return k;
    return at;
  }();
  ASSERT_LT(points_to_it, at);
  flatbuffers::WriteScalar<flatbuffers::uoffset_t>(&bytes[points_to_it],
                                                   static_cast<flatbuffers::uoffset_t>(at + 4 - points_to_it));
  flatbuffers::WriteScalar<flatbuffers::uoffset_t>(&bytes[at + 4], 2);
  const auto decoded = wire::decode(bytes);
  ASSERT_FALSE(decoded.has_value());
  EXPECT_EQ(decoded.error().what, "a frame whose numbers are not aligned");
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
