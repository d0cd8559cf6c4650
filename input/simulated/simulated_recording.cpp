#include "input/simulated/simulated_recording.h"

#include "devices/transport/record_transport.h"

namespace dubsar {
namespace {

constexpr TimestampNs kTickNs = 4'000'000;

}  // namespace

Result<std::int64_t> write_simulated_recording(const DriverEntry& driver, const std::filesystem::path& path,
                                               PersonOptions options) {
  const double seconds = options.script.duration_s;
  if (seconds > driver.longest_simulation_s)
    return fail(ErrorKind::kUsage, "simulate {}: {} s found, expected at most {} s", driver.name, seconds,
                driver.longest_simulation_s);
  ManualClock clock;
  DUBSAR_ASSIGN(const SimulatedFeed feed, simulate_device(driver, std::move(options), clock));
  DUBSAR_ASSIGN(const auto writer, RecordingWriter::create(path, driver.name, "made by a simulator, no device", clock,
                                                           driver.gives == Gives::kStereoPictures));
  OptionReader none({}, "simulate");
  const auto device = driver.drive(
      [writer, below = open_simulated(feed.device, clock)]() -> Result<std::unique_ptr<Transport>> {
        DUBSAR_ASSIGN(auto transport, below());
        return make_record_transport(std::move(transport), writer);
      },
      none, nullptr);
  const auto end = static_cast<TimestampNs>(1e9 * seconds);
  for (device->next(clock.now(), milliseconds(0)); clock.now() < end && !feed.person->finished();
       device->next(clock.now(), milliseconds(0)))
    clock.advance(kTickNs);
  DUBSAR_TRY(writer->finish());
  return writer->event_count();
}

}  // namespace dubsar
