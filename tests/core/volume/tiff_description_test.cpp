// What ImageJ, OME and tifffile write into the description of a TIFF file.

#include "core/volume/formats/tiff_description.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dubsar {
namespace {
using ::testing::HasSubstr;

TEST(TiffDescription, OmeSaysSizesAndWhatIsNoSlice) {
  const TiffDescription plain = parse_tiff_description(
      "<?xml version=\"1.0\"?><OME xmlns=\"x\"><Image ID=\"Image:0\"><Pixels ID=\"Pixels:0\" SizeX=\"96\" SizeY='64' "
      "SizeZ=\"48\" SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"50\" PhysicalSizeXUnit=\"&#181;m\" PhysicalSizeY=\"0.05\" "
      "PhysicalSizeYUnit=\"mm\" PhysicalSizeZ=\"150000\" PhysicalSizeZUnit=\"nm\"><TiffData/></Pixels></Image></OME>");
  EXPECT_FALSE(plain.several);
  EXPECT_EQ(plain.slices, 48);
  EXPECT_NEAR(plain.voxel_mm.x, 0.05, 1e-12);
  EXPECT_NEAR(plain.voxel_mm.y, 0.05, 1e-12);
  EXPECT_NEAR(plain.voxel_mm.z, 0.15, 1e-12);
  const TiffDescription unit =
      parse_tiff_description("<ome:OME><ome:Pixels SizeZ=\"2\" PhysicalSizeX = \"3\" /></ome:OME>");
  EXPECT_NEAR(unit.voxel_mm.x, 0.003, 1e-12) << "micrometres where no unit is said";
  for (const auto& [attributes, words] : std::vector<std::pair<std::string, std::string>>{
           {"SizeC=\"3\"", "3 channels"}, {"SizeT=\"2\"", "2 time points"}}) {
    const TiffDescription several = parse_tiff_description("<OME><Pixels SizeZ=\"4\" " + attributes + "/></OME>");
    EXPECT_TRUE(several.several);
    EXPECT_EQ(several.several_of, words);
  }
  EXPECT_THAT(parse_tiff_description("<OME><Pixels SizeZ=\"2\"/><Pixels SizeZ=\"2\"/></OME>").several_of,
              HasSubstr("2 images"));
}

TEST(TiffDescription, TifffileSaysItsAxes) {
  EXPECT_FALSE(parse_tiff_description(R"({"shape": [48, 64, 96]})").several);
  EXPECT_EQ(parse_tiff_description(R"({"shape": [48, 64, 96]})").images, 48);
  EXPECT_FALSE(parse_tiff_description(R"({"shape": [1, 48, 1, 64, 96], "axes": "TZCYX"})").several);
  EXPECT_EQ(parse_tiff_description(R"({"shape": [2, 48, 64, 96], "axes": "TZYX"})").several_of, "2 time points");
  EXPECT_EQ(parse_tiff_description(R"({"shape": [48, 3, 64, 96], "axes": "ZCYX"})").several_of, "3 channels");
  EXPECT_TRUE(parse_tiff_description(R"({"shape": [2, 48, 64, 96]})").several) << "nobody says which is z";
  EXPECT_FALSE(parse_tiff_description(R"({"shape": [64, 96]})").several);
  EXPECT_FALSE(parse_tiff_description("{\"shape\": broken").several);
}

TEST(TiffDescription, ImageJSaysPagesChannelsAndItsUnit) {
  const TiffDescription said =
      parse_tiff_description("ImageJ=1.53t\nimages=48\nslices=48\nunit=\\u00B5m\nspacing=-12.5\nloop=false\n");
  EXPECT_EQ(said.images, 48);
  EXPECT_FALSE(said.several);
  EXPECT_NEAR(said.unit_mm.value(), 1e-3, 1e-12);
  EXPECT_EQ(said.spacing, -12.5);
  EXPECT_EQ(parse_tiff_description("ImageJ=1\nimages=6\nchannels=3\nslices=2\n").several_of, "3 channels");
  EXPECT_EQ(parse_tiff_description("a scan of mine").images, 1);
}

// tifffile writes an array of three axes so where it is told no axes; ImageJ shows up to seven channels together.
TEST(TiffDescription, ManyChannelsWithoutSlicesAreSlices) {
  const auto said = [](int channels, const char* more) {
    return parse_tiff_description(
        fmt::format("ImageJ=1.11a\nimages={0}\nchannels={0}\nhyperstack=true\nmode=grayscale\n{1}", channels, more));
  };
  EXPECT_FALSE(said(48, "").several);
  EXPECT_EQ(said(48, "").slices, 48);
  EXPECT_EQ(said(48, "").images, 48);
  EXPECT_FALSE(said(8, "").several);
  EXPECT_TRUE(said(7, "").several);
  EXPECT_EQ(said(7, "").several_of, "7 channels");
  EXPECT_TRUE(said(48, "slices=2\n").several);
  EXPECT_TRUE(said(48, "frames=2\n").several);
}

}  // namespace
}  // namespace dubsar
