#include "app/panels/state_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/words/text.h"
#include "core/base/numbers/quantile.h"

namespace dubsar::app {
namespace {

const std::string& presence_words(Presence presence) {
  switch (presence) {
    case Presence::kTracked:
      return tr("state.tracked");
    case Presence::kHeld:
      return tr("state.held");
    case Presence::kEasing:
      return tr("state.easing");
    case Presence::kOff:
      break;
  }
  return tr("state.off");
}

/// Long sentences are on the terminal in full.
std::string shortened(std::string text) {
  constexpr std::size_t kMost = 150;
  if (text.size() > kMost) text.replace(text.rfind(' ', kMost), std::string::npos, " ...");
  return text;
}

const std::string& health_words(SourceHealth health) {
  switch (health) {
    case SourceHealth::kPresent:
      return tr("health.present");
    case SourceHealth::kLost:
      return tr("health.lost");
    case SourceHealth::kMissing:
      return tr("health.missing");
    case SourceHealth::kOff:
      break;
  }
  return tr("health.off");
}

}  // namespace

std::vector<HelpSection> state_page(const StateFigures& state) {
  const auto number_words = [](double value, int digits) {
    return local_figures(fmt::format("{:.{}f}", value, digits));
  };
  HelpSection now{tr("state.now"), {}};
  now.rows.push_back({tr("state.display"), state.display});
  now.rows.push_back({tr("state.picture"),
                      tr("state.views", state.traits.views, state.traits.output.width, state.traits.output.height)});
  now.rows.push_back(
      {tr("state.head"), tr("state.head_at", presence_words(state.head), number_words(state.eyes_mm.x, 0),
                            number_words(state.eyes_mm.y, 0), number_words(state.eyes_mm.z, 0))});
  now.rows.push_back(
      {tr("state.rate"),
       state.interval_ms.empty()
           ? tr("state.still")
           : tr("state.moving", number_words(1e3 / std::max(quantile(state.interval_ms, 0.5), 1e-3), 0))});
  now.rows.push_back({tr("state.delay"), state.input_age_ms.empty()
                                             ? tr("state.no_input")
                                             : tr("state.delays", number_words(quantile(state.input_age_ms, 0.5), 1),
                                                  number_words(quantile(state.input_age_ms, 0.95), 1))});
  HelpSection sources{tr("state.devices"), {}};
  int number = 1;
  for (const SourceRow& row : state.sources)
    sources.rows.push_back({fmt::format("{} {}", number++, row.spec),
                            row.reason.empty()
                                ? health_words(row.health)
                                : fmt::format("{}: {}", health_words(row.health), shortened(row.reason))});
  return {std::move(now), std::move(sources)};
}

}  // namespace dubsar::app
