#include "input/simulated/simulated_recording.h"

#include "devices/driver.h"
#include "devices/head_tracker/opentrack_protocol.h"
#include "devices/head_tracker/rift_protocol.h"
#include "devices/head_tracker/vrpn_protocol.h"
#include "devices/head_tracker/xreal_protocol.h"
#include "devices/leap/lmc1_driver.h"
#include "devices/spacemouse/spacenav_protocol.h"
#include "devices/transport/record_transport.h"

namespace dubsar {
namespace {

constexpr TimestampNs kTickNs = 4'000'000;
constexpr double kLongestLeap_s = 10.0;

template <class Poll>
void let_act(const SimulatedDevice& person, ManualClock& clock, double seconds, const Poll& poll) {
  const auto end = static_cast<TimestampNs>(1e9 * seconds);
  for (poll(); clock.now() < end && !person.finished(); poll()) clock.advance(kTickNs);
}

template <class Protocol>
void drive(const SimulatedDevice& person, ManualClock& clock, double seconds, OpenTransport open) {
  Driver<Protocol> driver(std::move(open), Protocol());
  let_act(person, clock, seconds, [&] { driver.poll(clock.now()); });
}

Result<void> drive_leap(const SimulatedDevice& person, ManualClock& clock, double seconds, OpenTransport open) {
  Lmc1Options options;
  options.own_thread = false;
  options.calibration_settle = milliseconds(0);
  const auto driver = make_lmc1_driver(std::move(open), options, clock);
  DUBSAR_TRY(driver->start());
  Frame frame;
  let_act(person, clock, seconds, [&] { driver->poll(frame); });
  return {};
}

}  // namespace

Result<std::int64_t> write_simulated_recording(std::string_view driver, const std::filesystem::path& path,
                                               WireOptions options) {
  const double seconds = options.script.duration_s;
  if (driver == "leap" && seconds > kLongestLeap_s)
    return fail(ErrorKind::kUsage, "simulate leap: {} s found, expected at most {} s (70 MB a second)", seconds,
                kLongestLeap_s);
  ManualClock clock;
  DUBSAR_ASSIGN(std::shared_ptr<SimulatedDevice> person, make_wire_person(driver, std::move(options), clock));
  DUBSAR_ASSIGN(const auto writer, RecordingWriter::create(path, driver, "made by a simulator, no device", clock));
  const OpenTransport open = [writer,
                              below = reach_wire_person(person, clock)]() -> Result<std::unique_ptr<Transport>> {
    DUBSAR_ASSIGN(auto transport, below());
    return make_record_transport(std::move(transport), writer);
  };
  if (driver == "spacemouse") drive<SpaceMouseProtocol>(*person, clock, seconds, open);
  if (driver == "spacenav") drive<SpacenavProtocol>(*person, clock, seconds, open);
  if (driver == "opentrack") drive<OpentrackProtocol>(*person, clock, seconds, open);
  if (driver == "vrpn") drive<VrpnProtocol>(*person, clock, seconds, open);
  if (driver == "rift") drive<RiftProtocol>(*person, clock, seconds, open);
  if (driver == "xreal") drive<XrealProtocol>(*person, clock, seconds, open);
  if (driver == "leap") DUBSAR_TRY(drive_leap(*person, clock, seconds, open));
  DUBSAR_TRY(writer->finish());
  return writer->event_count();
}

}  // namespace dubsar
