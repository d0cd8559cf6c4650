// Sessions of Vulkan at the made runtime: the first GPU that there is, pictures in its memory, read back when shown.

#include <algorithm>
#include <cstring>

#include "tests/openxr_runtime/runtime_state.h"

namespace dubsar::testing {
namespace {

/// The application's device, and what pictures are read with.
struct VulkanSide {
  VkPhysicalDevice gpu = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
};
VulkanSide& side() {
  static VulkanSide the;
  return the;
}

std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties all{};
  vkGetPhysicalDeviceMemoryProperties(side().gpu, &all);
  for (std::uint32_t i = 0; i < all.memoryTypeCount; ++i)
    if ((allowed >> i & 1u) != 0 && (all.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  return 0;
}

VkDeviceMemory allocate(const VkMemoryRequirements& needed, VkMemoryPropertyFlags wanted) {
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = needed.size;
  info.memoryTypeIndex = memory_type(needed.memoryTypeBits, wanted);
  VkDeviceMemory out = VK_NULL_HANDLE;
  vkAllocateMemory(side().device, &info, nullptr, &out);
  return out;
}

/// Records commands, and waits until they are done.
template <class Record>
void run_commands(const Record& record) {
  VkCommandBufferAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  info.commandPool = side().pool;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  vkAllocateCommandBuffers(side().device, &info, &commands);
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  vkBeginCommandBuffer(commands, &begin);
  record(commands);
  vkEndCommandBuffer(commands);
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  vkQueueSubmit(side().queue, 1, &submit, VK_NULL_HANDLE);
  vkQueueWaitIdle(side().queue);
  vkFreeCommandBuffers(side().device, side().pool, 1, &commands);
}

void change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr,
                       0, nullptr, 1, &barrier);
}

// ---- XR_KHR_vulkan_enable2

XrResult XRAPI_CALL vulkan_requirements(XrInstance, XrSystemId, XrGraphicsRequirementsVulkan2KHR* out) {
  out->minApiVersionSupported = XR_MAKE_VERSION(1, 0, 0);
  out->maxApiVersionSupported = XR_MAKE_VERSION(1, 3, 0);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL create_vulkan_instance(XrInstance, const XrVulkanInstanceCreateInfoKHR* info, VkInstance* out,
                                           VkResult* result) {
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(info->pfnGetInstanceProcAddr(nullptr, "vkCreateInstance"));
  *result = create(info->vulkanCreateInfo, info->vulkanAllocator, out);
  return XR_SUCCESS;
}
XrResult XRAPI_CALL vulkan_gpu(XrInstance, const XrVulkanGraphicsDeviceGetInfoKHR* info, VkPhysicalDevice* out) {
  std::uint32_t count = 1;
  vkEnumeratePhysicalDevices(info->vulkanInstance, &count, out);
  return count == 0 ? XR_ERROR_GRAPHICS_DEVICE_INVALID : XR_SUCCESS;
}
XrResult XRAPI_CALL create_vulkan_device(XrInstance, const XrVulkanDeviceCreateInfoKHR* info, VkDevice* out,
                                         VkResult* result) {
  *result = vkCreateDevice(info->vulkanPhysicalDevice, info->vulkanCreateInfo, info->vulkanAllocator, out);
  return XR_SUCCESS;
}

}  // namespace

XrResult bind_vulkan(const XrGraphicsBindingVulkan2KHR& binding) {
  if (binding.instance == nullptr || binding.physicalDevice == nullptr || binding.device == nullptr)
    return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  side() = {binding.physicalDevice, binding.device, VK_NULL_HANDLE, VK_NULL_HANDLE};
  vkGetDeviceQueue(side().device, binding.queueFamilyIndex, binding.queueIndex, &side().queue);
  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.queueFamilyIndex = binding.queueFamilyIndex;
  return vkCreateCommandPool(side().device, &pool, nullptr, &side().pool) == VK_SUCCESS
             ? XR_SUCCESS
             : XR_ERROR_GRAPHICS_DEVICE_INVALID;
}

void unbind_vulkan() {
  vkDestroyCommandPool(side().device, side().pool, nullptr);
  side() = {};
}

XrResult make_vulkan_images(MadeSwapchain& chain, std::int64_t format) {
  for (std::size_t i = 0; i < chain.images.size(); ++i) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = static_cast<VkFormat>(format);
    info.extent = {static_cast<std::uint32_t>(chain.width), static_cast<std::uint32_t>(chain.height), 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    if (vkCreateImage(side().device, &info, nullptr, &chain.images[i]) != VK_SUCCESS)
      return XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED;
    VkMemoryRequirements needed{};
    vkGetImageMemoryRequirements(side().device, chain.images[i], &needed);
    chain.memory[i] = allocate(needed, 0);
    vkBindImageMemory(side().device, chain.images[i], chain.memory[i], 0);
  }
  run_commands([&](VkCommandBuffer commands) {
    for (const VkImage image : chain.images)
      change_layout(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  });
  return XR_SUCCESS;
}

void destroy_vulkan_images(MadeSwapchain& chain) {
  for (std::size_t i = 0; i < chain.images.size(); ++i) {
    vkDestroyImage(side().device, chain.images[i], nullptr);
    vkFreeMemory(side().device, chain.memory[i], nullptr);
  }
}

std::vector<std::uint8_t> read_vulkan_image(const MadeSwapchain& chain) {
  const auto row = static_cast<std::size_t>(chain.width) * 4, rows = static_cast<std::size_t>(chain.height);
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = row * rows;
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  vkCreateBuffer(side().device, &info, nullptr, &buffer);
  VkMemoryRequirements needed{};
  vkGetBufferMemoryRequirements(side().device, buffer, &needed);
  const VkDeviceMemory memory =
      allocate(needed, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  vkBindBufferMemory(side().device, buffer, memory, 0);
  run_commands([&](VkCommandBuffer commands) {
    const VkImage image = chain.images[static_cast<std::size_t>(chain.shown)];
    change_layout(commands, image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {static_cast<std::uint32_t>(chain.width), static_cast<std::uint32_t>(chain.height), 1};
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
    change_layout(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  });
  std::vector<std::uint8_t> pixels(row * rows);
  void* bytes = nullptr;
  vkMapMemory(side().device, memory, 0, VK_WHOLE_SIZE, 0, &bytes);
  for (std::size_t y = 0; y < rows; ++y)  // Vulkan's first row is the uppermost
    std::memcpy(pixels.data() + y * row, static_cast<const std::uint8_t*>(bytes) + (rows - 1 - y) * row, row);
  vkUnmapMemory(side().device, memory);
  vkDestroyBuffer(side().device, buffer, nullptr);
  vkFreeMemory(side().device, memory, nullptr);
  return pixels;
}

PFN_xrVoidFunction vulkan_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> functions{
      {"xrGetVulkanGraphicsRequirements2KHR", reinterpret_cast<PFN_xrVoidFunction>(&vulkan_requirements)},
      {"xrCreateVulkanInstanceKHR", reinterpret_cast<PFN_xrVoidFunction>(&create_vulkan_instance)},
      {"xrGetVulkanGraphicsDevice2KHR", reinterpret_cast<PFN_xrVoidFunction>(&vulkan_gpu)},
      {"xrCreateVulkanDeviceKHR", reinterpret_cast<PFN_xrVoidFunction>(&create_vulkan_device)}};
  const auto found = functions.find(name);
  return found != functions.end() ? found->second : nullptr;
}

}  // namespace dubsar::testing
