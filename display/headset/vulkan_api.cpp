#include "display/headset/vulkan_api.h"

#include <dlfcn.h>

namespace dubsar::openxr {

Result<void> VulkanFunctions::open_library() {
  static void* const library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library != nullptr)
    vkGetInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
  if (vkGetInstanceProcAddr == nullptr)
    return fail(ErrorKind::kUnavailable,
                "openxr: the runtime takes Vulkan and there is no libvulkan.so.1; install libvulkan1 and the GPU's "
                "Vulkan driver");
  return {};
}

Result<void> VulkanFunctions::find_of(VkInstance instance) {
#define DUBSAR_FIND(name)                                                      \
  name = reinterpret_cast<PFN_##name>(vkGetInstanceProcAddr(instance, #name)); \
  if (name == nullptr) return fail(ErrorKind::kUnavailable, "openxr: Vulkan has no {}", #name);
  DUBSAR_VULKAN_OF_INSTANCE(DUBSAR_FIND)
#undef DUBSAR_FIND
  return {};
}

Result<void> VulkanFunctions::find_of(VkDevice device) {
#define DUBSAR_FIND(name)                                                  \
  name = reinterpret_cast<PFN_##name>(vkGetDeviceProcAddr(device, #name)); \
  if (name == nullptr) return fail(ErrorKind::kUnavailable, "openxr: the GPU's Vulkan driver has no {}", #name);
  DUBSAR_VULKAN_OF_DEVICE(DUBSAR_FIND)
#undef DUBSAR_FIND
  return {};
}

Result<void> check_vulkan(VkResult result, const char* tried) {
  if (result >= 0) return {};
  return fail(ErrorKind::kUnavailable, "openxr: {} ended with VkResult {}", tried, static_cast<int>(result));
}

}  // namespace dubsar::openxr
