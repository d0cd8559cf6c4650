// A scripted person as wire bytes, through the drivers, back to input: what comes out is what the script
// says.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>
#include <thread>

#include "devices/transport/replay_transport.h"
#include "devices/transport/socket_transport.h"
#include "input/navigation/mapping.h"
#include "input/navigation/navigation.h"
#include "input/people/person_keeper.h"
#include "input/simulated/simulated_recording.h"
#include "input/simulated/simulated_server.h"
#include "input/source_spec.h"
#include "tests/input/sources/source_bench.h"

namespace dubsar::test {
namespace {
namespace fs = std::filesystem;

class ScriptFile {
 public:
  explicit ScriptFile(std::string_view text)
      : path_((fs::temp_directory_path() / ("dubsar_person_" + std::to_string(::getpid()) + ".json")).string()) {
    std::ofstream(path_) << text;
  }
  ~ScriptFile() { fs::remove(path_); }
  const std::string& path() const { return path_; }
  Script script() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return parse_script(text.str(), path_).value();
  }

 private:
  std::string path_;
};

constexpr const char* kHeadScript = R"({"duration_s": 3, "rate_hz": 100, "latency_ms": 30, "heads": [{"keys":
  [{"t": 0, "at_mm": [-100, 0, 600]}, {"t": 1.5, "at_mm": [120, 50, 500]}, {"t": 3, "at_mm": [0, -20, 700]}]}]})";

glm::dvec3 middle(const HeadFrame& head) { return 0.5 * (*head.left_eye_m + *head.right_eye_m); }

TEST(SimulatedPeople, HeadsThroughOpentrackAndVrpnAreWhereTheScriptSays) {
  const ScriptFile file(kHeadScript);
  const Script script = file.script();
  for (const char* tracker : {"opentrack", "vrpn"}) {
    SourceBench bench;
    const auto source = bench.make(std::string("head:") + tracker + ",simulate=" + file.path());
    EXPECT_TRUE(source->has_end());
    int samples = 0;
    for (TimestampNs t = 0; t < 3 * kSecond; t += 10 * kMs, bench.clock.advance(10 * kMs)) {
      if (bench.poll(*source) != Freshness::kNew) continue;
      ++samples;
      ASSERT_EQ(bench.frame.heads.size(), 1u);
      const double measured_s = std::floor((1e-9 * static_cast<double>(t) - 0.030) * 100.0 + 1e-6) / 100.0;
      EXPECT_LE(glm::distance(middle(bench.frame.heads[0]), *sample_head(script.heads[0], measured_s)), 1e-9)
          << tracker << t;
      EXPECT_NEAR(glm::distance(*bench.frame.heads[0].left_eye_m, *bench.frame.heads[0].right_eye_m), 0.063, 1e-12);
    }
    EXPECT_EQ(samples, 297) << tracker;  // all of 3 s but the first 30 ms
    bench.poll(*source);
    EXPECT_TRUE(source->finished());
  }
}

TEST(SimulatedPeople, LostEyesAreMissingPackets) {
  const ScriptFile file(
      R"({"duration_s": 20, "rate_hz": 100, "latency_ms": 0, "heads": [{"keys": [{"t": 0, "at_mm": [0, 0, 600]},
    {"t": 20, "at_mm": [0, 0, 600]}]}], "eye_dropouts": {"per_s": 1, "shortest_ms": 100, "longest_ms": 100}})");
  SourceBench bench;
  const auto source = bench.make("head:opentrack,simulate=" + file.path());
  int missing = 0;
  for (int i = 0; i < 2000; ++i, bench.clock.advance(10 * kMs))
    missing += bench.poll(*source) == Freshness::kNew ? 0 : 1;
  // two eyes, each away for 1/11 of the time: 1 - (10/11)^2 of 2000
  EXPECT_NEAR(missing, 347, 120);
}

TEST(SimulatedPeople, GlassesTurnAsTheWearerLooksAtThePanel) {
  const ScriptFile file(
      R"({"duration_s": 2, "latency_ms": 0, "heads": [{"keys": [{"t": 0, "at_mm": [0, 0, 600]},
    {"t": 1.5, "at_mm": [300, 0, 519.615]}, {"t": 2, "at_mm": [300, 0, 519.615]}]}]})");
  for (const char* tracker : {"rift", "xreal"}) {
    SourceBench bench;
    const auto source = bench.make(std::string("head:") + tracker + ",simulate=" + file.path());
    for (int i = 0; i < 190; ++i, bench.clock.advance(10 * kMs)) bench.poll(*source);
    ASSERT_EQ(bench.frame.heads.size(), 1u);
    const glm::dvec3 right = *bench.frame.heads[0].right_eye_m - *bench.frame.heads[0].left_eye_m;
    EXPECT_NEAR(std::atan2(-right.z, right.x) * 180.0 / std::numbers::pi, 30.0, 0.5) << tracker;
  }
}

TEST(SimulatedPeople, AVisitorWithASpaceMouseTurnsTheViewToWhereItIsWished) {
  const ScriptFile file(
      R"({"duration_s": 20, "rate_hz": 60, "latency_ms": 20, "visitor": {"yaw_deg": 40, "pitch_deg": 15, "zoom": 1.3}})");
  for (const char* space_mouse : {"spacemouse", "spacenav"}) {
    SourceBench bench;
    Navigator navigator(default_mapping().value());
    PersonKeeper people;
    ViewState seen = navigator.view();
    bench.config.seen_view = [&] { return seen; };
    const auto source = bench.make(std::string(space_mouse) + ":simulate=" + file.path());
    double turned_at_once = 0.0;
    for (int i = 0; i < 60 * 20 && !source->finished(); ++i, bench.clock.advance(kSecond / 60)) {
      bench.poll(*source);
      navigator.update(bench.clock.now(), bench.frame, people.update(bench.clock.now(), bench.frame).hands);
      turned_at_once = std::max(turned_at_once, turn_between_deg(seen.rotation, navigator.view().rotation));
      seen = navigator.view();
    }
    EXPECT_TRUE(source->finished()) << space_mouse;
    constexpr double kDegree = std::numbers::pi / 180.0;
    const glm::dquat wished = turn_of({15 * kDegree, 0, 0}) * turn_of({0, 40 * kDegree, 0});
    EXPECT_LE(turn_between_deg(seen.rotation, wished), 2.0) << space_mouse;
    EXPECT_NEAR(seen.zoom, 1.3, 0.03) << space_mouse;
    EXPECT_LE(turned_at_once, 3.0) << space_mouse;
  }
  EXPECT_EQ(make_input("spacemouse:simulate=" + file.path()).error().kind,
            ErrorKind::kUsage);  // nothing to look at
}

TEST(SimulatedPeople, HandsOverALeapAreWhereTheScriptSays) {
  const ScriptFile file(R"({"duration_s": 2, "hands": [
    {"keys": [{"t": 0, "at_mm": [60, 50, 150]}, {"t": 0.9, "at_mm": [100, 80, 150]}]},
    {"chirality": "left", "keys": [{"t": 1.0, "at_mm": [-90, 60, 160], "grab": 1}, {"t": 2, "at_mm": [-40, 60, 160]}]}]})");
  const Script script = file.script();
  SourceBench bench;
  const auto source = bench.make("leap:simulate=" + file.path());
  int right = 0, left = 0;
  double worst = 0.0;
  for (int i = 0; i < 50; ++i, bench.clock.advance(40 * kMs)) {
    if (bench.poll(*source) != Freshness::kNew || bench.frame.hands.empty()) continue;
    ASSERT_EQ(bench.frame.hands.size(), 1u);
    const double t_s = 1e-9 * static_cast<double>(bench.clock.now() - kSecond);
    const bool second = t_s >= 1.0;
    const auto truth = sample_hand(script.hands[second ? 1 : 0], t_s);
    if (!truth) continue;  // the last picture of the first hand
    ++(second ? left : right);
    worst = std::max(worst, glm::distance(bench.frame.hands[0].palm.position_m, truth->palm.position_m));
    EXPECT_EQ(bench.frame.hands[0].grab_strength > 0.5, second) << t_s;
  }
  bench.poll(*source);
  EXPECT_GE(right, 20);
  EXPECT_GE(left, 22);
  EXPECT_LE(worst,
            0.030);  // arms that rise from the shoulder tilt the palm, which the tracker does not measure
  EXPECT_TRUE(source->finished());
}

TEST(SimulatedPeople, RecordingsOfEveryDriverDependOnTheScriptOnlyAndPlayThroughIt) {
  const auto folder = fs::temp_directory_path() / ("dubsar_wires_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  for (const DriverEntry& row : driver_table()) {
    if (!can_be_simulated(row)) continue;
    const std::string driver(row.name);
    const bool pictures = row.gives == Gives::kStereoPictures;
    const double seconds = pictures ? 0.05 : 1.0;
    const auto write = [&](const char* name, std::uint64_t seed) {
      PersonOptions options;
      options.script = somebody(seed, seconds);
      options.screen_from_device = row.usual_place;
      const auto events = write_simulated_recording(row, folder / name, options);
      EXPECT_TRUE(events) << events.error().message;
      return read_recording(folder / name).value();
    };
    const Recording first = write("a", 4), again = write("b", 4), other = write("c", 5);
    EXPECT_EQ(first.driver, driver);
    EXPECT_TRUE(first.events == again.events) << driver;
    EXPECT_FALSE(first.events == other.events) << driver;
    SourceBench bench;
    SourceSpec spec = parse_source(row.input.source).value();
    spec.options.push_back({"replay", (folder / "a").string()});
    const auto source = bench.make(spec.text());
    int fresh = 0;
    for (int i = 0; i < 110 && !source->finished(); ++i, bench.clock.advance(10 * kMs))
      fresh += bench.poll(*source) == Freshness::kNew ? 1 : 0;
    EXPECT_GE(fresh, pictures ? 3 : 20) << driver;
    EXPECT_TRUE(source->finished()) << driver;
  }
  fs::remove_all(folder);
}

TEST(SimulatedPeople, LiveTrackersAreFoundOnRealSockets) {
  const SteadyClock clock;
  std::uint16_t udp_port = 0;
  {
    UdpOptions any;
    any.port = 0;
    udp_port = open_udp(any, clock).value()->port();
  }
  const std::string socket_path = (fs::temp_directory_path() / ("dubsar_spnav_" + std::to_string(::getpid()))).string();
  struct Case {
    std::string_view driver;
    std::vector<Option> where;
    std::string spec;
  };
  std::vector<Case> cases{{"opentrack", {{"port", std::to_string(udp_port)}}, "head:opentrack,port="},
                          {"vrpn", {{"port", "0"}}, "head:vrpn,port="},
                          {"spacenav", {{"socket", socket_path}}, "spacenav:socket=" + socket_path}};
  for (Case& c : cases) {
    PersonOptions options;
    options.script = somebody(1, 60.0);
    const DriverEntry& driver = *find_driver(c.driver, "test", driver_table()).value();
    options.screen_from_device = driver.usual_place;
    const SimulatedFeed feed = simulate_device(driver, options, clock).value();
    std::atomic<bool> over{false};
    std::atomic<int> port{-1};
    Result<ServerResult> served;
    std::thread server([&] {
      served = serve_simulated(
          driver, feed, c.where, clock, [&] { return over.load(); }, [&](int p) { port = p; });
      port = 0;
    });
    while (port < 0) std::this_thread::yield();
    if (c.spec.back() == '=') c.spec += std::to_string(port);
    {
      const auto source = make_input(c.spec);
      ASSERT_TRUE(source) << source.error().message;
      InputFrame frame;
      bool heard = false;
      const TimestampNs until = clock.now() + 10 * kSecond;
      while (!heard && clock.now() < until) {
        heard = (*source)->poll(clock.now(), frame) == Freshness::kNew;
        std::this_thread::sleep_for(milliseconds(1));
      }
      EXPECT_TRUE(heard) << c.driver << ": " << (*source)->note();
      if (heard) {
        EXPECT_LE(clock.now() - frame.time, 50 * kMs);
      }
    }
    over = true;
    server.join();
    ASSERT_TRUE(served) << served.error().message;
    EXPECT_GT(served->messages, 0);
  }
  EXPECT_FALSE(fs::exists(socket_path));
}

}  // namespace
}  // namespace dubsar::test
