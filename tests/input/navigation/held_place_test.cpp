// What a mouse holds stays under it: turning, zooming and centring through the navigator, for any eye and any place.

#include "input/navigation/held_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <random>

#include "input/navigation/navigation.h"
#include "tests/input/navigation/turns.h"

namespace dubsar {
namespace {
using test::about;
using test::kRad;

/// A mouse over a window of 1000 pixels, 100 events a second.
struct MouseDesk {
  Mapping mapping = default_mapping().value();
  Navigator navigator{mapping};
  std::vector<InputEvent> events;
  TimestampNs now = 0;

  void step() {
    now += 10'000'000;
    InputFrame frame;
    frame.time = now;
    frame.events = std::exchange(events, {});
    for (InputEvent& event : frame.events) event.time = now;
    navigator.update(now, frame, {});
  }
  void steps(int n) {
    for (int i = 0; i < n; ++i) step();
  }
  void press(const glm::dvec2& at, std::optional<double> lever = {}, std::uint8_t modifiers = 0,
             std::optional<glm::dvec3> eye = {}) {
    events.push_back({0, EventKind::kButton, {}, MouseButton::kLeft, true, modifiers, {}, false, at, lever, eye});
    step();
  }
  void release() {
    events.push_back({0, EventKind::kButton, {}, MouseButton::kLeft, false, 0, {}});
    step();
  }
  void move_to(const glm::dvec2& from, const glm::dvec2& to, int n) {
    for (int i = 1; i <= n; ++i) {
      const glm::dvec2 at = glm::mix(from, to, static_cast<double>(i) / n), by = (to - from) / static_cast<double>(n);
      events.push_back({0, EventKind::kMotion, {1000 * by.x, -1000 * by.y}, {}, false, 0, {}, false, at});
      step();
    }
  }
  const ViewState& view() const { return navigator.view(); }
};

/// Where a place of the object (from its centre) is seen, in heights of the window, by an eye before its middle.
glm::dvec2 seen_at(const glm::dvec3& place, const ViewState& view, const glm::dvec3& eye) {
  const glm::dvec3 at = view.rotation * place + glm::dvec3(view.pan, 0.0);
  return glm::dvec2(eye) + (glm::dvec2(at) - glm::dvec2(eye)) * (eye.z / (eye.z - at.z));
}

TEST(HeldPlace, TheSurfaceThatIsHeldStaysUnderThePointerWhereverItIsTakenAndWhereverItGoes) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  int far_half = 0, rim = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 eye(real(-0.3, 0.3), real(-0.3, 0.3), real(2, 40));
    const double ball = std::exp(real(std::log(0.1), std::log(0.5 * eye.z)));  // zoomed out, and far in
    const glm::dvec3 place = ball * glm::normalize(glm::dvec3(real(-1, 1), real(-1, 1), real(-0.5, 1)));
    const auto at = [&](const ViewState& view) { return seen_at(place, view, eye); };
    MouseDesk desk;
    const glm::dvec2 from = at({});
    far_half += place.z < 0;
    rim += std::abs(place.z) < 0.1 * ball;
    // Inwards, where the ball has a place for it, and round about.
    const glm::dvec2 to = 0.3 * from + 0.2 * ball * glm::dvec2(real(-1, 1), real(-1, 1));
    desk.press(from, place.z, 0, eye);
    glm::dvec2 before = from;
    double worst = 0.0;
    for (int k = 1; k <= 30; ++k) {
      const glm::dvec2 next = glm::mix(from, to, k / 30.0);
      desk.move_to(before, next, 1);
      if (k > 10) worst = std::max(worst, glm::distance(at(desk.view()), next));
      before = next;
    }
    EXPECT_LT(worst, 1.5 / 1000) << "seed " << seed << ", at " << place.x << " " << place.y << " " << place.z;
    EXPECT_NEAR(glm::distance(at(desk.view()), to), 0.0, 1e-9) << "seed " << seed;
  }
  EXPECT_GT(far_half, 50);
  EXPECT_GT(rim, 20);
}

TEST(HeldPlace, AHeldTurnDoesNotRollAndGoesOnWhereThePointerLeavesTheBall) {
  MouseDesk desk;
  desk.press({0, 0}, 0.1);
  desk.move_to({0, 0}, {0.06, 0}, 20);
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, about({0, 1, 0}, std::asin(0.6) / kRad)), 0, 1e-6);
  desk.move_to({0.06, 0}, {0.2, 0}, 20);  // past its rim: by the way, 0.4 degrees a pixel
  const glm::dquat beyond = desk.view().rotation;
  desk.move_to({0.2, 0}, {0.3, 0}, 20);
  EXPECT_NEAR(turn_between_deg(desk.view().rotation, about({0, 1, 0}, 40) * beyond), 0, 1e-6);
  MouseDesk fine;  // the surface goes a quarter of the pointer's way
  fine.press({0, 0}, 0.1, kAlt);
  fine.move_to({0, 0}, {0.2, 0.04}, 20);
  const glm::dvec3 held = fine.view().rotation * glm::dvec3(0, 0, 0.1);
  EXPECT_NEAR(glm::distance(glm::dvec2(held), glm::dvec2(0.05, 0.01)), 0, 1e-9);
}

TEST(HeldPlace, WheelAndDoubleClickGoByTheSurfaceThatIsSeenAndNotByThePanel) {
  const glm::dvec3 eye(0, 0, 3), place(0.2, -0.1, 0.5);
  const glm::dvec2 at = seen_at(place, {}, eye);
  MouseDesk desk;
  desk.events.push_back({0, EventKind::kWheel, {0, 3}, {}, false, 0, {}, false, at, place.z, eye});
  desk.step();
  // The camera stands as many times farther away (as of pictures of one view).
  const double zoom = desk.view().zoom;
  EXPECT_GT(zoom, 1.3);
  EXPECT_NEAR(glm::distance(seen_at(zoom * place, desk.view(), zoom * eye), at), 0, 1e-9);
  MouseDesk twice;
  for (int i = 0; i < 2; ++i) {
    twice.press(at, place.z, 0, eye);
    twice.release();
  }
  twice.steps(200);
  EXPECT_NEAR(glm::length(seen_at(place, twice.view(), eye)), 0, 1e-9);
}

}  // namespace
}  // namespace dubsar
