#include "input/simulated/scripted_source.h"

#include <array>
#include <cmath>
#include <limits>

#include "core/base/files/input_file.h"
#include "input/simulated/visitor.h"
#include "input/source_options.h"

namespace dubsar {
namespace {

/// Times at which a tracker does not see a thing, drawn as time goes on.
class DropoutClock {
 public:
  DropoutClock(const Dropouts& dropouts, std::uint64_t seed) : dropouts_(dropouts), random_(seed) { draw(0.0); }
  /// Calls come with rising times.
  bool missing(double t_s) {
    while (t_s >= end_s_) {
      ++count_;
      draw(end_s_);
    }
    return t_s >= start_s_;
  }
  std::uint32_t count() const noexcept { return count_; }

 private:
  void draw(double from_s) {
    if (dropouts_.per_s <= 0) {
      start_s_ = end_s_ = std::numeric_limits<double>::infinity();
      return;
    }
    start_s_ = from_s - std::log(1.0 - random_.uniform(0.0, 1.0)) / dropouts_.per_s;
    end_s_ = start_s_ + random_.uniform(dropouts_.shortest_s, dropouts_.longest_s);
  }
  Dropouts dropouts_;
  ScriptRandom random_;
  double start_s_ = 0, end_s_ = 0;
  std::uint32_t count_ = 0;
};

class ScriptedSource final : public InputSource {
 public:
  ScriptedSource(Script script, std::function<ViewState()> seen_view)
      : script_(std::move(script)), seen_(std::move(seen_view)), noise_(script_.seed + 101) {
    add_bystanders(script_);
    if (script_.visitor) visitor_.emplace(*script_.visitor, script_.seed);
    const std::size_t hands = script_.hands.size() + 2;
    for (std::size_t i = 0; i < hands; ++i) hand_clocks_.emplace_back(script_.hand_dropouts, script_.seed * 1009 + i);
    for (std::size_t i = 0; i < 2 * script_.heads.size(); ++i)
      eye_clocks_.emplace_back(script_.eye_dropouts, script_.seed * 2003 + i);
  }

  std::string_view name() const noexcept override { return "scripted"; }
  Result<void> start() override { return {}; }
  bool has_end() const noexcept override { return true; }
  bool finished() const noexcept override { return finished_; }

  Freshness poll(TimestampNs now, InputFrame& newest) noexcept override {
    if (!start_) start_ = now;
    const double now_s = 1e-9 * static_cast<double>(now - *start_);
    if (visitor_) visitor_->look(now_s, seen_());
    finished_ = now_s >= script_.duration_s || (visitor_ && visitor_->gone());
    const auto sample = static_cast<std::int64_t>(std::floor((now_s - script_.latency_s) * script_.rate_hz + 1e-9));
    if (sample < 0 || sample == last_sample_) return Freshness::kUnchanged;
    last_sample_ = sample;
    const double t_s = static_cast<double>(sample) / script_.rate_hz;
    const TimestampNs offset = static_cast<TimestampNs>(1e9 * t_s);
    newest.time = *start_ + offset;
    newest.events.clear();
    for (; next_event_ < script_.events.size() && script_.events[next_event_].time <= offset; ++next_event_) {
      newest.events.push_back(script_.events[next_event_]);
      newest.events.back().time += *start_;
    }
    newest.hands.clear();
    for (std::size_t i = 0; i < script_.hands.size(); ++i) add_hand(script_.hands[i], i, t_s, newest);
    if (visitor_)
      for (std::size_t i = 0; i < 2; ++i) add_hand(visitor_->hands()[i], script_.hands.size() + i, t_s, newest);
    newest.heads.clear();
    for (std::size_t i = 0; i < script_.heads.size(); ++i) add_head(i, t_s, newest);
    return Freshness::kNew;
  }

 private:
  glm::dvec3 noise() { return script_.noise_m * glm::dvec3(noise_.normal(), noise_.normal(), noise_.normal()); }

  void add_hand(const HandTrack& track, std::size_t index, double t_s, InputFrame& frame) {
    DropoutClock& clock = hand_clocks_[index];
    const bool missing = clock.missing(t_s);
    auto hand = sample_hand(track, t_s);
    if (!hand || missing || frame.hands.size() == kMaxHands) return;
    hand->time = frame.time;
    hand->id = static_cast<std::uint32_t>(index) + 1000u * clock.count();  // a tracker finds it again as a new hand
    hand->palm.position_m += noise();
    hand->joint(HandJoint::kPalm).pose = hand->palm;
    frame.hands.push_back(*hand);
  }

  void add_head(std::size_t index, double t_s, InputFrame& frame) {
    const HeadTrack& track = script_.heads[index];
    const bool no_left = eye_clocks_[2 * index].missing(t_s), no_right = eye_clocks_[2 * index + 1].missing(t_s);
    const auto at = sample_head(track, t_s);
    if (!at || (no_left && no_right)) return;
    const glm::dvec3 half(0.5 * track.ipd_m, 0, 0);
    HeadFrame head;
    head.time = frame.time;
    head.id = static_cast<std::uint32_t>(index);
    head.tracked = true;
    head.confidence = 1.0;
    if (!no_left) head.left_eye_m = *at - half + noise();
    if (!no_right) head.right_eye_m = *at + half + noise();
    frame.heads.push_back(head);
  }

  Script script_;
  std::function<ViewState()> seen_;
  ScriptRandom noise_;
  std::optional<SimulatedVisitor> visitor_;
  std::vector<DropoutClock> hand_clocks_, eye_clocks_;
  std::optional<TimestampNs> start_;
  std::int64_t last_sample_ = -1;
  std::size_t next_event_ = 0;
  bool finished_ = false;
};

}  // namespace

Result<std::unique_ptr<InputSource>> play_script(Script script, std::function<ViewState()> seen_view) {
  if (script.visitor && !seen_view)
    return fail(ErrorKind::kUsage, "input scripted: the script has a visitor, who needs a view to look at");
  return std::make_unique<ScriptedSource>(std::move(script), std::move(seen_view));
}

Result<std::unique_ptr<InputSource>> make_scripted_source(const InputConfig& config) {
  DUBSAR_ASSIGN(const std::string path, only_path_option(config, "scripted"));
  DUBSAR_ASSIGN(const std::string text, read_source_text(path));
  DUBSAR_ASSIGN(Script script, parse_script(text, path));
  return play_script(std::move(script), config.seen_view);
}

}  // namespace dubsar
