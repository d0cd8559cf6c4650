#pragma once
// dubsar view --also: further panels of one session.

#include <string>
#include <string_view>
#include <vector>

#include "app/viewer/view_options.h"

namespace dubsar::app {

/// What one is asked for.
struct AskedPanel {
  std::string display;    ///< as of --display
  std::string monitor{};  ///< part of its name; covered where no size is given
  std::string size{};     ///< "WIDTHxHEIGHT" of its window, or of its pictures where there are no windows
};

/// "NAME[:options][,monitor=NAME][,size=WxH]": what is the display's own, and where it stands. kUsage.
Result<AskedPanel> parse_asked_panel(std::string_view text);

/// The display is made once, to see whether it can be beside another one: kUsage for displays that are worn, that show
/// their eyes in turn, and for sizes that are none. Errors of choose_display.
Result<SidePanelOptions> side_panel(const AskedPanel& asked, const std::vector<std::string>& plugin_files,
                                    int bridge_port);

}  // namespace dubsar::app
