#include "core/base/system/plugin_library.h"

#include <dlfcn.h>

#include <utility>

namespace dubsar {
namespace {

constexpr std::size_t kMaxName = 32, kMaxShown = 100;

}  // namespace

Result<PluginLibrary> PluginLibrary::load(const std::filesystem::path& file, const char* entry) {
  std::error_code error;
  const auto whole = std::filesystem::canonical(file, error);  // a bare name would be searched in the system's folders
  if (error) return fail(ErrorKind::kNoInput, "plug-in {}: {}", file.string(), error.message());
  void* const library = ::dlopen(whole.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    return fail(ErrorKind::kUnavailable, "plug-in {}: it cannot be loaded: {}", whole.string(), ::dlerror());
  PluginLibrary loaded(library, ::dlsym(library, entry), whole.string());
  if (loaded.entry_ == nullptr)
    return fail(ErrorKind::kBadData, "plug-in {}: it has no function {}, so it is not a plug-in", whole.string(),
                entry);
  return loaded;
}

PluginLibrary::PluginLibrary(PluginLibrary&& other) noexcept
    : library_(std::exchange(other.library_, nullptr)), entry_(other.entry_), path_(std::move(other.path_)) {}

PluginLibrary::~PluginLibrary() {
  if (library_ != nullptr) ::dlclose(library_);
}

Result<void> check_plugin_version(const std::string& file, PluginVersion found, PluginVersion expected,
                                  std::string_view header) {
  if (found.abi != expected.abi)
    return fail(ErrorKind::kBadData,
                "plug-in {}: ABI version {} found, expected {}; build it again with this program's {}", file, found.abi,
                expected.abi, header);
  if (found.size < expected.size)
    return fail(ErrorKind::kBadData, "plug-in {}: its table has {} bytes, expected at least {}", file, found.size,
                expected.size);
  return {};
}

Result<void> check_plugin_name(const std::string& file, std::string_view name) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789_";
  if (name.empty() || name.size() > kMaxName || name.find_first_not_of(kAllowed) != std::string_view::npos)
    return fail(ErrorKind::kBadData, "plug-in {}: its name is \"{}\", expected 1 to {} of a-z, 0-9 and _", file,
                name.substr(0, kMaxShown), kMaxName);
  return {};
}

}  // namespace dubsar
