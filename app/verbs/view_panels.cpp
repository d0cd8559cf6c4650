#include "app/verbs/view_panels.h"

#include <array>
#include <utility>

#include "app/calibration/display_choice.h"
#include "core/base/text/option_list.h"
#include "core/base/text/parse_number.h"

namespace dubsar::app {
namespace {

constexpr int kOffscreenWidth = 960, kOffscreenHeight = 540;

}  // namespace

Result<AskedPanel> parse_asked_panel(std::string_view text) {
  const std::size_t end = text.find_first_of(":,");
  SinkSpec display{std::string(text.substr(0, end))};
  if (display.name.empty())
    return fail(ErrorKind::kUsage, "--also \"{}\" has no display, expected NAME[:options][,monitor=NAME][,size=WxH]",
                text);
  AskedPanel out;
  if (end != std::string_view::npos) {
    DUBSAR_ASSIGN(const std::vector<Option> options, parse_options(text.substr(end + 1), "--also", text));
    for (const Option& option : options) {
      const bool place = option.key == "monitor" || option.key == "size";
      if (!place) {
        display.options.push_back(option);
      } else if (option.value.value_or("").empty()) {
        return fail(ErrorKind::kUsage, "--also \"{}\": {} has no value, expected {}={}", text, option.key, option.key,
                    option.key == "size" ? "640x480" : "HDMI-2");
      } else {
        (option.key == "size" ? out.size : out.monitor) = *option.value;
      }
    }
  }
  out.display = display.text();
  return out;
}

Result<SidePanelOptions> side_panel(const AskedPanel& asked, const std::vector<std::string>& plugin_files,
                                    int bridge_port) {
  DUBSAR_ASSIGN(DisplayChoice choice, choose_display(asked.display, plugin_files, bridge_port));
  DUBSAR_ASSIGN(const auto sink, choice.catalog->make(choice.display));
  const SinkTraits traits = sink->traits();
  if (traits.worn || traits.fields > 1)
    return fail(ErrorKind::kUsage, "display {} {}, expected it as --display, and others with --also", asked.display,
                traits.worn ? "is worn" : "shows its eyes in turn");
  SidePanelOptions out;
  out.name = asked.display;
  out.display = std::move(choice.display);
  out.catalog = std::move(choice.catalog);
  out.window.title = "dubsar: " + asked.display;
  out.window.monitor = asked.monitor;
  std::array<int, 2> size{kOffscreenWidth, kOffscreenHeight};
  if (!asked.size.empty()) {
    size = parse_size(asked.size).value_or(std::array{0, 0});
    if (size[0] < 16 || size[1] < 16 || size[0] > 16384 || size[1] > 16384)
      return fail(ErrorKind::kUsage, "--also {}: size \"{}\" found, expected WIDTHxHEIGHT of 16 to 16384 pixels",
                  asked.display, asked.size);
    out.window.width = size[0];
    out.window.height = size[1];
    out.fullscreen = false;
  } else if (!asked.monitor.empty()) {
    out.fullscreen = true;
  }
  out.screen.width_px = out.screen.window_w = size[0];
  out.screen.height_px = out.screen.window_h = size[1];
  out.screen.height_mm = out.screen.width_mm * size[1] / size[0];
  return out;
}

}  // namespace dubsar::app
