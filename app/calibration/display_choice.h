#pragma once
// From what somebody typed after --display to what can be made: plug-ins loaded, the user's panels read, "auto" found.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "display/sinks/catalog/sink_catalog.h"

namespace dubsar::app {

/// The user's panels and these plug-ins. Panel files that are left out are warned of. Errors of SinkPlugin::load.
Result<std::shared_ptr<SinkCatalog>> user_catalog(const std::vector<std::string>& plugin_files);

struct DisplayChoice {
  SinkSpec display;
  std::shared_ptr<SinkCatalog> catalog;
};

/// Reads `text` and looks for panel "auto" where it is named; its figures are in the catalog then. Other displays come
/// back as they are, and nothing is looked for. `bridge_port` as search_this_machine(). Errors of parse_sink_spec,
/// user_catalog, choose_auto_panel.
Result<DisplayChoice> choose_display(std::string_view text, const std::vector<std::string>& plugin_files,
                                     int bridge_port);

}  // namespace dubsar::app
