#pragma once
// A HID device in a simulated /sys and /dev (umockdev), for unmodified hidapi. Run with libumockdev-preload.

#include <umockdev.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace dubsar {

/// What the kernel tells of a device on USB.
struct HidIdentity {
  std::uint16_t vendor = 0x256f, product = 0xc635;
  std::string manufacturer = "3Dconnexion", name = "SpaceMouse Compact", serial = "SIM1";
  /// Generic Desktop, Multi-axis Controller; input report 1 of 12 bytes, feature report 2 of 6 bytes
  std::vector<std::uint8_t> descriptor{0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0x85, 0x01, 0x15, 0x00,
                                       0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x0c, 0x09, 0x01, 0x81,
                                       0x02, 0x85, 0x02, 0x95, 0x06, 0x09, 0x02, 0xb1, 0x02, 0xc0};
};

/// The node is a FIFO in packet mode, so that reports keep their boundaries; what the host sends is kept. The ioctls
/// are answered in a thread of umockdev's own.
class HidrawTestbed {
 public:
  explicit HidrawTestbed(HidIdentity identity = {});
  ~HidrawTestbed();
  HidrawTestbed(const HidrawTestbed&) = delete;
  HidrawTestbed& operator=(const HidrawTestbed&) = delete;

  void plug();  ///< a new node each time: umockdev does not give a name twice, and the kernel seldom does
  void unplug();
  /// One input report.
  bool send(std::span<const std::byte> report);
  std::vector<std::vector<std::byte>> written();
  std::vector<std::vector<std::byte>> features_set();
  /// Called in umockdev's thread with every feature report that the host sets; may send(). Set it before plug().
  void on_feature_set(std::function<void(std::span<const std::byte>)> answer) { answer_ = std::move(answer); }
  std::string node() const;             ///< "/dev/hidraw0", "/dev/hidraw1", ...
  std::string node_in_testbed() const;  ///< real path of the node, for permissions

 private:
  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  static gboolean on_write(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  std::string hid_folder() const;
  std::string description() const;

  HidIdentity identity_;
  std::function<void(std::span<const std::byte>)> answer_;
  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_;
  int plugging_ = -1;
  int fifo_ = -1;
  bool attached_ = false;
  std::mutex mutex_;
  std::vector<std::vector<std::byte>> written_, features_set_;  // guarded by mutex_
};

}  // namespace dubsar
