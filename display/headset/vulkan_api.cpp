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

#define DUBSAR_FIND(name)                                   \
  name = reinterpret_cast<PFN_##name>(find(handle, #name)); \
  if (name == nullptr) return fail(ErrorKind::kUnavailable, "openxr: Vulkan has no {}", #name);

Result<void> VulkanFunctions::find_of(VkInstance handle) {
  const auto find = vkGetInstanceProcAddr;
  DUBSAR_VULKAN_OF_INSTANCE(DUBSAR_FIND)
  return {};
}

Result<void> VulkanFunctions::find_of(VkDevice handle) {
  const auto find = vkGetDeviceProcAddr;
  DUBSAR_VULKAN_OF_DEVICE(DUBSAR_FIND)
  return {};
}
#undef DUBSAR_FIND

Result<void> check_vulkan(VkResult result, const char* tried) {
  if (result >= 0) return {};
  return fail(ErrorKind::kUnavailable, "openxr: {} ended with VkResult {}", tried, static_cast<int>(result));
}

}  // namespace dubsar::openxr
