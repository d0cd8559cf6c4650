#include "app/calibration/display_choice.h"

#include "app/calibration/auto_panel.h"
#include "app/cli/config_folder.h"
#include "core/base/system/log.h"
#include "display/sinks/catalog/plugin_sink.h"

namespace dubsar::app {

Result<std::shared_ptr<SinkCatalog>> user_catalog(const std::vector<std::string>& plugin_files) {
  DUBSAR_ASSIGN(auto plugins, load_plugins(plugin_files));
  auto catalog = std::make_shared<SinkCatalog>(load_panels(panel_folder()), std::move(plugins));
  for (const PanelProblem& problem : catalog->problems()) log_warning("left out: {}", problem.reason);
  return catalog;
}

Result<DisplayChoice> choose_display(std::string_view text, const std::vector<std::string>& plugin_files,
                                     int bridge_port) {
  DisplayChoice out;
  DUBSAR_ASSIGN(out.display, parse_sink_spec(text));
  DUBSAR_ASSIGN(out.catalog, user_catalog(plugin_files));
  if (!names_auto_panel(out.display)) return out;
  const SteadyClock clock;
  const PanelFacts facts{find_calibrations(search_this_machine(bridge_port, clock), out.catalog->panels(), clock),
                         read_connected_edids()};
  DUBSAR_ASSIGN(PanelProfile panel, choose_auto_panel(facts, out.catalog->panels()));
  log_info("panel {}{}", panel.name,
           panel.lenses.calibration.empty() ? "" : ", calibration " + panel.lenses.calibration);
  out.display = with_panel(std::move(out.display), panel);
  out.catalog->put(std::move(panel));
  return out;
}

}  // namespace dubsar::app
