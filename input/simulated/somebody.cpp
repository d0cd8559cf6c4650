#include <algorithm>

#include "input/simulated/scripted_person.h"

namespace dubsar {

Script somebody(std::uint64_t seed, double seconds) {
  Script script;
  script.seed = seed;
  script.duration_s = seconds;
  script.latency_s = 0.0;
  ScriptRandom random(seed);
  HeadTrack head;
  for (double t = 0.0; t < seconds; t += random.uniform(0.6, 1.5))
    head.keys.push_back({t, {random.uniform(-0.12, 0.12), random.uniform(-0.03, 0.06), random.uniform(0.5, 0.7)}});
  head.keys.push_back({seconds, head.keys.back().at_m});
  script.heads.push_back(std::move(head));
  HandTrack hand;
  const auto spot = [&] {
    return glm::dvec3(random.uniform(-0.08, 0.08), random.uniform(-0.03, 0.06), random.uniform(0.12, 0.2));
  };
  HandKey key{0.0, spot()};
  hand.keys.push_back(key);
  for (int i = 0; key.t_s < seconds; ++i) {
    key.t_s = std::min(seconds, key.t_s + random.uniform(0.4, 0.9));
    const bool closing = i % 4 == 0, opening = i % 4 == 2;
    if (closing || opening) {
      key.grab = closing ? 1.0 : 0.0;
      key.pinch_m = closing ? 0.015 : 0.06;
    } else {
      key.at_m = spot();
    }
    hand.keys.push_back(key);
  }
  script.hands.push_back(std::move(hand));
  return script;
}

}  // namespace dubsar
