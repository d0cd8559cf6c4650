#pragma once
// All displays there are: the built-in ones, those of plug-ins, and the panels that they may name.

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "display/panels/panel_set.h"
#include "display/sinks/catalog/sink_options.h"
#include "display/sinks/catalog/sink_spec.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

class SinkPlugin;

/// A row of the table of built-in displays.
struct SinkBackend {
  std::string_view name;
  std::string_view summary;  ///< one line with the options
  Result<std::unique_ptr<OutputSink>> (*make)(SinkOptions options);
  bool offered = true;  ///< a key may go there; false: it takes over a headset, writes files or shows nothing
};

/// The built-in displays, in the order in which they are offered.
std::span<const SinkBackend> output_sinks();

/// What make() can make. A value: copies share plug-ins, not panels.
class SinkCatalog {
 public:
  /// The program's own panels, no plug-ins.
  SinkCatalog();
  explicit SinkCatalog(PanelSet panels, std::vector<std::shared_ptr<SinkPlugin>> plugins = {});

  /// kUsage with the names there are, or with what the display's options are; kConfig for a panel whose file was not
  /// understood, with the reason; errors of calibration files.
  Result<std::unique_ptr<OutputSink>> make(const SinkSpec& spec) const;
  /// The same for a text, as parse_sink_spec() reads it.
  Result<std::unique_ptr<OutputSink>> make(std::string_view text) const;

  /// What somebody may go through who named none: the built-in displays as they are without options, each panel with
  /// lenses, the plug-ins'. Whether a window fits them their traits say.
  std::vector<SinkSpec> offered() const;

  const PanelSet& panels() const noexcept { return panels_; }
  /// Figures that did not come from a file: a calibration that a device told, lenses that somebody adjusts by eye.
  /// Replaces the panel of the same name from the next make() on.
  void put(PanelProfile panel) { panels_.put(std::move(panel)); }
  std::span<const std::shared_ptr<SinkPlugin>> plugins() const noexcept { return plugins_; }
  /// Files of the user's panel folder that were left out, and why.
  std::span<const PanelProblem> problems() const noexcept { return panels_.problems; }

 private:
  PanelSet panels_;
  std::vector<std::shared_ptr<SinkPlugin>> plugins_;
};

}  // namespace dubsar
