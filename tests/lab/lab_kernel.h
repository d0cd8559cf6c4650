#pragma once
// What the tests of the device lab share: they make virtual devices, so they run in the lab's own kernel and
// nowhere else.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "core/base/system/clock.h"
#include "devices/transport/transport.h"

namespace dubsar::lab {

/// True in the kernel that run_in_kernel.sh has booted (it says so on its command line).
bool inside();

/// File descriptors that this process has open.
int open_descriptors();

/// Threads of this process.
int threads();

/// How long ago the kernel made this device node; very long when it is not there.
double seconds_since_made(const std::string& node);

/// The kernel's camera driver (uvcvideo) has made a video node of a USB device with these ids.
bool is_a_camera(std::uint16_t vendor_id, std::uint16_t product_id);

/// No device of an earlier test is still about to leave: no HID device, nothing on the USB/IP buses.
bool all_unplugged();

/// Runs `work` in a child process that is user and group "nobody", and returns what it returns; "" when it
/// crashed.
std::string as_nobody(const std::function<std::string()>& work);

/// Asks every millisecond, for at most `limit`.
template <class Condition>
bool eventually(const Condition& condition, milliseconds limit = milliseconds(20'000)) {
  const auto until = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return true;
}

class Lab : public testing::Test {
 protected:
  void SetUp() override {
    if (!inside()) GTEST_SKIP() << "runs only in the device lab's kernel: ./do lab";
    ASSERT_TRUE(eventually(all_unplugged));
    descriptors_ = open_descriptors();
  }
  /// So many descriptors were open when the test began.
  int descriptors_at_start() const { return descriptors_; }
  SteadyClock clock_;

 private:
  int descriptors_ = 0;
};

}  // namespace dubsar::lab
