#pragma once

/// Another response beside that of the session, following the same edits and the same hand: what it would let the hand
/// feel at the same place.

#include <memory>
#include <span>

#include "response/contact.h"
#include "response/response.h"
#include "session/hand.h"

namespace rhexis::session {

class Comparison {
 public:
  explicit Comparison(std::unique_ptr<response::Response> other) : other_(std::move(other)) {}

  /// The hand has taken hold, or let go, or the body has torn.
  void grasp(const Hand& hand);
  /// False: the other response has no answer to the torn body, and this is of no more use. The hand is as it was: grasp
  /// follows when it is known what it still holds.
  bool follow(const mesh::MeshEdit& edit, std::span<const response::Focus> focus,
              const response::CrackAdvance& advance);
  void go_back(const mesh::MeshEdit& edit, std::span<const response::Focus> focus, const Hand& hand);
  /// N, on the hand.
  [[nodiscard]] Vec3 force(const Hand& hand) const { return hand.force_by(law_); }

 private:
  std::unique_ptr<response::Response> other_;
  response::ContactLaw law_;
};

}  // namespace rhexis::session
