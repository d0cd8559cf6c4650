// A monitor, a driver that is late and glasses, all simulated: which field meets which eye.

#include "display/sinks/field_cadence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dubsar {
namespace {

struct Seen {
  int pictures = 0, wrong = 0;  ///< at their first beat
};

/// A monitor whose glasses open the left eye at even beats. A picture takes `most_cost` beats at most, is shown at the
/// first beat after it is ready, and the present call comes back up to `jitter` of a beat later.
Seen watch(double said_hz, double true_hz, double jitter, double most_cost, double seconds, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  FieldCadence cadence;
  cadence.set_refresh(said_hz);
  const double period = 1e9 / true_hz, start = 5e9 + 1e9 * unit(random);
  const auto beat_after = [&](double t) { return static_cast<std::int64_t>(std::floor((t - start) / period)) + 1; };
  double now = start;
  std::int64_t glasses_of_first = -1;
  Seen seen;
  while (now < start + 1e9 * seconds) {
    double ready = now + most_cost * unit(random) * unit(random) * period;
    ready = static_cast<double>(cadence.turn(static_cast<TimestampNs>(ready)));
    const Field field = cadence.next(static_cast<TimestampNs>(ready));
    const std::int64_t beat = beat_after(ready);
    now = start + static_cast<double>(beat) * period + jitter * period * unit(random);
    cadence.presented(static_cast<TimestampNs>(now));
    if (++seen.pictures < 300) {  // the phase is found, and the viewer turns the glasses' switch if need be
      glasses_of_first = (beat + static_cast<int>(field)) % 2;
      continue;
    }
    seen.wrong += (beat + static_cast<int>(field)) % 2 != glasses_of_first;
  }
  return seen;
}

TEST(FieldCadenceTest, PicturesThatMissBeatsDoNotSwapTheEyes) {
  const std::uint32_t seed = std::random_device{}();
  for (const double true_hz : {120.0, 119.88, 119.9, 100.0, 144.0}) {
    const double said_hz = std::round(true_hz);
    for (const double cost : {0.5, 3.0, 12.0}) {
      const Seen seen = watch(said_hz, true_hz, 0.24, cost, 600.0, seed);
      EXPECT_GT(seen.pictures, 5000);
      EXPECT_EQ(seen.wrong, 0) << true_hz << " Hz, pictures of up to " << cost << " beats, seed " << seed;
    }
  }
}

TEST(FieldCadenceTest, CountingPicturesInsteadOfBeatsWouldSwapThem) {
  // The same glasses, and fields that alternate picture by picture: about half of them meet the wrong eye.
  std::mt19937 random(7);
  std::int64_t beat = 0;
  int wrong = 0;
  for (int picture = 0; picture < 10000; ++picture) {
    beat += 1 + (random() % 10 == 0);
    wrong += (picture - beat) % 2 != 0;
  }
  EXPECT_GT(wrong, 3000);
}

TEST(FieldCadenceTest, FieldsAlternateFromTheStartAndUnknownRatesCountAs60) {
  FieldCadence cadence;
  cadence.set_refresh(0.0);
  EXPECT_NEAR(cadence.period_ns(), 1e9 / 60, 1.0);
  TimestampNs now = 1'000'000'000;
  Field last = cadence.next(now);
  for (int i = 0; i < 100; ++i) {
    cadence.presented(now);
    const Field next = cadence.next(now + 1'000'000);
    EXPECT_NE(next, last) << i;
    last = next;
    now += 16'666'667;
  }
}

}  // namespace
}  // namespace dubsar
