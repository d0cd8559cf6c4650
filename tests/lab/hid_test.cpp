// HID devices in a real kernel: uhid or USB/IP below, hidraw and unmodified hidapi between, our drivers
// above.

#include <sys/stat.h>

#include <glm/gtc/quaternion.hpp>
#include <mutex>
#include <nlohmann/json.hpp>

#include "devices/device_list.h"
#include "devices/driver.h"
#include "devices/head_tracker/imu_sim.h"
#include "devices/looking_glass/looking_glass_sim.h"
#include "devices/spacemouse/spacemouse_sim.h"
#include "devices/transport/hotplug_watch.h"
#include "tests/lab/lab_kernel.h"
#include "tests/lab/report_descriptors.h"
#include "tests/lab/uhid_device.h"
#include "tests/lab/usbip_port.h"
#include "tests/lab/xreal_gadget.h"

namespace dubsar::lab {
namespace {

constexpr int kPluggings = 5;
constexpr double kDegree = 3.14159265358979323846 / 180.0;

double angle_between(const glm::dquat& a, const glm::dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

std::optional<DeviceInfo> listed(std::string_view driver) {
  for (DeviceInfo& info : list_hid_devices())
    if (info.driver == driver) return std::move(info);
  return std::nullopt;
}

/// Polls as a session does: a change in /dev wakes the driver. The time of the first sample, or nothing
/// within `limit`.
template <class AnyDriver>
std::optional<TimestampNs> first_sample(AnyDriver& driver, HotplugWatch& watch, const Clock& clock,
                                        TimestampNs limit = 20'000'000'000) {
  const TimestampNs begun = clock.now();
  while (clock.now() - begun < limit) {
    if (watch.changed()) driver.wake();
    if (driver.poll(clock.now(), milliseconds(5))) return clock.now();
    if (!driver.connected()) std::this_thread::sleep_for(milliseconds(2));
  }
  return std::nullopt;
}

template <class AnyDriver>
bool notices_loss(AnyDriver& driver, const Clock& clock) {
  return eventually(
      [&] {
        driver.poll(clock.now(), milliseconds(5));
        return !driver.connected();
      },
      milliseconds(1000));
}

class LabHid : public Lab {
 protected:
  /// Unplugs and plugs again: the loss is noticed, and a second after the node is there so is the first
  /// sample. What the kernel needs before that to ask a USB device who it is, is not ours.
  template <class AnyDriver, class Unplug, class Plug>
  void unplug_and_replug(std::string_view name, AnyDriver& driver, const Unplug& unplug, const Plug& plug) {
    auto watch = HotplugWatch::create(HotplugWatch::device_folders());
    ASSERT_TRUE(watch) << watch.error().message;
    double longest_s = 0.0, longest_of_ours_s = 0.0;
    for (int i = 0; i < kPluggings; ++i) {
      unplug();
      ASSERT_TRUE(notices_loss(driver, clock_));
      EXPECT_FALSE(driver.reason().empty());
      const TimestampNs plugged = clock_.now();
      plug();
      const auto sample = first_sample(driver, *watch, clock_);
      ASSERT_TRUE(sample) << driver.reason();
      longest_s = std::max(longest_s, 1e-9 * static_cast<double>(*sample - plugged));
      longest_of_ours_s = std::max(longest_of_ours_s, seconds_since_made(listed(name)->path));
    }
    std::printf("first sample at most %.0f ms after plugging in, %.0f ms after the kernel has made the node\n",
                1e3 * longest_s, 1e3 * longest_of_ours_s);
    EXPECT_LT(longest_of_ours_s, 1.0);
  }
};

class LabSpaceMouse : public LabHid {
 protected:
  SpaceMouseSim sim_;
  UhidDevice device_{{0x256f, 0xc635, "SpaceMouse Compact", "LAB1", kSpaceMouseReports},
                     [this] { return sim_.device().open(); },
                     [this] {
                       sim_.move({350, 0, -175}, {0, 70, 0});
                     },
                     milliseconds(16)};
};

TEST_F(LabSpaceMouse, IsListedSaysItsAxesLightsUpAndComesBack) {
  const auto plugged = device_.plug();
  ASSERT_TRUE(plugged) << plugged.error().message;
  ASSERT_TRUE(eventually([] { return listed("spacemouse").has_value(); }));
  const auto info = *listed("spacemouse");
  EXPECT_EQ(info.name, "SpaceMouse Compact");
  EXPECT_EQ(info.serial, "LAB1");
  EXPECT_EQ(info.vendor_id, 0x256f);
  EXPECT_EQ(info.path.rfind("/dev/hidraw", 0), 0U) << info.path;
  EXPECT_EQ(info.state, DeviceState::kUsable) << info.reason;
  {
    Driver<SpaceMouseProtocol> driver([this] { return open_hid_device("spacemouse", clock_); }, SpaceMouseProtocol());
    std::optional<SpaceMouseSample> sample;
    ASSERT_TRUE(eventually([&] {
      if (auto newest = driver.poll(clock_.now(), milliseconds(20))) sample = newest;
      // Two reports tell the two halves; whoever opens between them hears the second one first.
      return sample && sample->rotation != glm::dvec3(0.0) && sample->translation != glm::dvec3(0.0);
    })) << driver.reason();
    EXPECT_EQ(sample->translation, glm::dvec3(1.0, 0.5, 0.0));
    EXPECT_NEAR(sample->rotation.z, 0.2, 1e-9);
    EXPECT_TRUE(eventually([&] { return sim_.light_is_on(); }));
    EXPECT_EQ(driver.counts().refused, 0U);
    unplug_and_replug(
        "spacemouse", driver, [&] { device_.unplug(); }, [&] { ASSERT_TRUE(device_.plug()); });
    EXPECT_EQ(driver.counts().losses, static_cast<std::uint64_t>(kPluggings));
  }
  device_.unplug();
  EXPECT_TRUE(eventually([] { return list_hid_devices().empty(); }));
  EXPECT_EQ(open_descriptors(), descriptors_at_start());
}

TEST_F(LabSpaceMouse, ToAnotherUserItSaysThatPermissionIsMissingAndWhatToDo) {
  ASSERT_TRUE(device_.plug());
  ASSERT_TRUE(eventually([] { return listed("spacemouse").has_value(); }));
  const auto told = [this] {
    return as_nobody([this] {
      const auto info = listed("spacemouse");
      const auto opened = open_hid_device("spacemouse", clock_);
      return nlohmann::json{{"state", info ? device_state_name(info->state) : "none"},
                            {"reason", info ? info->reason : ""},
                            {"remedy", info ? info->remedy : ""},
                            {"opened", opened.has_value()},
                            {"kind", opened ? -1 : static_cast<int>(opened.error().kind)},
                            {"error", opened ? "" : opened.error().message}}
          .dump();
    });
  };
  const auto refused = nlohmann::json::parse(told());
  const std::string path = listed("spacemouse")->path;
  EXPECT_EQ(refused["state"], "no permission");
  EXPECT_EQ(refused["reason"], "this user may not open " + path);
  EXPECT_NE(refused["remedy"].get<std::string>().find("70-dubsar.rules"), std::string::npos) << refused["remedy"];
  EXPECT_NE(refused["remedy"].get<std::string>().find(R"(ATTRS{idVendor}=="256f")"), std::string::npos);
  EXPECT_EQ(refused["opened"], false);
  EXPECT_EQ(refused["kind"], static_cast<int>(ErrorKind::kPermission));
  EXPECT_NE(refused["error"].get<std::string>().find("70-dubsar.rules"), std::string::npos) << refused["error"];

  ASSERT_EQ(::chmod(path.c_str(), 0666), 0);  // the rule's effect
  const auto allowed = nlohmann::json::parse(told());
  EXPECT_EQ(allowed["state"], "usable");
  EXPECT_EQ(allowed["opened"], true) << allowed["error"];
}

class LabRift : public LabHid, public testing::WithParamInterface<RiftModel> {
 protected:
  static constexpr milliseconds kPeriod{10};
  static constexpr int kTurningReports = 50;

  bool dk1() const { return GetParam() == RiftModel::kDk1; }
  void step() {
    const std::lock_guard lock(mutex_);
    if (in_step_ && !polled_) return;
    polled_ = false;
    const bool turning = !sim_.silent() && reports_++ < kTurningReports;
    sim_.step({0.0, turning ? 2.0 : 0.0, 0.0}, readings_per_report_);
    told_.silent = sim_.silent();
    told_.time_ms += readings_per_report_;
    told_.still = reports_ > kTurningReports;
    told_.world_from_head = sim_.motion().world_from_head();
  }
  struct Told {
    bool silent = true;
    bool still = false;  ///< it has turned as far as it does
    int time_ms = 0;     ///< of the headset
    glm::dquat world_from_head{1.0, 0.0, 0.0, 0.0};
  };
  Told told() {
    const std::lock_guard lock(mutex_);
    return told_;
  }
  /// In step, the headset's time passes by one report after each poll: a busy machine that keeps us from polling does
  /// not let it fall asleep meanwhile.
  void keep_in_step(bool in_step) {
    const std::lock_guard lock(mutex_);
    in_step_ = in_step;
  }
  void has_been_polled() {
    const std::lock_guard lock(mutex_);
    polled_ = true;
  }

  int readings_per_report_ = 10;  ///< 1 ms each; more: the headset's time runs faster than ours
  std::mutex mutex_;
  bool in_step_ = false;
  bool polled_ = true;
  int reports_ = 0;
  Told told_;
  RiftSim sim_{GetParam()};
  UhidDevice device_{{kRiftVendor, dk1() ? kRiftDk1 : kRiftDk2, dk1() ? "Tracker DK" : "Rift DK2", "LAB2",
                      dk1() ? std::span<const std::uint8_t>(kRiftDk1Reports) : kRiftDk2Reports},
                     [this] { return sim_.device().open(); },
                     [this] { step(); },
                     kPeriod};
};
INSTANTIATE_TEST_SUITE_P(Models, LabRift, testing::Values(RiftModel::kDk1, RiftModel::kDk2),
                         [](const auto& model) { return model.param == RiftModel::kDk1 ? "Dk1" : "Dk2"; });

TEST_P(LabRift, IsKeptAwakeOrFallsSilentAndIsWoken) {
  constexpr int kSpeed = 10;  // so that 10 s of the headset pass in one of ours
  readings_per_report_ = kSpeed * static_cast<int>(kPeriod.count());
  const auto headset_now = [this] { return TimestampNs{1'000'000} * told().time_ms; };
  keep_in_step(true);
  const auto plugged = device_.plug();
  ASSERT_TRUE(plugged) << plugged.error().message;
  ASSERT_TRUE(eventually([] { return listed("rift").has_value(); }));
  {
    Driver<RiftProtocol> driver([this] { return open_hid_device("rift", clock_); }, RiftProtocol());
    bool heard = false;
    int polls_while_silent = 0;
    const int begun_ms = told().time_ms;
    ASSERT_TRUE(eventually([&] {
      if (driver.poll(headset_now(), milliseconds(20))) heard = true;
      has_been_polled();
      if (heard && told().silent) ++polls_while_silent;
      return told().time_ms - begun_ms > 16'000;
    }));
    ASSERT_TRUE(heard) << driver.reason();
    EXPECT_EQ(polls_while_silent, 0) << "told every 9.8 s to stay awake for 10 s";
    EXPECT_EQ(driver.counts().refused, 0U);

    keep_in_step(false);
    EXPECT_TRUE(eventually([this] { return told().silent; })) << "nobody keeps it awake now";
    while (driver.poll(0, milliseconds(0))) {  // what it had said before; time 0: no keep-alive is due
    }
    EXPECT_FALSE(driver.poll(0, milliseconds(100)));
    EXPECT_TRUE(driver.poll(headset_now(), milliseconds(1000))) << "the keep-alive wakes it";
  }
  device_.unplug();
  EXPECT_EQ(open_descriptors(), descriptors_at_start());
}

TEST_P(LabRift, TurnsAsFarAsTheHeadAndComesBack) {
  Driver<RiftProtocol> driver([this] { return open_hid_device("rift", clock_); }, RiftProtocol());
  auto watch = HotplugWatch::create(HotplugWatch::device_folders());
  ASSERT_TRUE(watch);
  ASSERT_FALSE(driver.poll(clock_.now()));
  EXPECT_NE(driver.reason().find("no such device is plugged in"), std::string::npos) << driver.reason();
  ASSERT_TRUE(device_.plug());
  ASSERT_TRUE(first_sample(driver, *watch, clock_)) << driver.reason();
  double error_rad = 9.0;
  EXPECT_TRUE(eventually([&] {
    const auto sample = driver.poll(clock_.now(), milliseconds(5));
    if (sample && told().still) error_rad = angle_between(sample->pose.rotation, told().world_from_head);
    return error_rad < 1.0 * kDegree;
  })) << error_rad / kDegree
      << " degrees off";
  EXPECT_GT(angle_between(told().world_from_head, glm::dquat(1.0, 0.0, 0.0, 0.0)), 55.0 * kDegree);
  unplug_and_replug(
      "rift", driver, [&] { device_.unplug(); }, [&] { ASSERT_TRUE(device_.plug()); });
}

TEST_F(LabHid, XrealGlassesAreFoundByTheirInterfaceStreamOnCommandAndComeBack) {
  constexpr int kTurningReports = 200;
  const double turn_rad = 60.0 * kDegree;
  const double seconds = 1e-3 * kTurningReports * static_cast<double>(XrealGadget::kPeriod.count());
  XrealGadget gadget({0.0, turn_rad / seconds, 0.0}, kTurningReports);
  {
    UsbipPort port(gadget);
    const auto plugged = port.plug();
    ASSERT_TRUE(plugged) << plugged.error().message;
    ASSERT_TRUE(eventually([] { return listed("xreal").has_value(); }));
    EXPECT_EQ(listed("xreal")->interface_number, XrealGadget::kInertialInterface);
    EXPECT_EQ(listed("xreal")->name, XrealGadget::kName);
    EXPECT_EQ(list_hid_devices().size(), 1U) << "the glasses' other HID interface is not a tracker";

    Driver<XrealProtocol> driver([this] { return open_hid_device("xreal", clock_); }, XrealProtocol());
    const glm::dquat turned = glm::angleAxis(turn_rad, glm::dvec3(0.0, 1.0, 0.0));
    double error_rad = 9.0;
    EXPECT_TRUE(eventually([&] {
      if (const auto sample = driver.poll(clock_.now(), milliseconds(5)))
        error_rad = angle_between(sample->pose.rotation, turned);
      return error_rad < 1.0 * kDegree;
    })) << error_rad / kDegree
        << " degrees off; " << driver.reason();
    EXPECT_EQ(driver.counts().refused, 0U);
    unplug_and_replug(
        "xreal", driver,
        [&] {
          port.unplug();
          gadget.switch_off();
        },
        [&] { ASSERT_TRUE(port.plug()); });
  }
  EXPECT_TRUE(eventually([] { return list_hid_devices().empty(); }));
  EXPECT_EQ(open_descriptors(), descriptors_at_start());
}

TEST_F(LabHid, LookingGlassTellsItsCalibration) {
  std::string text = R"({"serial":"LAB3","padding":")" + std::string(600, 'x') + "\"}";
  LookingGlassSim sim(text, {false, 1, 0, false});  // hidraw gives whole reports
  UhidDevice device(
      {kLookingGlassVendor, kLookingGlassProduct, "HoloPlay", "LAB3", kLookingGlassReports},
      [&] { return sim.device().open(); }, [] {}, milliseconds(2));
  ASSERT_TRUE(device.plug());
  ASSERT_TRUE(eventually([] { return listed("looking_glass").has_value(); }));
  auto transport = open_hid_device("looking_glass", clock_);
  ASSERT_TRUE(transport) << transport.error().message;
  const auto read = read_looking_glass_calibration(**transport, clock_, 10'000'000'000);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, text);
}

}  // namespace
}  // namespace dubsar::lab
