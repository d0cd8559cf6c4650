// The sources of a session on real device nodes: plugged in while the session runs, unplugged, plugged in
// again.

#include <algorithm>

#include "devices/device_list.h"
#include "devices/spacemouse/spacemouse_sim.h"
#include "input/input_source.h"
#include "tests/lab/lab_kernel.h"
#include "tests/lab/leap_gadget.h"
#include "tests/lab/report_descriptors.h"
#include "tests/lab/uhid_device.h"
#include "tests/lab/xreal_gadget.h"

namespace dubsar::lab {
namespace {

std::string node_of(std::string_view driver) {
  for (const DeviceInfo& info : list_devices("/none"))
    if (info.driver == driver) return info.path;
  return {};
}

/// The steady clock, 20 times slower: the tracker must find the hand before the picture is stale, and the
/// processor that qemu emulates is about that much slower than a real one.
class SlowClock final : public Clock {
 public:
  TimestampNs now() const noexcept override { return steady_.now() / 20; }

 private:
  SteadyClock steady_;
};

class LabSources : public Lab {
 protected:
  void SetUp() override {
    Lab::SetUp();
    if (IsSkipped()) return;
    hotplug_ = HotplugBell::of_this_machine();
  }

  struct Running {
    const Clock* clock = nullptr;
    std::unique_ptr<InputSource> source;
    InputFrame frame;
    TimestampNs polled = 0;
  };
  Running start(const std::string& name, const Clock& clock) {
    InputConfig config;
    config.hotplug = hotplug_;
    config.clock = &clock;
    auto made = make_input(name, config);
    EXPECT_TRUE(made) << made.error().message;
    return {&clock, made ? std::move(*made) : nullptr, {}, 0};
  }
  bool becomes(Running& running, Freshness wanted, milliseconds limit = milliseconds(60'000)) {
    const auto is_so = [&] {
      running.polled = clock_.now();
      return running.source->poll(running.clock->now(), running.frame) == wanted;
    };
    return eventually(is_so, limit);
  }
  /// How long after the kernel made the node the last poll of the source was.
  double seconds_from_node(const Running& running, std::string_view driver) const {
    const double age_s = seconds_since_made(node_of(driver));
    return age_s - 1e-9 * static_cast<double>(clock_.now() - running.polled);
  }

  SpaceMouseSim space_mouse_;
  UhidDevice space_mouse_plug_{{0x256f, 0xc635, "SpaceMouse Compact", "LAB1", kSpaceMouseReports},
                               [this] { return space_mouse_.device().open(); },
                               [this] {
                                 space_mouse_.move({350, 0, -175}, {0, 70, 0});
                               },
                               milliseconds(16)};
  XrealGadget glasses_{{0.0, 0.0, 0.0}, 0};
  UsbipPort glasses_plug_{glasses_};
  PluggedLeap leap_;
  SlowClock slow_clock_;
  std::shared_ptr<HotplugBell> hotplug_;
};

TEST_F(LabSources, SpaceMouseGlassesAndLeapComeGoAndComeBackWhileTheSessionRuns) {
  const int threads_before = threads();
  {
    Running space_mouse = start("spacemouse", clock_), glasses = start("head:xreal", clock_),
            leap = start("leap", slow_clock_);
    ASSERT_TRUE(space_mouse.source && glasses.source && leap.source);
    for (Running* running : {&space_mouse, &glasses, &leap}) {
      ASSERT_TRUE(becomes(*running, Freshness::kLost));
      EXPECT_TRUE(eventually([&] { return running->source->note().find("plugged in") != std::string::npos; }))
          << running->source->note();
    }
    for (int plugging = 0; plugging < 2; ++plugging) {
      ASSERT_TRUE(space_mouse_plug_.plug());
      ASSERT_TRUE(becomes(space_mouse, Freshness::kNew)) << space_mouse.source->note();
      const double space_mouse_s = seconds_from_node(space_mouse, "spacemouse");
      ASSERT_TRUE(space_mouse.frame.space_mouse);
      const auto pushed = [&] {  // the first report that is read may be the one of the turn
        space_mouse.source->poll(clock_.now(), space_mouse.frame);
        return space_mouse.frame.space_mouse && space_mouse.frame.space_mouse->push.x == 1.0;
      };
      EXPECT_TRUE(eventually(pushed, milliseconds(2000)));

      ASSERT_TRUE(glasses_plug_.plug());
      ASSERT_TRUE(becomes(glasses, Freshness::kNew)) << glasses.source->note();
      const double glasses_s = seconds_from_node(glasses, "xreal");
      ASSERT_EQ(glasses.frame.heads.size(), 1U);
      EXPECT_NEAR(glasses.frame.heads[0].left_eye_m->x, -0.0315, 1e-3);
      std::printf("after their nodes: SpaceMouse %.0f ms, glasses %.0f ms\n", 1e3 * space_mouse_s, 1e3 * glasses_s);
      EXPECT_LT(space_mouse_s, 1.0);
      EXPECT_LT(glasses_s, 1.0);

      space_mouse_plug_.unplug();
      glasses_plug_.unplug();
      glasses_.switch_off();
      EXPECT_TRUE(becomes(space_mouse, Freshness::kLost, milliseconds(2000)));
      EXPECT_TRUE(becomes(glasses, Freshness::kLost, milliseconds(2000)));
      EXPECT_FALSE(space_mouse.frame.space_mouse);
    }
    for (int plugging = 0; plugging < 2; ++plugging) {
      ASSERT_TRUE(leap_.plug());
      ASSERT_TRUE(eventually([] { return !node_of("leap").empty(); }));
      const TimestampNs appeared = clock_.now();
      ASSERT_TRUE(becomes(leap, Freshness::kNew)) << leap.source->note();
      std::printf("Leap: first hands %.0f ms after its node\n", 1e-6 * static_cast<double>(clock_.now() - appeared));
      const auto one_hand = [&] {  // a busy machine loses pictures, and the first may show none yet
        leap.source->poll(leap.clock->now(), leap.frame);
        return leap.frame.hands.size() == 1;
      };
      EXPECT_TRUE(eventually(one_hand));
      const auto present = present_inputs();
      EXPECT_EQ(std::count(present.begin(), present.end(), "leap"), 1);
      leap_.unplug();
      ASSERT_TRUE(becomes(leap, Freshness::kLost));
      ASSERT_TRUE(eventually([] { return node_of("leap").empty(); }));
    }
  }
  hotplug_.reset();
  EXPECT_EQ(threads(), threads_before);
  EXPECT_EQ(open_descriptors(), descriptors_at_start());
}

}  // namespace
}  // namespace dubsar::lab
