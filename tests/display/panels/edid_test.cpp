#include "display/panels/edid.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "display/panels/panel_set.h"
#include "tests/display/panels/made_edid.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;
using test::made_edid;
using test::MadeEdid;

Result<Edid> parse(std::string_view text) { return parse_edid(std::as_bytes(std::span(text.data(), text.size()))); }

TEST(Edid, TellsWhoMadeTheMonitorItsSizeNameAndSerial) {
  const auto edid = parse(made_edid({.manufacturer = "DEL",
                                     .product = 16711,
                                     .width_px = 1536,
                                     .height_px = 2048,
                                     .width_mm = 698,
                                     .height_mm = 393,
                                     .name = "UP3218K",
                                     .serial = "ABC123"}));
  ASSERT_TRUE(edid) << edid.error().message;
  EXPECT_EQ(*edid, (Edid{"DEL", 16711, 42, "UP3218K", "ABC123", 1536, 2048, 698, 393, 2023}));
  EXPECT_EQ(parse(made_edid({.name = "LKG-PORTRAIT1"}))->name, "LKG-PORTRAIT1") << "thirteen characters need no end";
}

TEST(Edid, EveryTruncationEveryWrongByteAndExtraBytes) {
  const std::string good = made_edid({});
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_EQ(parse(good.substr(0, length)).error().kind, ErrorKind::kBadData) << length;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    EXPECT_EQ(parse(bad).error().kind, ErrorKind::kBadData) << "byte " << i;
  }
  EXPECT_EQ(*parse(good + std::string(128, '\x7f')), *parse(good)) << "extension blocks are not read";
  std::string strange = good;
  strange[8] = '\0', strange[9] = '\0', strange[127] = static_cast<char>(strange[127] + good[8] + good[9]);
  EXPECT_NE(parse(strange).error().message.find("three letters"), std::string::npos);
}

class Connectors : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  void connect(const char* name, const std::string& bytes) {
    fs::create_directories(folder_ / name);
    std::ofstream(folder_ / name / "edid", std::ios::binary) << bytes;
  }
  fs::path folder_ = fs::temp_directory_path() / ("dubsar_drm_" + std::to_string(::getpid()));
};

TEST_F(Connectors, AreReadFromTheKernelsTree) {
  connect("card0-eDP-1", made_edid({.name = "INTERNAL"}));
  connect("card0-DP-1", "");
  connect("card1-HDMI-A-1", std::string(128, 'x'));
  fs::create_directories(folder_ / "card0");
  fs::create_directories(folder_ / "renderD128");
  const auto found = read_connected_edids(folder_);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].connector, "eDP-1");
  EXPECT_EQ(found[0].edid->name, "INTERNAL");
  EXPECT_EQ(found[1].connector, "HDMI-A-1");
  EXPECT_FALSE(found[1].edid);
  EXPECT_TRUE(read_connected_edids(folder_ / "nowhere").empty());
}

TEST_F(Connectors, MonitorsFindTheirsByNameAndBySize) {
  connect("card0-DP-1", made_edid({.name = "A"}));
  connect("card0-HDMI-A-1", made_edid({.width_px = 1536, .height_px = 2048, .name = "B"}));
  connect("card0-HDMI-A-2", made_edid({.width_px = 1920, .height_px = 1080, .name = "C"}));
  const auto found = read_connected_edids(folder_);
  const auto name_of = [&](std::string_view name, int width, int height) {
    const Edid* const edid = edid_of({.name = std::string(name), .width_px = width, .height_px = height}, found);
    return edid == nullptr ? "none" : edid->name;
  };
  EXPECT_EQ(name_of("DP-1", 3840, 2160), "A");
  EXPECT_EQ(name_of("HDMI-1", 1536, 2048), "B") << "X and the kernel spell it differently";
  EXPECT_EQ(name_of("HDMI-1", 2048, 1536), "B") << "turned";
  EXPECT_EQ(name_of("HDMI-A-1", 1920, 1080), "C") << "a driver that counts from 0: the size tells";
  EXPECT_EQ(name_of("Acer Technologies ASV15", 3840, 2160), "A") << "Wayland gives makers' names";
  EXPECT_EQ(name_of("DP-1", 1280, 720), "A") << "in another mode";
  EXPECT_EQ(name_of("DP-9", 1280, 720), "none");
}

TEST(PanelsOfEdid, LookingGlassesByNameAndSizeTrackedOnesByMakerAndProduct) {
  const PanelSet& panels = built_in_panels();
  const auto names = [&](const MadeEdid& of) {
    std::string out;
    for (const PanelProfile* p : panels_of_edid(panels, parse(made_edid(of)).value())) out += p->name + " ";
    return out;
  };
  EXPECT_EQ(names({.manufacturer = "LKG",
                   .width_px = 1440,
                   .height_px = 2560,
                   .width_mm = 74,
                   .height_mm = 132,
                   .name = "LKG-E01234"}),
            "looking-glass-go ");
  EXPECT_EQ(names({.width_px = 1536,
                   .height_px = 2048,
                   .width_mm = 120,
                   .height_mm = 160,
                   .name = "LKG",
                   .serial = "LKG-F00001"}),
            "looking-glass-kiosk ");
  EXPECT_EQ(names({.width_px = 1536, .height_px = 2048, .width_mm = 120, .height_mm = 160, .name = "LKG"}),
            "looking-glass-portrait looking-glass-kiosk ");
  EXPECT_EQ(names({.width_px = 1536, .height_px = 2048, .width_mm = 120, .height_mm = 160, .name = "iPad"}), "");
  EXPECT_EQ(names({.manufacturer = "ACR", .product = 1}), "spatiallabs-15.6 ");
  EXPECT_EQ(names({.manufacturer = "ACR", .product = 7}), "");
  EXPECT_EQ(names({.manufacturer = "ACR", .product = 1, .width_mm = 600, .height_mm = 340}), "")
      << "27 inches are another panel";
  EXPECT_EQ(names({.manufacturer = "DEL", .product = 16711, .width_px = 3840, .height_px = 2160}), "");
}

}  // namespace
}  // namespace dubsar
