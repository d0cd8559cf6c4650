#include "input/plugins/source_plugin.h"

#include <dlfcn.h>

#include <string_view>

#include "core/base/log.h"

namespace dubsar {
namespace {

constexpr std::size_t kMaxName = 32;

std::int64_t host_now_ns() { return SteadyClock().now(); }
void host_log(const char* text) { log_info("plug-in: {}", text); }
constexpr dubsar_source_host kHost{DUBSAR_SOURCE_ABI, sizeof(dubsar_source_host), host_now_ns, host_log};

Result<void> check_table(const std::string& file, const dubsar_source_table* table) {
  if (table == nullptr)
    return fail(ErrorKind::kBadData, "plug-in {}: it refuses to work with ABI version {}", file, DUBSAR_SOURCE_ABI);
  if (table->abi != DUBSAR_SOURCE_ABI)
    return fail(ErrorKind::kBadData,
                "plug-in {}: ABI version {} found, expected {}; build it again with this program's "
                "source_plugin_abi.h",
                file, table->abi, DUBSAR_SOURCE_ABI);
  if (table->size < sizeof(dubsar_source_table))
    return fail(ErrorKind::kBadData, "plug-in {}: its table has {} bytes, expected at least {}", file, table->size,
                sizeof(dubsar_source_table));
  if (table->name == nullptr || table->summary == nullptr || table->create == nullptr || table->destroy == nullptr ||
      table->open == nullptr || table->close == nullptr || table->read == nullptr)
    return fail(ErrorKind::kBadData, "plug-in {}: its table has gaps, expected every entry", file);
  const std::string_view name(table->name);
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789_";
  if (name.empty() || name.size() > kMaxName || name.find_first_not_of(kAllowed) != std::string_view::npos)
    return fail(ErrorKind::kBadData, "plug-in {}: its name is \"{}\", expected 1 to {} of a-z, 0-9 and _", file,
                name.substr(0, 100), kMaxName);
  return {};
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
  std::error_code error;
  const auto whole = std::filesystem::canonical(file, error);  // a bare name would be searched in the system's folders
  if (error) return fail(ErrorKind::kNoInput, "plug-in {}: {}", file.string(), error.message());
  void* const library = ::dlopen(whole.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    return fail(ErrorKind::kUnavailable, "plug-in {}: it cannot be loaded: {}", whole.string(), ::dlerror());
  const auto entry = reinterpret_cast<dubsar_source_entry>(::dlsym(library, DUBSAR_SOURCE_ENTRY));
  const dubsar_source_table* const table = entry != nullptr ? call_entry(entry) : nullptr;
  auto good = entry != nullptr ? check_table(whole.string(), table)
                               : fail(ErrorKind::kBadData, "plug-in {}: it has no function {}, so it is not a plug-in",
                                      whole.string(), DUBSAR_SOURCE_ENTRY);
  if (!good) {
    ::dlclose(library);
    return tl::unexpected<Error>(good.error());
  }
  return std::shared_ptr<SourcePlugin>(new SourcePlugin(library, table));
}

SourcePlugin::~SourcePlugin() { ::dlclose(library_); }

}  // namespace dubsar
