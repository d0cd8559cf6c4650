#pragma once
// The small things that sinks share: reading their options, two eyes through one window.

#include <array>
#include <initializer_list>
#include <string_view>

#include "display/panels/panel_profile.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// Takes a bare word out of `config` if it is one of `choices` and returns its index; 0 when none of them is there.
int take_choice(SinkConfig& config, std::initializer_list<std::string_view> choices);

/// Takes "panel=NAME" (or the first bare word) and "calibration=FILE" out of `config`; nothing when neither is there.
Result<std::optional<PanelProfile>> take_panel(SinkConfig& config);

/// kUsage naming the first option that is left, and what the sink knows.
Result<void> expect_no_more(const SinkConfig& config, std::string_view sink, std::string_view known);

/// Left and right view through the window.
std::array<View, 2> stereo_views(const Screen& screen, const Viewer& viewer);

}  // namespace dubsar
