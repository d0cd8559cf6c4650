#include "devices/simulated_recording.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "devices/driver.h"
#include "devices/head_tracker/imu_sim.h"
#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/record_transport.h"
#include "devices/spacemouse/spacemouse_sim.h"

namespace dubsar {
namespace {

constexpr TimestampNs kTickNs = 16'000'000;  // about the 62 Hz of a SpaceMouse

/// Slow swings with seeded phases and periods of 2 to 6 s.
class Swing {
 public:
  explicit Swing(std::mt19937_64& random)
      : phase_(uniform(random) * 2.0 * std::numbers::pi), rate_(2.0 * std::numbers::pi / (2.0 + 4.0 * uniform(random))) {}
  double at(double t_s) const { return std::sin(phase_ + rate_ * t_s) - std::sin(phase_); }
  double rate_at(double t_s) const { return rate_ * std::cos(phase_ + rate_ * t_s); }

 private:
  static double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }
  double phase_, rate_;
};

struct Person {
  explicit Person(std::uint64_t seed) : random(seed), swings{Swing(random), Swing(random), Swing(random), Swing(random)} {}
  std::mt19937_64 random;
  std::array<Swing, 4> swings;
};

/// Lets `step` move the simulated device every tick while a driver reads it through the recorder.
template <class Protocol, class Step>
Result<std::int64_t> record(std::string_view name, const std::filesystem::path& path, double seconds, SimDevice& device,
                            Protocol protocol, const Step& step) {
  ManualClock clock;
  DUBSAR_ASSIGN(const auto writer, RecordingWriter::create(path, name, "made by a simulator, no device", clock));
  Driver<Protocol> driver(
      [&]() -> Result<std::unique_ptr<Transport>> {
        DUBSAR_ASSIGN(auto transport, device.open());
        return make_record_transport(std::move(transport), writer);
      },
      std::move(protocol));
  driver.poll(clock.now());
  const auto ticks = static_cast<std::int64_t>(seconds * 1e9) / kTickNs;
  for (std::int64_t tick = 1; tick <= ticks; ++tick) {
    clock.advance(kTickNs);
    step(1e-9 * static_cast<double>(clock.now()));
    driver.poll(clock.now());
  }
  DUBSAR_TRY(writer->finish());
  return writer->event_count();
}

}  // namespace

Result<std::int64_t> write_simulated_recording(std::string_view driver, const std::filesystem::path& path,
                                               double seconds, std::uint64_t seed) {
  if (!(seconds > 0.0 && seconds <= 3600.0))
    return fail(ErrorKind::kUsage, "simulate: {} seconds found, expected more than 0 and at most 3600", seconds);
  const Person person(seed);
  const auto& swings = person.swings;
  const auto head_turn_rad_s = [&](double t) {
    return glm::dvec3(0.1 * swings[0].rate_at(t), 0.3 * swings[1].rate_at(t), 0.05 * swings[2].rate_at(t));
  };
  if (driver == "spacemouse") {
    SpaceMouseSim sim;
    return record(driver, path, seconds, sim.device(), SpaceMouseProtocol(), [&](double t) {
      const auto raw = [](double share) { return static_cast<int>(std::lround(share * kSpaceMouseFullScale)); };
      sim.move({raw(0.3 * swings[0].at(t)), 0, 0}, {0, 0, raw(0.45 * swings[1].at(t))});
    });
  }
  if (driver == "opentrack") {
    SimDevice device("simulated opentrack");
    return record(driver, path, seconds, device, OpentrackProtocol(), [&](double t) {
      device.send(format_opentrack({6.0 * swings[0].at(t), 2.0 * swings[1].at(t), 60.0 + 5.0 * swings[2].at(t),
                                    15.0 * swings[3].at(t), 3.0 * swings[1].at(t), 0.0}));
    });
  }
  if (driver == "rift") {
    RiftSim sim(RiftModel::kDk1);
    return record(driver, path, seconds, sim.device(), RiftProtocol(),
                  [&](double t) { for (int i = 0; i < 8; ++i) sim.step(head_turn_rad_s(t), 2); });
  }
  if (driver == "xreal") {
    XrealSim sim;
    return record(driver, path, seconds, sim.device(), XrealProtocol(),
                  [&](double t) { for (int i = 0; i < 16; ++i) sim.step(head_turn_rad_s(t), 1e-3); });
  }
  return fail(ErrorKind::kUsage, "simulate: \"{}\" found, expected spacemouse, opentrack, rift or xreal", driver);
}

}  // namespace dubsar
