// The table of drivers: what reads it agrees with it, and a new device is its protocol, its simulator and one row.

#include "devices/drivers.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "core/base/files/atomic_file.h"
#include "devices/device_list.h"
#include "devices/transport/replay_transport.h"
#include "devices/transport/usb_transport.h"
#include "devices/udev_rules.h"
#include "input/simulated/simulated_recording.h"
#include "input/sources/device_source.h"
#include "tests/devices/sample_device.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

using Products = std::vector<std::uint16_t>;
const fs::path kRoot = DUBSAR_SOURCE_DIR;

TEST(Enumerate, SaysWhyADeviceCannotBeUsedAndNamesTheRule) {
  const std::vector<HidNode> nodes{{"/dev/hidraw0", 0x256f, 0xc635, 1, 8, 0, "3Dconnexion", "SpaceMouse Compact", "S1"},
                                   {"/dev/hidraw1", 0x256f, 0xc650, 1, 2, 0, "3Dconnexion", "CadMouse", ""},
                                   {"/dev/hidraw2", 0x1234, 0x5678, 1, 2, 0, "", "Keyboard", ""},
                                   {"/dev/hidraw3", 0x3318, 0x0424, 0xff00, 1, 3, "", "XREAL Air", ""},
                                   {"/dev/hidraw4", 0x3318, 0x0424, 0xff00, 1, 4, "", "XREAL Air", ""},
                                   {"/dev/hidraw5", 0x256f, 0xc652, 1, 6, 0, "", "Universal Receiver", ""},
                                   {"/dev/hidraw6", 0x04d8, 0xef7e, 0, 0, 0, "", "HoloPlay", ""},
                                   {"/dev/hidraw7", 0x04d8, 0xef7e, 0, 0, 0, "", "Somebody's thermometer", ""},
                                   {"/dev/hidraw8", 0x04d8, 0xef7e, 0, 0, 0, "", "", ""}};
  const auto found = known_hid_devices(nodes, [](const std::string& path) {
    return path == "/dev/hidraw0" ? EACCES : path == "/dev/hidraw6" ? EIO : 0;
  });
  ASSERT_EQ(found.size(), 4U) << "04d8:ef7e is a chip maker's number, and a Looking Glass only with its own name";
  EXPECT_EQ(found[0].driver, "spacemouse");
  EXPECT_EQ(found[0].state, DeviceState::kNoPermission);
  EXPECT_NE(found[0].remedy.find(R"(SUBSYSTEM=="hidraw", ATTRS{idVendor}=="256f", ATTRS{idProduct}=="c635")"),
            std::string::npos);
  EXPECT_EQ(found[1].state, DeviceState::kIgnored);
  EXPECT_EQ(found[2].path, "/dev/hidraw3");
  EXPECT_EQ(found[2].state, DeviceState::kUsable);
  EXPECT_EQ(found[2].reason, "");
  EXPECT_EQ(found[3].driver, "looking_glass");
  EXPECT_EQ(found[3].state, DeviceState::kBroken);
}

TEST(Enumerate, HeadsetsAreKnownByAllTheirNumbersAndGlassesThatCannotBeReadSayWhatTheyNeed) {
  const std::vector<HidNode> nodes{{"/dev/hidraw0", 0x2833, 0x2021, 1, 0, 0, "", "", ""},
                                   {"/dev/hidraw1", 0x3318, 0x0437, 0xff00, 1, 0, "", "", "A"},
                                   {"/dev/hidraw2", 0x3318, 0x0437, 0xff00, 1, 1, "", "", "A"},
                                   {"/dev/hidraw3", 0x04d8, 0xef7e, 0, 0, 0, "", "Programmer", ""},
                                   {"/dev/hidraw4", 0x3318, 0x0426, 0xff00, 1, 2, "", "", ""}};
  const auto found = known_hid_devices(nodes, [](const std::string&) { return 0; });
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, "Oculus Rift DK2");
  EXPECT_EQ(found[0].state, DeviceState::kUsable);
  EXPECT_EQ(found[1].name, "XREAL One");
  EXPECT_EQ(found[1].state, DeviceState::kIgnored);
  EXPECT_NE(found[1].reason.find("network"), std::string::npos);
  EXPECT_NE(found[1].remedy.find("sender=xrlinux"), std::string::npos);
  EXPECT_EQ(found[2].name, "XREAL Air 2 Ultra");
  EXPECT_EQ(found[2].state, DeviceState::kUsable);
}

TEST(Enumerate, UnknownProductsOf3DconnexionAreTakenForSpaceMiceAndItsMiceAreTheSystems) {
  const auto seen_as = [](std::uint16_t vendor, std::uint16_t product) {
    const auto found = known_hid_devices({{"/dev/hidraw0", vendor, product, 1, 8, 0, "", "", ""}},
                                         [](const std::string&) { return 0; });
    return found.empty() ? std::string("nothing") : found[0].state == DeviceState::kUsable ? "a puck" : "left alone";
  };
  for (const std::uint16_t product : Products{0xc62e, 0xc635, 0xc652, 0xc69f})
    EXPECT_EQ(seen_as(0x256f, product), "a puck");
  for (const std::uint16_t product : Products{0xc62c, 0xc641, 0xc650, 0xc668})
    EXPECT_EQ(seen_as(0x256f, product), "left alone") << std::hex << product;
  for (const std::uint16_t product : Products{0xc603, 0xc606, 0xc640}) EXPECT_EQ(seen_as(0x046d, product), "a puck");
  EXPECT_EQ(seen_as(0x046d, 0xc69f), "nothing");
}

// The table of XRLinuxDriver, src/devices/xreal.c: products, and those that it reads by HID.
TEST(Enumerate, EveryModelOfXrealIsToldByItsInterfaceOrByUsbWithWhatItNeeds) {
  const auto by_usb = [](std::uint16_t vendor, std::uint16_t product) {
    UsbDevice device;
    device.vendor_id = vendor;
    device.product_id = product;
    device.path = "usb:001/002";
    return known_usb_devices({device});
  };
  for (const std::uint16_t product : Products{0x0424, 0x0428, 0x0432, 0x0426})
    EXPECT_TRUE(by_usb(0x3318, product).empty()) << std::hex << product;
  for (const std::uint16_t product : Products{0x0435, 0x0436, 0x0437, 0x0438, 0x043d, 0x043e, 0x0440, 0x0442}) {
    const auto told = by_usb(0x3318, product);
    ASSERT_EQ(told.size(), 1U) << std::hex << product;
    EXPECT_EQ(told[0].driver, "xreal");
    EXPECT_EQ(told[0].state, DeviceState::kIgnored);
    EXPECT_NE(told[0].reason, "");
    EXPECT_EQ(told[0].path, "usb:001/002");
  }
  EXPECT_TRUE(by_usb(0x3319, 0x0437).empty());
}

TEST(DriverTable, TheUdevRulesAreThoseOfTheTable) {
  const std::string made = udev_rules();
  if (read_text_file(kRoot / "devices/70-dubsar.rules").value() == made) return;
  const fs::path candidate = fs::temp_directory_path() / "70-dubsar.rules";
  std::ofstream(candidate) << made;
  FAIL() << "look at the difference and take it over: cp " << candidate.string() << " devices/70-dubsar.rules";
}

TEST(DriverTable, EveryRowHasItsRowInTheDocuments) {
  const std::string devices = read_text_file(kRoot / "docs/devices.md").value();
  const std::string input = read_text_file(kRoot / "docs/input.md").value();
  for (const DriverEntry& driver : driver_table()) {
    EXPECT_NE(devices.find(fmt::format("\n| {}", driver.summary)), std::string::npos)
        << "docs/devices.md has no row for: " << driver.summary;
    EXPECT_NE(devices.find(fmt::format("`{}`", driver.name)), std::string::npos) << driver.name;
    if (driver.input.source.empty()) continue;
    const std::string_view member = driver.input.source.substr(driver.input.source.rfind(':') + 1);
    EXPECT_NE(input.find(member), std::string::npos) << "docs/input.md does not name " << driver.input.source;
  }
}

TEST(DriverTable, NoTwoRowsClaimOneDevice) {
  std::set<std::tuple<std::uint16_t, std::uint16_t, int>> claimed;
  std::set<std::string_view> names, sources;
  for (const DriverEntry& driver : driver_table()) {
    EXPECT_TRUE(names.insert(driver.name).second) << driver.name;
    if (!driver.input.source.empty()) {
      EXPECT_TRUE(sources.insert(driver.input.source).second) << driver.input.source;
    }
    for (const DeviceId& id : driver.ids)
      EXPECT_TRUE(claimed.insert({id.vendor, id.product, id.interface_number}).second) << driver.name << id.product;
    EXPECT_EQ(driver.bus == Bus::kUdp || driver.bus == Bus::kTcp, driver.port != 0) << driver.name;
    EXPECT_TRUE(driver.input.instead_of.empty() || find_driver(driver.input.instead_of, "test", driver_table()))
        << driver.name;
    EXPECT_FALSE(driver.input.taken_unasked && (driver.bus == Bus::kVideo || driver.bus == Bus::kUdp ||
                                                driver.bus == Bus::kTcp || driver.bus == Bus::kService))
        << driver.name << " would be taken without having been named";
  }
}

/// Names of drivers steer nothing outside of the table: who wants to know something about a device asks its row.
TEST(DriverTable, NobodyComparesNamesOfDrivers) {
  std::string names;
  for (const DriverEntry& driver : driver_table()) names += (names.empty() ? "" : "|") + std::string(driver.name);
  const std::regex comparison("driver\\s*[=!]=\\s*\"(" + names + ")\"");
  for (const char* room : {"devices", "input", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / room)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
      const std::string text = read_text_file(entry.path()).value();
      std::smatch found;
      EXPECT_FALSE(std::regex_search(text, found, comparison)) << entry.path() << ": " << found.str();
    }
}

TEST(DriverTable, OptionsThatADriverDoesNotHaveAreRefused) {
  const ManualClock clock;
  const auto refused = [&](DeviceSpec spec) {
    const auto driven = drive_device(
        spec, [] { return fail(ErrorKind::kUnavailable, "nothing"); }, clock);
    return driven ? std::string("taken") : driven.error().message;
  };
  EXPECT_EQ(refused({"opentrack", {{"port", "4243"}, {"invert", "x+yaw"}, {"remote"}}}), "taken");
  EXPECT_NE(refused({"opentrack", {{"invert", "up"}}}).find("\"up\" found"), std::string::npos);
  EXPECT_NE(
      refused({"opentrack", {{"sensor", "1"}}}).find("\"sensor\" is not an option, expected one of: address, port"),
      std::string::npos)
      << refused({"opentrack", {{"sensor", "1"}}});
  EXPECT_NE(refused({"vrpn", {{"port", "70000"}}}).find("1 to 65535"), std::string::npos);
  EXPECT_NE(refused({"melt"}).find("spacemouse, spacenav"), std::string::npos);
  EXPECT_EQ(open_device({"opentrack", {{"address", "0.0.0.0"}}}, clock).error().kind, ErrorKind::kUsage);
}

/// All that the program does with devices, done with one that it does not know.
TEST(SampleDevice, IsItsProtocolItsSimulatorAndItsRow) {
  const DriverTable table = test::wand_table();
  const DriverEntry& wand = table[0];
  // listed, with what to do when it may not be opened
  const std::vector<HidNode> nodes{{"/dev/hidraw7", test::kWandVendor, test::kWandProduct, 1, 4, 0, "", "", "7"}};
  const auto listed = known_hid_devices(
      nodes, [](const std::string&) { return 0; }, table);
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_EQ(listed[0].driver, "wand");
  EXPECT_EQ(taken_unasked(listed, table), std::vector<const DriverEntry*>{&wand});
  EXPECT_NE(udev_rules(table).find(R"(ATTRS{idVendor}=="1209", ATTRS{idProduct}=="57a0", TAG+="uaccess")"),
            std::string::npos);
  // opened: not here
  const ManualClock still;
  const auto open = open_device({"wand"}, still, table);
  ASSERT_TRUE(open) << open.error().message;
  EXPECT_EQ((*open)().error().message, "wand: no such device is plugged in");
  // simulated, recorded
  const fs::path file = fs::temp_directory_path() / ("dubsar_wand_" + std::to_string(::getpid()));
  PersonOptions person;
  person.script = somebody(5, 3.0);
  const auto events = write_simulated_recording(wand, file, person);
  ASSERT_TRUE(events) << events.error().message;
  EXPECT_GT(*events, 100);
  // watched, over the recording
  ManualClock clock;
  ReplaySession session(read_recording(file).value(), clock);
  const auto driver = drive_device(
      {"wand"}, [&] { return session.open(); }, clock, table);
  ASSERT_TRUE(driver) << driver.error().message;
  double furthest = 0.0;
  for (; !session.finished(); clock.advance(4'000'000))
    if (const auto sample = (*driver)->next(clock.now(), milliseconds(0)))
      furthest = std::max(furthest, glm::length(std::get<SpaceMouseSample>(*sample).translation));
  EXPECT_GT(furthest, 0.5);
  EXPECT_EQ((*driver)->counts().refused, 0u);
  // a source, over the same recording
  InputConfig config;
  config.clock = &clock;
  config.simulated_time = true;
  config.options = {{"replay", file.string()}};
  const auto source = make_device_source(wand, config);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->name(), "wand");
  InputFrame frame;
  int fresh = 0;
  for (int i = 0; i < 1000 && !(*source)->finished(); ++i, clock.advance(4'000'000))
    fresh += (*source)->poll(clock.now(), frame) == Freshness::kNew && frame.space_mouse ? 1 : 0;
  EXPECT_TRUE((*source)->finished());
  EXPECT_GT(fresh, 100);
  fs::remove(file);
}

}  // namespace
}  // namespace dubsar
