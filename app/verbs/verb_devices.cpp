// dubsar devices: what is plugged in, whether it works, and recordings of it.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <thread>

#include "app/cli/verb.h"
#include "app/monitor/camera_pictures.h"
#include "app/monitor/device_monitor.h"
#include "app/monitor/monitor_text.h"
#include "core/base/numbers/quantile.h"
#include "core/base/text/json_text.h"
#include "devices/device_list.h"
#include "devices/looking_glass/calibration_pages.h"
#include "devices/transport/record_transport.h"
#include "devices/transport/replay_transport.h"
#include "input/simulated/simulated_recording.h"
#include "input/simulated/simulated_server.h"
#include "input/source_options.h"

namespace dubsar::app {
namespace {
using nlohmann::json;

constexpr std::size_t kMostAges = 1'000'000;

/// Which device, and what is said to its driver.
struct DeviceChoice {
  std::string driver;
  std::string address, port, tracker, sensor, invert, sender, socket, library;
  bool remote = false;

  DeviceSpec spec() const {
    DeviceSpec spec{driver};
    const auto add = [&](const char* key, const std::string& value) {
      if (!value.empty()) spec.options.push_back({key, value});
    };
    add("address", address);
    add("port", port);
    add("tracker", tracker);
    add("sensor", sensor);
    add("invert", invert);
    add("sender", sender);
    add("socket", socket);
    add("library", library);
    if (remote) spec.options.push_back({"remote"});
    return spec;
  }
};

struct Actions {
  std::optional<Arguments> list, probe, monitor, record, replay, simulate;
};

struct DevicesRequest {
  DeviceChoice device;
  std::string file, script, udp;
  bool live = false;
  std::optional<double> duration;
  double seconds = 10.0;
  std::optional<double> speed;
  std::optional<std::uint64_t> seed;
  Actions actions;
};

Result<VerbResult> list(const DevicesRequest& options) {
  const std::vector<DeviceInfo> devices = list_devices(options.device.socket);
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
    result.text =
        "no SpaceMouse, headset, Leap, touch panel or Looking Glass found; opentrack and vrpn trackers are reached by "
        "name\n";
  return result;
}

/// Reads a device until `over()`; `each` gets every sample.
template <class Over, class Each>
Result<VerbResult> watch(DeviceMonitor& device, const Clock& clock, Progress& progress, const Over& over,
                         const Each& each) {
  std::int64_t samples = 0;
  std::vector<double> ages_ms;
  while (!progress.cancelled() && !over()) {
    auto sample = device.poll(clock.now(), milliseconds(20));
    if (sample) {
      ++samples;
      const double age_ms = 1e-6 * static_cast<double>(clock.now() - device.newest());
      if (ages_ms.size() < kMostAges) ages_ms.push_back(age_ms);
      (*sample)["age_ms"] = age_ms;
      each(*sample);
    } else if (!device.connected()) {
      std::this_thread::sleep_for(milliseconds(20));
    }
  }
  VerbResult result;
  const DriverCounts& counts = device.counts();
  result.json = {{"samples", samples},      {"reports", counts.accepted},      {"refused", counts.refused},
                 {"losses", counts.losses}, {"connected", device.connected()}, {"reason", device.reason()}};
  result.text = fmt::format("{} samples from {} reports, {} refused, lost {} times\n", samples, counts.accepted,
                            counts.refused, counts.losses);
  if (!ages_ms.empty()) {
    const double median = quantile(ages_ms, 0.5), worst = quantile(ages_ms, 1.0);
    result.json["age_ms"] = {{"median", median}, {"worst", worst}};
    result.text += fmt::format("age when read: median {:.2f} ms, worst {:.2f} ms\n", median, worst);
  }
  const std::string note = device.note();
  result.json["note"] = note;
  if (!note.empty()) result.text += note + "\n";
  if (samples == 0 && (counts.accepted == 0 || !note.empty())) {
    result.failure = Error{ErrorKind::kUnavailable, !device.connected() ? device.reason()
                                                    : note.empty()      ? "the device is open and silent"
                                                                        : note};
  }
  return result;
}

/// Shows samples on standard output: drawn over and over in a terminal, else one line each.
class SamplePrinter {
 public:
  explicit SamplePrinter(const Clock& clock) : clock_(clock), terminal_(::isatty(STDOUT_FILENO) == 1) {}
  void operator()(const json& sample) {
    const TimestampNs now = clock_.now();
    if (!terminal_) {
      fmt::print("{}\n", dump_json(sample));
    } else if (now - drawn_ >= kDrawNs) {
      drawn_ = now;
      const std::string view = monitor_text(sample);
      fmt::print("{}{}", lines_ > 0 ? fmt::format("\x1b[{}A\x1b[J", lines_) : "", view);
      lines_ = std::count(view.begin(), view.end(), '\n');
    }
    std::fflush(stdout);
  }

 private:
  static constexpr TimestampNs kDrawNs = 50'000'000;
  const Clock& clock_;
  const bool terminal_;
  TimestampNs drawn_ = -kDrawNs;
  std::ptrdiff_t lines_ = 0;
};

bool is_calibration(std::string_view name) {
  const auto driver = find_driver(name, "devices", driver_table());
  return driver && (*driver)->gives == Gives::kNothing;
}

Result<VerbResult> probe_looking_glass(const Clock& clock) {
  DUBSAR_ASSIGN(const auto transport, open_hid_device("looking_glass", clock));
  DUBSAR_ASSIGN(const std::string text, read_looking_glass_calibration(*transport, clock));
  VerbResult result;
  result.json = {{"calibration", text}};
  result.text = text + "\n";
  return result;
}

Result<VerbResult> run_live(const DevicesRequest& options, bool print, Progress& progress) {
  const SteadyClock clock;
  const DeviceSpec spec = options.device.spec();
  const bool records = options.actions.record->chosen();
  if (is_plugin(spec.driver) && records)
    return fail(ErrorKind::kUsage,
                "devices: a plug-in sends no bytes of a device: record what it tells with dubsar view --input {} "
                "--record FILE",
                spec.driver);
  OpenTransport open;
  bool pictures = false;
  if (!is_plugin(spec.driver)) {
    DUBSAR_ASSIGN(const DriverEntry* driver, find_driver(spec.driver, "devices", driver_table()));
    pictures = driver->gives == Gives::kStereoPictures;
    if (driver->bus == Bus::kService && records)
      return fail(ErrorKind::kUsage,
                  "devices: {} is a service and sends no bytes of a device: record its hands with dubsar "
                  "view --input {} --record FILE",
                  spec.driver, driver->input.source);
    if (driver->bus != Bus::kService) {
      DUBSAR_ASSIGN(open, open_device(spec, clock));
    }
  }
  std::shared_ptr<RecordingWriter> writer;
  if (records) {
    DUBSAR_ASSIGN(writer, RecordingWriter::create(options.file, spec.driver, "", clock, pictures));
    open = [open = std::move(open), writer]() -> Result<std::unique_ptr<Transport>> {
      DUBSAR_ASSIGN(auto transport, open());
      return make_record_transport(std::move(transport), writer);
    };
  }
  DUBSAR_ASSIGN(const auto device, monitor_device(spec, std::move(open), clock, true));
  const TimestampNs end = clock.now() + static_cast<TimestampNs>(options.seconds * 1e9);
  const auto over = [&] { return clock.now() >= end || (writer && !writer->status()); };  // a full disk is told at once
  SamplePrinter printer(clock);
  const auto each = [&](const json& sample) {
    if (print) printer(sample);
  };
  DUBSAR_ASSIGN(VerbResult result, watch(*device, clock, progress, over, each));
  if (writer && writer->status() && writer->heard_count() == 0) {
    writer->discard();
    result.text += fmt::format("nothing was heard, {} is left as it was\n", options.file);
  } else if (writer) {
    DUBSAR_TRY(writer->finish());
    result.json["events"] = writer->event_count();
    result.text += fmt::format("{} events in {}\n", writer->event_count(), options.file);
  }
  return result;
}

constexpr TimestampNs kReopenNs = 100'000'000;  ///< of recorded time, for each look at a device that is not open

Result<VerbResult> run_replay(const DevicesRequest& options, bool print, Progress& progress) {
  const SteadyClock clock;
  DUBSAR_ASSIGN(Recording recording, read_recording(options.file));
  const DeviceSpec spec{recording.driver};
  const std::int64_t pictures = pictures_in(recording);
  // Hands may be found more slowly than pictures came: every one is looked at, unless it is to be in time.
  ReplaySession session(std::move(recording), clock, options.speed.value_or(pictures > 0 ? 0.0 : 1.0));
  DUBSAR_ASSIGN(const auto device, monitor_device(
                                       spec, [&] { return session.open(); }, session.recorded_clock(), false));
  const auto over = [&] {
    if (!device->connected()) session.pass(kReopenNs);
    return session.finished();
  };
  SamplePrinter printer(clock);
  DUBSAR_ASSIGN(VerbResult result, watch(*device, session.recorded_clock(), progress, over, [&](const json& sample) {
                  if (print) printer(sample);
                }));
  const std::int64_t left_out = pictures > 0 ? pictures - result.json["samples"].get<std::int64_t>() : 0;
  if (pictures > 0) result.json["pictures"] = pictures;
  if (left_out > 0)
    result.text += fmt::format(
        "{} of {} pictures were not looked at: hands are found more slowly than they came; "
        "without --speed every one is\n",
        left_out, pictures);
  if (const auto dry = session.ran_dry(); !dry && !result.failure)
    result.failure = Error{ErrorKind::kBadData, fmt::format("{}: {}", options.file, dry.error().message)};
  return result;
}

/// A script, or somebody; where the device stands is where its source expects it.
Result<PersonOptions> person_options(const DevicesRequest& options, const DriverEntry& driver) {
  PersonOptions person;
  if (options.script.empty()) {
    person.script = somebody(options.seed.value_or(1), options.duration.value_or(10.0));
  } else {
    DUBSAR_ASSIGN(const std::string text, read_source_text(options.script));
    DUBSAR_ASSIGN(person.script, parse_script(text, options.script));
    if (options.seed) person.script.seed = *options.seed;
    if (options.duration) person.script.duration_s = *options.duration;
  }
  person.screen_from_device = driver.usual_place;
  return person;
}

Result<VerbResult> run_simulate(const DevicesRequest& options, bool print, Progress& progress) {
  DeviceSpec spec = options.device.spec();
  DUBSAR_ASSIGN(const DriverEntry* driver, find_driver(spec.driver, "devices simulate", driver_table()));
  DUBSAR_ASSIGN(PersonOptions person, person_options(options, *driver));
  VerbResult result;
  const bool live = options.live || !options.udp.empty();
  if (live != options.file.empty())
    return fail(ErrorKind::kUsage, "devices simulate: expected either a file to write, or --live or --udp HOST:PORT");
  if (!live) {
    DUBSAR_ASSIGN(const std::int64_t events, write_simulated_recording(*driver, options.file, std::move(person)));
    result.json = {{"events", events}, {"file", options.file}};
    result.text = fmt::format("{} events in {}\n", events, options.file);
    return result;
  }
  if (!options.udp.empty()) {
    const std::size_t colon = options.udp.rfind(':');
    if (colon == std::string::npos || driver->bus != Bus::kUdp)
      return fail(ErrorKind::kUsage, "devices simulate: --udp \"{}\" found, expected HOST:PORT, for opentrack",
                  options.udp);
    spec.options = {{"address", options.udp.substr(0, colon)}, {"port", options.udp.substr(colon + 1)}};
  }
  const SteadyClock clock;
  DUBSAR_ASSIGN(const SimulatedFeed feed, simulate_device(*driver, std::move(person), clock));
  const auto ready = [&](int port) {
    if (!print) return;
    const std::string address = options.device.address.empty() ? "127.0.0.1" : options.device.address;
    fmt::print("simulated {} at {}\n", spec.driver,
               driver->bus == Bus::kUnixSocket ? options.device.socket : fmt::format("{}:{}", address, port));
    std::fflush(stdout);
  };
  DUBSAR_ASSIGN(const ServerResult served,
                serve_simulated(
                    *driver, feed, spec.options, clock, [&] { return progress.cancelled(); }, ready));
  result.json = {{"messages", served.messages}, {"clients", served.clients}};
  result.text = fmt::format("{} messages sent\n", served.messages);
  return result;
}

Result<VerbResult> run(const DevicesRequest& options, const CommonOptions& common, Progress& progress) {
  const bool print = common.json_path != "-" && !common.console.quiet;
  if (options.actions.list->chosen()) return list(options);
  if (options.actions.probe->chosen() && is_calibration(options.device.driver))
    return probe_looking_glass(SteadyClock());
  if (options.actions.replay->chosen()) return run_replay(options, print, progress);
  if (options.actions.simulate->chosen()) return run_simulate(options, print, progress);
  const auto driver = find_driver(options.device.driver, "devices", driver_table());
  if (driver && (*driver)->bus == Bus::kVideo && !options.actions.monitor->chosen())
    return watch_camera(options.file, options.actions.probe->chosen() ? 2.0 : options.seconds, progress);
  DevicesRequest chosen = options;
  if (options.actions.probe->chosen()) chosen.seconds = 2.0;
  return run_live(chosen, print && options.actions.monitor->chosen(), progress);
}

void add_device_options(Arguments command, DevicesRequest& options) {
  command
      .value("driver", options.device.driver,
             driver_names(driver_table(), can_be_opened) +
                 "; probe and monitor: leapc, plugin:FILE.so[,...]; probe and record: webcam")
      .required();
  command.value("--address", options.device.address, "opentrack: to listen on; vrpn: of the server");
  command.value("--port", options.device.port, "opentrack: 4242, vrpn: 3883 unless given");
  command.flag("--allow-remote", options.device.remote, "opentrack: listen to other machines too");
  command.value("--tracker", options.device.tracker, "vrpn: name of the tracker (the first)");
  command.value("--sensor", options.device.sensor, "vrpn: which of its sensors");
  command.value("--invert", options.device.invert, "opentrack: axes that count the other way, e.g. x+yaw")
      .called("AXES");
  command.value("--sender", options.device.sender, "opentrack: whose signs, opentrack or xrlinux").called("NAME");
  command.value("--socket", options.device.socket, "spacenav: path of the daemon's socket");
  command.value("--library", options.device.library, "leapc: Ultraleap's libLeapC.so").called("FILE");
}

void add_simulate_options(Arguments command, DevicesRequest& options) {
  command.value("driver", options.device.driver, "whose bytes: " + driver_names(driver_table(), can_be_simulated))
      .required();
  command.writes("file", options.file, FileFormat::kOther, "the recording to write").called("FILE");
  command.reads("--script", options.script, "what the person does (docs/input.md); else looks about and turns things")
      .called("FILE");
  command.value("--seed", options.seed, "another person");
  command.value("--seconds", options.duration, "how long, instead of the script's time").range(0.1, 3600.0).called("S");
  command.flag("--live", options.live, "in real time on sockets: opentrack, vrpn, spacenav");
  command.value("--udp", options.udp, "opentrack: live, to this receiver").called("HOST:PORT");
  command.value("--address", options.device.address, "opentrack: of the receiver; vrpn: to serve on");
  command.value("--port", options.device.port, "opentrack: 4242, vrpn: 3883 unless given");
  command.flag("--allow-remote", options.device.remote, "vrpn: serve other machines too");
  command.value("--socket", options.device.socket, "spacenav: the socket to serve");
}

}  // namespace

Verb add_devices_verb(Arguments program) {
  Arguments command = program.command("devices", "input devices: list, check, watch, record, replay");
  command.needs_command();
  command.footer(
      "Examples:\n  dubsar devices list\n  dubsar devices monitor opentrack --seconds 30\n"
      "  dubsar devices simulate spacemouse turn.txt\n  dubsar devices replay turn.txt\n"
      "  dubsar devices simulate opentrack --script scholar.json --udp 127.0.0.1:4242");
  auto options = std::make_shared<DevicesRequest>();
  const auto add = [&](const char* name, const char* what) { return command.subcommand(name, what); };
  const auto seconds = [&](Arguments sub) {
    sub.value("--seconds", options->seconds, "how long").range(0.1, 86400.0).called("S");
  };
  options->actions.list = add("list", "devices that are here, and why one cannot be used");
  options->actions.list->value("--socket", options->device.socket, "path of spacenavd's socket");
  options->actions.probe =
      add("probe", "open a device and see whether it answers (also looking_glass: its calibration)");
  options->actions.monitor =
      add("monitor", "show what a device says: bars in a terminal, else one JSON line per sample");
  options->actions.record = add("record", "write what a device says to a file");
  for (const Arguments& sub : {*options->actions.probe, *options->actions.monitor, *options->actions.record})
    add_device_options(sub, *options);
  options->actions.replay = add("replay", "play a recording through its driver");
  options->actions.replay
      ->value("--speed", options->speed,
              "2: twice as fast; unless given pictures are looked at one by one, as fast as that goes")
      .range(0.01, 1000.0);
  options->actions.record->writes("file", options->file, FileFormat::kOther, "the recording").required().called("FILE");
  options->actions.replay->reads("file", options->file, "the recording").required().called("FILE");
  for (const Arguments& sub : {*options->actions.monitor, *options->actions.record}) seconds(sub);
  options->actions.simulate =
      add("simulate", "a scripted person as bytes: a recording of any driver, or live on sockets");
  add_simulate_options(*options->actions.simulate, *options);
  return {command,
          [options](const CommonOptions& common, Progress& progress) { return run(*options, common, progress); }};
}

}  // namespace dubsar::app
