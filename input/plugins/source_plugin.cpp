#include "input/plugins/source_plugin.h"

#include <string_view>

#include "core/base/system/log.h"

namespace dubsar {
namespace {

std::int64_t host_now_ns() { return SteadyClock().now(); }
void host_log(const char* text) { log_info("plug-in: {}", text); }
constexpr dubsar_source_host kHost{DUBSAR_SOURCE_ABI, sizeof(dubsar_source_host), host_now_ns, host_log};

Result<void> check_table(const std::string& file, const dubsar_source_table* table) {
  if (table == nullptr)
    return fail(ErrorKind::kBadData, "plug-in {}: it refuses to work with ABI version {}", file, DUBSAR_SOURCE_ABI);
  DUBSAR_TRY(check_plugin_version(file, {table->abi, table->size}, {DUBSAR_SOURCE_ABI, sizeof(dubsar_source_table)},
                                  "source_plugin_abi.h"));
  if (table->name == nullptr || table->summary == nullptr || table->create == nullptr || table->destroy == nullptr ||
      table->open == nullptr || table->close == nullptr || table->read == nullptr)
    return fail(ErrorKind::kBadData, "plug-in {}: its table has gaps, expected every entry", file);
  return check_plugin_name(file, table->name);
}

const dubsar_source_table* call_entry(dubsar_source_entry entry) noexcept {
  try {
    return entry(&kHost);
  } catch (...) {
    return nullptr;
  }
}

}  // namespace

Result<std::shared_ptr<SourcePlugin>> SourcePlugin::load(const std::filesystem::path& file) {
  DUBSAR_ASSIGN(PluginLibrary library, PluginLibrary::load(file, DUBSAR_SOURCE_ENTRY));
  const dubsar_source_table* const table = call_entry(library.entry<dubsar_source_entry>());
  DUBSAR_TRY(check_table(library.path(), table));
  return std::shared_ptr<SourcePlugin>(new SourcePlugin(std::move(library), table));
}

}  // namespace dubsar
