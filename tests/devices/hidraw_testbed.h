#pragma once
// A SpaceMouse in a simulated /sys and /dev (umockdev), for unmodified hidapi. Run with libumockdev-preload.

#include <umockdev.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace dubsar {

/// The node is a FIFO in packet mode, so that reports keep their boundaries; what the host sends is kept. The ioctls are
/// answered in a thread of umockdev's own.
class HidrawTestbed {
 public:
  HidrawTestbed();
  ~HidrawTestbed();
  HidrawTestbed(const HidrawTestbed&) = delete;
  HidrawTestbed& operator=(const HidrawTestbed&) = delete;

  void plug();  ///< a new node each time: umockdev does not give a name twice, and the kernel seldom does
  void unplug();
  /// One input report.
  bool send(std::span<const std::byte> report);
  std::vector<std::vector<std::byte>> written();
  std::vector<std::vector<std::byte>> features_set();
  std::string node() const;             ///< "/dev/hidraw0", "/dev/hidraw1", ...
  std::string node_in_testbed() const;  ///< real path of the node, for permissions

 private:
  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  static gboolean on_write(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_;
  int plugging_ = -1;
  int fifo_ = -1;
  bool attached_ = false;
  std::mutex mutex_;
  std::vector<std::vector<std::byte>> written_, features_set_;  // guarded by mutex_
};

}  // namespace dubsar
