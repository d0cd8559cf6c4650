#include "app/steering/worn_input.h"

namespace dubsar::app {

WornSample worn_sample(const WearerFrame& wearer) {
  WornSample out;
  out.time = wearer.time;
  for (std::size_t side = 0; side < 2; ++side) {
    const WornController& controller = wearer.controllers[side];
    out.controllers[side] = {controller.active, controller.grip, controller.squeeze, controller.select};
    if (!wearer.hands[side].active) continue;
    HandFrame& hand = out.hands[side].emplace();
    static_assert(kHandJointCount == std::tuple_size_v<decltype(WornHand::joints)>);
    for (std::size_t i = 0; i < kHandJointCount; ++i) {
      const WornJoint& joint = wearer.hands[side].joints[i];
      hand.joints[i] = {joint.pose, joint.radius_m, joint.valid, joint.tracked};
    }
  }
  return out;
}

}  // namespace dubsar::app
