#include "server/client_frame.h"

#include <cmath>
#include <memory>
#include <utility>

namespace rhexis::server {
namespace {

using wire::Payload;

bool is_finite(const std::unique_ptr<wire::Vec3>& v) {
  return v != nullptr && std::isfinite(v->x()) && std::isfinite(v->y()) && std::isfinite(v->z());
}

bool has_finite_numbers(const wire::PayloadUnion& payload) {
  switch (payload.type) {
    case Payload::Grasp: return is_finite(payload.AsGrasp()->weights);
    case Payload::Move: return is_finite(payload.AsMove()->to);
    case Payload::Seek: return std::isfinite(payload.AsSeek()->time);
    case Payload::Play: return std::isfinite(payload.AsPlay()->speed);
    default: return true;
  }
}

}  // namespace

Right right_to_send(Payload kind) {
  switch (kind) {
    case Payload::TakeHand:
    case Payload::GiveHand:
    case Payload::Ping: return Right::anybody;
    case Payload::Grasp:
    case Payload::Move:
    case Payload::LetGo:
    case Payload::Reset:
    case Payload::Undo:
    case Payload::Pause:
    case Payload::Step:
    case Payload::Script:
    case Payload::SetValue:
    case Payload::Compare:
    case Payload::OpenScene:
    case Payload::ShowField:
    case Payload::Record:
    case Payload::Seek:
    case Payload::Feel:
    case Payload::Answer:
    case Payload::Play: return Right::hand;
    default: return Right::nobody;  // and what a newer schema, or nonsense, may have there
  }
}

Expected<wire::PayloadUnion> read_client_frame(std::span<const std::uint8_t> bytes) {
  Expected<std::unique_ptr<wire::FrameT>> frame = wire::decode(bytes);
  if (!frame) return fail(std::move(frame.error()));
  wire::PayloadUnion& payload = (*frame)->payload;
  if (right_to_send(payload.type) == Right::nobody) return fail("a frame that is not a client's to send");
  if (!has_finite_numbers(payload)) return fail("a frame with a number that is missing or not finite");
  return std::move(payload);
}

}  // namespace rhexis::server
