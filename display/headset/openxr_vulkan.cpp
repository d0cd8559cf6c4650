// Sessions of Vulkan (XR_KHR_vulkan_enable2): for runtimes that take no OpenGL, as those of lens panels, or take it
// badly. OpenGL draws into memory that both share; one copy from there into the runtime's picture.

#include <algorithm>
#include <array>
#include <cstring>

#include "display/headset/openxr_graphics.h"
#include "display/headset/shared_picture.h"
#include "display/render/view_array.h"

namespace dubsar::openxr {
namespace {

constexpr std::uint64_t kPatienceNs = 1'000'000'000;  // for one copy
constexpr VkImageSubresourceLayers kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

class VulkanGraphics final : public Graphics {
 public:
  explicit VulkanGraphics(const Instance& instance) : instance_(&instance) {}
  VulkanGraphics(const VulkanGraphics&) = delete;
  VulkanGraphics& operator=(const VulkanGraphics&) = delete;

  ~VulkanGraphics() override {
    const VulkanFunctions& vk = vulkan_.functions;
    if (vulkan_.device != VK_NULL_HANDLE) {
      vk.vkDeviceWaitIdle(vulkan_.device);
      for (SharedPicture& picture : shared_) picture = SharedPicture();
      if (copied_ != VK_NULL_HANDLE) vk.vkDestroyFence(vulkan_.device, copied_, nullptr);
      if (pool_ != VK_NULL_HANDLE) vk.vkDestroyCommandPool(vulkan_.device, pool_, nullptr);
      vk.vkDestroyDevice(vulkan_.device, nullptr);
    }
    if (vulkan_.instance != VK_NULL_HANDLE && vk.vkDestroyInstance != nullptr)
      vk.vkDestroyInstance(vulkan_.instance, nullptr);
  }

  Result<void> open() {
    DUBSAR_TRY(vulkan_.functions.open_library());
    DUBSAR_TRY(open_instance());
    DUBSAR_TRY(vulkan_.functions.find_of(vulkan_.instance));
    DUBSAR_TRY(find_gpu());
    DUBSAR_TRY(SharedPicture::check_gl(vulkan_));
    DUBSAR_TRY(open_device());
    DUBSAR_TRY(vulkan_.functions.find_of(vulkan_.device));
    DUBSAR_TRY(make_commands());
    binding_.instance = vulkan_.instance;
    binding_.physicalDevice = vulkan_.gpu;
    binding_.device = vulkan_.device;
    binding_.queueFamilyIndex = vulkan_.family;
    return {};
  }

  const char* name() const noexcept override { return "Vulkan"; }
  const void* binding() const noexcept override { return &binding_; }
  std::int64_t format() const noexcept override { return VK_FORMAT_R8G8B8A8_SRGB; }
  const char* format_name() const noexcept override { return "VK_FORMAT_R8G8B8A8_SRGB"; }

  Result<void> take(std::size_t eye, XrSwapchain chain, PixelSize size) override {
    DUBSAR_ASSIGN(images_[eye],
                  images_of<XrSwapchainImageVulkan2KHR>(door(), chain, XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR));
    DUBSAR_ASSIGN(shared_[eye], SharedPicture::create(vulkan_, size));
    return {};
  }

  Result<void> copy(const ViewArray& views, std::size_t eye, std::uint32_t image) override {
    if (image >= images_[eye].size()) return {};
    draw_upside_down(views, eye);
    return copy_shared(eye, images_[eye][image].image);
  }

 private:
  Door& door() const noexcept { return instance_->door(); }
  template <class Function>
  Result<Function> function(const char* name) const {
    const auto out = function_of<Function>(instance_->handle(), name);
    if (out == nullptr)
      return fail(ErrorKind::kUnavailable, "openxr: runtime {} lists XR_KHR_vulkan_enable2 and has no {}",
                  instance_->runtime(), name);
    return out;
  }

  Result<void> open_instance() {
    DUBSAR_ASSIGN(const auto requirements,
                  function<PFN_xrGetVulkanGraphicsRequirements2KHR>("xrGetVulkanGraphicsRequirements2KHR"));
    auto range = made<XrGraphicsRequirementsVulkan2KHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR);
    DUBSAR_TRY(
        check(door()(requirements, instance_->handle(), instance_->system(), &range), "asking which Vulkan is needed"));
    const XrVersion least = std::max<XrVersion>(range.minApiVersionSupported, XR_MAKE_VERSION(1, 1, 0));
    DUBSAR_ASSIGN(const auto create, function<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR"));
    VkApplicationInfo about{};
    about.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    about.pApplicationName = "dubsar";
    about.apiVersion = VK_MAKE_API_VERSION(0, XR_VERSION_MAJOR(least), XR_VERSION_MINOR(least), 0);
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &about;
    auto asked = made<XrVulkanInstanceCreateInfoKHR>(XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR);
    asked.systemId = instance_->system();
    asked.pfnGetInstanceProcAddr = vulkan_.functions.vkGetInstanceProcAddr;
    asked.vulkanCreateInfo = &info;
    VkResult result = VK_SUCCESS;
    DUBSAR_TRY(check(door()(create, instance_->handle(), &asked, &vulkan_.instance, &result), "opening Vulkan"));
    return check_vulkan(result, "opening Vulkan");
  }

  Result<void> find_gpu() {
    DUBSAR_ASSIGN(const auto find, function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR"));
    auto asked = made<XrVulkanGraphicsDeviceGetInfoKHR>(XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR);
    asked.systemId = instance_->system();
    asked.vulkanInstance = vulkan_.instance;
    return check(door()(find, instance_->handle(), &asked, &vulkan_.gpu), "finding the GPU");
  }

  Result<void> open_device() {
    const VulkanFunctions& vk = vulkan_.functions;
    std::uint32_t count = 0;
    vk.vkGetPhysicalDeviceQueueFamilyProperties(vulkan_.gpu, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.vkGetPhysicalDeviceQueueFamilyProperties(vulkan_.gpu, &count, families.data());
    const auto draws = std::find_if(families.begin(), families.end(), [](const VkQueueFamilyProperties& family) {
      return (family.queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0;
    });
    if (draws == families.end())
      return fail(ErrorKind::kUnavailable, "openxr: the GPU of runtime {} draws nothing by Vulkan",
                  instance_->runtime());
    vulkan_.family = static_cast<std::uint32_t>(draws - families.begin());
    const float first = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = vulkan_.family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &first;
    const char* const extensions[] = {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME};
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = extensions;
    DUBSAR_ASSIGN(const auto create, function<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR"));
    auto asked = made<XrVulkanDeviceCreateInfoKHR>(XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR);
    asked.systemId = instance_->system();
    asked.pfnGetInstanceProcAddr = vk.vkGetInstanceProcAddr;
    asked.vulkanPhysicalDevice = vulkan_.gpu;
    asked.vulkanCreateInfo = &info;
    VkResult result = VK_SUCCESS;
    DUBSAR_TRY(check(door()(create, instance_->handle(), &asked, &vulkan_.device, &result), "opening the GPU"));
    return check_vulkan(result, "opening the GPU");
  }

  Result<void> make_commands() {
    const VulkanFunctions& vk = vulkan_.functions;
    vk.vkGetDeviceQueue(vulkan_.device, vulkan_.family, 0, &vulkan_.queue);
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = vulkan_.family;
    DUBSAR_TRY(check_vulkan(vk.vkCreateCommandPool(vulkan_.device, &pool, nullptr, &pool_), "preparing copies"));
    VkCommandBufferAllocateInfo buffer{};
    buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer.commandPool = pool_;
    buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer.commandBufferCount = 1;
    DUBSAR_TRY(check_vulkan(vk.vkAllocateCommandBuffers(vulkan_.device, &buffer, &commands_), "preparing copies"));
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    return check_vulkan(vk.vkCreateFence(vulkan_.device, &fence, nullptr, &copied_), "preparing copies");
  }

  /// The eye's layer into the shared picture, its last row first: Vulkan's first row is the uppermost. The same bytes.
  void draw_upside_down(const ViewArray& views, std::size_t eye) {
    const PixelSize size = shared_[eye].size();
    const int width = std::min(views.width(), size.width), height = std::min(views.height(), size.height);
    const bool scissors = glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE;
    glDisable(GL_SCISSOR_TEST);
    glNamedFramebufferTextureLayer(layer_, GL_COLOR_ATTACHMENT0, views.coded(), 0, static_cast<GLint>(eye));
    glNamedFramebufferTexture(turned_, GL_COLOR_ATTACHMENT0, shared_[eye].texture(), 0);
    glBlitNamedFramebuffer(layer_, turned_, 0, 0, width, height, 0, height, width, 0, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    if (scissors) glEnable(GL_SCISSOR_TEST);
    glFinish();  // semaphores would need GL_EXT_semaphore_fd, which not all have
  }

  Result<void> copy_shared(std::size_t eye, VkImage to) {
    const VulkanFunctions& vk = vulkan_.functions;
    const PixelSize size = shared_[eye].size();
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    DUBSAR_TRY(check_vulkan(vk.vkBeginCommandBuffer(commands_, &begin), "copying a picture"));
    // What OpenGL wrote comes from outside; the runtime's picture comes and goes as a colour attachment.
    Barrier from{shared_[eye].image(), VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    from.source = VK_QUEUE_FAMILY_EXTERNAL;
    from.target = vulkan_.family;
    pass(from);
    pass({to, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL});
    VkImageCopy region{};
    region.srcSubresource = region.dstSubresource = kWhole;
    region.extent = {static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height), 1};
    vk.vkCmdCopyImage(commands_, from.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    pass({to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
    std::swap(from.from, from.to);
    std::swap(from.source, from.target);
    pass(from);
    DUBSAR_TRY(check_vulkan(vk.vkEndCommandBuffer(commands_), "copying a picture"));
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    DUBSAR_TRY(check_vulkan(vk.vkQueueSubmit(vulkan_.queue, 1, &submit, copied_), "copying a picture"));
    const VkResult done = vk.vkWaitForFences(vulkan_.device, 1, &copied_, VK_TRUE, kPatienceNs);
    if (done == VK_TIMEOUT) return fail(ErrorKind::kUnavailable, "openxr: the GPU copied no picture in a second");
    DUBSAR_TRY(check_vulkan(done, "copying a picture"));
    return check_vulkan(vk.vkResetFences(vulkan_.device, 1, &copied_), "copying a picture");
  }

  struct Barrier {
    VkImage image = VK_NULL_HANDLE;
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED, to = VK_IMAGE_LAYOUT_UNDEFINED;
    std::uint32_t source = VK_QUEUE_FAMILY_IGNORED, target = VK_QUEUE_FAMILY_IGNORED;
  };
  void pass(const Barrier& wanted) const {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = wanted.from;
    barrier.newLayout = wanted.to;
    barrier.srcQueueFamilyIndex = wanted.source;
    barrier.dstQueueFamilyIndex = wanted.target;
    barrier.image = wanted.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vulkan_.functions.vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                           VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
  }

  const Instance* instance_;
  VulkanDevice vulkan_;
  XrGraphicsBindingVulkan2KHR binding_ = made<XrGraphicsBindingVulkan2KHR>(XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR);
  std::array<std::vector<XrSwapchainImageVulkan2KHR>, 2> images_;
  std::array<SharedPicture, 2> shared_;
  GlFramebuffer layer_ = make_framebuffer(), turned_ = make_framebuffer();
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkFence copied_ = VK_NULL_HANDLE;
};

}  // namespace

Result<std::unique_ptr<Graphics>> make_vulkan_graphics(const Instance& instance) {
  auto out = std::make_unique<VulkanGraphics>(instance);
  DUBSAR_TRY(out->open());
  return out;
}

}  // namespace dubsar::openxr
