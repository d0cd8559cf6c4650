#pragma once
// How a session is doing, in words: the display, the head, speed and latency, the sources.

#include <string>
#include <vector>

#include "app/document/source_row.h"
#include "app/panels/help_page.h"
#include "display/sinks/output_sink.h"
#include "input/people/presence.h"

namespace dubsar::app {

struct StateFigures {
  std::string display;  ///< NAME[:options]
  SinkTraits traits;
  Presence head = Presence::kOff;
  glm::dvec3 eyes_mm{0.0};           ///< midpoint, screen frame
  std::vector<double> interval_ms;   ///< between pictures while things moved
  std::vector<double> input_age_ms;  ///< measurement to cameras
  std::vector<SourceRow> sources;
};

std::vector<HelpSection> state_page(const StateFigures& state);

}  // namespace dubsar::app
