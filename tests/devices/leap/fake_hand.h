#pragma once
// A plausible hand in the vendor's structs: flat over the device, fingers to the screen.

#include <cmath>

#include "fake_leapc.h"

namespace dubsar {

inline FakeVector plus(const FakeVector& a, float x, float y, float z) { return {a.x + x, a.y + y, a.z + z}; }

/// Palm at (x, y, z) mm; bones run to -z from 10 mm before the wrist, each 30 mm long.
inline FakeHand flat_fake_hand(std::uint32_t id, bool right, float x, float y, float z, float grab = 0.0F) {
  FakeHand hand{};
  hand.id = id;
  hand.type = right ? 1 : 0;
  hand.confidence = 1.0F;
  hand.grab_strength = grab;
  hand.palm.position = {x, y, z};
  hand.palm.velocity = {100.0F, 0.0F, -50.0F};
  hand.palm.normal = {0.0F, -1.0F, 0.0F};
  hand.palm.direction = {0.0F, 0.0F, -1.0F};
  hand.palm.width = 84.0F;
  hand.palm.orientation = {0.0F, 0.0F, 0.0F, 1.0F};
  hand.arm = {{x, y, z + 250.0F}, {x, y, z + 50.0F}, 60.0F, {0.0F, 0.0F, 0.0F, 1.0F}};
  for (int digit = 0; digit < 5; ++digit) {
    const float side = (right ? 1.0F : -1.0F) * 20.0F * static_cast<float>(digit - 2);
    FakeVector at{x + side, y, z + 40.0F};
    FakeDigit& d = hand.digits[digit];
    d.finger_id = digit;
    int bone = 0;
    for (FakeBone* b : {&d.metacarpal, &d.proximal, &d.intermediate, &d.distal}) {
      const float length = digit == 0 && bone == 0 ? 0.0F : 30.0F;
      b->prev_joint = at;
      at = plus(at, 0.0F, 0.0F, -length);
      b->next_joint = at;
      b->width = 16.0F + static_cast<float>(digit);
      b->rotation = {0.0F, 0.0F, 0.0F, 1.0F};
      ++bone;
    }
    d.is_extended = 1;
  }
  return hand;
}

}  // namespace dubsar
