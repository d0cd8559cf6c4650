#pragma once
// A test whose machine has the made runtime and its headset.

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/openxr_runtime/made_headset.h"

namespace dubsar::testing {

class WornTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("XR_RUNTIME_JSON", DUBSAR_MADE_RUNTIME_JSON, 1);
    ::setenv("XR_LOADER_DEBUG", "none", 1);
    static void* const library = ::dlopen(DUBSAR_MADE_RUNTIME, RTLD_NOW);  // stays, whatever the loader does
    ASSERT_NE(library, nullptr) << ::dlerror();
    const auto door = reinterpret_cast<MadeHeadset* (*)()>(::dlsym(library, "made_headset"));
    ASSERT_NE(door, nullptr);
    made_ = door();
    made_->reset();
  }
  /// By the runtime's own count: everything that was made is gone, and nothing was called out of turn.
  void TearDown() override {
    EXPECT_EQ(made_->alive.instances, 0);
    EXPECT_EQ(made_->alive.sessions, 0);
    EXPECT_EQ(made_->alive.swapchains, 0);
    EXPECT_EQ(made_->alive.spaces, 0);
    EXPECT_EQ(made_->alive.hand_trackers, 0);
    EXPECT_EQ(made_->wrong_calls, 0);
  }
  MadeHeadset* made_ = nullptr;
};

}  // namespace dubsar::testing
