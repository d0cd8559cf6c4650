#pragma once
// How the pictures of the GL context get into those of a session: through OpenGL itself, or through Vulkan.

#include <memory>

#include "display/headset/openxr_instance.h"

namespace dubsar::openxr {

/// One thread, that of the GL context, which outlives it; it outlives the session that it is bound to.
class Graphics {
 public:
  virtual ~Graphics() = default;
  virtual const char* name() const noexcept = 0;
  /// What XrSessionCreateInfo::next points at.
  virtual const void* binding() const noexcept = 0;
  /// Of sRGB-coded bytes, in the numbers of OpenGL or of Vulkan.
  virtual std::int64_t format() const noexcept = 0;
  virtual const char* format_name() const noexcept = 0;
  /// The pictures of an eye's swapchain of this size.
  virtual Result<void> take(std::size_t eye, XrSwapchain chain, PixelSize size) = 0;
  /// The eye's layer into one of them, from the lower left corner as far as both go; done, or ordered where the
  /// runtime's own work follows in the same order, when it returns. kUnavailable.
  virtual Result<void> copy(const ViewArray& views, std::size_t eye, std::uint32_t image) = 0;
};

/// Of the context that is current now: one of EGL (XR_MNDX_egl_enable) or of GLX.
Result<std::unique_ptr<Graphics>> make_gl_graphics(const Instance& instance);

/// With the GPU that the runtime names, through XR_KHR_vulkan_enable2: pictures lie in memory that OpenGL and Vulkan
/// share (GL_EXT_memory_object_fd), and are copied once.
Result<std::unique_ptr<Graphics>> make_vulkan_graphics(const Instance& instance);

template <class Image>
Result<std::vector<Image>> images_of(Door& door, XrSwapchain chain, XrStructureType type) {
  std::uint32_t count = 0;
  DUBSAR_TRY(check(door(xrEnumerateSwapchainImages, chain, 0u, &count, nullptr), "asking for pictures"));
  std::vector<Image> images(count, made<Image>(type));
  DUBSAR_TRY(check(door(xrEnumerateSwapchainImages, chain, count, &count,
                        reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())),
                   "asking for pictures"));
  return images;
}

}  // namespace dubsar::openxr
