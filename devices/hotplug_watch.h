#pragma once
// Notices that device nodes come, go or change their permissions, so that a replugged device is found at once.

#include <filesystem>

#include "core/base/result.h"

namespace dubsar {

/// Watches one folder with inotify; no thread. One thread.
class HotplugWatch {
 public:
  /// kUnavailable: no inotify instance left, or no such folder; then devices are found by the pauses of Reconnector.
  static Result<HotplugWatch> create(const std::filesystem::path& folder = "/dev");
  HotplugWatch(HotplugWatch&& other) noexcept;
  HotplugWatch& operator=(HotplugWatch&& other) noexcept;
  ~HotplugWatch();

  /// True when a node was made, removed or given other permissions since the last call. Never blocks.
  bool changed() noexcept;

 private:
  explicit HotplugWatch(int descriptor) noexcept : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace dubsar
