// Hands and controllers of the made runtime.

#include <algorithm>
#include <cstring>

#include "tests/openxr_runtime/runtime_state.h"

namespace dubsar::testing {
namespace {

// XR_EXT_hand_tracking_data_source, newer than Debian's headers: values of Khronos' registry.
constexpr auto kSourceInfo = static_cast<XrStructureType>(1000428000);
constexpr auto kSourceState = static_cast<XrStructureType>(1000428001);
constexpr std::int32_t kSeenHand = 1, kControllersHand = 2;
struct HandSource {
  XrStructureType type;
  void* next;
  XrBool32 active;
  std::int32_t source;
};

XrResult XRAPI_CALL create_tracker(XrSession, const XrHandTrackerCreateInfoEXT* info, XrHandTrackerEXT* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (s.headset.manners.refuses_trackers) return XR_ERROR_FEATURE_UNSUPPORTED;
  s.trackers[s.next_handle] = info->hand == XR_HAND_LEFT_EXT ? 0 : 1;
  s.only_seen_hands = info->next != nullptr && static_cast<const XrBaseInStructure*>(info->next)->type == kSourceInfo;
  ++s.headset.alive.hand_trackers;
  *out = handle_of<XrHandTrackerEXT>(s.next_handle++);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL destroy_tracker(XrHandTrackerEXT tracker) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  s.headset.alive.hand_trackers -= static_cast<int>(s.trackers.erase(id_of(tracker)));
  return XR_SUCCESS;
}

/// A flat right hand, fingers ahead (-z), palm down: joint places in metres from the palm. Order of
/// XR_EXT_hand_tracking.
std::array<glm::dvec3, 26> made_hand(bool pinch, bool fist) {
  std::array<glm::dvec3, 26> out{};
  out[0] = {0, 0, 0};
  out[1] = {0, 0, 0.07};
  const std::array<double, 4> across{-0.025, 0.0, 0.02, 0.04};  // index to little, from the thumb's side
  for (std::size_t f = 0; f < 4; ++f)
    for (std::size_t j = 0; j < 5; ++j) {
      constexpr std::array<double, 5> kAhead{0.04, -0.03, -0.07, -0.095, -0.115};
      out[6 + 5 * f + j] = {across[f], 0.0, kAhead[j]};
    }
  out[2] = {-0.03, -0.01, 0.05};
  out[3] = {-0.05, -0.02, 0.02};
  out[4] = {-0.065, -0.03, -0.01};
  out[5] = {-0.075, -0.035, -0.035};
  for (std::size_t f = 0; fist && f < 4; ++f) {  // ends of the fingers under the palm
    constexpr std::array<glm::dvec2, 3> kCurled{{{-0.035, -0.045}, {-0.045, -0.015}, {-0.03, 0.0}}};
    for (std::size_t j = 2; j < 5; ++j) out[6 + 5 * f + j] = {across[f], kCurled[j - 2].x, kCurled[j - 2].y};
  }
  if (pinch) {  // thumb and index meet before the palm
    out[8] = {-0.035, -0.02, -0.065};
    out[9] = {-0.045, -0.04, -0.07};
    out[10] = {-0.05, -0.055, -0.065};
    out[4] = {-0.055, -0.045, -0.03};
    out[5] = {-0.052, -0.056, -0.06};
  }
  return out;
}

XrResult XRAPI_CALL locate_joints(XrHandTrackerEXT tracker, const XrHandJointsLocateInfoEXT* info,
                                  XrHandJointLocationsEXT* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  const MadeHeadset& h = s.headset;
  if (session_lost()) return XR_ERROR_SESSION_LOST;
  const bool of_controller = h.manners.hands_from_controllers && h.hands.controller;
  const bool there = s.trackers[id_of(tracker)] == 1 && (h.hands.right_hand || (of_controller && !s.only_seen_hands));
  out->isActive = there ? XR_TRUE : XR_FALSE;
  if (auto* const source = static_cast<HandSource*>(out->next); source != nullptr && source->type == kSourceState) {
    if (!h.manners.hand_source) ++state().headset.wrong_calls;
    source->active = out->isActive;
    source->source = of_controller ? kControllersHand : kSeenHand;
  }
  if (!there) return XR_SUCCESS;
  const double t = 1e-9 * static_cast<double>(info->time);
  const bool holds = of_controller || (t >= h.hands.hold_from && t < h.hands.hold_to);
  const double moving = std::clamp(t - h.hands.hold_from, 0.0, h.hands.hold_to - h.hands.hold_from);
  const glm::dvec3 palm = of_controller ? h.hands.grip.position : h.hands.hand_from + h.hands.hand_speed * moving;
  const bool fist = h.hands.fist || of_controller;
  const auto places = made_hand(holds && !fist, holds && fist);
  for (std::uint32_t i = 0; i < out->jointCount && i < places.size(); ++i) {
    out->jointLocations[i].pose =
        posef(in_space({palm + places[i], {1, 0, 0, 0}}, s.spaces[id_of(info->baseSpace)], t));
    out->jointLocations[i].radius = 0.008f;
    out->jointLocations[i].locationFlags =
        XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT |
        XR_SPACE_LOCATION_POSITION_TRACKED_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
  }
  return XR_SUCCESS;
}

XrResult XRAPI_CALL string_to_path(XrInstance, const char* text, XrPath* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  *out = s.paths.try_emplace(text, s.paths.size() + 1).first->second;
  return XR_SUCCESS;
}
XrResult XRAPI_CALL create_action_set(XrInstance, const XrActionSetCreateInfo*, XrActionSet* out) {
  *out = handle_of<XrActionSet>(state().next_handle++);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL destroy_action_set(XrActionSet) { return XR_SUCCESS; }
XrResult XRAPI_CALL create_action(XrActionSet, const XrActionCreateInfo* info, XrAction* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  s.actions[s.next_handle] = {info->actionName, info->actionType};
  *out = handle_of<XrAction>(s.next_handle++);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL suggest_bindings(XrInstance, const XrInteractionProfileSuggestedBinding* suggestion) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  // As strict as runtimes are: profiles and their components must be known.
  static const std::map<std::string, std::vector<std::string>> profiles{
      {"/interaction_profiles/khr/simple_controller", {"/input/select/click", "/input/menu/click", "/input/grip/pose"}},
      {"/interaction_profiles/oculus/touch_controller",
       {"/input/squeeze/value", "/input/trigger/value", "/input/grip/pose"}}};
  const auto text_of = [&](XrPath path) {
    for (const auto& [text, known] : s.paths)
      if (known == path) return text;
    return std::string();
  };
  const auto profile = profiles.find(text_of(suggestion->interactionProfile));
  if (profile == profiles.end()) return XR_ERROR_PATH_UNSUPPORTED;
  for (std::uint32_t i = 0; i < suggestion->countSuggestedBindings; ++i) {
    const std::string to = text_of(suggestion->suggestedBindings[i].binding);
    const auto component = to.find("/input/");
    const auto& known = profile->second;
    if (component == std::string::npos || std::find(known.begin(), known.end(), to.substr(component)) == known.end()) {
      ++s.headset.wrong_calls;
      return XR_ERROR_PATH_UNSUPPORTED;
    }
  }
  return XR_SUCCESS;
}
XrResult XRAPI_CALL attach(XrSession, const XrSessionActionSetsAttachInfo*) { return XR_SUCCESS; }
XrResult XRAPI_CALL create_action_space(XrSession, const XrActionSpaceCreateInfo* info, XrSpace* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  const bool left = info->subactionPath == s.paths["/user/hand/left"];
  s.spaces[s.next_handle] = {SpaceKind::kGrip, left ? 0 : 1};
  ++s.headset.alive.spaces;
  *out = handle_of<XrSpace>(s.next_handle++);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL sync(XrSession, const XrActionsSyncInfo*) {
  const std::lock_guard lock(state().headset.mutex);
  leave_traces("xrSyncActions");
  if (session_lost()) return XR_ERROR_SESSION_LOST;
  return state().events.told == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}
/// There is a right controller, or none.
bool held(const XrActionStateGetInfo* info) {
  return state().headset.hands.controller && info->subactionPath == state().paths["/user/hand/right"];
}
XrResult XRAPI_CALL pose_state(XrSession, const XrActionStateGetInfo* info, XrActionStatePose* out) {
  const std::lock_guard lock(state().headset.mutex);
  out->isActive = held(info) ? XR_TRUE : XR_FALSE;
  return XR_SUCCESS;
}
XrResult XRAPI_CALL float_state(XrSession, const XrActionStateGetInfo* info, XrActionStateFloat* out) {
  const std::lock_guard lock(state().headset.mutex);
  out->isActive = held(info) ? XR_TRUE : XR_FALSE;
  out->currentState = static_cast<float>(state().headset.hands.squeeze);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL boolean_state(XrSession, const XrActionStateGetInfo* info, XrActionStateBoolean* out) {
  const std::lock_guard lock(state().headset.mutex);
  out->isActive = held(info) ? XR_TRUE : XR_FALSE;
  out->currentState = XR_FALSE;
  return XR_SUCCESS;
}

template <class F>
PFN_xrVoidFunction plain(F* function) {
  return reinterpret_cast<PFN_xrVoidFunction>(function);
}

}  // namespace

PFN_xrVoidFunction input_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> functions{
      {"xrCreateHandTrackerEXT", plain(&create_tracker)},
      {"xrDestroyHandTrackerEXT", plain(&destroy_tracker)},
      {"xrLocateHandJointsEXT", plain(&locate_joints)},
      {"xrStringToPath", plain(&string_to_path)},
      {"xrCreateActionSet", plain(&create_action_set)},
      {"xrDestroyActionSet", plain(&destroy_action_set)},
      {"xrCreateAction", plain(&create_action)},
      {"xrSuggestInteractionProfileBindings", plain(&suggest_bindings)},
      {"xrAttachSessionActionSets", plain(&attach)},
      {"xrCreateActionSpace", plain(&create_action_space)},
      {"xrSyncActions", plain(&sync)},
      {"xrGetActionStatePose", plain(&pose_state)},
      {"xrGetActionStateFloat", plain(&float_state)},
      {"xrGetActionStateBoolean", plain(&boolean_state)}};
  const auto found = functions.find(name);
  return found != functions.end() ? found->second : nullptr;
}

}  // namespace dubsar::testing
