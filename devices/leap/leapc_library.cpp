#include "devices/leap/leapc_library.h"

#include <dlfcn.h>
#include <unistd.h>

#include <array>
#include <string_view>

namespace dubsar::leapc {
namespace {

// Where the vendor's Linux packages, its SDK for ARM boards and hand-made installations put the library.
constexpr std::array<std::string_view, 8> kFolders{"/usr/lib/ultraleap-hand-tracking-service",
                                                   "/opt/ultraleap/LeapSDK/lib/x64",
                                                   "/opt/ultraleap/LeapSDK/lib",
                                                   "/opt/ultraleap/LeapSDK",
                                                   "/usr/local/lib",
                                                   "/usr/lib",
                                                   "/usr/lib/x86_64-linux-gnu",
                                                   "/usr/lib/aarch64-linux-gnu"};
constexpr std::array<std::string_view, 3> kNames{"libLeapC.so.6", "libLeapC.so.5", "libLeapC.so"};

void* open_library(const std::string& path) { return ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE); }

template <class Function>
bool find(void* handle, const char* symbol, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(handle, symbol));
  return function != nullptr;
}

}  // namespace

std::vector<std::string> search_paths() {
  std::vector<std::string> paths;
  for (const auto folder : kFolders)
    for (const auto name : kNames) paths.push_back(fmt::format("{}/{}", folder, name));
  return paths;
}

Result<std::shared_ptr<const Library>> Library::load(const std::string& path) {
  void* handle = nullptr;
  std::string found = path, why;
  if (!path.empty()) {
    // A bare file name would be searched for in the loader's folders, not here.
    handle = open_library(path.find('/') == std::string::npos ? "./" + path : path);
    if (handle == nullptr) why = ::dlerror();
  } else {
    for (const std::string& candidate : search_paths()) {
      handle = open_library(candidate);
      found = candidate;
      if (handle != nullptr) break;
      const char* const error = ::dlerror();
      if (::access(candidate.c_str(), F_OK) == 0 && why.empty()) why = error;
    }
  }
  if (handle == nullptr && !why.empty())
    return fail(ErrorKind::kUnavailable, "leapc: the library cannot be loaded: {}", why);
  if (handle == nullptr) {
    std::string folders;
    for (const auto folder : kFolders) folders += fmt::format("{}, ", folder);
    return fail(ErrorKind::kUnavailable,
                "leapc: no libLeapC.so (.6, .5) in {}or the loader's folders: install Ultraleap's hand "
                "tracking software "
                "(docs.ultraleap.com/linux), or name the file with library=FILE",
                folders);
  }
  const std::shared_ptr<Library> library(new Library(handle, found));
  const char* missing = nullptr;
  const auto need = [&](const char* symbol, auto& function) {
    if (!find(handle, symbol, function) && missing == nullptr) missing = symbol;
  };
  need("LeapCreateConnection", library->create_connection);
  need("LeapOpenConnection", library->open_connection);
  need("LeapPollConnection", library->poll_connection);
  need("LeapCloseConnection", library->close_connection);
  need("LeapDestroyConnection", library->destroy_connection);
  need("LeapGetNow", library->get_now);
  need("LeapSetPolicyFlags", library->set_policy_flags);
  need("LeapSetTrackingMode", library->set_tracking_mode);  // since version 5
  if (missing != nullptr)
    return fail(ErrorKind::kUnavailable,
                "leapc: {} has no function {}: it is not LeapC or older than version 5; install Ultraleap Gemini or "
                "Hyperion (versions 5 and 6)",
                found, missing);
  return library;
}

Library::~Library() { ::dlclose(handle_); }

}  // namespace dubsar::leapc
