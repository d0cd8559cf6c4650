#include "display/headset/shared_picture.h"

#include <epoxy/gl.h>
#include <unistd.h>

#include <bit>
#include <cstring>
#include <optional>
#include <utility>

namespace dubsar::openxr {
namespace {

/// A type of memory that an image may have, on the GPU where it can be.
std::optional<std::uint32_t> memory_type(const VulkanDevice& vulkan, std::uint32_t allowed) {
  VkPhysicalDeviceMemoryProperties all{};
  vulkan.functions.vkGetPhysicalDeviceMemoryProperties(vulkan.gpu, &all);
  for (std::uint32_t i = 0; i < all.memoryTypeCount; ++i)
    if ((allowed >> i & 1u) != 0 && (all.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) != 0)
      return i;
  if (allowed == 0) return std::nullopt;
  return static_cast<std::uint32_t>(std::countr_zero(allowed));
}

}  // namespace

Result<void> SharedPicture::check_gl(const VulkanDevice& vulkan) {
  if (!epoxy_has_gl_extension("GL_EXT_memory_object_fd"))
    return fail(
        ErrorKind::kUnavailable,
        "openxr: this OpenGL shares no memory with Vulkan (GL_EXT_memory_object_fd), which the runtime takes; a "
        "driver that does both is needed");
  VkPhysicalDeviceIDProperties ids{};
  ids.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES;
  VkPhysicalDeviceProperties2 about{};
  about.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  about.pNext = &ids;
  vulkan.functions.vkGetPhysicalDeviceProperties2(vulkan.gpu, &about);
  GLint count = 0;
  glGetIntegerv(GL_NUM_DEVICE_UUIDS_EXT, &count);
  for (GLint i = 0; i < count; ++i) {
    GLubyte id[GL_UUID_SIZE_EXT] = {};
    glGetUnsignedBytei_vEXT(GL_DEVICE_UUID_EXT, static_cast<GLuint>(i), id);
    if (std::memcmp(id, ids.deviceUUID, sizeof(id)) == 0) return {};
  }
  return fail(ErrorKind::kUnavailable,
              "openxr: the runtime shows pictures with {}, and the window's OpenGL runs on {}; both must be one GPU",
              about.properties.deviceName, reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
}

Result<SharedPicture> SharedPicture::create(const VulkanDevice& vulkan, PixelSize size) {
  const VulkanFunctions& vk = vulkan.functions;
  SharedPicture out;
  out.vulkan_ = &vulkan;
  out.size_ = size;
  VkExternalMemoryImageCreateInfo shared{};
  shared.sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO;
  shared.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.pNext = &shared;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height), 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  // all that a GL texture may be used for, so that both lay it out alike
  info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  DUBSAR_TRY(check_vulkan(vk.vkCreateImage(vulkan.device, &info, nullptr, &out.image_), "making a shared picture"));
  VkMemoryRequirements needed{};
  vk.vkGetImageMemoryRequirements(vulkan.device, out.image_, &needed);
  const auto type = memory_type(vulkan, needed.memoryTypeBits);
  if (!type) return fail(ErrorKind::kUnavailable, "openxr: Vulkan has no memory for shared pictures");
  VkMemoryDedicatedAllocateInfo alone{};
  alone.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO;
  alone.image = out.image_;
  VkExportMemoryAllocateInfo exported{};
  exported.sType = VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO;
  exported.pNext = &alone;
  exported.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  VkMemoryAllocateInfo wanted{};
  wanted.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  wanted.pNext = &exported;
  wanted.allocationSize = needed.size;
  wanted.memoryTypeIndex = *type;
  DUBSAR_TRY(check_vulkan(vk.vkAllocateMemory(vulkan.device, &wanted, nullptr, &out.memory_), "memory for a picture"));
  DUBSAR_TRY(
      check_vulkan(vk.vkBindImageMemory(vulkan.device, out.image_, out.memory_, 0), "memory for a shared picture"));
  VkMemoryGetFdInfoKHR asked{};
  asked.sType = VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR;
  asked.memory = out.memory_;
  asked.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  int fd = -1;
  DUBSAR_TRY(check_vulkan(vk.vkGetMemoryFdKHR(vulkan.device, &asked, &fd), "handing a picture to OpenGL"));

  glCreateMemoryObjectsEXT(1, &out.object_);
  const GLint dedicated = GL_TRUE;
  glMemoryObjectParameterivEXT(out.object_, GL_DEDICATED_MEMORY_OBJECT_EXT, &dedicated);
  glImportMemoryFdEXT(out.object_, needed.size, GL_HANDLE_TYPE_OPAQUE_FD_EXT, fd);  // takes the descriptor, unless
  const GLenum refused = glGetError();
  if (refused != GL_NO_ERROR) {
    close(fd);
    return fail(ErrorKind::kUnavailable, "openxr: OpenGL does not take Vulkan's memory (error 0x{:04x})", refused);
  }
  glCreateTextures(GL_TEXTURE_2D, 1, &out.texture_);
  glTextureParameteri(out.texture_, GL_TEXTURE_TILING_EXT, GL_OPTIMAL_TILING_EXT);
  glTextureStorageMem2DEXT(out.texture_, 1, GL_RGBA8, size.width, size.height, out.object_, 0);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    return fail(ErrorKind::kUnavailable, "openxr: OpenGL does not take Vulkan's pictures (error 0x{:04x})", error);
  return out;
}

SharedPicture& SharedPicture::operator=(SharedPicture&& other) noexcept {
  std::swap(vulkan_, other.vulkan_);
  std::swap(size_, other.size_);
  std::swap(image_, other.image_);
  std::swap(memory_, other.memory_);
  std::swap(object_, other.object_);
  std::swap(texture_, other.texture_);
  return *this;
}

SharedPicture::~SharedPicture() {
  if (vulkan_ == nullptr) return;
  if (texture_ != 0) glDeleteTextures(1, &texture_);
  if (object_ != 0) glDeleteMemoryObjectsEXT(1, &object_);
  const VulkanFunctions& vk = vulkan_->functions;
  if (image_ != VK_NULL_HANDLE) vk.vkDestroyImage(vulkan_->device, image_, nullptr);
  if (memory_ != VK_NULL_HANDLE) vk.vkFreeMemory(vulkan_->device, memory_, nullptr);
}

}  // namespace dubsar::openxr
