// dubsar devices: what is plugged in, whether it works, and recordings of it.

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <thread>

#include "app/cli/verb.h"
#include "app/live_device.h"
#include "devices/enumerate.h"
#include "devices/looking_glass/calibration_pages.h"
#include "devices/real/real_devices.h"
#include "devices/record_transport.h"
#include "devices/replay_transport.h"
#include "devices/simulated_recording.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

struct Options {
  DeviceChoice device;
  std::string file;
  double seconds = 10.0;
  double speed = 1.0;
  std::uint64_t seed = 1;
  CLI::App *list = nullptr, *probe = nullptr, *monitor = nullptr, *record = nullptr, *replay = nullptr,
           *simulate = nullptr;
};

Result<VerbResult> list(const Options& options) {
  const std::vector<DeviceInfo> devices = list_real_devices(options.device.socket);
  VerbResult result;
  result.json["devices"] = json::array();
  for (const DeviceInfo& d : devices) {
    const std::string_view state = device_state_name(d.state);
    result.json["devices"].push_back({{"driver", d.driver},
                                      {"path", d.path},
                                      {"name", d.name},
                                      {"serial", d.serial},
                                      {"vendor_id", d.vendor_id},
                                      {"product_id", d.product_id},
                                      {"state", state},
                                      {"reason", d.reason},
                                      {"remedy", d.remedy}});
    result.text += fmt::format("{:<14} {:<14} {:04x}:{:04x} {:<18} {}\n", d.driver, state, d.vendor_id, d.product_id,
                               d.path, d.name);
    if (!d.reason.empty()) result.text += fmt::format("               {}; {}\n", d.reason, d.remedy);
  }
  if (devices.empty())
    result.text = "no SpaceMouse, headset or Looking Glass found; opentrack and vrpn trackers are reached by name\n";
  return result;
}

/// Reads a device until `over()`; `each` gets every sample.
template <class Over, class Each>
Result<VerbResult> watch(LiveDevice& device, const Clock& clock, Progress& progress, const Over& over,
                         const Each& each) {
  std::int64_t samples = 0;
  while (!progress.cancelled() && !over()) {
    const auto sample = device.poll(clock.now(), milliseconds(20));
    if (sample) {
      ++samples;
      each(*sample);
    } else if (!device.connected()) {
      std::this_thread::sleep_for(milliseconds(20));
    }
  }
  VerbResult result;
  const DriverCounts& counts = device.counts();
  result.json = {{"samples", samples},          {"reports", counts.accepted}, {"refused", counts.refused},
                 {"losses", counts.losses},     {"connected", device.connected()},
                 {"reason", device.reason()}};
  result.text = fmt::format("{} samples from {} reports, {} refused, lost {} times\n", samples, counts.accepted,
                            counts.refused, counts.losses);
  if (counts.accepted == 0) {
    result.failed = true;
    result.failure = ErrorKind::kUnavailable;
    result.text += device.connected() ? "the device is open and silent\n" : device.reason() + "\n";
  }
  return result;
}

void print_sample(const json& sample) {
  fmt::print("{}\n", sample.dump());
  std::fflush(stdout);
}

Result<VerbResult> probe_looking_glass(const Clock& clock) {
  DUBSAR_ASSIGN(const auto transport, open_hid_device("looking_glass", clock));
  DUBSAR_ASSIGN(const std::string text, read_looking_glass_calibration(*transport, clock));
  VerbResult result;
  result.json = {{"calibration", text}};
  result.text = text + "\n";
  return result;
}

Result<VerbResult> run_live(const Options& options, bool print, Progress& progress) {
  const SteadyClock clock;
  DUBSAR_ASSIGN(OpenTransport open, reach_real_device(options.device, clock));
  std::shared_ptr<RecordingWriter> writer;
  if (options.record->parsed()) {
    DUBSAR_TRY(check_output_path(options.file));
    DUBSAR_ASSIGN(writer, RecordingWriter::create(options.file, options.device.driver, "", clock));
    open = [open = std::move(open), writer]() -> Result<std::unique_ptr<Transport>> {
      DUBSAR_ASSIGN(auto transport, open());
      return make_record_transport(std::move(transport), writer);
    };
  }
  DUBSAR_ASSIGN(const auto device, make_live_device(options.device, std::move(open)));
  const TimestampNs end = clock.now() + static_cast<TimestampNs>(options.seconds * 1e9);
  const auto over = [&] { return clock.now() >= end; };
  const auto each = [&](const json& sample) {
    if (print) print_sample(sample);
  };
  DUBSAR_ASSIGN(VerbResult result, watch(*device, clock, progress, over, each));
  if (writer) {
    DUBSAR_TRY(writer->finish());
    result.json["events"] = writer->event_count();
    result.text += fmt::format("{} events in {}\n", writer->event_count(), options.file);
  }
  return result;
}

Result<VerbResult> run_replay(const Options& options, bool print, Progress& progress) {
  const SteadyClock clock;
  DUBSAR_ASSIGN(Recording recording, read_recording(options.file));
  DeviceChoice choice = options.device;
  choice.driver = recording.driver;
  ReplaySession session(std::move(recording), clock, options.speed);
  DUBSAR_ASSIGN(const auto device, make_live_device(choice, [&] { return session.open(); }));
  const auto over = [&] { return session.finished(); };
  return watch(*device, session.recorded_clock(), progress, over, [&](const json& sample) {
    if (print) print_sample(sample);
  });
}

Result<VerbResult> run(const Options& options, const CommonOptions& common, Progress& progress) {
  const bool print = common.json_path != "-" && !common.console.quiet;
  if (options.list->parsed()) return list(options);
  if (options.probe->parsed() && options.device.driver == "looking_glass") return probe_looking_glass(SteadyClock());
  if (options.replay->parsed()) return run_replay(options, print, progress);
  if (options.simulate->parsed()) {
    DUBSAR_TRY(check_output_path(options.file));
    DUBSAR_ASSIGN(const std::int64_t events,
                  write_simulated_recording(options.device.driver, options.file, options.seconds, options.seed));
    VerbResult result;
    result.json = {{"events", events}, {"file", options.file}};
    result.text = fmt::format("{} events in {}\n", events, options.file);
    return result;
  }
  Options chosen = options;
  if (options.probe->parsed()) chosen.seconds = 2.0;
  return run_live(chosen, print && options.monitor->parsed(), progress);
}

void add_device_options(CLI::App& command, Options& options) {
  command.add_option("driver", options.device.driver, "spacemouse, spacenav, opentrack, vrpn, rift, xreal")->required();
  command.add_option("--address", options.device.address, "opentrack: to listen on; vrpn: of the server");
  command.add_option("--port", options.device.port, "opentrack: 4242, vrpn: 3883 unless given")->check(CLI::Range(0, 65535));
  command.add_flag("--allow-remote", options.device.allow_remote, "opentrack: listen to other machines too");
  command.add_option("--tracker", options.device.tracker, "vrpn: name of the tracker (the first)");
  command.add_option("--socket", options.device.socket, "spacenav: path of the daemon's socket");
}

}  // namespace

Verb add_devices_verb(CLI::App& program) {
  CLI::App* const command = program.add_subcommand("devices", "input devices: list, check, watch, record, replay");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n  dubsar devices list\n  dubsar devices monitor opentrack --seconds 30\n"
      "  dubsar devices simulate spacemouse turn.txt\n  dubsar devices replay turn.txt");
  auto options = std::make_shared<Options>();
  const auto add = [&](const char* name, const char* what) {
    CLI::App* const sub = command->add_subcommand(name, what);
    sub->fallthrough();
    return sub;
  };
  const auto seconds = [&](CLI::App* sub) {
    sub->add_option("--seconds", options->seconds, "how long")->check(CLI::Range(0.1, 86400.0))->type_name("S");
  };
  options->list = add("list", "devices that are here, and why one cannot be used");
  options->list->add_option("--socket", options->device.socket, "path of spacenavd's socket");
  options->probe = add("probe", "open a device and see whether it answers (also looking_glass: its calibration)");
  options->monitor = add("monitor", "print what a device says, one JSON line per sample");
  options->record = add("record", "write what a device says to a file");
  for (CLI::App* const sub : {options->probe, options->monitor, options->record}) add_device_options(*sub, *options);
  options->replay = add("replay", "play a recording through its driver");
  options->replay->add_option("--speed", options->speed, "2: twice as fast")->check(CLI::Range(0.01, 1000.0));
  options->simulate = add("simulate", "write a recording of a scripted person: spacemouse, opentrack, rift or xreal");
  options->simulate->add_option("driver", options->device.driver, "whose bytes")->required();
  options->simulate->add_option("--seed", options->seed, "another person");
  for (CLI::App* const sub : {options->record, options->replay, options->simulate})
    sub->add_option("file", options->file, "the recording")->required()->type_name("FILE");
  for (CLI::App* const sub : {options->monitor, options->record, options->simulate}) seconds(sub);
  return {command, [options](const CommonOptions& common, Progress& progress) { return run(*options, common, progress); }};
}

}  // namespace dubsar::app
