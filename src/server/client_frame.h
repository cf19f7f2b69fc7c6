#pragma once

/// What a client may say. All of it is foreign data: looked at here before anything is done with it.

#include "base/error.h"
#include "wire/frame.h"

namespace rhexis::server {

/// Who may say it.
enum class Right { nobody, anybody, hand };

/// Frames that a client sends are for anybody (the hand itself, Ping) or for who has the hand; the others are ours.
[[nodiscard]] Right right_to_send(wire::Payload kind);

/// A frame of a client, whole and with finite numbers. Errors: anything else.
[[nodiscard]] Expected<wire::PayloadUnion> read_client_frame(std::span<const std::uint8_t> bytes);

}  // namespace rhexis::server
