// Pictures of the made runtime: swapchains, what was submitted, and the door to the loader.

#include <algorithm>
#include <cstring>

#include "tests/openxr_runtime/runtime_state.h"

namespace dubsar::testing {

PFN_xrGetInstanceProcAddr runtime_door();
PFN_xrVoidFunction frame_function(const std::string& name);

namespace {

XrResult wrong() {
  ++state().headset.wrong_calls;
  return XR_ERROR_CALL_ORDER_INVALID;
}

XrResult XRAPI_CALL swapchain_formats(XrSession, std::uint32_t capacity, std::uint32_t* count, std::int64_t* out) {
  const std::vector<std::int64_t> formats =
      state().vulkan ? std::vector<std::int64_t>{VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_SRGB}
                     : state().headset.manners.formats;
  *count = static_cast<std::uint32_t>(formats.size());
  if (capacity >= formats.size()) std::copy(formats.begin(), formats.end(), out);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL create_swapchain(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* out) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  MadeSwapchain chain;
  chain.width = static_cast<int>(info->width);
  chain.height = static_cast<int>(info->height);
  if (s.vulkan) {
    if (const XrResult made = make_vulkan_images(chain, info->format); made != XR_SUCCESS) return made;
  } else {
    glCreateTextures(GL_TEXTURE_2D, 3, chain.textures.data());
    for (const unsigned texture : chain.textures)
      glTextureStorage2D(texture, 1, static_cast<GLenum>(info->format), chain.width, chain.height);
  }
  s.swapchains[s.next_handle] = chain;
  ++s.headset.alive.swapchains;
  *out = handle_of<XrSwapchain>(s.next_handle++);
  leave_traces("xrCreateSwapchain");
  return XR_SUCCESS;
}
XrResult XRAPI_CALL destroy_swapchain(XrSwapchain swapchain) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (s.vulkan)
    destroy_vulkan_images(s.swapchains[id_of(swapchain)]);
  else
    glDeleteTextures(3, s.swapchains[id_of(swapchain)].textures.data());
  s.headset.alive.swapchains -= static_cast<int>(s.swapchains.erase(id_of(swapchain)));
  return XR_SUCCESS;
}
XrResult XRAPI_CALL swapchain_images(XrSwapchain swapchain, std::uint32_t capacity, std::uint32_t* count,
                                     XrSwapchainImageBaseHeader* out) {
  const MadeSwapchain& chain = state().swapchains[id_of(swapchain)];
  *count = static_cast<std::uint32_t>(chain.textures.size());
  for (std::size_t i = 0; capacity >= chain.textures.size() && i < chain.textures.size(); ++i)
    if (state().vulkan)
      reinterpret_cast<XrSwapchainImageVulkan2KHR*>(out)[i].image = chain.images[i];
    else
      reinterpret_cast<XrSwapchainImageOpenGLKHR*>(out)[i].image = chain.textures[i];
  return XR_SUCCESS;
}
XrResult XRAPI_CALL acquire_image(XrSwapchain swapchain, const XrSwapchainImageAcquireInfo*, std::uint32_t* index) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (session_lost()) return XR_ERROR_SESSION_LOST;
  MadeSwapchain& chain = s.swapchains[id_of(swapchain)];
  if (chain.acquired || !s.frame.begun) return wrong();
  if (s.headset.manners.refuses_gl_errors && glGetError() != GL_NO_ERROR) return XR_ERROR_RUNTIME_FAILURE;
  chain.acquired = true;
  *index = static_cast<std::uint32_t>(chain.next);
  leave_traces("xrAcquireSwapchainImage");
  return XR_SUCCESS;
}
XrResult XRAPI_CALL wait_image(XrSwapchain swapchain, const XrSwapchainImageWaitInfo*) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  MadeSwapchain& chain = s.swapchains[id_of(swapchain)];
  if (!chain.acquired || chain.waited) return wrong();
  leave_traces("xrWaitSwapchainImage");
  if (s.headset.manners.busy_waits > 0) {
    --s.headset.manners.busy_waits;
    return XR_TIMEOUT_EXPIRED;
  }
  chain.waited = true;
  return XR_SUCCESS;
}
XrResult XRAPI_CALL release_image(XrSwapchain swapchain, const XrSwapchainImageReleaseInfo*) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  MadeSwapchain& chain = s.swapchains[id_of(swapchain)];
  if (!chain.waited) return wrong();
  chain.acquired = chain.waited = false;
  chain.shown = chain.next;
  chain.next = (chain.next + 1) % static_cast<int>(chain.textures.size());
  leave_traces("xrReleaseSwapchainImage");
  return XR_SUCCESS;
}

/// The picture's red, and mean place of pixels that are lighter than half, from the lower left.
void look_at(const MadeSwapchain& chain, std::vector<std::uint8_t>& red, std::optional<glm::dvec2>& bright) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(chain.width) * chain.height * 4);
  if (state().vulkan)
    pixels = read_vulkan_image(chain);
  else
    glGetTextureImage(chain.textures[static_cast<std::size_t>(chain.shown)], 0, GL_RGBA, GL_UNSIGNED_BYTE,
                      static_cast<GLsizei>(pixels.size()), pixels.data());
  glm::dvec2 sum(0.0);
  int count = 0;
  red.reserve(pixels.size() / 4);
  for (int y = 0; y < chain.height; ++y)
    for (int x = 0; x < chain.width; ++x) {
      const std::uint8_t value = pixels[4 * (static_cast<std::size_t>(y) * chain.width + x)];
      red.push_back(value);
      if (value <= 127) continue;
      sum += glm::dvec2(x + 0.5, y + 0.5);
      ++count;
    }
  bright = count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
}

/// As a compositor that shares the context may leave it.
void spoil_gl_state() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glUseProgram(0);
  glBindVertexArray(0);
  glActiveTexture(GL_TEXTURE5);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 1, 1);
  glViewport(0, 0, 1, 1);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT_AND_BACK);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 7);
}

XrResult XRAPI_CALL end_frame(XrSession, const XrFrameEndInfo* info) {
  RuntimeState& s = state();
  const std::lock_guard lock(s.headset.mutex);
  if (session_lost()) return XR_ERROR_SESSION_LOST;
  if (!s.frame.begun) return wrong();
  s.frame.begun = false;
  MadeFrame frame;
  frame.predicted = (s.frame.number + 2) * period_ns(s.headset);
  frame.displayed = info->displayTime;
  frame.layers = static_cast<int>(info->layerCount);
  frame.blend = static_cast<int>(info->environmentBlendMode);
  if (info->layerCount == 1) {
    const auto& layer = *reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[0]);
    if (layer.type != XR_TYPE_COMPOSITION_LAYER_PROJECTION || layer.viewCount != 2) return wrong();
    frame.layer_flags = layer.layerFlags;
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const XrCompositionLayerProjectionView& view = layer.views[eye];
      const XrPosef& p = view.pose;
      // Submitted in the layer's space; what is kept is in LOCAL.
      const MadePose base = place_of(s.spaces[id_of(layer.space)], 1e-9 * static_cast<double>(info->displayTime));
      const glm::dquat rotation(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z);
      frame.poses[eye] = {base.position + base.rotation * glm::dvec3(p.position.x, p.position.y, p.position.z),
                          base.rotation * rotation};
      frame.fov[eye] = {view.fov.angleLeft, view.fov.angleRight, view.fov.angleUp, view.fov.angleDown};
      const auto chain = s.swapchains.find(id_of(view.subImage.swapchain));
      if (chain == s.swapchains.end() || chain->second.acquired || chain->second.shown < 0) return wrong();
      if (s.headset.read_pictures) look_at(chain->second, frame.red[eye], frame.bright[eye]);
    }
  }
  s.headset.frames.push_back(frame);
  if (s.headset.manners.spoils_gl_state) spoil_gl_state();
  leave_traces("xrEndFrame");
  return XR_SUCCESS;
}

template <class F>
PFN_xrVoidFunction plain(F* function) {
  return reinterpret_cast<PFN_xrVoidFunction>(function);
}

// What the loader and a runtime say to each other (OpenXR loader specification, "Runtime Interface Negotiation").
// NOLINTBEGIN(readability-identifier-naming): names as that specification has them
struct LoaderInfo {
  int structType;
  std::uint32_t structVersion;
  std::size_t structSize;
  std::uint32_t minInterfaceVersion, maxInterfaceVersion;
  XrVersion minApiVersion, maxApiVersion;
};
struct RuntimeRequest {
  int structType;
  std::uint32_t structVersion;
  std::size_t structSize;
  std::uint32_t runtimeInterfaceVersion;
  XrVersion runtimeApiVersion;
  PFN_xrGetInstanceProcAddr getInstanceProcAddr;
};
// NOLINTEND(readability-identifier-naming)

}  // namespace

PFN_xrVoidFunction frame_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> functions{
      {"xrEnumerateSwapchainFormats", plain(&swapchain_formats)},
      {"xrCreateSwapchain", plain(&create_swapchain)},
      {"xrDestroySwapchain", plain(&destroy_swapchain)},
      {"xrEnumerateSwapchainImages", plain(&swapchain_images)},
      {"xrAcquireSwapchainImage", plain(&acquire_image)},
      {"xrWaitSwapchainImage", plain(&wait_image)},
      {"xrReleaseSwapchainImage", plain(&release_image)},
      {"xrEndFrame", plain(&end_frame)}};
  const auto found = functions.find(name);
  return found != functions.end() ? found->second : nullptr;
}

}  // namespace dubsar::testing

// NOLINTNEXTLINE(readability-identifier-naming): the loader looks for it
extern "C" XrResult xrNegotiateLoaderRuntimeInterface(const dubsar::testing::LoaderInfo* loader,
                                                      dubsar::testing::RuntimeRequest* request) {
  if (loader == nullptr || request == nullptr || loader->minInterfaceVersion > 1 || loader->maxInterfaceVersion < 1)
    return XR_ERROR_INITIALIZATION_FAILED;
  request->runtimeInterfaceVersion = 1;
  request->runtimeApiVersion = XR_CURRENT_API_VERSION;
  request->getInstanceProcAddr = dubsar::testing::runtime_door();
  return XR_SUCCESS;
}
