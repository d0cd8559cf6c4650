#include "input/recorded_frame.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/text/json_text.h"

namespace dubsar {
namespace {
using nlohmann::json;

constexpr std::size_t kMostThings = 4096;
constexpr double kLargest = 1e6, kRounded = 1e-7;

double to_1e6(double x) { return std::round(x * 1e6) / 1e6; }
double to_1e8(double x) { return std::round(x * 1e8) / 1e8; }
json numbers(const glm::dvec3& v) { return {to_1e6(v.x), to_1e6(v.y), to_1e6(v.z)}; }
json numbers(const glm::dquat& q) { return {to_1e8(q.w), to_1e8(q.x), to_1e8(q.y), to_1e8(q.z)}; }

json hand_json(const HandFrame& hand) {
  json joints = json::array();
  for (std::size_t i = 0; i < hand.joints.size(); ++i)
    if (hand.joints[i].valid)
      joints.push_back({{"j", i},
                        {"at", numbers(hand.joints[i].pose.position_m)},
                        {"q", numbers(hand.joints[i].pose.rotation)},
                        {"r", to_1e6(hand.joints[i].radius_m)},
                        {"tracked", hand.joints[i].tracked}});
  return {{"t", hand.time},
          {"id", hand.id},
          {"side", static_cast<int>(hand.chirality)},
          {"valid", hand.valid},
          {"tracked", hand.tracked},
          {"confidence", hand.confidence},
          {"palm", numbers(hand.palm.position_m)},
          {"q", numbers(hand.palm.rotation)},
          {"v", numbers(hand.velocity_mps)},
          {"grab", hand.grab_strength},
          {"pinch", hand.pinch_distance_m},
          {"joints", joints}};
}

json head_json(const HeadFrame& head) {
  json out{{"t", head.time}, {"id", head.id}, {"tracked", head.tracked}, {"confidence", head.confidence}};
  if (head.left_eye_m) out["left"] = numbers(*head.left_eye_m);
  if (head.right_eye_m) out["right"] = numbers(*head.right_eye_m);
  return out;
}

json grip_json(std::size_t side, const HandGrip& grip) {
  return {{"side", side},
          {"closed", grip.closed},
          {"controller", grip.controller},
          {"at", numbers(grip.pose.position_m)},
          {"q", numbers(grip.pose.rotation)}};
}

bool has_down(EventKind kind) {
  return kind == EventKind::kButton || kind == EventKind::kKey || kind == EventKind::kPinch;
}

json event_json(const InputEvent& event) {
  json out{{"t", event.time}, {"kind", static_cast<int>(event.kind)}, {"mods", event.modifiers}};
  if (event.kind == EventKind::kMotion || event.kind == EventKind::kWheel) out["by"] = {event.motion.x, event.motion.y};
  if (event.kind == EventKind::kButton) out["button"] = static_cast<int>(event.button);
  if (event.kind == EventKind::kPinch)
    out["pinch"] = {event.pinch.by.x, event.pinch.by.y, event.pinch.factor, event.pinch.roll_rad};
  if (event.touched) out["touched"] = true;
  if (event.kind == EventKind::kKey) out["key"] = event.key;
  if (event.repeat) out["repeat"] = true;
  if (event.at) out["at"] = {event.at->x, event.at->y};
  if (event.lever) out["lever"] = *event.lever;
  if (event.eye) out["eye"] = {event.eye->x, event.eye->y, event.eye->z};
  if (has_down(event.kind)) out["down"] = event.down;
  return out;
}

/// Reads one line; the first thing wrong is kept and everything after it reads as zero.
class LineReader {
 public:
  const json& get(const json& object, const char* name) {
    static const json nothing;
    if (object.is_object() && object.contains(name)) return object.at(name);
    complain(std::string(name) + " is missing");
    return nothing;
  }
  double real(const json& value, const char* name) {
    if (value.is_number() && std::abs(value.get<double>()) <= kLargest) return value.get<double>();
    complain(std::string(name) + " is not a number of -1000000 to 1000000");
    return 0.0;
  }
  std::int64_t whole(const json& value, const char* name, std::int64_t low, std::int64_t high) {
    if (value.is_number_integer() &&
        (!value.is_number_unsigned() || value.get<std::uint64_t>() <= std::uint64_t{9'000'000'000'000'000'000}) &&
        value.get<std::int64_t>() >= low && value.get<std::int64_t>() <= high)
      return value.get<std::int64_t>();
    complain(fmt::format("{} is not a whole number of {} to {}", name, low, high));
    return low;
  }
  TimestampNs time(const json& object) { return whole(get(object, "t"), "t", 0, kLatest); }
  bool truth(const json& object, const char* name) {
    const json& value = get(object, name);
    if (!value.is_boolean()) complain(std::string(name) + " is not true or false");
    return value.is_boolean() && value.get<bool>();
  }
  template <std::size_t N>
  std::array<double, N> reals(const json& value, const char* name) {
    std::array<double, N> out{};
    if (!value.is_array() || value.size() != N) {
      complain(fmt::format("{} is not {} numbers", name, N));
      return out;
    }
    for (std::size_t i = 0; i < N; ++i) out[i] = real(value[i], name);
    return out;
  }
  glm::dvec3 vector(const json& object, const char* name) {
    const auto v = reals<3>(get(object, name), name);
    return {v[0], v[1], v[2]};
  }
  glm::dquat turn(const json& object, const char* name) {
    const auto v = reals<4>(get(object, name), name);
    const glm::dquat q(v[0], v[1], v[2], v[3]);
    const double length = glm::length(q);
    if (std::abs(length - 1.0) <= kRounded) return q;  // so that a line read and written again is the same
    if (std::abs(length - 1.0) <= 0.01) return glm::normalize(q);
    complain(std::string(name) + " is not a unit quaternion");
    return {1, 0, 0, 0};
  }
  const json& list(const json& object, const char* name, std::size_t most) {
    static const json empty = json::array();
    if (!object.contains(name)) return empty;
    if (object.at(name).is_array() && object.at(name).size() <= most) return object.at(name);
    complain(fmt::format("{} is not a list of at most {} things", name, most));
    return empty;
  }
  void complain(std::string sentence) {
    if (complaint_.empty()) complaint_ = std::move(sentence);
  }
  const std::string& complaint() const { return complaint_; }

  static constexpr TimestampNs kLatest = 4'000'000'000'000'000'000;

 private:
  std::string complaint_;
};

HandFrame read_hand(LineReader& read, const json& object) {
  HandFrame hand;
  hand.time = read.time(object);
  hand.id = static_cast<std::uint32_t>(read.whole(read.get(object, "id"), "id", 0, 0xffffffffLL));
  hand.chirality = static_cast<Chirality>(read.whole(read.get(object, "side"), "side", 0, 2));
  hand.valid = read.truth(object, "valid");
  hand.tracked = read.truth(object, "tracked");
  hand.confidence = read.real(read.get(object, "confidence"), "confidence");
  hand.palm = {read.vector(object, "palm"), read.turn(object, "q")};
  hand.velocity_mps = read.vector(object, "v");
  hand.grab_strength = read.real(read.get(object, "grab"), "grab");
  hand.pinch_distance_m = read.real(read.get(object, "pinch"), "pinch");
  for (const json& item : read.list(object, "joints", kHandJointCount)) {
    HandJointPose& joint =
        hand.joints[static_cast<std::size_t>(read.whole(read.get(item, "j"), "j", 0, kHandJointCount - 1))];
    joint = {{read.vector(item, "at"), read.turn(item, "q")},
             read.real(read.get(item, "r"), "r"),
             true,
             read.truth(item, "tracked")};
  }
  return hand;
}

HeadFrame read_head(LineReader& read, const json& object) {
  HeadFrame head;
  head.time = read.time(object);
  head.id = static_cast<std::uint32_t>(read.whole(read.get(object, "id"), "id", 0, 0xffffffffLL));
  head.tracked = read.truth(object, "tracked");
  head.confidence = read.real(read.get(object, "confidence"), "confidence");
  if (object.is_object() && object.contains("left")) head.left_eye_m = read.vector(object, "left");
  if (object.is_object() && object.contains("right")) head.right_eye_m = read.vector(object, "right");
  return head;
}

void read_grip(LineReader& read, const json& object, HandGrips& grips) {
  grips[static_cast<std::size_t>(read.whole(read.get(object, "side"), "side", 0, 1))] = {
      true,
      read.truth(object, "closed"),
      read.truth(object, "controller"),
      {read.vector(object, "at"), read.turn(object, "q")}};
}

InputEvent read_event(LineReader& read, const json& object) {
  InputEvent event;
  event.time = read.time(object);
  event.kind = static_cast<EventKind>(read.whole(read.get(object, "kind"), "kind", 0, 4));
  event.modifiers = static_cast<std::uint8_t>(read.whole(read.get(object, "mods"), "mods", 0, 7));
  if (event.kind == EventKind::kMotion || event.kind == EventKind::kWheel) {
    const auto by = read.reals<2>(read.get(object, "by"), "by");
    event.motion = {by[0], by[1]};
  }
  if (event.kind == EventKind::kButton)
    event.button = static_cast<MouseButton>(read.whole(read.get(object, "button"), "button", 0, 2));
  if (event.kind == EventKind::kPinch) {
    const auto pinch = read.reals<4>(read.get(object, "pinch"), "pinch");
    event.pinch = {{pinch[0], pinch[1]}, pinch[2], pinch[3]};
    if (event.pinch.factor <= 0.0) read.complain("pinch has a factor that is not above 0");
  }
  if (object.is_object() && object.contains("touched")) event.touched = read.truth(object, "touched");
  if (has_down(event.kind)) event.down = read.truth(object, "down");
  if (object.is_object() && object.contains("repeat")) event.repeat = read.truth(object, "repeat");
  if (object.is_object() && object.contains("lever")) event.lever = read.real(object.at("lever"), "lever");
  if (object.is_object() && object.contains("eye")) event.eye = read.vector(object, "eye");
  if (object.is_object() && object.contains("at")) {
    const auto at = read.reals<2>(object.at("at"), "at");
    event.at = {at[0], at[1]};
  }
  if (event.kind == EventKind::kKey) {
    const json& key = read.get(object, "key");
    if (key.is_string() && key.get_ref<const std::string&>().size() <= 32) {
      event.key = key.get<std::string>();
    } else {
      read.complain("key is not a name of at most 32 letters");
    }
  }
  return event;
}

RecordedFrame read_frame(LineReader& read, const json& object) {
  RecordedFrame out;
  out.polled = read.whole(read.get(object, "polled"), "polled", 0, LineReader::kLatest);
  out.frame.time = read.time(object);
  for (const json& item : read.list(object, "events", kMostThings)) out.frame.events.push_back(read_event(read, item));
  for (const json& item : read.list(object, "hands", kMaxHands)) out.frame.hands.push_back(read_hand(read, item));
  for (const json& item : read.list(object, "heads", 16)) out.frame.heads.push_back(read_head(read, item));
  for (const json& item : read.list(object, "grips", 2)) read_grip(read, item, out.frame.grips);
  if (object.contains("puck")) {
    const json& space_mouse = object.at("puck");
    out.frame.space_mouse =
        SpaceMouseMotion{read.time(space_mouse), read.vector(space_mouse, "push"), read.vector(space_mouse, "twist")};
  }
  return out;
}

}  // namespace

std::string record_line(const RecordedFrame& recorded) {
  const InputFrame& frame = recorded.frame;
  json out{{"polled", recorded.polled}, {"t", frame.time}};
  for (const InputEvent& event : frame.events) out["events"].push_back(event_json(event));
  for (const HandFrame& hand : frame.hands) out["hands"].push_back(hand_json(hand));
  for (const HeadFrame& head : frame.heads) out["heads"].push_back(head_json(head));
  for (std::size_t side = 0; side < frame.grips.size(); ++side)
    if (frame.grips[side].active) out["grips"].push_back(grip_json(side, frame.grips[side]));
  if (frame.space_mouse)
    out["puck"] = {{"t", frame.space_mouse->time},
                   {"push", numbers(frame.space_mouse->push)},
                   {"twist", numbers(frame.space_mouse->twist)}};
  return dump_json(out);
}

Result<RecordedFrame> parse_line(std::string_view line) {
  DUBSAR_ASSIGN(const json object, parse_json(line, "line"));
  if (!object.is_object()) return fail(ErrorKind::kConfig, "found {}, expected an object", object.type_name());
  LineReader read;
  RecordedFrame frame = read_frame(read, object);
  if (!read.complaint().empty()) return fail(ErrorKind::kConfig, "{}", read.complaint());
  return frame;
}

}  // namespace dubsar
