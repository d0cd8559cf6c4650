#include "app/calibration/eye_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/base/numbers/quantile.h"
#include "core/base/system/second.h"
#include "display/optics/optics.h"

namespace dubsar::app {
namespace {

constexpr TimestampNs kTellNs = kSecondNs / 2;
constexpr auto kBetweenPolls = std::chrono::milliseconds(4);

/// The first head with both eyes.
const HeadFrame* head_with_eyes(const InputFrame& frame) {
  for (const HeadFrame& head : frame.heads)
    if (head.left_eye_m && head.right_eye_m) return &head;
  return nullptr;
}

}  // namespace

void EyeCheck::add(TimestampNs at, const EyePair& eyes_mm) {
  known_.push_back({at, eyes_mm});
  while (known_.front().at < at - 2 * kSecondNs) known_.pop_front();
}

std::optional<double> EyeCheck::wrong_light() const {
  if (known_.empty()) return std::nullopt;
  const TimestampNs then = known_.back().at - static_cast<TimestampNs>(1e6 * options_.delay_ms);
  // The newest that was known then: a panel weaves for it until there is another.
  const auto after = std::upper_bound(known_.begin(), known_.end(), then,
                                      [](TimestampNs at, const Known& known) { return at < known.at; });
  if (after == known_.begin()) return std::nullopt;
  return wrong_eye_light(panel_, std::prev(after)->eyes, known_.back().eyes, true, options_.step_px).worst();
}

std::optional<double> EyeCheck::own_light() const {
  if (known_.empty()) return std::nullopt;
  return wrong_eye_light(panel_, known_.back().eyes, known_.back().eyes, true, options_.step_px).worst();
}

int EyeCheck::a_second() const {
  return static_cast<int>(std::count_if(known_.begin(), known_.end(),
                                        [&](const Known& known) { return known.at > known_.back().at - kSecondNs; }));
}

Result<EyeCheckFigures> check_eyes(InputSource& source, const PanelProfile& panel, const EyeCheckOptions& options,
                                   const std::function<void(const std::string&)>& told, Progress& progress) {
  if (panel.kind != PanelKind::kTracked)
    return fail(ErrorKind::kConfig, "panel {}: its views are made for all places at once, expected a tracked panel",
                panel.name);
  DUBSAR_ASSIGN(const TrackedPanel optics, panel_optics(panel, panel.zone.design_distance_mm));
  const SteadyClock clock;
  EyeCheck check(optics, options);
  EyeCheckFigures out;
  std::vector<double> percents;
  InputFrame frame;
  TimestampNs first = -1, last = -1, told_at = clock.now();
  const TimestampNs start = told_at;
  while (clock.now() - start < static_cast<TimestampNs>(1e9 * options.seconds)) {
    if (progress.cancelled()) return cancelled_error();
    const Freshness freshness = source.poll(clock.now(), frame);
    if (const HeadFrame* const head = head_with_eyes(frame); freshness == Freshness::kNew && head != nullptr) {
      check.add(clock.now(), {1e3 * *head->left_eye_m, 1e3 * *head->right_eye_m});
      ++out.samples;
      last = clock.now();
      if (first < 0) first = last;
    }
    if (clock.now() - told_at >= kTellNs) {
      told_at = clock.now();
      const auto wrong = freshness == Freshness::kLost ? std::nullopt : check.wrong_light();
      if (wrong) {
        percents.push_back(100.0 * *wrong);
        const glm::dvec3 middle = 0.5 * (check.newest().left_mm + check.newest().right_mm);
        told(fmt::format("head {:.0f}, {:.0f}, {:.0f} mm, {} a second: {:.1f} % of the light is the other eye's",
                         middle.x, middle.y, middle.z, check.a_second(), percents.back()));
      } else {
        told(source.note().empty() ? "no eyes are seen" : source.note());
      }
    }
    std::this_thread::sleep_for(kBetweenPolls);
  }
  out.note = source.note();
  if (out.samples == 0)
    return fail(ErrorKind::kUnavailable, "no eyes were seen in {:g} s{}{}", options.seconds,
                out.note.empty() ? "" : ": ", out.note);
  out.checks = static_cast<int>(percents.size());
  out.rate_hz = last > first ? (out.samples - 1) / (1e-9 * static_cast<double>(last - first)) : 0.0;
  out.median_percent = quantile(percents, 0.5);
  out.worst_percent = quantile(percents, 1.0);
  out.own_percent = 100.0 * check.own_light().value_or(0.0);
  out.last_mm = check.newest();
  return out;
}

}  // namespace dubsar::app
