#include "input/simulated/script.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "core/base/text/json_fields.h"
#include "core/base/text/json_text.h"

namespace dubsar {
namespace {
using nlohmann::json;

constexpr std::size_t kMostKeys = 10000;

/// Index of the key at or before t_s, and how far the next one has been reached as a smooth step.
template <class Key>
std::optional<std::pair<std::size_t, double>> place_in(const std::vector<Key>& keys, double t_s) {
  if (keys.empty() || t_s < keys.front().t_s || t_s > keys.back().t_s) return std::nullopt;
  const auto next = std::upper_bound(keys.begin(), keys.end(), t_s, [](double t, const Key& k) { return t < k.t_s; });
  const auto i = static_cast<std::size_t>(next - keys.begin()) - 1;
  if (next == keys.end()) return std::pair{i, 0.0};
  const double u = (t_s - keys[i].t_s) / (next->t_s - keys[i].t_s);
  return std::pair{i, u * u * (3.0 - 2.0 * u)};
}

void set_joint(HandFrame& hand, HandJoint which, const glm::dvec3& offset_m) {
  HandJointPose& joint = hand.joint(which);
  joint = {{hand.palm.position_m + hand.palm.rotation * offset_m, hand.palm.rotation}, 0.008, true, true};
}

/// Looks along `direction` with -Z, the back of the hand up.
glm::dquat pointing(const glm::dvec3& direction) {
  const glm::dvec3 back = -glm::normalize(direction);
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back));
  return glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
}

double real(JsonFields& f, const char* name, double low, double high, double fallback) {
  return f.number(name, low, high, &fallback);
}

glm::dvec3 place(JsonFields& f, const json& object, const char* name, const glm::dvec3& fallback_m) {
  if (!f.has(name)) return fallback_m;
  const json& value = object.at(name);
  const auto fits = [](const json& v) { return v.is_number() && std::abs(v.get<double>()) <= 5000.0; };
  if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), fits)) {
    f.complain(fmt::format("{} is not three numbers of -5000 to 5000 mm", name));
    return fallback_m;
  }
  return 1e-3 * glm::dvec3(value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
}

Result<Dropouts> read_dropouts(const json& object, const std::string& where, Dropouts out) {
  JsonFields f(object, where);
  f.only({"per_s", "shortest_ms", "longest_ms"});
  out.per_s = real(f, "per_s", 0, 100, out.per_s);
  out.shortest_s = 1e-3 * real(f, "shortest_ms", 1, 60000, 1e3 * out.shortest_s);
  out.longest_s = 1e-3 * real(f, "longest_ms", 1, 60000, 1e3 * out.longest_s);
  if (out.longest_s < out.shortest_s) f.complain("longest_ms is below shortest_ms");
  DUBSAR_TRY(f.finish());
  return out;
}

Result<HandTrack> read_hand(const json& object, const std::string& where, double duration_s) {
  JsonFields f(object, where);
  HandTrack out;
  f.only({"chirality", "shoulder_mm", "keys"});
  const std::string side = f.text("chirality", "right");
  if (side != "left" && side != "right") f.complain(fmt::format("chirality is \"{}\", expected left or right", side));
  out.chirality = side == "left" ? Chirality::kLeft : Chirality::kRight;
  out.shoulder_m = place(f, object, "shoulder_mm", {side == "left" ? -0.2 : 0.2, -0.2, 0.75});
  HandKey last;
  last.t_s = -1;
  for (const json& item : f.list("keys", kMostKeys)) {
    JsonFields k(item, where + ": key " + std::to_string(out.keys.size()));
    k.only({"t", "at_mm", "grab", "pinch_mm"});
    HandKey key;
    key.t_s = k.number("t", 0, duration_s);
    key.at_m = place(k, item, "at_mm", last.at_m);
    key.grab = real(k, "grab", 0, 1, last.grab);
    key.pinch_m = 1e-3 * real(k, "pinch_mm", 0, 200, 1e3 * last.pinch_m);
    if (key.t_s <= last.t_s) k.complain("t does not rise");
    DUBSAR_TRY(k.finish());
    out.keys.push_back(last = key);
  }
  if (out.keys.size() < 2) f.complain("keys has fewer than 2 things");
  DUBSAR_TRY(f.finish());
  return out;
}

Result<HeadTrack> read_head(const json& object, const std::string& where, double duration_s) {
  JsonFields f(object, where);
  HeadTrack out;
  f.only({"ipd_mm", "keys"});
  out.ipd_m = 1e-3 * real(f, "ipd_mm", 40, 90, 63);
  HeadKey last;
  last.t_s = -1;
  for (const json& item : f.list("keys", kMostKeys)) {
    JsonFields k(item, where + ": key " + std::to_string(out.keys.size()));
    k.only({"t", "at_mm"});
    HeadKey key{k.number("t", 0, duration_s), place(k, item, "at_mm", last.at_m)};
    if (key.t_s <= last.t_s) k.complain("t does not rise");
    DUBSAR_TRY(k.finish());
    out.keys.push_back(last = key);
  }
  if (out.keys.size() < 2) f.complain("keys has fewer than 2 things");
  DUBSAR_TRY(f.finish());
  return out;
}

Result<InputEvent> read_event(const json& object, const std::string& where, double duration_s) {
  JsonFields f(object, where);
  InputEvent out;
  f.only({"t", "key", "button", "down", "move_px", "wheel", "shift", "ctrl", "alt"});
  out.time = static_cast<TimestampNs>(1e9 * f.number("t", 0, duration_s));
  out.down = f.flag("down", true);
  out.modifiers = static_cast<std::uint8_t>((f.flag("shift", false) ? kShift : 0) |
                                            (f.flag("ctrl", false) ? kControl : 0) | (f.flag("alt", false) ? kAlt : 0));
  if (f.has("key") + f.has("button") + f.has("move_px") + f.has("wheel") != 1)
    f.complain("expected exactly one of key, button, move_px and wheel");
  if (f.has("key")) {
    out.kind = EventKind::kKey;
    out.key = f.text("key", "");
  } else if (f.has("button")) {
    out.kind = EventKind::kButton;
    const std::string name = f.text("button", "");
    if (name != "left" && name != "middle" && name != "right")
      f.complain(fmt::format("button is \"{}\", expected left, middle or right", name));
    out.button = name == "right" ? MouseButton::kRight : name == "middle" ? MouseButton::kMiddle : MouseButton::kLeft;
  } else if (f.has("wheel")) {
    out.kind = EventKind::kWheel;
    out.motion.y = f.number("wheel", -100, 100);
  } else if (f.has("move_px")) {
    const json& px = object.at("move_px");
    if (!px.is_array() || px.size() != 2 || !px[0].is_number() || !px[1].is_number()) {
      f.complain("move_px is not two numbers");
    } else {
      out.motion = {std::clamp(px[0].get<double>(), -1e5, 1e5), std::clamp(px[1].get<double>(), -1e5, 1e5)};
    }
  }
  DUBSAR_TRY(f.finish());
  return out;
}

}  // namespace

double ScriptRandom::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += uniform(0.0, 1.0);
  return sum;
}

std::optional<HandFrame> sample_hand(const HandTrack& track, double t_s) {
  const auto found = place_in(track.keys, t_s);
  if (!found) return std::nullopt;
  const HandKey& a = track.keys[found->first];
  const HandKey& b = track.keys[std::min(found->first + 1, track.keys.size() - 1)];
  HandFrame hand;
  hand.chirality = track.chirality;
  hand.valid = hand.tracked = true;
  hand.confidence = 1.0;
  hand.palm.position_m = glm::mix(a.at_m, b.at_m, found->second);
  hand.palm.rotation = pointing(hand.palm.position_m - track.shoulder_m);
  hand.grab_strength = glm::mix(a.grab, b.grab, found->second);
  hand.pinch_distance_m = glm::mix(a.pinch_m, b.pinch_m, found->second);
  const double thumb_side = track.chirality == Chirality::kLeft ? 1.0 : -1.0;
  set_joint(hand, HandJoint::kPalm, {0, 0, 0});
  set_joint(hand, HandJoint::kWrist, {0, 0, 0.06});
  set_joint(hand, HandJoint::kIndexProximal, {0.02 * thumb_side, 0, -0.04});
  set_joint(hand, HandJoint::kMiddleProximal, {0, 0, -0.042});
  set_joint(hand, HandJoint::kIndexTip, {0.02 * thumb_side, 0, -0.04 - 0.07 * (1.0 - hand.grab_strength)});
  set_joint(hand, HandJoint::kThumbTip,
            {0.02 * thumb_side, -hand.pinch_distance_m, -0.04 - 0.07 * (1.0 - hand.grab_strength)});
  return hand;
}

std::optional<glm::dvec3> sample_head(const HeadTrack& track, double t_s) {
  const auto found = place_in(track.keys, t_s);
  if (!found) return std::nullopt;
  const std::size_t next = std::min(found->first + 1, track.keys.size() - 1);
  return glm::mix(track.keys[found->first].at_m, track.keys[next].at_m, found->second);
}

Result<Script> parse_script(std::string_view json_text, std::string_view source) {
  auto parsed = parse_json(json_text, source);
  if (!parsed) return fail(ErrorKind::kConfig, "{}", parsed.error().message);
  const json& object = *parsed;
  const std::string where(source);
  JsonFields f(object, where);
  Script out;
  f.only({"seed", "duration_s", "rate_hz", "latency_ms", "noise_mm", "hand_dropouts", "eye_dropouts", "hands", "heads",
          "events", "visitor", "bystanders", "bystander_heads"});
  DUBSAR_TRY(f.finish());
  out.seed = static_cast<std::uint64_t>(real(f, "seed", 0, 9e15, 1));
  out.duration_s = real(f, "duration_s", 0.01, 3600, 10);
  out.rate_hz = real(f, "rate_hz", 1, 1000, 90);
  out.latency_s = 1e-3 * real(f, "latency_ms", 0, 1000, 20);
  out.noise_m = 1e-3 * real(f, "noise_mm", 0, 50, 0);
  const int none = 0;
  out.bystanders = f.integer("bystanders", 0, 3, &none);
  out.bystander_heads = f.flag("bystander_heads", true);
  if (f.has("hand_dropouts")) {
    DUBSAR_ASSIGN(out.hand_dropouts,
                  read_dropouts(object.at("hand_dropouts"), where + ": hand_dropouts", out.hand_dropouts));
  }
  if (f.has("eye_dropouts")) {
    DUBSAR_ASSIGN(out.eye_dropouts,
                  read_dropouts(object.at("eye_dropouts"), where + ": eye_dropouts", out.eye_dropouts));
  }
  for (const json& item : f.list("hands", kMostKeys)) {
    DUBSAR_ASSIGN(HandTrack hand,
                  read_hand(item, where + ": hand " + std::to_string(out.hands.size()), out.duration_s));
    out.hands.push_back(std::move(hand));
  }
  if (out.hands.size() > 4) f.complain("hands has more than 4 things");
  for (const json& item : f.list("heads", kMostKeys)) {
    DUBSAR_ASSIGN(HeadTrack head,
                  read_head(item, where + ": head " + std::to_string(out.heads.size()), out.duration_s));
    out.heads.push_back(std::move(head));
  }
  for (const json& item : f.list("events", kMostKeys)) {
    DUBSAR_ASSIGN(InputEvent event,
                  read_event(item, where + ": event " + std::to_string(out.events.size()), out.duration_s));
    out.events.push_back(std::move(event));
  }
  std::stable_sort(out.events.begin(), out.events.end(),
                   [](const InputEvent& a, const InputEvent& b) { return a.time < b.time; });
  if (f.has("visitor")) {
    const json& visitor = object.at("visitor");
    JsonFields v(visitor, where + ": visitor");
    v.only({"yaw_deg", "pitch_deg", "zoom", "patience_s"});
    out.visitor = VisitorGoal{real(v, "yaw_deg", -180, 180, 0), real(v, "pitch_deg", -90, 90, 0),
                              real(v, "zoom", 0.25, 8, 1), real(v, "patience_s", 1, 3600, 60)};
    DUBSAR_TRY(v.finish());
  }
  DUBSAR_TRY(f.finish());
  return out;
}

}  // namespace dubsar
