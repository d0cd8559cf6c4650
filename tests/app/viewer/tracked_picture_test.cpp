// From the datagram of a head tracker to the pixel on the panel.

#include <gtest/gtest.h>

#include <cmath>

#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/transport/sim_transport.h"
#include "display/optics/off_axis.h"
#include "input/input_source.h"

namespace dubsar {
namespace {

/// Where the straight line from eye to point meets the panel, in pixels from its left and lower edge.
glm::dvec2 seen_through_the_panel(const glm::dvec3& eye_mm, const glm::dvec3& point_mm, const Screen& screen) {
  const double share = eye_mm.z / (eye_mm.z - point_mm.z);
  const glm::dvec3 hit_mm = eye_mm + share * (point_mm - eye_mm);
  return {(hit_mm.x / screen.width_mm + 0.5) * screen.width_px, (hit_mm.y / screen.height_mm + 0.5) * screen.height_px};
}

TEST(TrackedPicture, AHead120MillimetresToTheRightAsOpentrackSendsItSeesThePictureFromThere) {
  ManualClock clock(1'000'000'000);
  SimDevice tracker("simulated opentrack");
  InputConfig config;
  config.clock = &clock;
  config.simulated_time = true;
  config.reach_device = [&](const DeviceSpec&, const Clock&) -> Result<OpenTransport> {
    return OpenTransport([&] { return tracker.open(); });
  };
  const auto source = make_input("head:opentrack,ipd=63", config);
  ASSERT_TRUE(source) << source.error().message;
  InputFrame frame;
  (*source)->poll(clock.now(), frame);
  tracker.send(format_opentrack({-12, 0, 0, 0, 0, 0}));
  ASSERT_EQ((*source)->poll(clock.now(), frame), Freshness::kNew);
  ASSERT_EQ(frame.heads.size(), 1U);

  const Screen screen;
  Observer viewer;
  viewer.left_mm = 1e3 * *frame.heads[0].left_eye_m;
  viewer.right_mm = 1e3 * *frame.heads[0].right_eye_m;
  const CameraPair cameras = camera_pair(viewer);
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 eye_mm(120.0 + 31.5 * side, 0.0, 600.0);  // where that person's eye is
    const View view = viewer_view(screen.window_rect(), viewer, side < 0 ? cameras.left_mm : cameras.right_mm);
    for (const glm::dvec3 point_mm : {glm::dvec3(0, 0, -100), glm::dvec3(40, -30, 50), glm::dvec3(-60, 20, 0)}) {
      const glm::dvec4 clip = view.clip_from_world() * glm::dvec4(point_mm, 1.0);
      const glm::dvec2 pixel((0.5 + 0.5 * clip.x / clip.w) * screen.width_px,
                             (0.5 + 0.5 * clip.y / clip.w) * screen.height_px);
      const glm::dvec2 expected = seen_through_the_panel(eye_mm, point_mm, screen);
      EXPECT_LE(std::hypot(pixel.x - expected.x, pixel.y - expected.y), 0.2)
          << side << " " << point_mm.z << ": " << pixel.x << " for " << expected.x;
    }
  }
}

}  // namespace
}  // namespace dubsar
