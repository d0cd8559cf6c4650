#include "tests/app/kiosk/soak_figures.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace dubsar::app::test {

double resident_mib() {
  std::ifstream in("/proc/self/statm");
  double whole = 0.0, resident = 0.0;
  in >> whole >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

double slope_mib_per_h(const std::vector<MemoryAt>& samples) {
  if (samples.size() < 2) return 0.0;
  double hours = 0.0, mib = 0.0;
  for (const MemoryAt& at : samples) {
    hours += at.hours / static_cast<double>(samples.size());
    mib += at.mib / static_cast<double>(samples.size());
  }
  double up = 0.0, down = 0.0;
  for (const MemoryAt& at : samples) {
    up += (at.hours - hours) * (at.mib - mib);
    down += (at.hours - hours) * (at.hours - hours);
  }
  return down > 0.0 ? up / down : 0.0;
}

double settled_slope_mib_per_h(const std::vector<MemoryAt>& samples) {
  return slope_mib_per_h({samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 4), samples.end()});
}

bool holds(const SoakFigures& figures, bool drawn, const Limits& limits) {
  const bool memory = settled_slope_mib_per_h(figures.memory) < limits.slope_mib_per_h;
  const bool back =
      figures.never_back == 0 &&
      std::all_of(figures.recovery_s.begin(), figures.recovery_s.end(), [&](const auto& kind) {
        return std::all_of(kind.second.begin(), kind.second.end(), [&](double s) { return s <= limits.recovery_s; });
      });
  const bool pictures =
      !drawn || (figures.pictures > 0 && figures.gl_errors == 0 && figures.longest_ms <= limits.picture_ms &&
                 figures.hand_ms.quantile(0.95) <= limits.hand_ms);
  return memory && back && pictures && figures.restarts == 0;
}

std::string describe(const SoakFigures& figures, bool drawn, const Limits& limits) {
  std::string out = fmt::format("memory: {:.1f} MiB at first, {:.1f} at last, {:+.2f} MiB an hour (limit {:.0f})\n",
                                figures.memory.empty() ? 0.0 : figures.memory.front().mib,
                                figures.memory.empty() ? 0.0 : figures.memory.back().mib,
                                settled_slope_mib_per_h(figures.memory), limits.slope_mib_per_h);
  for (const auto& [kind, times] : figures.recovery_s)
    out += fmt::format("{}: {} times, back after {:.2f} s at the latest (limit {:.0f})\n", kind, times.size(),
                       *std::max_element(times.begin(), times.end()), limits.recovery_s);
  out += fmt::format("never back: {}; visits: {}\n", figures.never_back, figures.visits);
  out += fmt::format("signs of life: {:.1f} s apart at most; restarts by a watchdog: {}\n", figures.silence_s,
                     figures.restarts);
  if (drawn)
    out += fmt::format("pictures: {}, longest {:.0f} ms after the first (limit {:.0f}), GL errors: {}\n",
                       figures.pictures, figures.longest_ms, limits.picture_ms, figures.gl_errors);
  if (drawn && !figures.hand_ms.empty())
    out += fmt::format(
        "a hand that comes is in a picture after {:.0f} ms, 95 of 100 after {:.0f} ms, at most {:.0f} ms ({} hands; "
        "limit {:.0f} for 95)\n",
        figures.hand_ms.quantile(0.5), figures.hand_ms.quantile(0.95), figures.hand_ms.quantile(1.0),
        figures.hand_ms.size(), limits.hand_ms);
  return out + (holds(figures, drawn, limits) ? "holds\n" : "does NOT hold\n");
}

}  // namespace dubsar::app::test
