// The command that lets the light go round.

#include "app/commands/command_table.h"
#include "app/commands/number_argument.h"

namespace dubsar::app {
namespace {

constexpr double kElevationDeg = 15.0, kPeriodS = 8.0;

Command sweep() {
  Command out{"sweep", "group.light", {{"shift+r"}}};
  out.argument = "arg.sweep";
  out.values = {"15 8", "30 20"};
  out.optional = true;
  out.run = [](Editor& editor, const std::string& text) -> Result<void> {
    UiState& ui = editor.ui();
    if (text.empty() && ui.sweep) {
      ui.sweep.reset();
      return {};
    }
    LightSweep wanted{kElevationDeg, kPeriodS};
    const auto [elevation, period] = first_word(text);
    if (!elevation.empty()) {
      DUBSAR_ASSIGN(wanted.elevation_deg, number_argument("sweep", elevation, 5.0, 85.0));
    }
    if (!period.empty()) {
      DUBSAR_ASSIGN(wanted.period_s, number_argument("sweep", period, 2.0, 600.0));  // flicker is below 3 Hz
    }
    ui.sweep = wanted;
    return {};
  };
  return out;
}

}  // namespace

std::vector<Command> light_commands() {
  std::vector<Command> out;
  out.push_back(sweep());
  return out;
}

}  // namespace dubsar::app
