// A real client of spacenavd, Debian's libspnav, before the simulated daemon on a UNIX socket.

#include <gtest/gtest.h>
#include <spnav.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>

#include "devices/spacemouse/spacenav_server.h"
#include "devices/transport/socket_server.h"

namespace dubsar {
namespace {

/// Serves one client until it is told to end.
class Daemon {
 public:
  explicit Daemon(const std::string& path) : server_(listen_unix(path).value()), thread_([this] { serve(); }) {}
  ~Daemon() {
    over_ = true;
    thread_.join();
  }
  void say(const SpacenavEvent& event) {
    said_ = event;
    waiting_ = true;
    while (waiting_) std::this_thread::yield();
  }

 private:
  void serve() {
    std::unique_ptr<Transport> client;
    std::array<std::byte, 256> buffer;
    while (!over_) {
      if (!client && !(client = server_->accept(milliseconds(5)))) continue;
      const auto length = client->read(buffer, milliseconds(1));
      if (!length) return;
      if (const auto answer = side_.accept(std::span(buffer).first(*length)); !answer.empty()) {
        ASSERT_TRUE(client->write(answer));
      }
      if (!waiting_) continue;
      if (const auto bytes = side_.tell(said_); !bytes.empty()) {
        ASSERT_TRUE(client->write(bytes));
      }
      waiting_ = false;
    }
  }
  std::unique_ptr<StreamServer> server_;
  SpacenavServerSide side_;
  std::atomic<bool> over_{false}, waiting_{false};
  SpacenavEvent said_;
  std::thread thread_;
};

TEST(LibSpnav, OpensAsksAndHearsTheSimulatedDaemon) {
  const std::string path = ::testing::TempDir() + "dubsar_spnav_" + std::to_string(::getpid());
  ::setenv("SPNAV_SOCKET", path.c_str(), 1);
  Daemon daemon(path);
  ASSERT_EQ(spnav_open(), 0);
  EXPECT_EQ(spnav_protocol(), 1);
  EXPECT_EQ(spnav_client_name("a name of more than twenty-four bytes"), 0);
  std::array<char, 64> name{};
  EXPECT_EQ(spnav_dev_name(name.data(), name.size()), 20);
  EXPECT_STREQ(name.data(), "simulated SpaceMouse");
  EXPECT_EQ(spnav_dev_axes(), 6);
  EXPECT_EQ(spnav_dev_buttons(), 2);
  unsigned vendor = 0, product = 0;
  EXPECT_EQ(spnav_dev_usbid(&vendor, &product), 0);
  EXPECT_EQ(vendor, 0x256fU);
  EXPECT_EQ(product, 0xc635U);
  EXPECT_EQ(spnav_dev_type(), SPNAV_DEV_SMCOMP);
  EXPECT_EQ(spnav_sensitivity(0.5), 0);
  EXPECT_EQ(spnav_cfg_get_sens(), 1.0F);
  EXPECT_EQ(spnav_cfg_set_sens(2.0F), 0);
  EXPECT_EQ(spnav_cfg_get_sens(), 2.0F);
  EXPECT_EQ(spnav_cfg_get_axismap(4), 4);
  EXPECT_EQ(spnav_cfg_set_deadzone(3, 9), 0);
  EXPECT_EQ(spnav_cfg_get_deadzone(3), 9);
  EXPECT_EQ(spnav_cfg_reset(), 0);
  EXPECT_EQ(spnav_cfg_get_sens(), 1.0F);

  SpacenavEvent motion;
  motion.translation = {500, -20, 3};
  motion.rotation = {-7, 8, -500};
  motion.period_ms = 16;
  daemon.say(motion);
  spnav_event heard{};
  ASSERT_EQ(spnav_wait_event(&heard), SPNAV_EVENT_MOTION);
  EXPECT_EQ(heard.motion.x, 500);
  EXPECT_EQ(heard.motion.y, -20);
  EXPECT_EQ(heard.motion.rz, -500);
  EXPECT_EQ(heard.motion.period, 16U);
  SpacenavEvent press;
  press.kind = SpacenavEvent::Kind::kPress;
  press.button = 1;
  daemon.say(press);
  ASSERT_EQ(spnav_wait_event(&heard), SPNAV_EVENT_BUTTON);
  EXPECT_EQ(heard.button.press, 1);
  EXPECT_EQ(heard.button.bnum, 1);
  SpacenavEvent gone;
  gone.kind = SpacenavEvent::Kind::kDevice;
  gone.removed = true;
  daemon.say(gone);
  ASSERT_EQ(spnav_wait_event(&heard), SPNAV_EVENT_DEV);
  EXPECT_EQ(heard.dev.op, SPNAV_DEV_RM);
  EXPECT_EQ(spnav_evmask(SPNAV_EVMASK_BUTTON), 0);
  daemon.say(motion);
  press.kind = SpacenavEvent::Kind::kRelease;
  daemon.say(press);
  ASSERT_EQ(spnav_wait_event(&heard), SPNAV_EVENT_BUTTON);  // the motion was masked
  EXPECT_EQ(heard.button.press, 0);
  EXPECT_EQ(spnav_close(), 0);
}

}  // namespace
}  // namespace dubsar
