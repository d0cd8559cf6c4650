#include "input/sources/option_reader.h"
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
  EXPECT_EQ(refused("head:opentrack,at=0/0", "at=0/0"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,at=0/0/0/0", "at="), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,remote=yes", "takes no value"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:opentrack,address=0.0.0.0", "other machines"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:vrpn,address=no host", "name of a host"), ErrorKind::kUsage);
  EXPECT_EQ(refused("head:rift,port=1", "\"port\" is not an option"), ErrorKind::kUsage);
  EXPECT_EQ(refused("leap:tilt=3", "at, turn"), ErrorKind::kUsage);
  EXPECT_EQ(refused("spacemouse:replay=/no/such/file", "/no/such/file"), ErrorKind::kNoInput);
  EXPECT_EQ(refused("spacemouse:replay=", "needs a value"), ErrorKind::kUsage);
}

TEST(SourceOptions, PlacesAreMillimetresAndTurnsDegrees) {
  InputConfig config;
  config.options = {{"at", "10/-20.5/30"}, {"turn", "90/90/0"}};
  OptionReader options(config, "test");
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
