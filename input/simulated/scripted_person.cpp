#include "input/simulated/scripted_person.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/numbers/angle.h"
#include "input/simulated/scripted_source.h"

namespace dubsar {
namespace {

constexpr double kFullDeflection_m = 0.05, kGrab = 0.8;
constexpr double kContent_rad = std::numbers::pi / 180.0, kContentZoom = 0.01, kFullTurn_rad = 0.5, kFullZoom = 0.5;
constexpr double kDeadZone = 0.05, kRest = 0.01;

/// Turns head axes so that -Z points from `at_m` to the panel's centre, without roll.
glm::dquat looking_at_centre(const glm::dvec3& at_m) {
  const double yaw = std::atan2(at_m.x, at_m.z), pitch = -std::atan2(at_m.y, std::hypot(at_m.x, at_m.z));
  return glm::angleAxis(yaw, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch, glm::dvec3(1, 0, 0));
}

/// Nobody presses less than it takes for something to happen.
double pressed(double wanted) {
  return std::abs(wanted) < kRest ? 0.0 : std::copysign(std::min(1.0, kDeadZone + std::abs(wanted)), wanted);
}

class ScriptedPerson final : public SimulatedPerson {
 public:
  ScriptedPerson(Script script, std::optional<VisitorGoal> steers, std::shared_ptr<const SeenView> seen)
      : script_(script), goal_(steers), seen_(std::move(seen)) {
    actor_ = play_script(std::move(script), [this] { return view_; }).value();
    if (!goal_) return;
    wished_ = turn_of({goal_->pitch_deg * kRadPerDeg, 0, 0}) * turn_of({0, goal_->yaw_deg * kRadPerDeg, 0});
  }

  bool act(TimestampNs now) override {
    if (!start_) start_ = now;
    seconds_ = 1e-9 * static_cast<double>(now - *start_);
    if (seen_) view_ = seen_->look();
    const bool fresh = actor_->poll(now, frame_) == Freshness::kNew;
    if (fresh) cap_ = goal_ ? steered() : held();
    if (actor_->finished()) end();
    return fresh;
  }
  TimestampNs period_ns() const override { return static_cast<TimestampNs>(1e9 / script_.rate_hz); }
  TimestampNs time() const override { return frame_.time; }
  CapDeflection cap() const override { return cap_; }

  std::optional<Pose> head() const override {
    const auto head =
        std::find_if(frame_.heads.begin(), frame_.heads.end(), [](const HeadFrame& h) { return h.id == 0; });
    if (head == frame_.heads.end() || !head->left_eye_m || !head->right_eye_m) return std::nullopt;
    return Pose{0.5 * (*head->left_eye_m + *head->right_eye_m), {1, 0, 0, 0}};
  }
  glm::dquat gaze() const override {
    if (!script_.heads.empty())
      if (const auto at = sample_head(script_.heads.front(), std::max(0.0, seconds_ - script_.latency_s)))
        gaze_ = looking_at_centre(*at);
    return gaze_;
  }
  std::vector<ShownHand> hands() const override {
    std::vector<ShownHand> out;
    for (const HandFrame& hand : frame_.hands)
      out.push_back({hand.palm, hand.grab_strength, hand.pinch_distance_m, hand.chirality == Chirality::kLeft});
    return out;
  }

 private:
  /// Towards the wished view, the harder the further away.
  CapDeflection steered() {
    const glm::dvec3 error = vector_of(wished_ * glm::conjugate(view_.rotation));
    const double zoom = std::log(goal_->zoom / view_.zoom);
    if (glm::length(error) <= kContent_rad && std::abs(zoom) <= kContentZoom) {
      end();
      return {};
    }
    return {{0.0, 0.0, pressed(zoom / kFullZoom)},
            {pressed(error.x / kFullTurn_rad), pressed(error.y / kFullTurn_rad), pressed(error.z / kFullTurn_rad)}};
  }
  CapDeflection held() {
    if (frame_.hands.empty() || frame_.hands.front().grab_strength < kGrab) {
      grip_m_.reset();
      return {};
    }
    const glm::dvec3 at = frame_.hands.front().palm.position_m;
    if (!grip_m_) grip_m_ = at;
    const glm::dvec3 d = glm::clamp((at - *grip_m_) / kFullDeflection_m, -1.0, 1.0);
    return {{0.0, 0.0, d.z}, {-d.y, d.x, 0.0}};
  }

  const Script script_;
  const std::optional<VisitorGoal> goal_;  // of one who steers with a SpaceMouse
  const std::shared_ptr<const SeenView> seen_;
  ViewState view_{};
  std::unique_ptr<InputSource> actor_;
  InputFrame frame_;
  std::optional<TimestampNs> start_;
  double seconds_ = 0.0;
  glm::dquat wished_{1, 0, 0, 0};
  mutable glm::dquat gaze_{1, 0, 0, 0};  // before the first and after the last key the head rests
  std::optional<glm::dvec3> grip_m_;
  CapDeflection cap_;
};

}  // namespace

Result<std::shared_ptr<SimulatedPerson>> make_scripted_person(const DriverEntry& driver, PersonOptions options) {
  Script& script = options.script;
  const bool head = driver.gives == Gives::kHead;
  const bool hands = !script.hands.empty() || script.visitor || script.bystanders > 0;
  if (script.visitor && !options.seen && !head)
    return fail(ErrorKind::kUsage, "simulate {}: the script has a visitor, who needs a view to look at (dubsar view)",
                driver.name);
  if (head && script.heads.empty()) return fail(ErrorKind::kUsage, "simulate {}: the script has no head", driver.name);
  if (!head && !hands) return fail(ErrorKind::kUsage, "simulate {}: the script has no hands", driver.name);
  std::optional<VisitorGoal> steers;
  if (driver.gives == Gives::kSpaceMouse) steers = script.visitor;
  if (head || steers) script.visitor.reset();
  if (driver.gives == Gives::kStereoPictures) script.latency_s = 0.0;
  return std::make_shared<ScriptedPerson>(std::move(script), steers, std::move(options.seen));
}

}  // namespace dubsar
