#include "core/hdf5/hdf5_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>

#include "core/hdf5/hdf5_writer.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

class Hdf5Files : public testing::Test {
 protected:
  Hdf5Files() { fs::create_directories(folder_); }
  ~Hdf5Files() override { fs::remove_all(folder_); }
  fs::path in(const std::string& name) const { return folder_ / name; }
  static std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  fs::path folder_ =
      fs::temp_directory_path() /
      fmt::format("dubsar-hdf5-{}-{}", ::getpid(), testing::UnitTest::GetInstance()->current_test_info()->name());
};

std::vector<float> ramp(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(i) * 0.5F - 7.0F;
  return values;
}

Result<void> write_sample(const fs::path& path) {
  DUBSAR_ASSIGN(Hdf5Writer writer, Hdf5Writer::create(path));
  Hdf5Storage plain;
  plain.dims = {4, 3, 5};
  DUBSAR_TRY(writer.create_dataset("/entry/data/data", plain));
  const auto values = ramp(60);
  for (std::uint64_t z = 0; z < 4; z += 2)
    DUBSAR_TRY(writer.write_slab<float>("/entry/data/data", z, std::span(values).subspan(z * 15, 30)));
  Hdf5Storage packed = plain;
  packed.chunk = {2, 2, 4};
  packed.deflate = 4;
  packed.shuffle = true;
  packed.order = ByteOrder::kBig;
  DUBSAR_TRY(writer.write<float>("/packed", packed, values));
  DUBSAR_TRY(writer.set_attribute("/", "default", "entry"));
  DUBSAR_TRY(writer.set_attribute("/entry/data/data", "voxel_size", 0.038));
  const std::vector<std::string> axes{"z", "y", "x"};
  DUBSAR_TRY(writer.set_attribute("/entry/data", "axes", axes));
  const std::vector<std::string> columns{"x", "depth_mm"};
  const std::vector<double> table{1, 2, 3, 4, 5, 6};
  DUBSAR_TRY(writer.write_table("/wedges", columns, table));
  return writer.commit();
}

TEST_F(Hdf5Files, WhatWasWrittenIsReadBack) {
  const auto written = write_sample(in("a.h5"));
  ASSERT_TRUE(written) << written.error().message;
  const auto file = Hdf5File::open(in("a.h5"));
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->string("/", "default"), "entry");
  EXPECT_EQ(file->numbers("/entry/data/data", "voxel_size"), std::vector<double>{0.038});
  EXPECT_EQ(file->strings("/entry/data", "axes"), (std::vector<std::string>{"z", "y", "x"}));
  EXPECT_EQ(file->number_dataset("/wedges"), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file->strings("/wedges", "columns"), (std::vector<std::string>{"x", "depth_mm"}));
  EXPECT_EQ(file->numbers("/", "absent"), std::nullopt);
  EXPECT_EQ(file->numbers("/", "default"), std::nullopt) << "a string is not a number";

  const auto values = ramp(60);
  for (const char* path : {"/entry/data/data", "/packed"}) {
    const auto dataset = file->open_dataset(path);
    ASSERT_TRUE(dataset) << dataset.error().message;
    EXPECT_EQ(dataset->info().dims, (std::vector<std::uint64_t>{4, 3, 5}));
    EXPECT_EQ(dataset->info().type_text, "float32");
    const std::vector<std::uint64_t> offset{1, 0, 2}, count{2, 3, 3};
    std::vector<double> box(18);
    ASSERT_TRUE(dataset->read_doubles(offset, count, box));
    for (std::size_t i = 0; i < 18; ++i) {
      const std::size_t z = 1 + i / 9, y = i / 3 % 3, x = 2 + i % 3;
      EXPECT_EQ(box[i], static_cast<double>(values[(z * 3 + y) * 5 + x])) << path << " " << i;
    }
  }
  const auto plain = file->inspect("/entry/data/data");
  const auto packed = file->inspect("/packed");
  ASSERT_TRUE(plain && packed);
  EXPECT_EQ(plain->layout, Hdf5Layout::kContiguous);
  EXPECT_GT(plain->file_offset, 0);
  EXPECT_EQ(plain->storage_bytes, 240u);
  EXPECT_EQ(packed->layout, Hdf5Layout::kChunked);
  EXPECT_EQ(packed->chunk, (std::vector<std::uint64_t>{2, 2, 4}));
  EXPECT_EQ(packed->order, ByteOrder::kBig);
  ASSERT_EQ(packed->filters.size(), 2u);
  EXPECT_EQ(packed->filters[0].id, 2);
  EXPECT_EQ(packed->filters[1].id, 1);
}

// The library reads what our threads compressed: whole layers of chunks that reach beyond the dataset on all sides, and
// slabs that are no whole layers, which go through the library.
TEST_F(Hdf5Files, TheLibraryReadsChunksThatWereCompressedByThreads) {
  constexpr std::uint64_t kZ = 11, kY = 21, kX = 35;
  const auto values = ramp(kZ * kY * kX);
  const auto whole = std::as_bytes(std::span(values));
  for (const bool shuffle : {false, true}) {
    for (const std::vector<std::uint64_t>& slabs : {std::vector<std::uint64_t>{11}, {4, 4, 3}, {8, 3}, {3, 5, 3}}) {
      auto writer = Hdf5Writer::create(in("layers.h5"));
      ASSERT_TRUE(writer);
      ASSERT_TRUE(writer->create_dataset(
          "/data", {.dims = {kZ, kY, kX}, .chunk = {4, 8, 16}, .deflate = 1, .shuffle = shuffle}));
      std::uint64_t z = 0;
      for (const std::uint64_t height : slabs) {
        ASSERT_TRUE(writer->write_slab<float>("/data", z, std::span(values).subspan(z * kY * kX, height * kY * kX)));
        z += height;
      }
      ASSERT_TRUE(writer->commit());
      const auto file = Hdf5File::open(in("layers.h5"));
      ASSERT_TRUE(file);
      const auto dataset = file->open_dataset("/data");
      ASSERT_TRUE(dataset);
      std::vector<std::byte> read(whole.size());
      const std::vector<std::uint64_t> offset{0, 0, 0}, count{kZ, kY, kX};
      const auto done = dataset->read_stored(offset, count, read);
      ASSERT_TRUE(done) << done.error().message;
      EXPECT_TRUE(std::equal(read.begin(), read.end(), whole.begin())) << slabs.size() << " slabs";
      EXPECT_LT(dataset->info().storage_bytes, whole.size());
    }
  }
}

TEST_F(Hdf5Files, TheSameCallsGiveTheSameBytes) {
  ASSERT_TRUE(write_sample(in("a.h5")));
  ::sleep(1);  // the resolution of HDF5's time stamps
  ASSERT_TRUE(write_sample(in("b.h5")));
  EXPECT_EQ(bytes_of(in("a.h5")), bytes_of(in("b.h5")));
}

TEST_F(Hdf5Files, AnAbandonedWriterLeavesTheOldFile) {
  ASSERT_TRUE(write_sample(in("a.h5")));
  const std::string before = bytes_of(in("a.h5"));
  {
    auto writer = Hdf5Writer::create(in("a.h5"));
    ASSERT_TRUE(writer);
    Hdf5Storage storage;
    storage.dims = {10, 10, 10};
    ASSERT_TRUE(writer->create_dataset("/data", storage));
  }
  EXPECT_EQ(bytes_of(in("a.h5")), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(in("a.h5").parent_path()), {}), 1) << "a temporary file was left";
}

// Everything that a file can ask for in texts: each may be short, and all together more than there is memory for.
TEST_F(Hdf5Files, VariableLengthStringsHaveALimit) {
  const std::vector<std::string> many(3000, std::string(1000, 'x')), few(16, std::string(1000, 'y'));
  {
    auto writer = Hdf5Writer::create(in("a.h5"));
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->set_attribute("/", "many", many));
    ASSERT_TRUE(writer->set_attribute("/", "long", std::string((1 << 16) + 1, 'z')));
    ASSERT_TRUE(writer->set_attribute("/", "few", few));
    ASSERT_TRUE(writer->set_attribute("/", "most", std::string(1 << 16, 'z')));
    ASSERT_TRUE(writer->commit());
  }
  const auto file = Hdf5File::open(in("a.h5"));
  ASSERT_TRUE(file);
  EXPECT_EQ(file->strings("/", "many"), std::nullopt) << "3 MB in one attribute";
  EXPECT_EQ(file->strings("/", "long"), std::nullopt);
  EXPECT_EQ(file->strings("/", "few"), few);
  EXPECT_EQ(file->string("/", "most")->size(), std::size_t{1} << 16);
}

// In a process of its own, whose files may not grow beyond a limit, as on a full disk.
void write_within(const fs::path& path, rlim_t limit) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit size{limit, limit};
  if (::setrlimit(RLIMIT_FSIZE, &size) != 0) ::_exit(3);
  for (int again = 0; again < 2; ++again) {  // and the library is fit for use afterwards
    const auto written = write_sample(path);
    if (written || written.error().kind != ErrorKind::kIo) ::_exit(written ? 1 : 2);
    if (written.error().message.find('\n') != std::string::npos) ::_exit(4);
  }
  std::exit(0);  // with all that the library does at the end of a program
}

TEST_F(Hdf5Files, AFullDiskIsAnErrorAtEveryByte) {
  ASSERT_TRUE(write_sample(in("whole.h5")));
  const auto whole = static_cast<rlim_t>(fs::file_size(in("whole.h5")));
  for (rlim_t limit = 0; limit < whole; limit += whole / 9)
    EXPECT_EXIT(write_within(in("a.h5"), limit), testing::ExitedWithCode(0), "") << limit << " of " << whole;
  EXPECT_EXIT(write_within(in("a.h5"), whole - 1), testing::ExitedWithCode(0), "");
  EXPECT_FALSE(fs::exists(in("a.h5")));
}

TEST_F(Hdf5Files, ListsEveryLinkInOrder) {
  ASSERT_TRUE(write_sample(in("a.h5")));
  const auto file = Hdf5File::open(in("a.h5"));
  ASSERT_TRUE(file);
  const auto links = file->list();
  ASSERT_TRUE(links);
  std::vector<std::string> paths;
  for (const auto& link : *links) paths.push_back(link.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"/entry", "/entry/data", "/entry/data/data", "/packed", "/wedges"}));
  const auto missing = file->resolve("/entry/none/data");
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->kind, Hdf5Target::Kind::kMissing);
  EXPECT_EQ(missing->path, "/entry/none");
}

TEST_F(Hdf5Files, WhatIsNoHdf5FileIsRefusedWithItsKind) {
  EXPECT_EQ(Hdf5File::open(in("absent.h5")).error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(Hdf5File::open(in("")).error().kind, ErrorKind::kBadData);
  std::ofstream(in("text.h5")) << "no volume here";
  EXPECT_EQ(Hdf5File::open(in("text.h5")).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(Hdf5Writer::create(in("no/such/folder.h5")).error().kind, ErrorKind::kCannotCreate);
}

TEST(ScalarType, HalfPrecisionFollowsIeee754) {
  const std::vector<std::uint16_t> halves{0x3c00, 0xc000, 0x7bff, 0x0001, 0x7c00, 0x8000, 0x3555};
  std::vector<float> out(halves.size());
  scalars_to_float(std::as_bytes(std::span(halves)).data(), ScalarType::kF16, kNativeOrder, {}, out);
  EXPECT_EQ(out, (std::vector<float>{1.0F, -2.0F, 65504.0F, std::ldexp(1.0F, -24), INFINITY, -0.0F, 0.333251953125F}));
}

TEST(ScalarType, EveryNameIsUnderstood) {
  for (int i = 0; i <= static_cast<int>(ScalarType::kF64); ++i) {
    const auto type = static_cast<ScalarType>(i);
    EXPECT_EQ(parse_scalar_type(scalar_name(type)), type);
  }
  EXPECT_EQ(parse_scalar_type("complex64"), std::nullopt);
}

}  // namespace
}  // namespace dubsar
