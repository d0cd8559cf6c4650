// Runtimes that are no well-behaved libraries: each manner by itself, and pictures go on or the reason is said. None
// ends the program, none leaves a GL error, none is called out of turn.

#include <gtest/gtest.h>

#include "tests/openxr_runtime/worn_card.h"

namespace dubsar {
namespace {

using testing::MadeManners;
using testing::XrState;

class RudeRuntime : public testing::WornCard {
 protected:
  /// Pictures with light in both eyes, to the end.
  void expect_pictures(int count = 12) {
    pictures_until_worn();
    const std::size_t from = made_->frames.size();
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(picture()) << sink_->note();
      ASSERT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    }
    ASSERT_GE(made_->frames.size(), from + static_cast<std::size_t>(count));
    for (std::size_t i = from; i < made_->frames.size(); ++i)
      for (const auto& bright : made_->frames[i].bright) EXPECT_TRUE(bright) << "frame " << i << " is dark";
  }
  void expect_reason(std::string_view words) {
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(picture());
    EXPECT_NE(sink_->note().find(words), std::string::npos) << sink_->note();
  }
  void tell_states(std::initializer_list<XrState> states) {
    const std::lock_guard lock(made_->mutex);
    for (const XrState state : states) made_->faults.states.push_back(state);
  }
};

constexpr const char* kCalls[] = {
    "xrCreateSession",      "xrBeginSession",          "xrPollEvent",   "xrWaitFrame",       "xrBeginFrame",
    "xrLocateViews",        "xrLocateSpace",           "xrSyncActions", "xrCreateSwapchain", "xrAcquireSwapchainImage",
    "xrWaitSwapchainImage", "xrReleaseSwapchainImage", "xrEndFrame"};

class RudeCall : public RudeRuntime, public ::testing::WithParamInterface<const char*> {};

TEST_P(RudeCall, GlErrorsThatItLeavesAreDropped) {
  made_->wearer.floor_m = -1.05;
  made_->manners.gl_error_after = GetParam();
  made_->manners.refuses_gl_errors = true;  // what SteamVR leaves, its own next call refuses
  open();
  expect_pictures();
}

TEST_P(RudeCall, TheContextThatItTakesIsPutBack) {
  made_->manners.context_taken_by = GetParam();
  open();
  expect_pictures();
}

INSTANTIATE_TEST_SUITE_P(Each, RudeCall, ::testing::ValuesIn(kCalls),
                         [](const auto& each) { return std::string(each.param); });

TEST_F(RudeRuntime, ErrorsOfOurOwnAreStillTold) {
  open();
  pictures_until_worn();
  sink_->views(Observer());
  glEnable(0x4321);
  const auto done = sink_->compose(scene_->array, scene_->mirror.surface());
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("0x0500"), std::string::npos) << done.error().message;
}

TEST_F(RudeRuntime, GlStateMayBeLeftAsItLikes) {
  made_->manners.spoils_gl_state = true;
  open();
  expect_pictures();
}

TEST_F(RudeRuntime, OneOfApi10IsEnough) {
  made_->manners.lacks.newer_api = true;
  open();
  expect_pictures(2);
}

TEST_F(RudeRuntime, OneInstanceIsMadeForAWholeSession) {
  open();
  EXPECT_EQ(made_->instances_ever, 0) << "asking what the display is like opens nothing";
  expect_pictures(3);
  EXPECT_EQ(made_->instances_ever, 1);
}

TEST_F(RudeRuntime, WithoutOpenGlOrASessionOfItTheReasonIsSaid) {
  made_->manners.lacks.vulkan = made_->manners.lacks.gl = true;
  open();
  expect_reason("takes neither OpenGL (XR_KHR_opengl_enable) nor Vulkan");
  scene_.reset();
  sink_.reset();
  made_->manners = MadeManners();
  made_->manners.lacks.vulkan = made_->manners.lacks.gl_session = true;
  open();
  expect_reason("takes no OpenGL session though it lists");
}

TEST_F(RudeRuntime, WithoutItsExtensionsItGoesOn) {
  made_->manners.lacks.hands = made_->manners.lacks.time = true;
  open();
  expect_pictures(3);
}

TEST_F(RudeRuntime, WithoutEglAWindowOnX11IsAskedFor) {
  made_->manners.lacks.egl = true;
  open();
  expect_reason("takes no EGL contexts");
}

TEST_F(RudeRuntime, OfFourViewsTheFirstTwoAreTheEyes) {
  made_->manners.views = 4;
  open();
  expect_pictures(3);
}

TEST_F(RudeRuntime, WithoutAFormatThatWeWriteTheReasonIsSaid) {
  made_->manners.formats = {0x881A};
  open();
  expect_reason("no pictures of format GL_SRGB8_ALPHA8");
}

TEST_F(RudeRuntime, ABusyCompositorIsWaitedForWithoutALostSession) {
  open();
  pictures_until_worn();
  {
    const std::lock_guard lock(made_->mutex);
    made_->manners.busy_waits = 5;
  }
  for (int i = 0; i < 12; ++i) EXPECT_TRUE(picture());
  EXPECT_EQ(made_->sessions_ever, 1);
  EXPECT_EQ(made_->frames.back().layers, 1);
}

TEST_F(RudeRuntime, HiddenPicturesAreNotSubmittedAndTheSinkSaysThatNobodySeesThem) {
  open();
  pictures_until_worn();
  EXPECT_FALSE(sink_->hidden());
  {
    const std::lock_guard lock(made_->mutex);
    made_->manners.hidden = true;
  }
  EXPECT_TRUE(picture());
  EXPECT_TRUE(sink_->hidden());
  EXPECT_EQ(made_->frames.back().layers, 0);
}

TEST_F(RudeRuntime, PausesAndReturnsAreFollowed) {
  open();
  pictures_until_worn();
  tell_states({XrState::kVisible, XrState::kSynchronized, XrState::kStopping});
  for (int i = 0; i < 3; ++i) picture();
  EXPECT_NE(sink_->note().find("not worn or not ready"), std::string::npos) << sink_->note();
  EXPECT_FALSE(sink_->ended());
  tell_states({XrState::kIdle, XrState::kReady});
  expect_pictures(3);
  EXPECT_EQ(made_->sessions_ever, 1);
}

TEST_F(RudeRuntime, TheWearersQuitIsAnEndAndTheHeadsetIsNotTakenAgain) {
  open();
  pictures_until_worn();
  tell_states({XrState::kStopping, XrState::kIdle, XrState::kExiting});
  for (int i = 0; i < 3; ++i) picture();
  EXPECT_TRUE(sink_->ended());
  EXPECT_EQ(made_->alive.sessions, 0);
  EXPECT_EQ(made_->alive.instances, 0);
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1500);
       std::chrono::steady_clock::now() < end;)
    EXPECT_FALSE(picture());
  EXPECT_EQ(made_->sessions_ever, 1) << "a new one 10 s later at the earliest";
}

TEST_F(RudeRuntime, ANewMiddleHoldsFromTheMomentThatItIsToldFor) {
  made_->manners.recentre_lead = 20;
  open();
  pictures_until_worn();
  {
    const std::lock_guard lock(made_->mutex);
    made_->faults.recentre = true;
    made_->wearer.head_middle = {0.6, 0, 0};
  }
  const auto aside = [&] {
    return 0.5 * (sink_->wearer()->eyes[0].pose.position_m + sink_->wearer()->eyes[1].pose.position_m).x;
  };
  int before = 0;
  for (; before < 40; ++before) {
    ASSERT_TRUE(picture());
    if (std::abs(aside()) < 1e-6) break;
  }
  EXPECT_EQ(before, 20);
}

TEST_F(RudeRuntime, AnotherHeadsetAfterALossHasItsOwnSize) {
  open();
  pictures_until_worn();
  EXPECT_EQ(sink_->traits().view.width, 240);
  {
    const std::lock_guard lock(made_->mutex);
    made_->faults.end_instance = true;
    made_->manners.eye_px = 320;
  }
  for (int i = 0; i < 3; ++i) picture();
  made_->faults.end_instance = false;
  pictures_until_worn();
  EXPECT_EQ(sink_->traits().view.width, 320);
}

TEST_F(RudeRuntime, TheRoomIsSeenOnlyWhereItWasAskedFor) {
  made_->manners.blends = {2, 3, 1};  // additive is the favourite, as of Monado's North Star
  for (const auto& [spec, blend, flags] :
       {std::tuple{"openxr", 1, 0u}, {"openxr:blend=additive", 2, 0u}, {"openxr:blend=alpha", 3, 2u}}) {
    open(spec);
    pictures_until_worn();
    EXPECT_TRUE(picture());
    EXPECT_EQ(made_->frames.back().blend, blend) << spec;
    EXPECT_EQ(made_->frames.back().layer_flags, flags) << spec;
    EXPECT_EQ(sink_->traits().see_through, blend != 1) << spec;
    scene_.reset();
    sink_.reset();
  }
  made_->manners.blends = {2};
  open("openxr:blend=alpha");
  pictures_until_worn();
  EXPECT_EQ(made_->frames.back().blend, 2) << "what there is";
}

TEST_F(RudeRuntime, HandsThatAreMadeUpFromControllersAreNone) {
  for (const bool told : {true, false}) {
    made_->manners.hand_source = told;
    made_->manners.hands_from_controllers = made_->hands.controller = true;
    open();
    pictures_until_worn();
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(picture());
    EXPECT_FALSE(sink_->wearer()->hands[1].active) << told;
    EXPECT_TRUE(sink_->wearer()->controllers[1].active) << told;
    {
      const std::lock_guard lock(made_->mutex);  // it is laid down
      made_->hands.controller = false;
      made_->hands.right_hand = true;
    }
    EXPECT_TRUE(picture());
    EXPECT_TRUE(sink_->wearer()->hands[1].active) << told;
    made_->hands = {};
    scene_.reset();
    sink_.reset();
  }
}

TEST_F(RudeRuntime, WhileTheSystemMenuIsOpenNeitherHandsNorControllersAct) {
  made_->hands.right_hand = made_->hands.controller = true;
  made_->hands.squeeze = 1.0;
  made_->manners.hand_source = true;
  open();
  pictures_until_worn();
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(picture());
  EXPECT_TRUE(sink_->wearer()->hands[1].active);
  tell_states({XrState::kVisible});
  EXPECT_TRUE(picture());
  EXPECT_FALSE(sink_->wearer()->hands[1].active);
  EXPECT_FALSE(sink_->wearer()->controllers[1].active);
  tell_states({XrState::kFocused});
  EXPECT_TRUE(picture());
  EXPECT_TRUE(sink_->wearer()->hands[1].active);
}

}  // namespace
}  // namespace dubsar
