#pragma once
// What a device says, drawn with letters for a terminal.

#include <nlohmann/json.hpp>
#include <string>

namespace dubsar::app {

/// A sample of DeviceMonitor as lines of at most 79 characters: axes and head as bars, hands as a line each, the
/// age when the sample has "age_ms". Samples of one device that have the same parts have the same number of
/// lines.
std::string monitor_text(const nlohmann::json& sample);

}  // namespace dubsar::app
