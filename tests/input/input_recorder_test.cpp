// A minute of two hands with all 26 joints on its way to a file, and what is left of it when the process is killed.

#include "input/input_recorder.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include "core/base/files/atomic_file.h"
#include "input/mixer.h"
#include "input/navigation/navigation.h"
#include "input/people/person_keeper.h"
#include "input/simulated/scripted_source.h"
#include "tests/input/recorded_frames.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

constexpr TimestampNs kStart = 1'000'000'000, kStep = 11'000'000;
constexpr int kSteps = 5455;  // a minute

/// What the killed process saw.
struct Seen {
  std::atomic<int> steps;
  std::array<glm::dquat, kSteps> rotation;
  std::array<double, kSteps> zoom;
};

/// A visitor who never is content, as the view does not go that near, turns and zooms with both hands for a minute.
Script busy_minute(std::uint64_t seed) {
  Script script;
  script.seed = seed;
  script.duration_s = 62;
  script.noise_m = 0.0005;
  script.visitor = VisitorGoal{170, 80, 50.0, 61};
  return script;
}

/// As a hand tracker that measures everything gives it.
void add_all_joints(HandFrame& hand) {
  for (std::size_t i = 0; i < kHandJointCount; ++i) {
    HandJointPose& joint = hand.joints[i];
    if (joint.valid) continue;
    const glm::dvec3 offset_m(0.004 * static_cast<double>(i % 5), 0.003 * static_cast<double>(i % 3),
                              -0.003 * static_cast<double>(i));
    const glm::dquat turn = glm::angleAxis(0.05 * static_cast<double>(i), glm::normalize(glm::dvec3(1, 0.3, -0.2)));
    joint = {{hand.palm.position_m + hand.palm.rotation * offset_m, hand.palm.rotation * turn}, 0.0081, true, true};
  }
}

/// The session: `paced` in real time, else as fast as it goes with the file never more than a step behind.
void record_minute(const fs::path& path, std::uint64_t seed, bool paced, Seen& seen) {
  auto recorder = InputRecorder::create(path).value();
  ViewState view;
  InputMixer mixer;
  mixer.add(play_script(busy_minute(seed), [&] { return view; }).value());
  Navigator navigator(default_mapping().value());
  PersonKeeper people;
  for (int i = 0; i < kSteps; ++i) {
    const TimestampNs now = kStart + i * kStep;
    InputFrame frame = mixer.poll(now);
    for (HandFrame& hand : frame.hands) add_all_joints(hand);
    if (frame.hands.size() == 1) {  // the other one rests
      frame.hands.push_back(frame.hands[0]);
      frame.hands[1].id += 500;
      frame.hands[1].palm.position_m.y -= 0.6;
      for (HandJointPose& joint : frame.hands[1].joints) joint.pose.position_m.y -= 0.6;
    }
    navigator.update(now, frame, people.update(now, frame).hands);
    recorder->add(now, frame);
    if (!paced) static_cast<void>(recorder->flush());
    view = navigator.view();
    seen.rotation[static_cast<std::size_t>(i)] = view.rotation;
    seen.zoom[static_cast<std::size_t>(i)] = view.zoom;
    seen.steps = i + 1;
    if (paced) std::this_thread::sleep_for(std::chrono::nanoseconds(kStep));
  }
}

class KilledRecording : public ::testing::Test {
 protected:
  KilledRecording() {
    void* const shared = ::mmap(nullptr, sizeof(Seen), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    seen_ = new (shared) Seen{};
  }
  ~KilledRecording() override {
    ::munmap(seen_, sizeof(Seen));
    fs::remove(path_);
  }

  /// Kills the session after some of its steps and reads what it left.
  std::vector<RecordedFrame> kill_after(int steps, bool paced) {
    const pid_t child = ::fork();
    if (child == 0) {
      record_minute(path_, seed_, paced, *seen_);
      ::_exit(0);
    }
    while (seen_->steps < steps && ::waitpid(child, nullptr, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "it was over before it was killed";
    std::vector<RecordedFrame> frames;
    RecordingReader reader = RecordingReader::open(path_).value();
    for (;;) {
      auto frame = reader.next();
      EXPECT_TRUE(frame) << frame.error().message;
      if (!frame || !*frame) return frames;
      frames.push_back(**std::move(frame));
    }
  }

  const std::uint64_t seed_ = std::random_device{}();
  const fs::path path_ = fs::temp_directory_path() / ("dubsar_killed_" + std::to_string(::getpid()) + ".jsonl");
  Seen* seen_ = nullptr;
};

TEST_F(KilledRecording, ShowsTheSameViewWithinTheLastSecond) {
  std::minstd_rand random(static_cast<unsigned>(seed_));
  const int wait = 700 + static_cast<int>(random() % 4000);
  SCOPED_TRACE("seed " + std::to_string(seed_));
  const std::vector<RecordedFrame> frames = kill_after(wait, false);
  const int steps = seen_->steps;
  ASSERT_GT(frames.size(), 20u);
  const TimestampNs last = frames.back().polled;
  EXPECT_GE(last, kStart + (steps - 1) * kStep - 1'000'000'000);
  std::size_t with_two_hands = 0;
  for (const RecordedFrame& frame : frames)
    with_two_hands += frame.frame.hands.size() >= 2 &&
                      std::all_of(frame.frame.hands[0].joints.begin(), frame.frame.hands[0].joints.end(),
                                  [](const HandJointPose& j) { return j.valid; });
  EXPECT_GT(2 * with_two_hands, frames.size());

  InputMixer mixer;
  mixer.add(replay_of(frames));
  Navigator navigator(default_mapping().value());
  PersonKeeper people;
  double worst_deg = 0, worst_zoom = 0;
  const auto played = std::min(steps, static_cast<int>((last - kStart) / kStep) + 1);
  for (int i = static_cast<int>((frames.front().polled - kStart) / kStep); i < played; ++i) {
    const InputFrame& polled = mixer.poll(kStart + i * kStep);
    navigator.update(kStart + i * kStep, polled, people.update(kStart + i * kStep, polled).hands);
    const auto at = static_cast<std::size_t>(i);
    worst_deg = std::max(worst_deg, turn_between_deg(navigator.view().rotation, seen_->rotation[at]));
    worst_zoom = std::max(worst_zoom, std::abs(navigator.view().zoom - seen_->zoom[at]));
  }
  EXPECT_LT(worst_deg, 0.1) << "over " << played << " steps";
  EXPECT_LT(worst_zoom, 0.002);
  std::cout << "[   FACT   ] killed after " << played * 1e-9 * kStep << " s of the session, " << frames.size()
            << " frames, " << fs::file_size(path_) / 1000 << " kB; worst " << worst_deg << " degrees\n";
}

TEST_F(KilledRecording, LosesLessThanASecondOfRealTimeWithoutBeingAskedToFlush) {
  SCOPED_TRACE("seed " + std::to_string(seed_));
  const std::vector<RecordedFrame> frames = kill_after(130, true);
  ASSERT_FALSE(frames.empty());
  const TimestampNs newest = kStart + (seen_->steps - 1) * kStep;
  EXPECT_GT(newest, kStart + 500'000'000);
  EXPECT_LT(newest - frames.back().polled, 1'000'000'000);
}

TEST(InputRecorder, KeepsWhatTheSessionItselfTookAndLeavesOutRepetitions) {
  const auto path = fs::temp_directory_path() / ("dubsar_recorder_" + std::to_string(::getpid()) + ".jsonl");
  auto recorder = InputRecorder::create(path).value();
  InputFrame frame;
  frame.time = 5;
  frame.heads = {HeadFrame{5, 1, true, 1.0, glm::dvec3(0, 0, 0.6), {}}};
  recorder->add(10, frame);
  recorder->add(20, frame);  // nothing new
  InputEvent f2;
  f2.time = 25;
  f2.kind = EventKind::kKey;
  f2.key = "f2";
  f2.down = true;
  recorder->add_event(f2);
  recorder->add(30, frame);
  frame.time = 35;
  recorder->add(40, frame);
  ASSERT_TRUE(recorder->finish());
  ASSERT_TRUE(recorder->finish());
  EXPECT_EQ(recorder->frames(), 3);
  const auto read = frames_of(read_text_file(path).value(), "r").value();
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[1].polled, 30);
  ASSERT_EQ(read[1].frame.events.size(), 1u);
  EXPECT_EQ(read[1].frame.events[0].key, "f2");
  EXPECT_EQ(read[1].frame.heads, frame.heads);  // poses are not lost for it
  EXPECT_TRUE(read[2].frame.events.empty());
  fs::remove(path);
}

TEST(InputRecorder, AnOldRecordingStaysWhereNothingCameOrTheDiskIsFull) {
  const auto path = fs::temp_directory_path() / ("dubsar_recorder_old_" + std::to_string(::getpid()) + ".jsonl");
  std::ofstream(path) << "old";
  ASSERT_TRUE(InputRecorder::create(path).value()->finish());
  EXPECT_EQ(read_text_file(path).value(), "old");
  {
    auto recorder = InputRecorder::create(path).value();
    recorder->add(1, {});
    ASSERT_TRUE(recorder->flush());
    EXPECT_EQ(read_text_file(path).value(), "old");
  }  // an error ended the session
  EXPECT_EQ(frames_of(read_text_file(path).value(), "r").value().size(), 1u);
  fs::remove(path);
  auto full = InputRecorder::create("/dev/full").value();
  full->add(1, {});
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (full->status() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(full->status().error().kind, ErrorKind::kIo);  // told without being asked to end
  EXPECT_EQ(full->flush().error().kind, ErrorKind::kIo);
  full->add(2, {});
  EXPECT_EQ(full->finish().error().kind, ErrorKind::kIo);
  EXPECT_EQ(InputRecorder::create(path / "no").error().kind, ErrorKind::kCannotCreate);
}

}  // namespace
}  // namespace dubsar
