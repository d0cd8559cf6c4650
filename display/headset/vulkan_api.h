#pragma once
// Vulkan's functions, as far as sessions need them: found in the loader's library when a runtime asks for Vulkan, so
// that a machine without it runs everything else.

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

#include "core/base/result.h"

namespace dubsar::openxr {

// NOLINTBEGIN(readability-identifier-naming): the members have the names of the functions
#define DUBSAR_VULKAN_OF_INSTANCE(X)          \
  X(vkDestroyInstance)                        \
  X(vkEnumerateDeviceExtensionProperties)     \
  X(vkGetPhysicalDeviceProperties2)           \
  X(vkGetPhysicalDeviceQueueFamilyProperties) \
  X(vkGetPhysicalDeviceMemoryProperties)      \
  X(vkGetDeviceProcAddr)
#define DUBSAR_VULKAN_OF_DEVICE(X) \
  X(vkDestroyDevice)               \
  X(vkDeviceWaitIdle)              \
  X(vkGetDeviceQueue)              \
  X(vkCreateImage)                 \
  X(vkDestroyImage)                \
  X(vkGetImageMemoryRequirements)  \
  X(vkAllocateMemory)              \
  X(vkFreeMemory)                  \
  X(vkBindImageMemory)             \
  X(vkGetMemoryFdKHR)              \
  X(vkCreateCommandPool)           \
  X(vkDestroyCommandPool)          \
  X(vkAllocateCommandBuffers)      \
  X(vkBeginCommandBuffer)          \
  X(vkEndCommandBuffer)            \
  X(vkCmdPipelineBarrier)          \
  X(vkCmdCopyImage)                \
  X(vkQueueSubmit)                 \
  X(vkCreateFence)                 \
  X(vkDestroyFence)                \
  X(vkWaitForFences)               \
  X(vkResetFences)

struct VulkanFunctions {
  PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr = nullptr;
#define DUBSAR_MEMBER(name) PFN_##name name = nullptr;
  DUBSAR_VULKAN_OF_INSTANCE(DUBSAR_MEMBER)
  DUBSAR_VULKAN_OF_DEVICE(DUBSAR_MEMBER)
#undef DUBSAR_MEMBER

  /// Opens libvulkan.so.1, once; it stays. kUnavailable with what to install.
  Result<void> open_library();
  /// kUnavailable: one of the functions is not there.
  Result<void> find_of(VkInstance instance);
  Result<void> find_of(VkDevice device);
};
// NOLINTEND(readability-identifier-naming)

/// kUnavailable with what was tried and the number that came back.
Result<void> check_vulkan(VkResult result, const char* tried);

}  // namespace dubsar::openxr
