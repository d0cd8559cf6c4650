#pragma once
// How far the whole of a run is, and how long it will still take, from the stages that it goes through.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dubsar::app {

/// A stage of a run, as Progress::begin() names it, and its share of the time on a usual scan. Stages over voxels and
/// stages over the surface are told apart, because how much surface a scan holds is not known before it is there.
struct PlannedStage {
  std::string name;
  double share = 0.0;  ///< in any unit, the same for all
  bool surface = false;
};

/// One run. Times are arguments, in seconds from any beginning. Stages that the plan does not know count as time, not
/// as progress; planned ones that do not come are passed over.
class OverallProgress {
 public:
  explicit OverallProgress(std::vector<PlannedStage> plan = {}) : plan_(std::move(plan)) {}
  void begin(std::string_view stage, double now_s);
  void advance(double fraction, double now_s);  ///< of the present stage, 0..1
  void end(double now_s);

  bool planned() const noexcept { return !plan_.empty(); }
  /// 0..1, never falling.
  double fraction() const noexcept { return shown_; }
  double elapsed_s(double now_s) const noexcept { return started_ ? now_s - *started_ : 0.0; }
  /// Nothing while it is too early to say: in the first 3 s, and before some of each kind of work that is still to come
  /// was seen: how much surface there is, nobody knows before it is found. What has been done so far says how fast this
  /// machine is on this scan.
  std::optional<double> remaining_s(double now_s) const;

 private:
  struct Kind {
    double seconds = 0.0, share = 0.0;  // of finished stages
  };
  double pace(bool surface, double now_s) const;  // seconds a share; 0: not known
  double in_stage() const { return stage_ < plan_.size() ? plan_[stage_].share * stage_fraction_ : 0.0; }

  std::vector<PlannedStage> plan_;
  std::size_t next_ = 0;                              // first planned stage that has not begun
  std::size_t stage_ = static_cast<std::size_t>(-1);  // the present one; beyond the plan: none of it
  double stage_started_s_ = 0.0, stage_fraction_ = 0.0;
  Kind kinds_[2];
  double passed_ = 0.0, shown_ = 0.0;  // shares that are behind; what fraction() says
  std::optional<double> started_;
};

/// "about 2 min", "about 20 s", "about 1 h 10 min": as exact as an estimate is.
std::string rough_duration(double seconds);

}  // namespace dubsar::app
