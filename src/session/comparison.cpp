#include "session/comparison.h"

namespace rhexis::session {

void Comparison::grasp(const Hand& hand) {
  other_->grasp(hand.nodes());
  law_ = hand.holds() ? hand.law_by(*other_) : response::ContactLaw();
}

bool Comparison::follow(const mesh::MeshEdit& edit, std::span<const response::Focus> focus,
                        const response::CrackAdvance& advance) {
  return other_->follow(edit, focus, &advance).ok;
}

/// Nodes that go with the edit are held by nobody any more.
void Comparison::go_back(const mesh::MeshEdit& edit, std::span<const response::Focus> focus, const Hand& hand) {
  other_->grasp({});
  other_->go_back(edit, focus);
  grasp(hand);
}

}  // namespace rhexis::session
