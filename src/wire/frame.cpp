#include "wire/frame.h"

namespace rhexis::wire {
namespace {

/// Deeper or with more tables than any frame of the schema: refused unread.
constexpr flatbuffers::uoffset_t kMostDepth = 16;
constexpr flatbuffers::uoffset_t kMostTables = 1'000'000;

using Texts = flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>;
using Fronts = flatbuffers::Vector<flatbuffers::Offset<Front>>;

std::uint64_t bytes_of(const Texts* texts) {
  std::uint64_t bytes = 0;
  for (flatbuffers::uoffset_t k = 0; texts != nullptr && k < texts->size(); ++k) bytes += texts->Get(k)->size();
  return bytes;
}

std::uint64_t bytes_of(const Fronts* fronts) {
  std::uint64_t bytes = 0;
  for (flatbuffers::uoffset_t k = 0; fronts != nullptr && k < fronts->size(); ++k)
    if (const auto* points = fronts->Get(k)->points()) bytes += std::uint64_t{points->size()} * sizeof(Vec3);
  return bytes;
}

/// Of lists in lists, once they are unpacked. Entries may share what they point to, so that a small frame could unpack
/// to any size; one that `encode` made holds each by itself, and is larger than all of them.
std::uint64_t nested_bytes(const Frame& frame) {
  if (const Hello* hello = frame.payload_as_Hello()) return bytes_of(hello->scenes()) + bytes_of(hello->devices());
  if (const Body* body = frame.payload_as_Body()) return bytes_of(body->fronts());
  if (const Edit* edit = frame.payload_as_Edit()) return bytes_of(edit->fronts());
  return 0;
}

/// The verifier sees to it that a list's length is aligned, and not that its entries are, where they are larger.
bool is_aligned(const void* entries) { return reinterpret_cast<std::uintptr_t>(entries) % alignof(double) == 0; }

bool are_aligned(const Fronts* fronts) {
  for (flatbuffers::uoffset_t k = 0; fronts != nullptr && k < fronts->size(); ++k)
    if (const auto* points = fronts->Get(k)->points(); points != nullptr && !is_aligned(points->Data())) return false;
  return true;
}

bool has_aligned_lists(const Frame& frame) {
  if (const Body* body = frame.payload_as_Body()) return are_aligned(body->fronts());
  if (const Edit* edit = frame.payload_as_Edit()) return are_aligned(edit->fronts());
  const Timeline* timeline = frame.payload_as_Timeline();
  return timeline == nullptr || timeline->marks() == nullptr || is_aligned(timeline->marks()->Data());
}

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
  const Frame* packed = GetFrame(bytes.data());
  // The verifier lets a kind pass that the schema does not have, and one without its table.
  if (packed->payload() == nullptr || packed->payload_type() == Payload::NONE || packed->payload_type() > Payload::MAX)
    return fail("a frame without a payload");
  if (!has_aligned_lists(*packed)) return fail("a frame whose numbers are not aligned");
  if (nested_bytes(*packed) > bytes.size()) return fail("a frame whose lists share their entries");
  std::unique_ptr<FrameT> frame(packed->UnPack());
  return frame;
}

}  // namespace rhexis::wire
