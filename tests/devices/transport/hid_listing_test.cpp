// Listing HID devices from a folder that looks like the kernel's. The mouse's descriptor is the one of the HID 1.11
// definition, appendix E.10.

#include "devices/transport/hid_listing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <thread>

#include "tests/core/volume/temp_folder.h"
#include "tests/devices/device_bytes.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

const char* const kBootMouse =
    "05010902a1010901a100050919012903150025019503750181029501750581010501093009311581257f750895028106c0c0";

void write(const fs::path& file, std::string_view text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

std::string as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// /sys of a test: /sys/class/hidraw holds links into /sys/devices, as on a machine.
class HidListing : public testing_tools::TempFolder {
 protected:
  HidListing() { fs::create_directories(listed()); }

  fs::path listed() const { return root_ / "class/hidraw"; }
  /// Folder of a HID device below `bus`, and its node in the list.
  fs::path add(const std::string& node, const std::string& bus, const std::string& id) {
    fs::path device = root_ / "devices" / bus / id;
    fs::create_directories(device / "hidraw" / node);
    fs::create_directory_symlink("../../../" + id, device / "hidraw" / node / "device");
    fs::create_directory_symlink(device / "hidraw" / node, listed() / node);
    return device;
  }
  fs::path add_mouse(const std::string& node) {
    fs::path device = add(node, "pci/usb1/1-1/1-1:1.1", "0003:046D:C077.000" + node.substr(6));
    write(device / "uevent",
          "DRIVER=hid-generic\nHID_ID=0003:0000046D:0000C077\nHID_NAME=Logitech USB Optical Mouse\n"
          "HID_PHYS=usb-1/input0\nHID_UNIQ=\nMODALIAS=hid:b0003\n");
    write(device / "report_descriptor", as_text(from_hex(kBootMouse)));
    write(device / "../bInterfaceNumber", "01\n");
    write(device / "../../manufacturer", "Logitech\n");
    write(device / "../../product", "USB Optical Mouse\n");
    return device;
  }
  const fs::path root_ = in("sys");
};

TEST_F(HidListing, AUsbDeviceIsToldByItsInterfaceAndByThePluggedThing) {
  add_mouse("hidraw3");
  const HidNode expected{"/dev/hidraw3", 0x046d, 0xc077, 1, 2, 1, "Logitech", "USB Optical Mouse", ""};
  EXPECT_EQ(list_hid_nodes(listed()), std::vector{expected});
}

TEST_F(HidListing, ADeviceOfAnotherBusIsToldByItsOwnFacts) {
  const fs::path device = add("hidraw0", "virtual/misc/uhid", "0005:256F:C63A.0001");
  write(device / "uevent", "HID_ID=0005:0000256F:0000C63A\nHID_NAME=SpaceMouse \xc3\xa9\tBT\nHID_UNIQ=00:1f:20:aa\n");
  write(device / "report_descriptor", as_text(from_hex("05010908a101c0")));
  const HidNode expected{"/dev/hidraw0", 0x256f, 0xc63a, 1, 8, -1, "", "SpaceMouse ???BT", "00:1f:20:aa"};
  EXPECT_EQ(list_hid_nodes(listed()), std::vector{expected});
}

TEST_F(HidListing, ADeviceThatIsGoneOrHalfThereIsLeftOutAndTheOthersStay) {
  fs::create_directory_symlink(root_ / "devices/gone/hidraw/hidraw0", listed() / "hidraw0");
  add("hidraw1", "pci/usb2/2-1/2-1:1.0", "0003:1111:2222.0001");  // no facts yet
  write(add("hidraw2", "pci/usb3/3-1/3-1:1.0", "0003:1111:2222.0002") / "uevent", "HID_ID=0003:zz\nHID_NAME=x\n");
  write(listed() / "notes", "a file where a folder is expected");
  fs::remove(add_mouse("hidraw4") / "report_descriptor");
  const auto nodes = list_hid_nodes(listed());
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes[0].path, "/dev/hidraw4");
  EXPECT_EQ(nodes[0].usage_page, 0);
  EXPECT_TRUE(list_hid_nodes(root_ / "no/such/folder").empty());
}

TEST_F(HidListing, LongNamesAreCutAndOrderIsThatOfThePaths) {
  for (const char* node : {"hidraw7", "hidraw1"})
    write(add(node, std::string("virtual/") + node, "0003:0001:0002.0001") / "uevent",
          "HID_ID=0003:00000001:00000002\nHID_NAME=" + std::string(1000, 'n') + "\n");
  const auto nodes = list_hid_nodes(listed());
  ASSERT_EQ(nodes.size(), 2U);
  EXPECT_EQ(nodes[0].path, "/dev/hidraw1");
  EXPECT_EQ(nodes[0].product, std::string(256, 'n'));
}

TEST_F(HidListing, UnpluggingWhileTheyAreListedIsNoMatter) {
  add("hidraw5", "virtual/stays", "0003:0009:0009.0009");
  write(root_ / "devices/virtual/stays/0003:0009:0009.0009/uevent", "HID_ID=0003:00000009:00000009\n");
  std::atomic<bool> stop = false;
  std::jthread plugging([&] {
    while (!stop) {
      add_mouse("hidraw3");
      fs::remove_all(root_ / "devices/pci");
      fs::remove(listed() / "hidraw3");
    }
  });
  int seen = 0;
  for (int i = 0; i < 2000 || (seen == 0 && i < 1'000'000); ++i) {
    const auto nodes = list_hid_nodes(listed());
    const bool stays = std::any_of(nodes.begin(), nodes.end(), [](const HidNode& n) { return n.vendor_id == 9; });
    ASSERT_TRUE(stays) << "round " << i;
    for (const HidNode& node : nodes) {
      ASSERT_TRUE(node.vendor_id == 9 || (node.vendor_id == 0x046d && node.product_id == 0xc077));
      seen += node.vendor_id != 9;
    }
  }
  stop = true;
  EXPECT_GT(seen, 0);
}

TEST(HidUsage, IsThatOfTheFirstCollectionAndBrokenDescriptorsHaveNone) {
  const auto usage = [](const char* bytes) { return first_usage(from_hex(bytes)); };
  EXPECT_EQ(usage(kBootMouse), (HidUsage{1, 2}));
  EXPECT_EQ(usage("0600ff0901a101c0"), (HidUsage{0xff00, 1}));
  EXPECT_EQ(usage("0b08000100a100"), (HidUsage{1, 8})) << "a usage of four bytes brings its page";
  EXPECT_EQ(usage("fe0255aabb05010908a101"), (HidUsage{1, 8})) << "a long item before it is passed over";
  EXPECT_EQ(usage("050109"), HidUsage{}) << "cut in an item";
  EXPECT_EQ(usage("fe"), HidUsage{});
  EXPECT_EQ(usage("feff00"), HidUsage{});
  EXPECT_EQ(usage("05010908"), HidUsage{}) << "no collection";
  EXPECT_EQ(usage(""), HidUsage{});
}

}  // namespace
}  // namespace dubsar
