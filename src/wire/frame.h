#pragma once

/// Frames of the wire (schema/rhexis.fbs) as bytes: what the server sends, what a recording keeps.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/error.h"
#include "wire/rhexis_generated.h"

namespace rhexis::wire {

/// One encoded frame. Shared, since many clients and a recording read the same bytes.
struct Message {
  std::vector<std::uint8_t> bytes;
  Payload kind = Payload::NONE;
};
using SharedMessage = std::shared_ptr<const Message>;

/// `payload`: one of the generated object types (StateT, EditT, ...).
template <typename PayloadT>
[[nodiscard]] SharedMessage encode(PayloadT payload);

/// What stands behind the template: takes a filled frame.
[[nodiscard]] SharedMessage encode_frame(const FrameT& frame);

/// `bytes` begin where memory from `new` does. Verified before anything in them is read: no offset leaves `bytes`,
/// whatever they say, and what is unpacked is no more than a small multiple of them. The payload is there. Errors: not
/// a frame of this schema, a frame without payload.
[[nodiscard]] Expected<std::unique_ptr<FrameT>> decode(std::span<const std::uint8_t> bytes);

/// Newest wins: a client that is slow may miss it.
[[nodiscard]] constexpr bool may_be_dropped(Payload kind) { return kind == Payload::State; }

template <typename PayloadT>
SharedMessage encode(PayloadT payload) {
  FrameT frame;
  frame.payload.Set(std::move(payload));
  return encode_frame(frame);
}

}  // namespace rhexis::wire
