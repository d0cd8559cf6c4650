#include "input/navigation/mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/text/json_fields.h"
#include "core/base/text/json_text.h"
#include "input/navigation/embedded_mappings.h"

namespace dubsar {
namespace {
using nlohmann::json;

constexpr std::array<std::string_view, 10> kActionNames{"none",          "rotate", "rotate_fine", "pan",    "zoom",
                                                        "zoom_and_roll", "light",  "next_side",   "select", "reset"};
constexpr std::array<std::string_view, 5> kControlNames{"none", "mouse", "keyboard", "puck", "hands"};
constexpr std::initializer_list<Action> kDrags{Action::kNone, Action::kRotate, Action::kPan, Action::kZoom,
                                               Action::kLight};
constexpr std::initializer_list<Action> kMouseDrags{Action::kNone, Action::kRotate, Action::kRotateFine,
                                                    Action::kPan,  Action::kZoom,   Action::kLight};
constexpr std::size_t kLongestKeyCommand = 200;

TimestampNs from_ms(double ms) { return static_cast<TimestampNs>(ms * 1e6); }

Action read_action(JsonFields& fields, const std::string& name, std::initializer_list<Action> allowed) {
  const std::string found = fields.text(name.c_str(), nullptr);
  std::string names;
  for (const Action action : allowed) {
    if (found == action_name(action)) return action;
    names += (names.empty() ? "" : ", ") + std::string(action_name(action));
  }
  fields.complain(fmt::format("{} is \"{}\", expected one of: {}", name, found, names));
  return Action::kNone;
}

glm::dvec3 read_vector(JsonFields& fields, const json& object, const char* name) {
  glm::dvec3 out{0.0};
  const json* const value = fields.has(name) ? &object.at(name) : nullptr;
  if (value == nullptr || !value->is_array() || value->size() != 3 ||
      !std::all_of(value->begin(), value->end(),
                   [](const json& v) { return v.is_number() && std::abs(v.get<double>()) <= 5000; })) {
    fields.complain(fmt::format("{} is not three numbers of -5000 to 5000", name));
    return out;
  }
  for (std::size_t i = 0; i < 3; ++i) out[static_cast<int>(i)] = value->at(i).get<double>();
  return out;
}

/// Names in `found` that `known` does not have; the tables of mouse chords and keys are open.
Result<void> refuse_unknown(const json& found, const json& known, const std::string& where) {
  std::vector<std::string_view> names;
  for (const auto& item : known.get_ref<const json::object_t&>()) names.push_back(item.first);
  DUBSAR_TRY(check_members(found, names, where, ErrorKind::kConfig));
  for (const auto& [name, value] : found.items()) {
    if (known.at(name).is_object() && name != "keys" && name != "mouse") {
      DUBSAR_TRY(refuse_unknown(value, known.at(name), fmt::format("{}: {}", where, name)));
    } else if (known.at(name).is_object() && !value.is_object()) {
      return fail(ErrorKind::kConfig, "{}: {} is {}, expected an object", where, name, value.type_name());
    }
  }
  return {};
}

Result<HandMapping> read_hands(const json& object, const std::string& where) {
  JsonFields f(object, where);
  HandMapping out;
  out.grab = read_action(f, "grab", kDrags);
  out.pull = read_action(f, "pull", {Action::kNone, Action::kZoom});
  out.two_hands = read_action(f, "two_hands", {Action::kNone, Action::kZoom, Action::kZoomAndRoll});
  out.pinch = read_action(f, "pinch", kDrags);
  out.swipe = read_action(f, "swipe", {Action::kNone, Action::kNextSide});
  out.dwell = read_action(f, "dwell", {Action::kNone, Action::kSelect, Action::kReset});
  out.turn_deg_per_mm = f.number("turn_deg_per_mm", 0.01, 10);
  out.light_deg_per_mm = f.number("light_deg_per_mm", 0.01, 10);
  out.inertia_s = f.number("inertia_s", 0, 5);
  out.fastest_turn_deg_per_s = f.number("fastest_turn_deg_per_s", 10, 720);
  out.fastest_zoom_per_s = f.number("fastest_zoom_per_s", 1.05, 20);
  out.zone_min_mm = read_vector(f, object, "zone_min_mm");
  out.zone_max_mm = read_vector(f, object, "zone_max_mm");
  out.entry_margin_mm = read_vector(f, object, "entry_margin_mm");
  for (int i = 0; i < 3; ++i) {
    if (out.entry_margin_mm[i] < 0.0) f.complain("entry_margin_mm is below 0");
    if (out.zone_min_mm[i] >= out.zone_max_mm[i]) f.complain("zone_min_mm is not below zone_max_mm");
  }
  DUBSAR_TRY(f.finish());
  return out;
}

Result<GestureOptions> read_gestures(const json& object, const std::string& where) {
  JsonFields f(object, where);
  GestureOptions out;
  out.grab.on = f.number("grab_on", 0.1, 1);
  out.grab.off = f.number("grab_off", 0, 1);
  out.grab.gentle = f.number("grab_gentle", 0.1, 1);
  out.grab.rise = f.number("grab_rise", 0.05, 1);
  out.grab.let_go = f.number("grab_let_go", 0.05, 1);
  out.grab.rest_mps = 1e-3 * f.number("grab_rest_mm_per_s", 1, 5000);
  out.grab.still_ns = from_ms(f.number("grab_still_ms", 0, 2000));
  out.grab.sure_ns = from_ms(f.number("grab_sure_ms", 0, 1000));
  out.grab.open_ns = from_ms(f.number("grab_open_ms", 0, 1000));
  out.grab.beginner_slack = f.number("grab_beginner_slack", 0, 0.5);
  out.held.pull_start_m = 1e-3 * f.number("pull_start_mm", 1, 200);
  out.pinch.on_m = 1e-3 * f.number("pinch_on_mm", 5, 60);
  out.pinch.off_m = 1e-3 * f.number("pinch_off_mm", 5, 100);
  out.held.drag_start_m = 1e-3 * f.number("drag_start_mm", 0, 100);
  out.held.roll_start_rad = f.number("roll_start_deg", 0, 45) * std::numbers::pi / 180;
  out.cooldown_ns = from_ms(f.number("cooldown_ms", 0, 5000));
  out.hold_ns = from_ms(f.number("hold_ms", 0, 1000));
  out.swipe.fast_mps = 1e-3 * f.number("swipe_mm_per_s", 100, 5000);
  out.swipe.lateral_mps = 1e-3 * f.number("swipe_lateral_mm_per_s", 10, 5000);
  out.swipe.end_mps = 1e-3 * f.number("swipe_end_mm_per_s", 10, 5000);
  out.swipe.opposing_mps = 1e-3 * f.number("swipe_opposing_mm_per_s", 1, 5000);
  out.swipe.lockout_ns = from_ms(f.number("swipe_lockout_ms", 0, 5000));
  out.swipe.travel_m = 1e-3 * f.number("swipe_travel_mm", 0, 500);
  out.swipe.known_ns = from_ms(f.number("swipe_known_ms", 0, 60000));
  out.swipe.sure_ns = from_ms(f.number("swipe_sure_ms", 0, 60000));
  out.swipe.still_ns = from_ms(f.number("swipe_still_ms", 0, 2000));
  out.place.signs_from_x_m = 1e-3 * f.number("signs_from_x_mm", -10000, 10000);
  out.place.signs_from_y_m = 1e-3 * f.number("signs_from_y_mm", -10000, 10000);
  out.place.acts_to_z_m = 1e-3 * f.number("acts_to_z_mm", -10000, 10000);
  out.swipe.within_m = 1e-3 * f.number("swipes_within_mm", 0, 10000);
  out.dwell.radius_m = 1e-3 * f.number("dwell_radius_mm", 1, 200);
  out.dwell.start_ns = from_ms(f.number("dwell_start_ms", 0, 10000));
  out.dwell.fill_ns = from_ms(f.number("dwell_fill_ms", 50, 10000));
  if (out.grab.off >= out.grab.on) f.complain("grab_off is not below grab_on");
  if (out.pinch.off_m <= out.pinch.on_m) f.complain("pinch_off_mm is not above pinch_on_mm");
  if (out.swipe.end_mps >= out.swipe.fast_mps) f.complain("swipe_end_mm_per_s is not below swipe_mm_per_s");
  DUBSAR_TRY(f.finish());
  return out;
}

bool is_chord(std::string_view name) {
  for (const std::string_view modifier : {"shift+", "ctrl+", "alt+"})
    if (name.starts_with(modifier)) name.remove_prefix(modifier.size());
  return name == "left" || name == "middle" || name == "right" || name == "wheel";
}

Result<MouseMapping> read_mouse(const json& object, const std::string& where) {
  JsonFields f(object, where);
  MouseMapping out;
  out.turn_deg_per_px = f.number("turn_deg_per_px", 0.001, 10);
  out.light_deg_per_px = f.number("light_deg_per_px", 0.001, 10);
  out.zoom_per_100_px = f.number("zoom_per_100_px", 1.01, 20);
  out.zoom_per_notch = f.number("zoom_per_notch", 1.001, 4);
  for (const auto& [name, value] : object.items()) {
    if (value.is_number()) {
      if (name != "turn_deg_per_px" && name != "light_deg_per_px" && name != "zoom_per_100_px" &&
          name != "zoom_per_notch")
        f.complain(fmt::format("\"{}\" is not known", name));
    } else if (is_chord(name)) {
      out.chords[name] = read_action(f, name, kMouseDrags);
    } else {
      f.complain(
          fmt::format("\"{}\" is no mouse chord, expected left, middle, right or wheel, after shift+, ctrl+ or alt+ "
                      "in this order",
                      name));
    }
  }
  DUBSAR_TRY(f.finish());
  return out;
}

Result<Mapping> read_mapping(const json& object, const std::string& where) {
  Mapping out;
  DUBSAR_ASSIGN(out.hands, read_hands(object.at("hands"), where + ": hands"));
  DUBSAR_ASSIGN(out.gestures, read_gestures(object.at("gestures"), where + ": gestures"));
  DUBSAR_ASSIGN(out.mouse, read_mouse(object.at("mouse"), where + ": mouse"));
  JsonFields keys(object.at("keys"), where + ": keys");
  for (const auto& item : object.at("keys").items()) {
    const std::string command = keys.text(item.key().c_str(), nullptr);
    if (command.empty() || command.size() > kLongestKeyCommand || !item.value().is_string())
      keys.complain(fmt::format("{} is no command, expected its name, with what it is told behind it", item.key()));
    out.keys[item.key()] = command;
  }
  DUBSAR_TRY(keys.finish());
  JsonFields space_mouse(object.at("puck"), where + ": puck");
  out.space_mouse.turn_deg_per_s = space_mouse.number("turn_deg_per_s", 1, 720);
  out.space_mouse.pan_per_s = space_mouse.number("pan_per_s", 0.01, 10);
  out.space_mouse.zoom_per_s = space_mouse.number("zoom_per_s", 1.01, 20);
  out.space_mouse.dead_zone = space_mouse.number("dead_zone", 0, 0.5);
  out.space_mouse.one_axis = space_mouse.flag("one_axis", false);
  DUBSAR_TRY(space_mouse.finish());
  JsonFields f(object, where);
  out.key_step_deg = f.number("key_step_deg", 0.1, 90);
  out.key_zoom = f.number("key_zoom", 1.001, 4);
  out.zoom_min = f.number("zoom_min", 0.01, 1);
  out.zoom_max = f.number("zoom_max", 1, 1000);
  out.handover_ns = from_ms(f.number("handover_ms", 0, 10000));
  const json& priority = object.at("priority");
  for (const json& name : priority) {
    const auto* const found = name.is_string()
                                  ? std::find(kControlNames.begin() + 1, kControlNames.end(), name.get<std::string>())
                                  : kControlNames.end();
    const auto control = static_cast<Control>(found - kControlNames.begin());
    if (found == kControlNames.end() ||
        std::find(out.priority.begin(), out.priority.end(), control) != out.priority.end()) {
      f.complain("priority is not a list of mouse, keyboard, puck and hands, each at most once");
      break;
    }
    out.priority.push_back(control);
  }
  if (!priority.is_array()) f.complain("priority is not a list of mouse, keyboard, puck and hands, each at most once");
  DUBSAR_TRY(f.finish());
  return out;
}

}  // namespace

std::string_view action_name(Action action) noexcept { return kActionNames[static_cast<std::size_t>(action)]; }

Result<Mapping> parse_mapping(std::string_view json_text, std::string_view source) {
  DUBSAR_ASSIGN(json merged, parse_json(embedded_mappings().front().second, "the program's own mapping"));
  auto changes = parse_json(json_text, source);
  if (!changes) return fail(ErrorKind::kConfig, "{}", changes.error().message);
  DUBSAR_TRY(refuse_unknown(*changes, merged, std::string(source)));
  for (const auto& [name, value] : changes->items())
    if (value.is_null()) return fail(ErrorKind::kConfig, "{}: {} is null, expected a value", source, name);
  if (changes->contains("keys"))
    for (auto& [key, command] : changes->at("keys").items())
      if (command.is_null()) command = "none";
  merged.merge_patch(*changes);
  return read_mapping(merged, std::string(source));
}

Result<Mapping> default_mapping() { return parse_mapping("{}", "the program's own mapping"); }

Result<Mapping> gallery_mapping() {
  for (const auto& [name, text] : embedded_mappings())
    if (name == "gallery.json") return parse_mapping(text, "the program's mapping for galleries");
  return fail(ErrorKind::kInternal, "the program's mapping for galleries is not embedded");
}

Action chord_action(const MouseMapping& mapping, std::uint8_t modifiers, std::string_view what) {
  std::string chord;
  if (modifiers & kShift) chord += "shift+";
  if (modifiers & kControl) chord += "ctrl+";
  if (modifiers & kAlt) chord += "alt+";
  const auto found = mapping.chords.find(chord.append(what));
  return found == mapping.chords.end() ? Action::kNone : found->second;
}

}  // namespace dubsar
