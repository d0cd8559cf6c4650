// One hand suffices: a hand that has grabbed and comes nearer brings the object nearer.

#include <gtest/gtest.h>

#include <cmath>

#include "input/navigation/navigation.h"

namespace dubsar {
namespace {

/// A right hand that has grabbed, 100 frames a second.
struct Puller {
  explicit Puller(std::string_view changes = "{}") : navigator(parse_mapping(changes, "test").value()) {
    hand.chirality = Chirality::kRight;
    hand.valid = hand.tracked = true;
    hand.palm.position_m = {0.1, 0, 0.3};
    move({0, 0, 0}, 40);
    hand.grab_strength = 1.0;
    move({0, 0, 0}, 5);
  }
  void move(const glm::dvec3& by, int frames) {
    for (int i = 0; i < frames; ++i) {
      now += 10'000'000;
      hand.time = now;
      hand.palm.position_m += by / static_cast<double>(frames);
      navigator.update(now, {}, {&hand, nullptr});
    }
  }
  double turned_deg() const { return turn_between_deg(navigator.view().rotation, {1, 0, 0, 0}); }
  Navigator navigator;
  HandFrame hand;
  TimestampNs now = 0;
};

TEST(Pull, OneHandThatPullsOrPushesZoomsAndDoesNotTurn) {
  for (const double way_m : {0.1, -0.1}) {
    Puller person;
    person.move({0.01, 0.0, way_m}, 100);
    person.move({0, 0, 0}, 40);
    EXPECT_NEAR(std::log(person.navigator.view().zoom), 7.0 * (way_m - std::copysign(0.025, way_m)), 0.04);
    EXPECT_LT(person.turned_deg(), 1e-9);
  }
}

TEST(Pull, WhoHasBegunToTurnGoesOnTurning) {
  Puller person;
  person.move({0.03, 0.0, 0.0}, 30);
  person.move({0.03, 0.0, 0.1}, 60);
  person.move({0, 0, 0}, 40);
  EXPECT_EQ(person.navigator.view().zoom, 1.0);
  EXPECT_GT(person.turned_deg(), 15.0);
}

TEST(Pull, AMappingCanSwitchItOff) {
  Puller person(R"({"hands": {"pull": "none"}})");
  person.move({0.0, 0.0, 0.1}, 60);
  EXPECT_EQ(person.navigator.view().zoom, 1.0);
}

}  // namespace
}  // namespace dubsar
