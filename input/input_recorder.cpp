#include "input/input_recorder.h"

#include <algorithm>
#include <chrono>

#include "input/event_limit.h"

namespace dubsar {
namespace {

constexpr auto kWriteEvery = std::chrono::milliseconds(200);
constexpr std::size_t kMostPending = 4096;  // frames; 45 s of two hands at 90 Hz, 25 MB

/// Whether both say the same, events aside.
bool same(const InputFrame& a, const InputFrame& b) {
  return a.time == b.time && a.space_mouse == b.space_mouse && a.hands == b.hands && a.heads == b.heads &&
         a.grips == b.grips;
}

}  // namespace

Result<std::unique_ptr<InputRecorder>> InputRecorder::create(const std::filesystem::path& path) {
  DUBSAR_ASSIGN(GrowingFile file, GrowingFile::create(path));
  return std::unique_ptr<InputRecorder>(new InputRecorder(std::move(file)));
}

InputRecorder::InputRecorder(GrowingFile file) : file_(std::move(file)), thread_([this] { write_loop(); }) {}

InputRecorder::~InputRecorder() { static_cast<void>(finish()); }

void InputRecorder::add(TimestampNs polled, const InputFrame& frame) {
  std::unique_lock lock(mutex_);
  if (finished_ || !status_) return;
  if (frame.events.empty() && events_.empty() && added_ > 0 && same(frame, last_.frame)) return;
  written_.wait(lock, [this] { return pending_.size() < kMostPending || !status_; });
  last_ = {std::max(last_.polled, polled), frame};
  RecordedFrame& recorded = pending_.emplace_back(last_);
  auto& events = recorded.frame.events;
  events.insert(events.end(), events_.begin(), events_.end());
  std::stable_sort(events.begin(), events.end(),
                   [](const InputEvent& a, const InputEvent& b) { return a.time < b.time; });
  if (events.size() > kMostEvents) events.resize(kMostEvents);
  events_.clear();
  ++added_;
}

void InputRecorder::add_event(const InputEvent& event) {
  const std::lock_guard lock(mutex_);
  if (events_.size() < kMostEvents) events_.push_back(event);
}

Result<void> InputRecorder::flush() {
  std::unique_lock lock(mutex_);
  hurry_ = true;
  wake_.notify_all();
  written_.wait(lock, [this, upto = added_] { return done_ >= upto || !status_ || finished_; });
  return status_;
}

Result<void> InputRecorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    if (finished_) return status_;
    ending_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  if (std::exchange(finished_, true)) return status_;
  if (added_ == 0) {
    file_.discard();
  } else if (auto done = file_.finish(); !done && status_) {
    status_ = std::move(done);
  }
  return status_;
}

std::int64_t InputRecorder::frames() const {
  const std::lock_guard lock(mutex_);
  return added_;
}

Result<void> InputRecorder::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void InputRecorder::write_loop() {
  std::vector<RecordedFrame> frames;
  std::string text;
  std::unique_lock lock(mutex_);
  for (bool last = false; !last;) {
    wake_.wait_for(lock, kWriteEvery, [this] { return hurry_ || ending_; });
    last = ending_;
    hurry_ = false;
    frames.swap(pending_);
    lock.unlock();
    text.clear();
    for (const RecordedFrame& frame : frames) text += record_line(frame) + "\n";
    auto written = file_.append(text);
    lock.lock();
    done_ += static_cast<std::int64_t>(frames.size());
    frames.clear();
    if (!written && status_) status_ = std::move(written);
    written_.notify_all();
  }
}

}  // namespace dubsar
