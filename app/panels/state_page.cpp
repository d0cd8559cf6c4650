#include "app/panels/state_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/numbers/quantile.h"

namespace dubsar::app {
namespace {

std::string_view presence_words(Presence presence) {
  switch (presence) {
    case Presence::kTracked:
      return "followed";
    case Presence::kHeld:
      return "out of sight, held";
    case Presence::kEasing:
      return "out of sight, going to the middle";
    case Presence::kOff:
      break;
  }
  return "nobody is followed";
}

/// Long sentences are on the terminal in full.
std::string shortened(std::string text) {
  constexpr std::size_t kMost = 150;
  if (text.size() > kMost) text.replace(text.rfind(' ', kMost), std::string::npos, " ...");
  return text;
}

std::string_view health_words(SourceHealth health) {
  switch (health) {
    case SourceHealth::kPresent:
      return "present";
    case SourceHealth::kLost:
      return "lost";
    case SourceHealth::kMissing:
      return "not available";
    case SourceHealth::kOff:
      break;
  }
  return "off";
}

}  // namespace

std::vector<HelpSection> state_page(const StateFigures& state) {
  HelpSection now{"Now", {}};
  now.rows.push_back({"display", state.display});
  now.rows.push_back(
      {"picture", fmt::format("{} x {} pixels, {} view{}", state.traits.output.width, state.traits.output.height,
                              state.traits.views, state.traits.views == 1 ? "" : "s")});
  now.rows.push_back({"head", fmt::format("{}; eyes at {:.0f}, {:.0f}, {:.0f} mm", presence_words(state.head),
                                          state.eyes_mm.x, state.eyes_mm.y, state.eyes_mm.z)});
  now.rows.push_back({"pictures a second", state.interval_ms.empty()
                                               ? "nothing moves"
                                               : fmt::format("{:.0f} while things move",
                                                             1e3 / std::max(quantile(state.interval_ms, 0.5), 1e-3))});
  now.rows.push_back({"delay of input", state.input_age_ms.empty() ? "no input yet"
                                                                   : fmt::format("median {:.1f} ms, 95 % {:.1f} ms",
                                                                                 quantile(state.input_age_ms, 0.5),
                                                                                 quantile(state.input_age_ms, 0.95))});
  HelpSection sources{"Devices", {}};
  int number = 1;
  for (const SourceRow& row : state.sources)
    sources.rows.push_back({fmt::format("{} {}", number++, row.spec),
                            row.reason.empty()
                                ? std::string(health_words(row.health))
                                : fmt::format("{}: {}", health_words(row.health), shortened(row.reason))});
  return {std::move(now), std::move(sources)};
}

}  // namespace dubsar::app
