#pragma once
// A picture in memory that OpenGL and Vulkan share: a texture to the one, an image to the other.

#include "display/headset/vulkan_api.h"
#include "display/render/context/gl_objects.h"
#include "display/render/images/surface.h"

namespace dubsar::openxr {

/// One GPU, and the way to it. The functions and the device outlive what is made with them.
struct VulkanDevice {
  VulkanFunctions functions;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice gpu = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t family = 0;
};

/// One thread, that of the GL context. Bytes of four channels, whatever they code; row 0 is the first.
class SharedPicture {
 public:
  /// kUnavailable: this OpenGL shares no memory with Vulkan (GL_EXT_memory_object_fd), or not with this GPU.
  static Result<void> check_gl(const VulkanDevice& vulkan);
  static Result<SharedPicture> create(const VulkanDevice& vulkan, PixelSize size);
  SharedPicture() = default;
  SharedPicture(SharedPicture&& other) noexcept { *this = std::move(other); }
  SharedPicture& operator=(SharedPicture&& other) noexcept;
  ~SharedPicture();

  PixelSize size() const noexcept { return size_; }
  GLuint texture() const noexcept { return texture_; }  ///< GL_RGBA8
  VkImage image() const noexcept { return image_; }     ///< VK_FORMAT_R8G8B8A8_UNORM

 private:
  const VulkanDevice* vulkan_ = nullptr;
  PixelSize size_{};
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  GLuint object_ = 0, texture_ = 0;
};

}  // namespace dubsar::openxr
