#include <dlfcn.h>

#include <filesystem>
#include <mutex>

#include "devices/camera/capture.h"

namespace dubsar {
namespace {

constexpr const char* kFile = "libdubsar_capture.so";

Result<OpenCapture> load() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  std::string why = "there is no such file";
  for (const fs::path& path : {program / kFile, program.parent_path() / "lib" / "dubsar" / kFile}) {
    if (!fs::exists(path, error)) continue;
    void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      why = ::dlerror();
      continue;
    }
    const auto* const module = static_cast<const CaptureModule*>(::dlsym(library, "dubsar_capture"));
    if (module != nullptr && module->version == CaptureModule::kVersion) return module->open;
    why = path.string() + " belongs to another version";
    ::dlclose(library);
  }
  return fail(ErrorKind::kUnavailable, "camera: {} cannot be loaded ({}); build it, and install libopencv-videoio406",
              kFile, why);
}

}  // namespace

Result<OpenCapture> load_capture() {
  static std::mutex mutex;
  static OpenCapture loaded = nullptr;
  const std::lock_guard lock(mutex);
  if (loaded == nullptr) {
    DUBSAR_ASSIGN(loaded, load());
  }
  return loaded;
}

}  // namespace dubsar
