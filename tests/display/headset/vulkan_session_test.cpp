// Sessions of Vulkan: for runtimes that take no OpenGL. Truth: the picture of the same moment in a session of OpenGL.

#include <gtest/gtest.h>
#include <vulkan/vulkan_core.h>

#include "tests/openxr_runtime/worn_card.h"

namespace dubsar {
namespace {

using testing::MadeFrame;

/// Its instance lives as long as the process: so the driver stays loaded, and whose leaks are whose can be told.
bool has_vulkan_gpu() {
  static const VkInstance instance = [] {
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    VkInstance out = VK_NULL_HANDLE;
    return vkCreateInstance(&info, nullptr, &out) == VK_SUCCESS ? out : VK_NULL_HANDLE;
  }();
  std::uint32_t count = 0;
  if (instance != VK_NULL_HANDLE) vkEnumeratePhysicalDevices(instance, &count, nullptr);
  return count > 0;
}

class VulkanSession : public testing::WornCard {
 protected:
  void SetUp() override {
    if (!has_vulkan_gpu()) GTEST_SKIP() << "no Vulkan driver is installed; mesa-vulkan-drivers has one for every CPU";
    WornCard::SetUp();
    if (HasFatalFailure()) return;
    sit();
  }
  /// Still, and so that the object is in neither middle of the pictures.
  void sit() {
    made_->wearer.yaw_middle = 1.1;
    made_->wearer.head_middle = {0.3, 0.1, -0.7};
    made_->wearer.floor_m = -1.05;
  }
  std::vector<MadeFrame> frames_of(const std::string& spec, int count) {
    open(spec);
    pictures_until_worn();
    for (int i = 1; i < count; ++i) EXPECT_TRUE(picture()) << sink_->note();
    scene_.reset();
    sink_.reset();
    return std::exchange(made_->frames, {});
  }
};

TEST_F(VulkanSession, ShowsTheSameBytesAsOneOfOpenGl) {
  const std::vector<MadeFrame> gl = frames_of("openxr:graphics=gl", 12);
  EXPECT_EQ(std::string_view(made_->binding), "EGL");
  made_->reset();
  sit();
  const std::vector<MadeFrame> vulkan = frames_of("openxr:graphics=vulkan", 12);
  EXPECT_EQ(std::string_view(made_->binding), "Vulkan");
  ASSERT_EQ(gl.size(), vulkan.size());
  for (std::size_t i = 0; i < gl.size(); ++i)
    for (std::size_t eye = 0; eye < 2; ++eye) {
      ASSERT_EQ(vulkan[i].layers, 1);
      ASSERT_TRUE(gl[i].bright[eye] && std::abs(gl[i].bright[eye]->y - 120.0) > 10.0) << "upside down must be seen";
      EXPECT_EQ(vulkan[i].poses[eye].position, gl[i].poses[eye].position);
      EXPECT_TRUE(vulkan[i].red[eye] == gl[i].red[eye]) << "frame " << i << ", eye " << eye;
    }
}

TEST_F(VulkanSession, IsBegunByItselfWhereTheRuntimeTakesNoOpenGl) {
  for (const bool listed : {false, true}) {
    made_->reset();
    sit();
    (listed ? made_->manners.lacks.gl_session : made_->manners.lacks.gl) = true;
    const std::vector<MadeFrame> frames = frames_of("openxr", 3);
    EXPECT_EQ(std::string_view(made_->binding), "Vulkan");
    for (const MadeFrame& frame : frames) EXPECT_TRUE(frame.bright[0] && frame.bright[1]);
  }
}

TEST_F(VulkanSession, ComesBackAfterALoss) {
  open("openxr:graphics=vulkan");
  pictures_until_worn();
  for (int loss = 0; loss < 3; ++loss) {
    {
      const std::lock_guard lock(made_->mutex);
      made_->faults.lose_session = true;
    }
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(picture());
    {
      const std::lock_guard lock(made_->mutex);
      made_->faults.lose_session = false;
    }
    pictures_until_worn();
    EXPECT_TRUE(picture());
  }
  EXPECT_EQ(made_->sessions_ever, 4);
}

TEST_F(VulkanSession, WhatWasAskedForIsKeptWhereTheRuntimeHasOnlyTheOther) {
  for (const auto& [spec, lacks] : {std::pair("openxr:graphics=gl", "OpenGL (XR_KHR_opengl_enable)"),
                                    std::pair("openxr:graphics=vulkan", "Vulkan (XR_KHR_vulkan_enable2)")}) {
    made_->reset();
    (std::string_view(lacks).starts_with("OpenGL") ? made_->manners.lacks.gl : made_->manners.lacks.vulkan) = true;
    open(spec);
    EXPECT_FALSE(picture());  // the nominal one
    EXPECT_FALSE(picture());
    EXPECT_NE(sink_->note().find(lacks), std::string::npos) << sink_->note();
    EXPECT_EQ(made_->sessions_ever, 0);
    scene_.reset();
    sink_.reset();
  }
}

TEST_F(VulkanSession, AGraphicsThatIsNoneIsAMistakeOfUse) {
  const auto sink = SinkCatalog().make("openxr:graphics=metal");
  ASSERT_FALSE(sink);
  EXPECT_EQ(sink.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace dubsar
