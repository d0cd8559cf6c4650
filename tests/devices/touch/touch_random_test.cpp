// Touch panels at random: fingers by a driver of one's own against what is told of them, and noise.

#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <random>

#include "tests/devices/touch/touch_bench.h"

namespace dubsar {
namespace {
using namespace touch_bench;

TEST(Touch, TenThousandRandomReportsAreToldAsTheyWere) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  KernelPanel panel;
  Reader reader(panel);
  std::map<int, glm::ivec3> truth;  // by slot: tracking id, x, y
  int next_id = 0, losses = 0;
  for (int step = 0; step < 10'000; ++step) {
    bool lost = below(100) == 0;
    for (int change = below(4); change >= 0; --change) {
      const int s = below(5);  // so that they are never a blob
      if (truth.count(s) != 0 && below(3) == 0) {
        truth.erase(s);
        panel.slot(s).id(-1);
        continue;
      }
      if (truth.count(s) == 0) {
        truth[s] = {next_id, below(kWide + 1), below(kHigh + 1)};
        panel.slot(s).id(next_id).at(truth[s].y, truth[s].z);
        next_id = (next_id + 1) % 65536;
      } else {
        truth[s] = {truth[s].x, below(kWide + 1), below(kHigh + 1)};
        panel.slot(s).at(truth[s].y, truth[s].z);
      }
    }
    panel.report();
    if (lost) {
      static_cast<void>(panel.take());
      panel.say(EV_SYN, SYN_DROPPED, 0).report();
      EXPECT_TRUE(reader.read().empty());
      ++losses;
    }
    const auto frames = reader.read();
    if (frames.empty()) continue;
    std::vector<glm::dvec2> told, was;
    for (const TouchContact& contact : frames.back().contacts) told.push_back(contact.at);
    for (const auto& [s, finger] : truth)
      was.emplace_back(static_cast<double>(finger.y) / kWide, static_cast<double>(finger.z) / kHigh);
    const auto order = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
    std::sort(told.begin(), told.end(), order);
    std::sort(was.begin(), was.end(), order);
    ASSERT_EQ(told, was) << "seed " << seed << ", step " << step;
  }
  EXPECT_GT(losses, 20);
}

TEST(Touch, RandomBytesAndEventsNeverGiveMoreThanFiveFingersNorPlacesBesideThePanel) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  KernelPanel panel;
  Reader reader(panel);
  const std::array<int, 8> codes{
      ABS_MT_SLOT, ABS_MT_TRACKING_ID, ABS_MT_POSITION_X, ABS_MT_POSITION_Y, ABS_MT_TOOL_TYPE, ABS_X, ABS_MT_PRESSURE,
      0xffff};
  std::int64_t accepted = 0, frames = 0;
  for (int round = 0; round < 200'000; ++round) {
    Bytes bytes;
    if (round % 4 == 0) {
      bytes.resize(random() % 100);
      for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    } else {
      for (auto n = 1 + random() % 6; n > 0; --n) {
        const auto kind = random() % 16;
        const int value = random() % 8 == 0 ? static_cast<int>(random()) : static_cast<int>(random() % 12) - 1;
        const Bytes event = kind == 0   ? panel.event(EV_SYN, SYN_DROPPED, 0)
                            : kind < 4  ? panel.event(EV_SYN, SYN_REPORT, 0)
                            : kind == 4 ? panel.event(static_cast<int>(random()), static_cast<int>(random()), value)
                                        : panel.event(EV_ABS, codes[random() % codes.size()], value);
        bytes.insert(bytes.end(), event.begin(), event.end());
      }
    }
    accepted += reader.protocol.accept(bytes, round);
    ASSERT_TRUE(reader.protocol.keep_up(*reader.transport, round));
    const auto sample = reader.protocol.newest();
    if (!sample) continue;
    ASSERT_FALSE(sample->frames.empty());
    for (const TouchFrame& frame : sample->frames) {
      ++frames;
      ASSERT_LE(frame.contacts.size(), kMostTouches) << "seed " << seed;
      for (std::size_t i = 0; i < frame.contacts.size(); ++i) {
        const glm::dvec2& at = frame.contacts[i].at;
        ASSERT_TRUE(at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1) << "seed " << seed;
        ASSERT_TRUE(i == 0 || frame.contacts[i].id > frame.contacts[i - 1].id) << "seed " << seed;
      }
    }
  }
  EXPECT_GT(accepted, 140'000);
  EXPECT_GT(frames, 1000);
}

}  // namespace
}  // namespace dubsar
