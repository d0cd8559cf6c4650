// Every bad input has its sentence and its exit code.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>
#include <utility>

#include "core/hdf5/hdf5_file.h"
#include "core/hdf5/hdf5_filters.h"
#include "core/hdf5/hdf5_writer.h"
#include "core/volume/formats/import.h"
#include "tests/core/volume/hdf5_fixture.h"
#include "tests/core/volume/temp_folder.h"

namespace dubsar {
namespace {
using ::testing::HasSubstr;
using testing_tools::Hdf5Fixture;
using testing_tools::Packing;

class ImportRefusal : public testing_tools::TempFolder {
 protected:
  Error refusal(const std::string& dataset = "", const std::function<void(ImportOptions&)>& change = {}) {
    ImportOptions options;
    options.path = in("a.h5");
    options.dataset = dataset;
    if (change) change(options);
    auto volume = open_volume(options);
    if (volume) return {ErrorKind::kInternal, "it was opened"};
    return volume.error();
  }
  void expect(const Error& error, ErrorKind kind, std::initializer_list<const char*> parts) {
    EXPECT_EQ(error.kind, kind) << error.message;
    for (const char* part : parts) EXPECT_THAT(error.message, HasSubstr(part));
    EXPECT_EQ(error.message.find('\n'), std::string::npos) << "more than one line";
  }
  static std::vector<double> ones(std::size_t count) { return std::vector<double>(count, 1.0); }
};

constexpr auto kLittle = ByteOrder::kLittle;

TEST_F(ImportRefusal, Projections) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/exchange/data", {4, 5, 6}, ones(120));
    file.array("/exchange/theta", {4}, ones(4));
  }
  expect(refusal(), ErrorKind::kBadData,
         {"\"/exchange/data\" holds projections", "\"/exchange/theta\"", "reconstruct it first"});
  expect(refusal("/exchange/data"), ErrorKind::kBadData, {"holds projections"});
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/entry/instrument/detector/data", {4, 5, 6}, ones(120));
    file.array("/entry/instrument/detector/image_key", {4}, ones(4));
  }
  expect(refusal(), ErrorKind::kBadData, {"holds projections", "image_key"});
  {
    Hdf5Fixture file(in("a.h5"));
    file.text("/entry/definition", "NXtomo");
    file.array("/entry/data/data", {4, 5, 6}, ones(120));
  }
  expect(refusal(), ErrorKind::kBadData, {"holds projections", "NXtomo"});
}

TEST_F(ImportRefusal, AReconstructionBesideThetaIsNone) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/exchange/data", {4, 5, 6}, ones(120));
    file.array("/exchange/theta", {4}, ones(4));
    file.attribute("/exchange/data", "description", "Reconstructed");
  }
  EXPECT_EQ(refusal().message, "it was opened");
}

TEST_F(ImportRefusal, PicturesAndWrongRanks) {
  { Hdf5Fixture(in("a.h5")).array("/image", {20, 30}, ones(600)); }
  expect(refusal(), ErrorKind::kBadData, {"holds no volume", "\"/image\" is 20x30 float32 of rank 2", "rank 3"});
  expect(refusal("/image"), ErrorKind::kBadData, {"has rank 2 (20x30 float32), expected 3", "folder of TIFF slices"});
  { Hdf5Fixture(in("a.h5")).array("/one", {1, 20, 30}, ones(600)); }
  expect(refusal("/one"), ErrorKind::kBadData, {"a single picture"});
  { Hdf5Fixture(in("a.h5")).array("/series", {2, 3, 4, 5}, ones(120)); }
  expect(refusal("/series"), ErrorKind::kBadData, {"has rank 4"});
  { Hdf5Fixture(in("a.h5")).group("/empty"); }
  expect(refusal(), ErrorKind::kBadData, {"holds no dataset"});
}

TEST_F(ImportRefusal, CompoundStringAndOtherTypes) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.compound("/complex", {4, 5, 6});
    file.strings("/names", {4, 5, 6});
  }
  expect(refusal("/complex"), ErrorKind::kBadData, {"the type compound, expected integers or floats"});
  expect(refusal("/names"), ErrorKind::kBadData, {"the type string, expected integers or floats"});
  expect(refusal(), ErrorKind::kBadData, {"holds no volume"});
}

TEST_F(ImportRefusal, TwoVolumesOfSimilarSize) {
  {
    Hdf5Fixture file(in("a.h5"));
    file.array("/first", {4, 5, 6}, ones(120));
    file.array("/second", {3, 5, 6}, ones(90));
    file.array("/small", {3, 3, 3}, ones(27));
  }
  expect(refusal(), ErrorKind::kBadData,
         {"several volumes of similar size", "name its dataset", "/first (4x5x6 float32)", "/second (3x5x6"});
  EXPECT_EQ(refusal().message.find("/small"), std::string::npos);
  EXPECT_EQ(refusal("/second").message, "it was opened");
}

TEST_F(ImportRefusal, EmptyAndNeverWritten) {
  { Hdf5Fixture(in("a.h5")).array("/none", {0, 5, 6}, {}); }
  expect(refusal("/none"), ErrorKind::kBadData, {"is empty (0x5x6 float32)"});
  { Hdf5Fixture(in("a.h5")).unwritten("/v", {1944, 3072, 3072}, {64, 64, 64}); }
  expect(refusal(), ErrorKind::kBadData, {"nothing was ever written"});
  { Hdf5Fixture(in("a.h5")).array("/late", {4, 5, 6}, {}); }
  expect(refusal(), ErrorKind::kBadData, {"nothing was ever written"});
  { Hdf5Fixture(in("a.h5")).half_written("/v", {8, 8, 8}, {2, 8, 8}, 5); }
  expect(refusal(), ErrorKind::kBadData, {"1 of 4 chunks are missing", "if sparse data are allowed"});
  EXPECT_EQ(refusal("", [](ImportOptions& o) { o.allow_sparse = true; }).message, "it was opened");
}

TEST_F(ImportRefusal, SizesThatCannotBe) {
  { Hdf5Fixture(in("a.h5")).unwritten("/v", {65536, 4, 4}, {4, 4, 4}); }
  expect(refusal("/v"), ErrorKind::kBadData, {"dimension 65536 found, expected at most 65535"});
  { Hdf5Fixture(in("a.h5")).unwritten("/v", {60000, 60000, 60000}, {64, 64, 64}); }
  expect(refusal("/v"), ErrorKind::kBadData, {"more than 2^36"});
  { Hdf5Fixture(in("a.h5")).unwritten("/v", {1ULL << 40, 1ULL << 20, 4}, {64, 64, 4}); }
  expect(refusal("/v"), ErrorKind::kBadData, {"expected at most 65535"});
}

TEST_F(ImportRefusal, ACompressionBombUnlessItIsTrusted) {
  auto writer = Hdf5Writer::create(in("a.h5"));
  ASSERT_TRUE(writer);
  Hdf5Storage storage{.type = ScalarType::kU8, .dims = {80, 1024, 1024}, .chunk = {80, 1024, 1024}, .deflate = 9};
  ASSERT_TRUE(writer->write<std::uint8_t>("/v", storage, std::vector<std::uint8_t>(80 << 20)));
  ASSERT_TRUE(writer->commit());
  expect(refusal(), ErrorKind::kBadData, {"expected at most 250:1", "say that it is trusted"});
  EXPECT_EQ(refusal("", [](ImportOptions& o) { o.trust = true; }).message, "it was opened");
}

TEST_F(ImportRefusal, MissingAndUnsafeFilters) {
  const auto with = [&](int id) {
    Hdf5Fixture(in("a.h5"))
        .array("/v", ScalarType::kF32, kLittle, {4, 4, 4}, ones(64), {.chunk = {2, 2, 2}, .foreign_filter = id});
  };
  const auto folder = set_hdf5_plugin_folder(in("no-plugins"));
  for (const auto& [id, name, package] :
       {std::tuple(307, "bzip2", "hdf5-filter-plugin"), std::tuple(32004, "lz4", "hdf5-filter-plugin"),
        std::tuple(32008, "bitshuffle", "bitshuffle"), std::tuple(32001, "blosc", "hdf5-filter-plugin-blosc-serial"),
        std::tuple(32013, "zfp", "hdf5-filter-plugin-zfp-serial")}) {
    with(id);
    expect(refusal(), ErrorKind::kBadData,
           {fmt::format("filter {} ({}), which is missing; apt install {}", id, name, package).c_str()});
  }
  set_hdf5_plugin_folder(folder);
  with(32015);
  expect(refusal(), ErrorKind::kBadData, {"filter 32015 (zstd), for which there is no Debian package"});
  with(32026);
  expect(refusal(), ErrorKind::kBadData, {"filter 32026 (blosc2), for which there is no Debian package"});
  with(40000);
  expect(refusal(), ErrorKind::kBadData, {"filter 40000 (foreign), for which there is no Debian package"});
  {
    Hdf5Fixture(in("a.h5"))
        .array("/v", ScalarType::kI16, kLittle, {4, 4, 4}, ones(64), {.chunk = {2, 2, 2}, .nbit = true});
  }
  expect(refusal(), ErrorKind::kBadData, {"filter 5 (n-bit)", "h5repack"});
}

TEST_F(ImportRefusal, ExternalStorageUnlessItsFolderIsAllowed) {
  std::filesystem::create_directories(in("raw"));
  std::string raw(64, '\0');
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = static_cast<char>(i);
  write_bytes(in("raw/v.raw"), "head" + raw);
  { Hdf5Fixture(in("a.h5")).external_storage("/v", {4, 4, 4}, "raw/v.raw", 4); }
  expect(refusal(), ErrorKind::kBadData, {"lies in another file \"raw/v.raw\"", "its folder is allowed"});
  ImportOptions options;
  options.path = in("a.h5");
  options.allow_external = in("raw");
  const auto volume = open_volume(options);
  ASSERT_TRUE(volume) << volume.error().message;
  std::vector<float> out(64);
  ASSERT_TRUE((*volume)->read(0, 4, out));
  EXPECT_EQ(out[0], 0.0F);
  EXPECT_EQ(out[63], 63.0F);

  { Hdf5Fixture(in("a.h5")).external_storage("/v", {2, 2, 2}, "/etc/debian_version", 0); }
  const auto allow = [&](ImportOptions& o) { o.allow_external = in("raw"); };
  expect(refusal("", allow), ErrorKind::kBadData, {"outside the allowed folder"});
  std::filesystem::create_symlink("/etc/debian_version", in("raw/link"));
  { Hdf5Fixture(in("a.h5")).external_storage("/v", {2, 2, 2}, "raw/link", 0); }
  expect(refusal("", allow), ErrorKind::kBadData, {"outside the allowed folder"});
}

TEST_F(ImportRefusal, ExternalLinksUnlessTheirFolderIsAllowed) {
  std::filesystem::create_directories(in("parts"));
  { Hdf5Fixture(in("parts/b.h5")).array("/group/v", {4, 5, 6}, ones(120)); }
  {
    Hdf5Fixture file(in("a.h5"));
    file.external_link("/entry/data", "parts/b.h5", "/group");
    file.soft_link("/detour", "/entry/data");
  }
  for (const char* path : {"", "/entry/data/v", "/detour/v"})
    expect(refusal(path), ErrorKind::kBadData, {"lies in another file \"parts/b.h5\"", "its folder is allowed"});
  ImportOptions options;
  options.path = in("a.h5");
  options.dataset = "/detour/v";
  options.allow_external = in("parts");
  const auto volume = open_volume(options);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ((*volume)->dims(), (Dims{6, 5, 4}));
  options.allow_external = in("elsewhere");
  EXPECT_EQ(open_volume(options).error().kind, ErrorKind::kNoInput);
  std::filesystem::create_directories(in("elsewhere"));
  expect(open_volume(options).error(), ErrorKind::kBadData, {"outside the allowed folder"});
}

TEST_F(ImportRefusal, VirtualDatasetsUnlessTheirFolderIsAllowed) {
  std::filesystem::create_directories(in("parts"));
  { Hdf5Fixture(in("parts/b.h5")).array("/v", {4, 5, 6}, ones(120)); }
  { Hdf5Fixture(in("a.h5")).virtual_dataset("/v", {4, 5, 6}, "parts/b.h5", "/v"); }
  expect(refusal(), ErrorKind::kBadData,
         {"virtual dataset \"/v\" lies in another file \"parts/b.h5\"", "its folder is allowed"});
  ImportOptions options;
  options.path = in("a.h5");
  options.allow_external = in("parts");
  {
    const auto volume = open_volume(options);
    ASSERT_TRUE(volume) << volume.error().message;
    std::vector<float> out(120);
    ASSERT_TRUE((*volume)->read(0, 4, out));
    EXPECT_EQ(out, std::vector<float>(120, 1.0F));
  }
  { Hdf5Fixture(in("parts/b.h5")).external_storage("/v", {4, 5, 6}, "/etc/debian_version", 0); }
  expect(refusal("", [&](ImportOptions& o) { o.allow_external = in("parts"); }), ErrorKind::kBadData,
         {"refers to further files"});
}

TEST_F(ImportRefusal, MissingDatasetNamesWhatIsThere) {
  { Hdf5Fixture(in("a.h5")).array("/there", {4, 5, 6}, ones(120)); }
  expect(refusal("/absent"), ErrorKind::kBadData, {"\"/absent\" is not in", "expected one of: /there"});
}

TEST_F(ImportRefusal, CropAndStrideThatLeaveNothing) {
  { Hdf5Fixture(in("a.h5")).array("/v", {4, 5, 6}, ones(120)); }
  const auto crop = [&](const char* text) {
    return refusal("", [&](ImportOptions& o) { o.crop = *parse_crop(text); });
  };
  expect(crop("0:7,:,:"), ErrorKind::kUsage, {"crop 0:7 along x found, expected a part of 0:6"});
  expect(crop(":,:,9:"), ErrorKind::kUsage, {"along z"});
  expect(crop(":,2:3,:"), ErrorKind::kUsage, {"leaves 1 voxels along y, expected at least 2"});
  expect(refusal("", [](ImportOptions& o) { o.stride = {1, 1, 4}; }), ErrorKind::kUsage, {"leaves 1 voxels along z"});
}

TEST_F(ImportRefusal, OptionsThatAreNotUnderstood) {
  for (const char* text : {"", "1:2", "1:2,3:4", "2:1,:,:", "a:b,:,:", "-1:4,:,:", "0:4,:,:,:"})
    EXPECT_FALSE(parse_crop(text)) << text;
  for (const char* text : {"", "0", "1,2", "1,0,1", "x", "-2"}) EXPECT_FALSE(parse_stride(text)) << text;
  for (const char* text : {"", "10x10", "10x0x10", "10x10x10x10", "axbxc"}) EXPECT_FALSE(parse_dims(text)) << text;
  for (const char* text : {"", "38", "0um", "-1mm", "1mm,2mm"}) EXPECT_FALSE(parse_voxel_size(text)) << text;
  EXPECT_EQ(parse_voxel_size("10um,20um,0.03mm")->z, 0.03);
}

TEST_F(ImportRefusal, WhatIsNoRegularFile) {
  const auto at = [&](const std::filesystem::path& path) {
    return refusal("", [&](ImportOptions& o) { o.path = path; });
  };
  expect(at(in("absent.h5")), ErrorKind::kNoInput, {"absent.h5", "No such file"});
  expect(at(folder()), ErrorKind::kBadData, {"holds no TIFF files"});
  ASSERT_EQ(::mkfifo(in("pipe").c_str(), 0600), 0);
  expect(at(in("pipe")), ErrorKind::kBadData, {"a pipe, socket or device, expected a regular file"});
  write_bytes(in("empty"), "");
  expect(at(in("empty")), ErrorKind::kBadData, {"is empty"});
  write_bytes(in("text"), "this is not a volume");
  expect(at(in("text")), ErrorKind::kBadData, {"no known format", "its size and number type"});
  write_bytes(in("picture.h5"), "\x89PNG\r\n\x1a\nxxxxxxxx");
  expect(at(in("picture.h5")), ErrorKind::kBadData, {"a PNG picture"});
  if (::geteuid() != 0) {
    write_bytes(in("secret"), "x");
    ::chmod(in("secret").c_str(), 0);
    expect(at(in("secret")), ErrorKind::kPermission, {"Permission denied"});
  }
}

TEST_F(ImportRefusal, EveryTruncationIsRefusedOrReadWhole) {
  std::vector<double> values(5 * 6 * 7);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  for (const Packing& packing : {Packing{}, Packing{.chunk = {2, 3, 4}, .deflate = 5, .shuffle = true}}) {
    { Hdf5Fixture(in("whole.h5")).array("/v", ScalarType::kI16, kLittle, {5, 6, 7}, values, packing); }
    const std::string bytes = bytes_of(in("whole.h5"));
    int opened = 0;
    for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 300) {
      write_bytes(in("a.h5"), bytes.substr(0, length));
      ImportOptions options;
      options.path = in("a.h5");
      const auto volume = open_volume(options);
      if (!volume) {
        EXPECT_EQ(volume.error().kind, ErrorKind::kBadData) << length << ": " << volume.error().message;
        continue;
      }
      ++opened;
      std::vector<float> out(values.size());
      if ((*volume)->read(0, 5, out)) {
        EXPECT_EQ(out.back(), 209.0F) << length;
      }
    }
    EXPECT_EQ(opened, 0) << "the library checks the end of the file";
  }
}

}  // namespace
}  // namespace dubsar
