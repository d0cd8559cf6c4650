#pragma once
// Which hand of this frame is which of the frame before.

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/system/clock.h"
#include "input/tracking/hands/hand_search.h"

namespace dubsar {

struct KnownHand {
  std::uint32_t id = 0;
  glm::dvec3 palm_m{};
  TimestampNs time = 0;
  HandMemory memory;
};

/// One thread.
class KnownHands {
 public:
  /// A new frame: those of the one before wait to be taken.
  void begin_frame() {
    previous_.swap(known_);
    known_.clear();
  }
  /// Those of the frame before that were not taken yet.
  const std::vector<KnownHand>& previous() const noexcept { return previous_; }
  /// The hand that was nearest to this palm in the frame before, within 120 mm, or a new one.
  KnownHand take(const glm::dvec3& palm_m) {
    constexpr double kSameM = 0.12;
    const auto apart = [&](const KnownHand& hand) { return glm::distance(hand.palm_m, palm_m); };
    const auto same = std::min_element(previous_.begin(), previous_.end(),
                                       [&](const KnownHand& a, const KnownHand& b) { return apart(a) < apart(b); });
    if (same == previous_.end() || apart(*same) >= kSameM) {
      KnownHand out;
      out.id = next_id_++;
      return out;
    }
    KnownHand out = *same;
    previous_.erase(same);
    return out;
  }
  /// It was seen in this frame.
  void keep(const KnownHand& hand) { known_.push_back(hand); }
  void forget() { known_.clear(); }

 private:
  std::vector<KnownHand> known_, previous_;
  std::uint32_t next_id_ = 1;
};

}  // namespace dubsar
