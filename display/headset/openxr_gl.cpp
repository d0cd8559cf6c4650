// Sessions of OpenGL: the runtime's pictures are textures of the context that is current.

#include <algorithm>
#include <array>

#include "display/headset/openxr_graphics.h"
#include "display/render/view_array.h"

namespace dubsar::openxr {
namespace {

class GlGraphics final : public Graphics {
 public:
  static Result<std::unique_ptr<Graphics>> create(const Instance& instance) {
    auto out = std::make_unique<GlGraphics>(instance);
    const XrInstance handle = instance.handle();
    const auto requirements =
        function_of<PFN_xrGetOpenGLGraphicsRequirementsKHR>(handle, "xrGetOpenGLGraphicsRequirementsKHR");
    if (requirements == nullptr)
      return fail(ErrorKind::kUnavailable, "openxr: runtime {} does not say which OpenGL it needs", instance.runtime());
    auto range = made<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
    DUBSAR_TRY(
        check(instance.door()(requirements, handle, instance.system(), &range), "asking which OpenGL is needed"));
    if (XR_MAKE_VERSION(4, 5, 0) < range.minApiVersionSupported)
      return fail(ErrorKind::kUnavailable, "openxr: runtime {} needs OpenGL {}.{}, expected 4.5 or less",
                  instance.runtime(), XR_VERSION_MAJOR(range.minApiVersionSupported),
                  XR_VERSION_MINOR(range.minApiVersionSupported));
    DUBSAR_TRY(out->bind_current());
    return out;
  }

  explicit GlGraphics(const Instance& instance) : instance_(&instance) {}

  const char* name() const noexcept override { return "OpenGL"; }
  const void* binding() const noexcept override { return binding_; }
  std::int64_t format() const noexcept override { return GL_SRGB8_ALPHA8; }
  const char* format_name() const noexcept override { return "GL_SRGB8_ALPHA8"; }

  Result<void> take(std::size_t eye, XrSwapchain chain, PixelSize size) override {
    DUBSAR_ASSIGN(images_[eye],
                  images_of<XrSwapchainImageOpenGLKHR>(instance_->door(), chain, XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR));
    sizes_[eye] = size;
    return {};
  }

  /// Both are sRGB-coded bytes: copied as they are.
  Result<void> copy(const ViewArray& views, std::size_t eye, std::uint32_t image) override {
    if (image < images_[eye].size())
      glCopyImageSubData(views.coded(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(eye),
                         images_[eye][image].image, GL_TEXTURE_2D, 0, 0, 0, 0,
                         std::min(views.width(), sizes_[eye].width), std::min(views.height(), sizes_[eye].height), 1);
    return {};
  }

 private:
  Result<void> bind_current() {
    if (const EGLContext context = eglGetCurrentContext(); context != EGL_NO_CONTEXT) {
      if (!instance_->has_egl())
        return fail(ErrorKind::kUnavailable,
                    "openxr: runtime {} takes no EGL contexts (XR_MNDX_egl_enable), expected a window on an X11 server",
                    instance_->runtime());
      egl_.getProcAddress = eglGetProcAddress;
      egl_.display = eglGetCurrentDisplay();
      egl_.context = context;
      binding_ = &egl_;
      return {};
    }
    const GLXContext context = glXGetCurrentContext();
    Display* const display = context != nullptr ? glXGetCurrentDisplay() : nullptr;
    if (display == nullptr)
      return fail(ErrorKind::kUnavailable, "openxr: no OpenGL context of EGL or GLX is current, expected one");
    int id = 0, screen = 0, count = 0;
    glXQueryContext(display, context, GLX_FBCONFIG_ID, &id);
    glXQueryContext(display, context, GLX_SCREEN, &screen);
    const int wanted[] = {GLX_FBCONFIG_ID, id, 0};
    GLXFBConfig* const configs = glXChooseFBConfig(display, screen, wanted, &count);
    if (configs == nullptr || count < 1)
      return fail(ErrorKind::kUnavailable, "openxr: the window's visual {} was not found again", id);
    glx_.xDisplay = display;
    glx_.glxFBConfig = configs[0];
    int visual = 0;
    glXGetFBConfigAttrib(display, configs[0], GLX_VISUAL_ID, &visual);
    glx_.visualid = static_cast<std::uint32_t>(visual);
    glx_.glxDrawable = glXGetCurrentDrawable();
    glx_.glxContext = context;
    binding_ = &glx_;
    XFree(configs);
    return {};
  }

  const Instance* instance_;
  XrGraphicsBindingEGLMNDX egl_ = made<XrGraphicsBindingEGLMNDX>(XR_TYPE_GRAPHICS_BINDING_EGL_MNDX);
  XrGraphicsBindingOpenGLXlibKHR glx_ = made<XrGraphicsBindingOpenGLXlibKHR>(XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR);
  const void* binding_ = nullptr;
  std::array<std::vector<XrSwapchainImageOpenGLKHR>, 2> images_;
  std::array<PixelSize, 2> sizes_{};
};

}  // namespace

Result<std::unique_ptr<Graphics>> make_gl_graphics(const Instance& instance) { return GlGraphics::create(instance); }

}  // namespace dubsar::openxr
