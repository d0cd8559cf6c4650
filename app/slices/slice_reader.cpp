#include "app/slices/slice_reader.h"

#include <algorithm>

#include "core/base/system/clock.h"
#include "core/base/system/guarded.h"
#include "core/mesh/plane_section.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kCoarseNs = 40'000'000, kEveryNs = 150'000'000;

}  // namespace

std::vector<OutlinePiece> outline_in(const TriMesh& mesh, const SliceFrame& frame) {
  std::vector<OutlinePiece> out;
  const glm::dvec2 size(frame.width, frame.height);
  for (const SectionPiece& piece : plane_section(mesh, frame.middle_mm, frame.to_viewer())) {
    const glm::dvec2 a = frame.px_at(piece.a_mm), b = frame.px_at(piece.b_mm);
    const glm::dvec2 low = glm::min(a, b), high = glm::max(a, b);
    if (high.x < 0 || high.y < 0 || low.x > size.x || low.y > size.y) continue;
    out.push_back({glm::vec2(a), glm::vec2(b), mesh.partition_of(piece.triangle),
                   !mesh.triangle_inferred.empty() && mesh.triangle_inferred[piece.triangle] != 0});
  }
  return out;
}

SliceReader::SliceReader(const TriMesh& mesh, OpenScan open) : mesh_(mesh) {
  thread_ = std::jthread([this, open = std::move(open)](const std::stop_token& stop) {
    const auto ended = guarded("the slices", [&] { run(stop, open); });
    if (ended) return;
    {
      const std::scoped_lock lock(mutex_);
      note_ = ended.error().message;
      over_ = true;
    }
    changed_.notify_all();
  });
}

SliceReader::~SliceReader() {
  thread_.request_stop();
  changed_.notify_all();
}

void SliceReader::ask(std::size_t which, const SliceFrame& frame) {
  {
    const std::scoped_lock lock(mutex_);
    Slot& slot = slots_[which];
    if (slot.asked == frame) return;
    slot.asked = frame;
    ++slot.question;
    slot.coarse = slot.exact = false;
  }
  changed_.notify_all();
}

SharedSlice SliceReader::picture(std::size_t which) const {
  const std::scoped_lock lock(mutex_);
  return slots_[which].picture;
}

std::string SliceReader::note() const {
  const std::scoped_lock lock(mutex_);
  return note_;
}

bool SliceReader::has_scan() const {
  const std::scoped_lock lock(mutex_);
  return has_scan_;
}

void SliceReader::wait() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return over_ || (opened_ && next().first == Left::kNothing); });
}

/// What is to be done now: coarse pictures go first.
std::pair<SliceReader::Left, std::size_t> SliceReader::next() const {
  for (std::size_t i = 0; i < kSlices; ++i)
    if (!slots_[i].coarse) return {Left::kCoarse, i};
  for (std::size_t i = 0; i < kSlices; ++i)
    if (!slots_[i].exact) return {Left::kExact, i};
  return {Left::kNothing, 0};
}

void SliceReader::run(const std::stop_token& stop, const OpenScan& open) {
  auto opened = open ? open() : Result<OpenedScan>(OpenedScan());
  {
    const std::scoped_lock lock(mutex_);
    if (opened) {
      sampler_ = std::move(opened->sampler);
      voxel_mm_ = opened->voxel_mm;
      note_ = opened->note;
    } else {
      note_ = opened.error().message;
    }
    has_scan_ = sampler_ != nullptr;
    opened_ = true;
  }
  changed_.notify_all();
  while (!stop.stop_requested()) {
    std::pair<Left, std::size_t> work;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return next().first != Left::kNothing; })) return;
      work = next();
    }
    answer(work.second, work.first == Left::kExact, stop);
  }
}

void SliceReader::publish(std::size_t which, std::uint64_t question, SlicePicture picture, bool done) {
  {
    const std::scoped_lock lock(mutex_);
    Slot& slot = slots_[which];
    if (slot.question != question) return;
    slot.coarse = true;
    slot.exact = slot.exact || done;
    picture.done = done;
    slot.picture = std::make_shared<const SlicePicture>(std::move(picture));
  }
  changed_.notify_all();
}

void SliceReader::answer(std::size_t which, bool exact, const std::stop_token& stop) {
  SlicePicture out;
  std::uint64_t question = 0;
  SharedSlice before;
  {
    const std::scoped_lock lock(mutex_);
    out.frame = *slots_[which].asked;
    question = slots_[which].question;
    before = slots_[which].picture;
  }
  out.outline = before && before->frame == out.frame ? before->outline : outline_in(mesh_, out.frame);
  if (!sampler_) {
    out.exact = true;
    return publish(which, question, std::move(out), true);
  }
  const SteadyClock clock;
  const TimestampNs begun = clock.now();
  TimestampNs shown = begun;
  const auto look = [&](const PlanePicture& so_far) {
    if (stop.stop_requested()) return false;
    const TimestampNs now = clock.now();
    if (!exact) return now - begun < kCoarseNs;
    {
      const std::scoped_lock lock(mutex_);
      if (slots_[which].question != question || next().first == Left::kCoarse) return false;
    }
    if (now - shown < kEveryNs) return true;
    shown = now;
    SlicePicture partial = out;
    partial.image = so_far.image();
    publish(which, question, std::move(partial), false);
    return true;
  };
  auto image = sampler_->sample(out.frame.grid(voxel_mm_), look);
  if (!image) {
    {
      const std::scoped_lock lock(mutex_);
      note_ = image.error().message;
    }
    return publish(which, question, std::move(out), true);
  }
  {
    const std::scoped_lock lock(mutex_);
    const bool given_up = exact && (slots_[which].question != question || next().first == Left::kCoarse);
    if (given_up) return;  // what was read is kept: the next time is quicker
  }
  out.exact = image->exact();
  out.image = *std::move(image);
  const bool done = out.exact || exact;
  publish(which, question, std::move(out), done);
}

}  // namespace dubsar::app
