#include "input/people/other_bodies.h"

#include <gtest/gtest.h>

#include "tests/input/milliseconds.h"

namespace dubsar {
namespace {

using test::kMs;

TEST(OtherBodies, ABodyIsThereOnceHandsToldOfItForAWhileAndIsForgottenLater) {
  OtherBodies others;
  TimestampNs now = 0;
  for (; now < 250 * kMs; now += 10 * kMs) others.see(now, 0.4);
  EXPECT_FALSE(others.near(now, 0.4, 0.2)) << "it may be noise";
  for (; now < 500 * kMs; now += 10 * kMs) others.see(now, 0.4);
  EXPECT_TRUE(others.near(now, 0.55, 0.2));
  EXPECT_FALSE(others.near(now, 0.65, 0.2));
  EXPECT_FALSE(others.near(now, -0.4, 0.2));
  EXPECT_TRUE(others.near(now + 19'000 * kMs, 0.4, 0.2));
  EXPECT_FALSE(others.near(now + 21'000 * kMs, 0.4, 0.2));
}

TEST(OtherBodies, TwoOfThemAreToldApartAndFollowed) {
  OtherBodies others;
  TimestampNs now = 0;
  for (; now < 2000 * kMs; now += 10 * kMs) {
    others.see(now, 0.5 - 0.1 * (static_cast<double>(now) / (2000.0 * kMs)));  // it steps nearer
    others.see(now, -0.6);
  }
  EXPECT_TRUE(others.near(now, 0.4, 0.06));
  EXPECT_TRUE(others.near(now, -0.6, 0.02));
  EXPECT_FALSE(others.near(now, 0.0, 0.3));
}

TEST(OtherBodies, AClockThatIsSetBackForgets) {
  OtherBodies others;
  for (TimestampNs now = 5000 * kMs; now < 6000 * kMs; now += 10 * kMs) others.see(now, 0.3);
  others.see(0, 0.3);
  EXPECT_FALSE(others.near(0, 0.3, 0.1));
}

}  // namespace
}  // namespace dubsar
