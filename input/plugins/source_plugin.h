#pragma once
// Inputs from shared libraries (source_plugin_abi.h): loading one, and it as a source.

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/system/plugin_library.h"
#include "input/input_source.h"
#include "input/plugins/source_plugin_abi.h"

namespace dubsar {

/// One loaded library; unloaded with the last owner.
class SourcePlugin {
 public:
  /// kNoInput: no such file; kUnavailable: it cannot be loaded; kBadData: it is no plug-in, or not for this program.
  static Result<std::shared_ptr<SourcePlugin>> load(const std::filesystem::path& file);
  SourcePlugin(const SourcePlugin&) = delete;
  SourcePlugin& operator=(const SourcePlugin&) = delete;

  const dubsar_source_table& table() const noexcept { return *table_; }
  std::string name() const { return table_->name; }

 private:
  SourcePlugin(PluginLibrary library, const dubsar_source_table* table) : library_(std::move(library)), table_(table) {}
  PluginLibrary library_;
  const dubsar_source_table* table_;
};

/// How long a plug-in may keep quiet inside read(), and how long the end of a source waits for it. One that does not
/// come back by then keeps its thread and its library until the program ends.
inline constexpr TimestampNs kPluginPatienceNs = 2'000'000'000;

/// "plugin:FILE.so[,at=X/Y/Z,turn=X/Y/Z,...]": options that are not placements go to the plug-in. Its heads, hands and
/// keys are checked (finite, within 100 m) and bounded; a plug-in that throws, blocks or floods is a lost or a slowed
/// source.
Result<std::unique_ptr<InputSource>> make_plugin_source(const InputConfig& config);

}  // namespace dubsar
