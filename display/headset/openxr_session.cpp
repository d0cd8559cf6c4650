#include "display/headset/openxr_session.h"

#include <algorithm>
#include <cmath>

#include "display/render/view_array.h"

namespace dubsar::openxr {
namespace {

constexpr XrDuration kPatience = 50'000'000;  // for an image that the compositor still shows, a frame

}  // namespace

Result<std::unique_ptr<Session>> Session::create(Instance& instance, SessionGraphics wish) {
  const bool may_be_gl = wish != SessionGraphics::kVulkan, may_be_vulkan = wish != SessionGraphics::kGl;
  if ((!may_be_vulkan && !instance.has_gl()) || (!may_be_gl && !instance.has_vulkan()))
    return fail(ErrorKind::kUnavailable, "openxr: runtime {} does not take {}, expected graphics=any",
                instance.runtime(), may_be_gl ? "OpenGL (XR_KHR_opengl_enable)" : "Vulkan (XR_KHR_vulkan_enable2)");
  if (may_be_gl && instance.has_gl()) {
    DUBSAR_ASSIGN(auto graphics, make_gl_graphics(instance));
    auto session = begin_with(instance, std::move(graphics));
    if (session || session.error().kind != ErrorKind::kUsage) return session;
    if (!may_be_vulkan || !instance.has_vulkan())
      return fail(
          ErrorKind::kUnavailable,
          "openxr: runtime {} takes no OpenGL session though it lists XR_KHR_opengl_enable, expected one that does",
          instance.runtime());
  }
  DUBSAR_ASSIGN(auto graphics, make_vulkan_graphics(instance));
  return begin_with(instance, std::move(graphics));
}

/// kUsage: the runtime takes sessions of other graphics only.
Result<std::unique_ptr<Session>> Session::begin_with(Instance& instance, std::unique_ptr<Graphics> graphics) {
  std::unique_ptr<Session> out(new Session(instance));
  out->graphics_ = std::move(graphics);
  auto info = made<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
  info.next = out->graphics_->binding();
  info.systemId = instance.system();
  const XrResult begun = instance.door()(xrCreateSession, instance.handle(), &info, &out->session_);
  if (begun == XR_ERROR_GRAPHICS_DEVICE_INVALID)
    return fail(ErrorKind::kUsage, "openxr: runtime {} takes no {} session", instance.runtime(),
                out->graphics_->name());
  DUBSAR_TRY(check(begun, "beginning a session"));
  DUBSAR_TRY(out->make_spaces());
  DUBSAR_ASSIGN(out->hands_, HandInput::create(instance, out->session_));
  DUBSAR_TRY(out->make_chains());
  return out;
}

Session::~Session() {
  hands_.reset();
  for (const Chain& chain : chains_)
    if (chain.handle != XR_NULL_HANDLE) door()(xrDestroySwapchain, chain.handle);
  for (const XrSpace space : {stage_, local_})
    if (space != XR_NULL_HANDLE) door()(xrDestroySpace, space);
  if (session_ != XR_NULL_HANDLE) door()(xrDestroySession, session_);
}

Result<void> Session::make_spaces() {
  auto info = made<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  info.poseInReferenceSpace.orientation.w = 1.0f;
  info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
  DUBSAR_TRY(check(door()(xrCreateReferenceSpace, session_, &info, &local_), "finding the room's middle"));
  info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_STAGE;
  if (XR_FAILED(door()(xrCreateReferenceSpace, session_, &info, &stage_)))
    stage_ = XR_NULL_HANDLE;  // nobody measured the floor
  return {};
}

Result<void> Session::make_chains() {
  std::uint32_t count = 0;
  DUBSAR_TRY(check(door()(xrEnumerateSwapchainFormats, session_, 0, &count, nullptr), "asking for formats"));
  std::vector<std::int64_t> formats(count);
  DUBSAR_TRY(check(door()(xrEnumerateSwapchainFormats, session_, count, &count, formats.data()), "asking for formats"));
  if (std::find(formats.begin(), formats.end(), graphics_->format()) == formats.end())
    return fail(ErrorKind::kUnavailable, "openxr: runtime {} has no pictures of format {} among its {}",
                instance_->runtime(), graphics_->format_name(), count);
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const XrViewConfigurationView& size = instance_->eyes()[eye];
    auto info = made<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
    info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
    info.format = graphics_->format();
    info.sampleCount = 1;
    info.width = size.recommendedImageRectWidth;
    info.height = size.recommendedImageRectHeight;
    info.faceCount = info.arraySize = info.mipCount = 1;
    Chain& chain = chains_[eye];
    DUBSAR_TRY(check(door()(xrCreateSwapchain, session_, &info, &chain.handle), "making pictures"));
    chain.width = static_cast<int>(info.width);
    chain.height = static_cast<int>(info.height);
    DUBSAR_TRY(graphics_->take(eye, chain.handle, {chain.width, chain.height}));
  }
  return {};
}

Result<void> Session::start_running() {
  auto info = made<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
  info.primaryViewConfigurationType = kStereo;
  DUBSAR_TRY(check(door()(xrBeginSession, session_, &info), "beginning to show pictures"));
  running_ = true;
  return {};
}

Result<void> Session::follow_events() {
  XrEventDataBuffer event;
  for (;;) {
    DUBSAR_ASSIGN(const bool more, instance_->next_event(event));
    if (!more) return {};
    if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING)
      return fail(ErrorKind::kUnavailable, "openxr: runtime {} is going away", instance_->runtime());
    if (event.type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
      const auto& change = *reinterpret_cast<const XrEventDataReferenceSpaceChangePending*>(&event);
      if (change.referenceSpaceType == XR_REFERENCE_SPACE_TYPE_LOCAL) recentred_at_ = change.changeTime;
    }
    if (event.type != XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) continue;
    const auto& change = *reinterpret_cast<const XrEventDataSessionStateChanged*>(&event);
    if (change.session != session_) continue;
    state_ = change.state;
    if (change.state == XR_SESSION_STATE_READY) {
      DUBSAR_TRY(start_running());
    } else if (change.state == XR_SESSION_STATE_STOPPING) {
      running_ = begun_ = false;
      DUBSAR_TRY(check(door()(xrEndSession, session_), "pausing"));
    } else if (change.state == XR_SESSION_STATE_LOSS_PENDING) {
      return fail(ErrorKind::kUnavailable, "openxr: the headset was lost; it is waited for");
    } else if (change.state == XR_SESSION_STATE_EXITING) {
      exited_ = true;
      return fail(ErrorKind::kUnavailable, "openxr: the wearer ended the session");
    }
  }
}

TimestampNs Session::steady_from(XrTime time) const {
  const auto convert =
      function_of<PFN_xrConvertTimeToTimespecTimeKHR>(instance_->handle(), "xrConvertTimeToTimespecTimeKHR");
  timespec steady{};
  if (instance_->has_time() && convert != nullptr && XR_SUCCEEDED(door()(convert, instance_->handle(), time, &steady)))
    return static_cast<TimestampNs>(steady.tv_sec) * 1'000'000'000 + steady.tv_nsec;
  return SteadyClock().now() + frame_.predictedDisplayPeriod;  // about: a frame is begun one refresh before
}

std::optional<double> Session::floor_at(XrTime time) const {
  if (stage_ == XR_NULL_HANDLE) return std::nullopt;
  auto location = made<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
  if (XR_FAILED(door()(xrLocateSpace, stage_, local_, time, &location)) ||
      (location.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) == 0)
    return std::nullopt;
  return location.pose.position.y;
}

Result<std::optional<WearerFrame>> Session::begin() {
  if (begun_) DUBSAR_TRY(end(nullptr));
  frame_ = made<XrFrameState>(XR_TYPE_FRAME_STATE);
  DUBSAR_TRY(check(door()(xrWaitFrame, session_, nullptr, &frame_), "waiting for a frame"));
  DUBSAR_TRY(check(door()(xrBeginFrame, session_, nullptr), "beginning a frame"));
  begun_ = true;
  WearerFrame out;
  out.time = SteadyClock().now();
  out.displayed = steady_from(frame_.predictedDisplayTime);
  auto where = made<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
  where.viewConfigurationType = kStereo;
  where.displayTime = frame_.predictedDisplayTime;
  where.space = local_;
  auto state = made<XrViewState>(XR_TYPE_VIEW_STATE);
  views_.assign(instance_->view_count(), made<XrView>(XR_TYPE_VIEW));
  std::uint32_t count = 0;
  DUBSAR_TRY(check(door()(xrLocateViews, session_, &where, &state, instance_->view_count(), &count, views_.data()),
                   "finding the eyes"));
  constexpr XrViewStateFlags kPlaced = XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT;
  if (count < 2 || (state.viewStateFlags & kPlaced) != kPlaced) return std::optional<WearerFrame>();
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const XrFovf& fov = views_[eye].fov;
    out.eyes[eye] = {pose_of(views_[eye].pose), std::tan(fov.angleLeft), std::tan(fov.angleRight),
                     std::tan(fov.angleDown), std::tan(fov.angleUp)};
  }
  if (focused()) hands_->locate(local_, frame_.predictedDisplayTime, out);
  out.floor_m = floor_at(frame_.predictedDisplayTime);
  out.seen = frame_.shouldRender == XR_TRUE;
  out.period = frame_.predictedDisplayPeriod;
  out.recentred = recentred_at_ && frame_.predictedDisplayTime >= *recentred_at_;
  if (out.recentred) recentred_at_.reset();
  return std::optional<WearerFrame>(out);
}

Result<bool> Session::copy_eye(const ViewArray& views, std::size_t eye) {
  Chain& chain = chains_[eye];
  if (!chain.acquired) {
    std::uint32_t index = 0;
    DUBSAR_TRY(check(door()(xrAcquireSwapchainImage, chain.handle, nullptr, &index), "taking a picture"));
    chain.acquired = index;
  }
  auto wait = made<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
  wait.timeout = kPatience;
  const XrResult ready = door()(xrWaitSwapchainImage, chain.handle, &wait);
  if (ready == XR_TIMEOUT_EXPIRED) return false;
  DUBSAR_TRY(check(ready, "waiting for a picture"));
  const std::uint32_t index = *std::exchange(chain.acquired, std::nullopt);
  const Result<void> copied = graphics_->copy(views, eye, index);
  DUBSAR_TRY(check(door()(xrReleaseSwapchainImage, chain.handle, nullptr), "giving a picture back"));
  DUBSAR_TRY(copied);
  return true;
}

Result<bool> Session::copy_eyes(const ViewArray& views) {
  for (std::size_t eye = 0; eye < 2; ++eye) {
    DUBSAR_ASSIGN(const bool copied, copy_eye(views, eye));
    if (!copied) return false;
  }
  return true;
}

Result<void> Session::end(const ViewArray* views) {
  bool shown = false;
  if (views != nullptr && frame_.shouldRender == XR_TRUE) {
    DUBSAR_ASSIGN(shown, copy_eyes(*views));
  }
  std::array<XrCompositionLayerProjectionView, 2> eyes{};
  for (std::size_t eye = 0; shown && eye < 2; ++eye) {
    eyes[eye] = made<XrCompositionLayerProjectionView>(XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW);
    eyes[eye].pose = views_[eye].pose;
    eyes[eye].fov = views_[eye].fov;
    eyes[eye].subImage.swapchain = chains_[eye].handle;
    eyes[eye].subImage.imageRect.extent = {std::min(views->width(), chains_[eye].width),
                                           std::min(views->height(), chains_[eye].height)};
  }
  auto layer = made<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  if (instance_->blend() == XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND)
    layer.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
  layer.space = local_;
  layer.viewCount = 2;
  layer.views = eyes.data();
  const auto* const first = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
  auto info = made<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
  info.displayTime = frame_.predictedDisplayTime;
  info.environmentBlendMode = instance_->blend();
  info.layerCount = shown ? 1 : 0;
  info.layers = shown ? &first : nullptr;
  begun_ = false;
  return check(door()(xrEndFrame, session_, &info), "showing a frame");
}

}  // namespace dubsar::openxr
