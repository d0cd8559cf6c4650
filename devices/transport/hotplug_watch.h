#pragma once
// Notices that device nodes come, go or change their permissions, so that a replugged device is found at once.

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace dubsar {

/// Watches folders with inotify; no thread. One thread.
class HotplugWatch {
 public:
  /// kUnavailable: no inotify instance left, or none of the folders is there; then devices are found by the pauses of
  /// Reconnector.
  static Result<HotplugWatch> create(std::span<const std::filesystem::path> folders);
  /// Where this machine's device nodes are: /dev, /dev/input, and the folders of USB devices.
  static std::vector<std::filesystem::path> device_folders();
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
