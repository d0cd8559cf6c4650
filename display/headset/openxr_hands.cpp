#include "display/headset/openxr_hands.h"

#include <cstring>

namespace dubsar::openxr {
namespace {

constexpr XrSpaceLocationFlags kPlaced = XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
constexpr XrSpaceLocationFlags kSeen =
    XR_SPACE_LOCATION_POSITION_TRACKED_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;

template <std::size_t N>
void put(char (&to)[N], const char* text) {
  std::strncpy(to, text, N - 1);
  to[N - 1] = '\0';
}

}  // namespace

Result<std::unique_ptr<HandInput>> HandInput::create(const Instance& instance, XrSession session) {
  std::unique_ptr<HandInput> out(new HandInput(instance));
  out->session_ = session;
  if (instance.has_hands()) DUBSAR_TRY(out->make_trackers(session));
  DUBSAR_TRY(out->make_actions(session));
  return out;
}

/// Of hands that are seen, not of those that a runtime draws round a held controller: its closed fingers are no grip.
Result<void> HandInput::make_trackers(XrSession session) {
  const auto create = function_of<PFN_xrCreateHandTrackerEXT>(instance_->handle(), "xrCreateHandTrackerEXT");
  locate_joints_ = function_of<PFN_xrLocateHandJointsEXT>(instance_->handle(), "xrLocateHandJointsEXT");
  if (create == nullptr || locate_joints_ == nullptr) return {};
  XrHandTrackingDataSourceEXT seen = XR_HAND_TRACKING_DATA_SOURCE_UNOBSTRUCTED_EXT;
  XrHandTrackingDataSourceInfoEXT source{XR_TYPE_HAND_TRACKING_DATA_SOURCE_INFO_EXT, nullptr, 1, &seen};
  for (std::size_t side = 0; side < 2; ++side) {
    auto info = made<XrHandTrackerCreateInfoEXT>(XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT);
    if (instance_->tells_hand_source()) info.next = &source;
    info.hand = side == 0 ? XR_HAND_LEFT_EXT : XR_HAND_RIGHT_EXT;
    info.handJointSet = XR_HAND_JOINT_SET_DEFAULT_EXT;
    const XrResult made = door()(create, session, &info, &trackers_[side]);
    if (XR_FAILED(made)) trackers_[side] = XR_NULL_HANDLE;
    // Monado 25 refuses a tracker of seen hands where it has those of controllers only: then there are none.
    if (made == XR_ERROR_SESSION_LOST || made == XR_ERROR_INSTANCE_LOST) return check(made, "following a hand");
  }
  return {};
}

HandInput::~HandInput() {
  const auto destroy = function_of<PFN_xrDestroyHandTrackerEXT>(instance_->handle(), "xrDestroyHandTrackerEXT");
  for (const XrHandTrackerEXT tracker : trackers_)
    if (tracker != XR_NULL_HANDLE && destroy != nullptr) door()(destroy, tracker);
  for (const XrSpace grip : grips_)
    if (grip != XR_NULL_HANDLE) door()(xrDestroySpace, grip);
  if (set_ != XR_NULL_HANDLE) door()(xrDestroyActionSet, set_);
}

Result<XrAction> HandInput::make_action(const char* name, const char* words, XrActionType type) {
  auto info = made<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
  put(info.actionName, name);
  put(info.localizedActionName, words);
  info.actionType = type;
  info.countSubactionPaths = 2;
  info.subactionPaths = sides_.data();
  XrAction action = XR_NULL_HANDLE;
  DUBSAR_TRY(check(door()(xrCreateAction, set_, &info, &action), "making an action"));
  return action;
}

/// Where a runtime does not know a profile it says so, and the others hold.
void HandInput::suggest(const char* profile, const char* squeeze, const char* select) {
  const XrInstance instance = instance_->handle();
  XrPath path = XR_NULL_PATH;
  if (XR_FAILED(door()(xrStringToPath, instance, profile, &path))) return;
  std::vector<XrActionSuggestedBinding> bindings;
  for (const char* side : {"/user/hand/left", "/user/hand/right"}) {
    const auto bind = [&](XrAction action, const char* component) {
      XrPath to = XR_NULL_PATH;
      if (XR_SUCCEEDED(door()(xrStringToPath, instance, (std::string(side) + component).c_str(), &to)))
        bindings.push_back({action, to});
    };
    bind(grip_, "/input/grip/pose");
    bind(squeeze_, squeeze);
    bind(select_, select);
  }
  auto suggestion = made<XrInteractionProfileSuggestedBinding>(XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
  suggestion.interactionProfile = path;
  suggestion.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
  suggestion.suggestedBindings = bindings.data();
  door()(xrSuggestInteractionProfileBindings, instance, &suggestion);
}

Result<void> HandInput::make_actions(XrSession session) {
  const XrInstance instance = instance_->handle();
  DUBSAR_TRY(check(door()(xrStringToPath, instance, "/user/hand/left", &sides_[0]), "naming a hand"));
  DUBSAR_TRY(check(door()(xrStringToPath, instance, "/user/hand/right", &sides_[1]), "naming a hand"));
  auto set = made<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
  put(set.actionSetName, "tablet");
  put(set.localizedActionSetName, "Holding the tablet");
  DUBSAR_TRY(check(door()(xrCreateActionSet, instance, &set, &set_), "making actions"));
  DUBSAR_ASSIGN(grip_, make_action("grip", "Where the controller is", XR_ACTION_TYPE_POSE_INPUT));
  DUBSAR_ASSIGN(squeeze_, make_action("hold", "Hold and turn", XR_ACTION_TYPE_FLOAT_INPUT));
  DUBSAR_ASSIGN(select_, make_action("select", "Next side", XR_ACTION_TYPE_BOOLEAN_INPUT));
  suggest("/interaction_profiles/khr/simple_controller", "/input/select/click", "/input/menu/click");
  suggest("/interaction_profiles/oculus/touch_controller", "/input/squeeze/value", "/input/trigger/value");
  suggest("/interaction_profiles/valve/index_controller", "/input/squeeze/value", "/input/trigger/click");
  suggest("/interaction_profiles/htc/vive_controller", "/input/squeeze/click", "/input/trigger/click");
  suggest("/interaction_profiles/microsoft/motion_controller", "/input/squeeze/click", "/input/trigger/value");
  auto attach = made<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
  attach.countActionSets = 1;
  attach.actionSets = &set_;
  DUBSAR_TRY(check(door()(xrAttachSessionActionSets, session, &attach), "attaching actions"));
  for (std::size_t side = 0; side < 2; ++side) {
    auto space = made<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
    space.action = grip_;
    space.subactionPath = sides_[side];
    space.poseInActionSpace.orientation.w = 1.0f;
    DUBSAR_TRY(check(door()(xrCreateActionSpace, session, &space, &grips_[side]), "following a controller"));
  }
  return {};
}

void HandInput::locate(XrSpace base, XrTime time, WearerFrame& frame) {
  locate_controllers(base, time, frame);
  for (std::size_t side = 0; side < 2; ++side) {
    if (trackers_[side] == XR_NULL_HANDLE) continue;
    std::array<XrHandJointLocationEXT, XR_HAND_JOINT_COUNT_EXT> joints{};
    auto where = made<XrHandJointsLocateInfoEXT>(XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT);
    where.baseSpace = base;
    where.time = time;
    auto found = made<XrHandJointLocationsEXT>(XR_TYPE_HAND_JOINT_LOCATIONS_EXT);
    XrHandTrackingDataSourceStateEXT source{XR_TYPE_HAND_TRACKING_DATA_SOURCE_STATE_EXT, nullptr, XR_FALSE, {}};
    if (instance_->tells_hand_source()) found.next = &source;
    found.jointCount = XR_HAND_JOINT_COUNT_EXT;
    found.jointLocations = joints.data();
    WornHand& hand = frame.hands[side];
    hand.active = XR_SUCCEEDED(door()(locate_joints_, trackers_[side], &where, &found)) && found.isActive == XR_TRUE;
    const bool seen = source.isActive == XR_TRUE && source.dataSource == XR_HAND_TRACKING_DATA_SOURCE_UNOBSTRUCTED_EXT;
    if (instance_->tells_hand_source() ? !seen : frame.controllers[side].active) hand.active = false;
    for (std::size_t i = 0; hand.active && i < joints.size(); ++i) {
      WornJoint& joint = hand.joints[i];
      joint.valid = (joints[i].locationFlags & kPlaced) == kPlaced;
      joint.tracked = joint.valid && (joints[i].locationFlags & kSeen) == kSeen;
      if (joint.valid) joint.pose = pose_of(joints[i].pose);
      joint.radius_m = joints[i].radius;
    }
  }
}

void HandInput::locate_controllers(XrSpace base, XrTime time, WearerFrame& frame) {
  const XrActiveActionSet active{set_, XR_NULL_PATH};
  auto sync = made<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
  sync.countActiveActionSets = 1;
  sync.activeActionSets = &active;
  if (door()(xrSyncActions, session_, &sync) != XR_SUCCESS) return;  // not focused: somebody else has the input
  for (std::size_t side = 0; side < 2; ++side) {
    auto get = made<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
    get.subactionPath = sides_[side];
    WornController& out = frame.controllers[side];
    get.action = grip_;
    auto pose = made<XrActionStatePose>(XR_TYPE_ACTION_STATE_POSE);
    auto location = made<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    out.active = XR_SUCCEEDED(door()(xrGetActionStatePose, session_, &get, &pose)) && pose.isActive == XR_TRUE &&
                 XR_SUCCEEDED(door()(xrLocateSpace, grips_[side], base, time, &location)) &&
                 (location.locationFlags & kPlaced) == kPlaced;
    if (!out.active) continue;
    out.grip = pose_of(location.pose);
    get.action = squeeze_;
    auto amount = made<XrActionStateFloat>(XR_TYPE_ACTION_STATE_FLOAT);
    if (XR_SUCCEEDED(door()(xrGetActionStateFloat, session_, &get, &amount)) && amount.isActive == XR_TRUE)
      out.squeeze = amount.currentState;
    get.action = select_;
    auto press = made<XrActionStateBoolean>(XR_TYPE_ACTION_STATE_BOOLEAN);
    out.select = XR_SUCCEEDED(door()(xrGetActionStateBoolean, session_, &get, &press)) && press.isActive == XR_TRUE &&
                 press.currentState == XR_TRUE;
  }
}

}  // namespace dubsar::openxr
