#pragma once
// A touch panel in a simulated /sys and /dev (umockdev), for the unmodified transport. Run with libumockdev-preload.

#include <umockdev.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace dubsar {

/// What the kernel tells of an input device in /sys.
struct InputIdentity {
  std::string name = "Simulated Touchscreen";
  std::uint16_t vendor = 0x0eef, product = 0x0001;
  std::string properties = "2";          ///< INPUT_PROP_DIRECT
  std::string axes = "260800000000003";  ///< X, Y; and ABS_MT_SLOT, POSITION_X, POSITION_Y, TRACKING_ID
};

/// The node is a FIFO that whole events are written to; the ioctls are answered in a thread of umockdev's own from what
/// the test says of the slots.
class EvdevTestbed {
 public:
  static constexpr int kSlots = 10;
  EvdevTestbed();
  ~EvdevTestbed();
  EvdevTestbed(const EvdevTestbed&) = delete;
  EvdevTestbed& operator=(const EvdevTestbed&) = delete;

  void plug(const InputIdentity& identity = {});  ///< a new node each time
  void unplug();
  /// One event.
  bool send(int type, int code, int value);
  /// What the ioctls say of a slot from now on.
  void set_slot(int slot, int id, int x, int y);
  void hold_elsewhere(bool held);  ///< another program has grabbed it
  int grabs();                     ///< by who opened it, so far
  std::string node() const;
  std::string node_in_testbed() const;

 private:
  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  std::string folder() const;

  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_;
  int plugging_ = -1, fifo_ = -1;
  std::mutex mutex_;
  std::vector<int> id_, x_, y_;  // guarded by mutex_
  bool held_elsewhere_ = false;  // guarded by mutex_
  int grabs_ = 0;                // guarded by mutex_
};

}  // namespace dubsar
