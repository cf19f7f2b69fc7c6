#include "wire/frame.h"

namespace rhexis::wire {
namespace {

/// Deeper or with more tables than any frame of the schema: refused unread.
constexpr flatbuffers::uoffset_t kMostDepth = 16;
constexpr flatbuffers::uoffset_t kMostTables = 1'000'000;

}  // namespace

SharedMessage encode_frame(const FrameT& frame) {
  flatbuffers::FlatBufferBuilder builder(1024);
  FinishFrameBuffer(builder, Frame::Pack(builder, &frame));
  auto message = std::make_shared<Message>();
  message->bytes.assign(builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize());
  message->kind = frame.payload.type;
  return message;
}

Expected<std::unique_ptr<FrameT>> decode(std::span<const std::uint8_t> bytes) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), kMostDepth, kMostTables);
  if (bytes.size() < 8 || !FrameBufferHasIdentifier(bytes.data()) || !VerifyFrameBuffer(verifier))
    return fail("these bytes are not a frame", "a client of the same version");
  std::unique_ptr<FrameT> frame(GetFrame(bytes.data())->UnPack());
  if (frame->payload.type == Payload::NONE) return fail("a frame without a payload");
  return frame;
}

}  // namespace rhexis::wire
