#include "core/base/text/option_reader.h"
#include "devices/drivers.h"
#include "input/source_spec.h"
#include "tests/input/sources/source_bench.h"

namespace dubsar::test {
namespace {

ErrorKind refused(std::string_view spec, std::string_view word) {
  const auto source = make_input(spec);
  EXPECT_FALSE(source) << spec;
  if (source) return ErrorKind::kInternal;
  EXPECT_NE(source.error().message.find(word), std::string::npos) << source.error().message;
  return source.error().kind;
}

TEST(SourceOptions, WhatIsWrongIsSaidByNameBeforeAnythingIsOpened) {
  EXPECT_EQ(refused("head", "opentrack, vrpn, rift, xreal"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:kinect", "kinect"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,ipd=630", "40 to 90"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,port=1.5", "whole number"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,invert=up", "\"up\""), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,at=0/0", "at is \"0/0\""), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,at=0/0/0/0", "at is"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,remote=yes", "takes no value"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,address=0.0.0.0", "other machines"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:vrpn,address=no host", "name of a host"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:rift,port=1", "\"port\" is not an option"), ErrorKind::kUsage);
  EXPECT_EQ(refused("leap:tilt=3", "at, turn"), ErrorKind::kUsage);
  EXPECT_EQ(refused("spacemouse:replay=/no/such/file", "/no/such/file"), ErrorKind::kNoInput);
  EXPECT_EQ(refused("spacemouse:replay=", "needs a value"), ErrorKind::kUsage);
}

TEST(SourceOptions, EveryDocumentedOptionIsTakenWithColonsAndCommas) {
  const std::vector<std::string_view> names = input_source_names();
  const std::string many =
      "head:opentrack,address=::1,port=4243,remote,invert=x+yaw,sender=xrlinux,at=0/0/600,turn=0/5/0,eyes=0/0/"
      "80,ipd=64,"
      "head:vrpn,address=127.0.0.2,port=3884,tracker=\"a,b:c\",sensor=2,"
      "head:rift,ipd=60,at=0/10/600,turn=0/0/0,eyes=0/1/2,"
      "head:xreal,"
      "spacemouse,"
      "spacenav:socket=/tmp/a:b,"
      "leap:at=0/-200/150,turn=0/0/0,exposure_us=150,"
      "mouse,keyboard";
  const auto specs = parse_sources(many, names);
  ASSERT_TRUE(specs) << specs.error().message;
  ASSERT_EQ(specs->size(), 9u);
  EXPECT_EQ((*specs)[0].options[1], (Option{"address", "::1"}));
  EXPECT_EQ((*specs)[1].options[3], (Option{"tracker", "a,b:c"}));
  InputConfig config;
  config.simulated_time = true;
  SimDevice nothing("nothing");
  config.reach_device = [&](const DeviceSpec&, const Clock&) -> Result<OpenTransport> {
    return OpenTransport([&] { return nothing.open(); });
  };
  for (const SourceSpec& spec : *specs) {
    EXPECT_EQ(parse_source(spec.text()).value(), spec) << spec.text();
    if (spec.name == "mouse" || spec.name == "keyboard") continue;  // need a window
    const auto source = make_input(spec.text(), config);
    EXPECT_TRUE(source) << spec.text() << ": " << source.error().message;
  }
  const auto webcam = parse_sources(
      "webcam:hfov=60,device=/dev/v4l/by-path/pci-0000:00:14.0-usb-0:3:1.0-video-index0,hands,scripted:a.json,replay:b",
      names);
  ASSERT_EQ(webcam->size(), 3u);
  EXPECT_EQ((*webcam)[0].options.size(), 3u);
  EXPECT_EQ((*webcam)[1].text(), "scripted:a.json");
  const SourceSpec odd{"scripted", {{"path", "a,b=\"c\":d.json"}}};
  EXPECT_EQ(parse_sources(odd.text() + ",mouse", names)->front(), odd);
  EXPECT_EQ(parse_sources("", names).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(parse_sources("mouse,,keyboard", names).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(parse_sources("head:opentrack,address=\"::1", names).error().kind, ErrorKind::kUsage);
}

TEST(InputSources, ExactlyTheseAreTakenUnasked) {
  const auto here = [](std::string_view driver, DeviceState state = DeviceState::kUsable) {
    DeviceInfo info;
    info.driver = driver;
    info.state = state;
    return info;
  };
  using Inputs = std::vector<std::string>;
  EXPECT_EQ(present_inputs(std::vector<DeviceInfo>{}), Inputs{});
  std::vector<DeviceInfo> all;
  for (const DriverEntry& driver : driver_table()) all.push_back(here(driver.name));
  EXPECT_EQ(present_inputs(all), (Inputs{"spacenav", "head:rift", "head:xreal", "leap"}));
  EXPECT_EQ(present_inputs({here("spacemouse"), here("webcam"), here("leapc"), here("opentrack"), here("vrpn"),
                            here("looking_glass")}),
            (Inputs{"spacemouse"}));
  EXPECT_EQ(present_inputs({here("spacemouse", DeviceState::kIgnored), here("leap", DeviceState::kNoPermission),
                            here("rift", DeviceState::kBusy), here("xreal", DeviceState::kBroken)}),
            Inputs{});
  // two of a kind are one source
  EXPECT_EQ(present_inputs({here("xreal"), here("xreal")}), (Inputs{"head:xreal"}));
}

TEST(SourceOptions, PlacesAreMillimetresAndTurnsDegrees) {
  OptionReader options({{"at", "10/-20.5/30"}, {"turn", "90/90/0"}}, "test");
  const Pose place = options.placement({});
  ASSERT_TRUE(options.finish());
  EXPECT_LE(glm::distance(place.position_m, glm::dvec3(0.010, -0.0205, 0.030)), 1e-12);
  // the device's y: about x to its z, then about y to the screen's x
  EXPECT_LE(glm::distance(place.rotation * glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0)), 1e-12);
}

TEST(Sources, AMissingDeviceIsAStateAndItsReasonIsTold) {
  InputConfig config;
  config.simulated_time = true;
  const auto source = make_input("spacenav:socket=/no/such/socket", config);
  ASSERT_TRUE(source) << source.error().message;
  InputFrame frame;
  EXPECT_EQ((*source)->poll(1, frame), Freshness::kLost);
  EXPECT_NE((*source)->note().find("/no/such/socket"), std::string::npos) << (*source)->note();
}

}  // namespace
}  // namespace dubsar::test
