#pragma once
// Displays from shared libraries (display/sinks/catalog/plugin_abi.h). Loading one runs its code with the user's
// rights.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/system/plugin_library.h"
#include "display/sinks/catalog/plugin_abi.h"
#include "display/sinks/output_sink.h"

namespace dubsar {

/// A loaded plug-in; the library stays loaded as long as this or a sink of it lives.
class SinkPlugin : public std::enable_shared_from_this<SinkPlugin> {
 public:
  /// kNoInput when there is no such file, kUnavailable when it cannot be loaded, kBadData, with what was found, when it
  /// is not a plug-in of this ABI version, its table is incomplete or its name is one of the built-in displays.
  static Result<std::shared_ptr<SinkPlugin>> load(const std::filesystem::path& file);
  SinkPlugin(const SinkPlugin&) = delete;
  SinkPlugin& operator=(const SinkPlugin&) = delete;

  std::string_view name() const noexcept { return table_->name; }
  std::string_view summary() const noexcept { return table_->summary; }
  /// kUsage with the plug-in's own sentence when it refuses the options.
  Result<std::unique_ptr<OutputSink>> create(const std::string& options);

 private:
  SinkPlugin(PluginLibrary library, const dubsar_sink_table* table) : library_(std::move(library)), table_(table) {}
  PluginLibrary library_;
  const dubsar_sink_table* table_;
};

/// All of these files, or the first error of SinkPlugin::load.
Result<std::vector<std::shared_ptr<SinkPlugin>>> load_plugins(const std::vector<std::string>& files);

}  // namespace dubsar
