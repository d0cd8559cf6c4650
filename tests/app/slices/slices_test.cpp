// Slices: where their pixels lie, what they show of a scan and of a surface, and that nobody waits for them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "app/slices/slice_reader.h"
#include "core/base/files/file_fingerprint.h"
#include "core/phantom/phantom_source.h"
#include "core/volume/formats/import.h"
#include "core/volume/formats/import_raw.h"
#include "core/volume/slab_source.h"
#include "tests/core/volume/read_all.h"
#include "tests/display/test_meshes.h"

namespace dubsar::app {
namespace {
namespace fs = std::filesystem;

/// A volume in memory; `slow` waits before each brick until it is let go.
class ArrayReader final : public VoxelReader {
 public:
  explicit ArrayReader(const Volume<float>& volume, std::atomic<bool>* go = nullptr) : volume_(volume), go_(go) {}
  Dims dims() const noexcept override { return volume_.dims; }
  Dims chunk() const noexcept override { return {24, 20, 28}; }
  const NumberFormat& format() const noexcept override { return format_; }
  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override {
    if (go_ != nullptr) go_->wait(false);
    auto* to = reinterpret_cast<float*>(out.data());
    for (std::int64_t z = box.z.begin; z < box.z.end; ++z)
      for (std::int64_t y = box.y.begin; y < box.y.end; ++y)
        for (std::int64_t x = box.x.begin; x < box.x.end; ++x) *to++ = volume_.at(x, y, z);
    return {};
  }

 private:
  const Volume<float>& volume_;
  std::atomic<bool>* go_;
  NumberFormat format_;
};

double trilinear(const Volume<float>& v, const glm::dvec3& p) {
  const auto x = static_cast<std::int64_t>(p.x), y = static_cast<std::int64_t>(p.y), z = static_cast<std::int64_t>(p.z);
  const glm::dvec3 f = p - glm::floor(p);
  const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
  const auto row = [&](std::int64_t j, std::int64_t k) { return mix(v.at(x, j, k), v.at(x + 1, j, k), f.x); };
  return mix(mix(row(y, z), row(y + 1, z), f.y), mix(row(y, z + 1), row(y + 1, z + 1), f.y), f.z);
}

ScanView any_view(std::mt19937& random, const glm::dvec3& size_mm) {
  std::uniform_real_distribution<double> share(0.35, 0.65), turn(-1.0, 1.0);
  ScanView out;
  out.cursor_mm = size_mm * glm::dvec3(share(random), share(random), share(random));
  out.centre_mm = size_mm * glm::dvec3(share(random), share(random), share(random));
  out.free_up = glm::normalize(glm::dvec3(turn(random), turn(random), turn(random)));
  out.free_right = glm::normalize(glm::cross(out.free_up, glm::dvec3(turn(random), turn(random), turn(random))));
  out.zoom = 1.0 + share(random);
  return out;
}

TEST(SliceFrame, PicturesAreNoMirrorImagesAndGoThroughThePlaceThatIsMeant) {
  std::mt19937 random(std::random_device{}());
  for (int round = 0; round < 20; ++round) {
    const ScanView view = any_view(random, {60, 50, 40});
    for (std::size_t i = 0; i < kSlices; ++i) {
      const SliceFrame frame = slice_frame(view, i, 210, 170, 66.0);
      EXPECT_NEAR(glm::dot(frame.right, frame.down), 0.0, 1e-12);
      EXPECT_NEAR(frame.mm_per_px * 170, 66.0 / view.zoom, 1e-9);
      const glm::dvec2 cursor = frame.px_at(view.cursor_mm);
      EXPECT_LT(glm::distance(frame.mm_at(cursor), view.cursor_mm), 1e-9) << "it lies in the plane";
      EXPECT_LT(glm::distance(frame.mm_at({105, 85}), frame.middle_mm), 1e-9);
      // Right, up and to the viewer are as x, y and z.
      EXPECT_NEAR(glm::determinant(glm::dmat3(frame.right, -frame.down, frame.to_viewer())), 1.0, 1e-9);
    }
  }
}

TEST(Slices, PixelsOfAPhantomAreTheTrilinearSamplesOfItsArray) {
  std::mt19937 random(std::random_device{}());
  phantom::PhantomOptions options;
  options.dims = {72, 44, 66};
  options.seed = random();
  SCOPED_TRACE(options.seed);
  const std::shared_ptr<const phantom::Phantom> phantom = phantom::Phantom::create(options).value();
  phantom::PhantomSource source(phantom);
  const Volume<float> scan = testing::read_all(source).value();
  const glm::dvec3 voxel(0.31, 0.31, 0.31);
  const TriMesh nothing = testing::sphere(1.0f, 8, 16);
  SliceReader reader(nothing, [&]() -> Result<OpenedScan> {
    DUBSAR_ASSIGN(auto sampler, PlaneSampler::create(std::make_unique<ArrayReader>(scan)));
    return OpenedScan{std::move(sampler), voxel, {}};
  });
  const glm::dvec3 size_mm = voxel * glm::dvec3(72, 44, 66);
  for (int round = 0; round < 4; ++round) {
    const ScanView view = any_view(random, size_mm);
    std::array<SliceFrame, kSlices> frames;
    for (std::size_t i = 0; i < kSlices; ++i) reader.ask(i, frames[i] = slice_frame(view, i, 90, 70, size_mm.x));
    reader.wait();
    for (std::size_t i = 0; i < kSlices; ++i) {
      const SharedSlice picture = reader.picture(i);
      ASSERT_TRUE(picture && picture->exact && picture->frame == frames[i]);
      int compared = 0;
      for (int y = 0; y < 70; ++y)
        for (int x = 0; x < 90; ++x) {
          const glm::dvec3 at = frames[i].mm_at({x + 0.5, y + 0.5}) / voxel;
          const glm::dvec3 last = glm::dvec3(72, 44, 66) - 1.001;
          if (glm::any(glm::lessThan(at, glm::dvec3(0.0))) || glm::any(glm::greaterThan(at, last))) continue;
          ASSERT_NEAR(picture->image.values[static_cast<std::size_t>(90 * y + x)], trilinear(scan, at), 2e-6);
          ++compared;
        }
      EXPECT_GT(compared, 1000);
    }
  }
}

TEST(Slices, TheOutlineOfASphereIsWithinHalfAPixelOfItsCircle) {
  std::mt19937 random(std::random_device{}());
  const TriMesh ball = testing::sphere(20.0f, 180, 360);
  SliceReader reader(ball, {});
  for (int round = 0; round < 8; ++round) {
    ScanView view = any_view(random, {1, 1, 1});
    view.cursor_mm = 12.0 * view.cursor_mm;
    view.centre_mm = {0, 0, 0};
    view.zoom = 1.0;
    for (std::size_t i = 0; i < kSlices; ++i) {
      const SliceFrame frame = slice_frame(view, i, 400, 400, 44.0);
      reader.ask(i, frame);
      reader.wait();
      const SharedSlice picture = reader.picture(i);
      ASSERT_TRUE(picture && picture->exact && picture->image.values.empty());
      const double off = glm::dot(frame.middle_mm, frame.to_viewer());
      const double radius = std::sqrt(400.0 - off * off) / frame.mm_per_px;
      const glm::dvec2 centre = frame.px_at({0, 0, 0});
      ASSERT_GT(picture->outline.size(), 200u);
      for (const OutlinePiece& piece : picture->outline)
        for (const glm::vec2 p : {piece.a, piece.b}) EXPECT_NEAR(glm::distance(glm::dvec2(p), centre), radius, 0.5);
    }
  }
}

TEST(Slices, AFileThatTakesItsTimeHoldsNobodyUpAndTheNewestQuestionIsAnswered) {
  Volume<float> volume(Dims{96, 80, 84});
  std::fill_n(volume.voxels.data(), volume.dims.count(), 0.25f);
  std::atomic<bool> go = false;
  const TriMesh ball = testing::sphere(20.0f, 20, 40);
  SliceReader reader(ball, [&]() -> Result<OpenedScan> {
    DUBSAR_ASSIGN(auto sampler, PlaneSampler::create(std::make_unique<ArrayReader>(volume, &go)));
    return OpenedScan{std::move(sampler), glm::dvec3(1.0), {}};
  });
  ScanView view;
  view.cursor_mm = view.centre_mm = {48, 40, 42};
  SliceFrame newest;
  for (int i = 0; i < 200; ++i) {  // each comes back though nothing can be read
    view.cursor_mm.z = 20 + 0.2 * i;
    reader.ask(2, newest = slice_frame(view, 2, 80, 80, 80));
    EXPECT_FALSE(reader.picture(2) && reader.picture(2)->exact);
  }
  go = true;
  go.notify_all();
  reader.wait();
  ASSERT_TRUE(reader.picture(2)->exact);
  EXPECT_EQ(reader.picture(2)->frame, newest);
}

class ScanLinks : public ::testing::Test {
 protected:
  ScanLinks() { fs::create_directories(folder_ / "elsewhere"); }
  ~ScanLinks() override { fs::remove_all(folder_); }
  void write(const fs::path& path, int edge, char first = 7) const {
    std::ofstream out(path, std::ios::binary);
    out << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: " << edge << " " << edge << " " << edge
        << "\nencoding: raw\nspacings: 0.05 0.05 0.05\nunits: \"mm\" \"mm\" \"mm\"\n\n";
    std::string bytes(static_cast<std::size_t>(edge * edge * edge), '\x20');
    bytes[0] = first;
    out << bytes;
  }
  /// A surface that says what it was made of.
  TriMesh made_of(const fs::path& scan, const std::string& path) const {
    TriMesh out = testing::sphere(1.0f, 8, 16);
    out.provenance =
        fmt::format(R"({{"input": {{"path": "{}", "dataset": "", "file_dims": [12, 12, 12], "fingerprint": "{}"}}}})",
                    path, file_fingerprint(scan).value());
    return out;
  }
  ImportOptions named(const std::string& name) const {
    ImportOptions out;
    out.path = folder_ / name;
    return out;
  }
  const fs::path folder_ = fs::temp_directory_path() / fmt::format("dubsar_scan_link_{}", ::getpid());
};

TEST_F(ScanLinks, TheScanBesideTheSurfaceIsFoundByItsNameAndKnownByItsBytes) {
  write(folder_ / "scan.nrrd", 12);
  const TriMesh mesh = made_of(folder_ / "scan.nrrd", "/another/machine/scan.nrrd");
  const auto link = scan_of(mesh, folder_ / "tablet.exa");
  ASSERT_TRUE(link);
  const auto opened = open_scan(*link);
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->sampler->dims(), (Dims{12, 12, 12}));
  EXPECT_EQ(opened->note, "");
  EXPECT_FALSE(scan_of(mesh, folder_ / "elsewhere" / "tablet.exa")) << "there is none";
  EXPECT_FALSE(scan_of(testing::sphere(1.0f, 8, 16), folder_ / "tablet.exa")) << "it says nothing";

  write(folder_ / "scan.nrrd", 12, 8);  // another one under the same name
  const auto other = open_scan(scan_of(mesh, folder_ / "tablet.exa").value());
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().message,
            "slices: scan.nrrd is not the scan that this surface was made of, though it has its name");
  const auto given = open_scan(scan_of(mesh, folder_ / "tablet.exa", named("scan.nrrd")).value());
  ASSERT_TRUE(given) << "who names it gets it, and is told";
  EXPECT_NE(given->note.find("not the file"), std::string::npos);

  write(folder_ / "small.nrrd", 11);
  const auto small = open_scan(scan_of(mesh, folder_ / "tablet.exa", named("small.nrrd")).value());
  ASSERT_FALSE(small);
  EXPECT_NE(small.error().message.find("11 x 11 x 11 voxels, expected 12 x 12 x 12"), std::string::npos);
}

TEST_F(ScanLinks, ARawVolumeIsReadAsItWasWhenTheSurfaceWasMade) {
  std::string bytes(16, 'h');  // that are skipped
  for (int i = 0; i < 6 * 5 * 4; ++i) {
    bytes += static_cast<char>(i / 256);  // big endian
    bytes += static_cast<char>(i % 256);
  }
  std::ofstream(folder_ / "scan.raw", std::ios::binary) << bytes;
  ImportOptions import = named("scan.raw");
  import.raw = RawSpec{{6, 5, 4}, ScalarType::kU16, ByteOrder::kBig, 16};
  const auto read = open_voxels(import);
  ASSERT_TRUE(read) << read.error().message;
  TriMesh mesh = testing::sphere(1.0f, 8, 16);
  mesh.provenance = fmt::format(
      R"({{"input": {{"path": "scan.raw", "dataset": "", "format": "{}", "file_dims": [6, 5, 4], "dtype": "{}",
          "byte_order": "{}", "layout": "{}", "axes": {{"order": "{}"}}, "fingerprint": "{}"}}}})",
      read->info.format, read->info.stored.dtype, read->info.stored.byte_order, read->info.stored.layout,
      read->info.axes.letters(), read->info.fingerprint);
  for (const bool given : {false, true}) {
    const auto link =
        given ? scan_of(mesh, folder_ / "tablet.exa", readable_scan(named("scan.raw"), mesh.provenance).value())
              : scan_of(mesh, folder_ / "tablet.exa");
    ASSERT_TRUE(link);
    ASSERT_TRUE(link->import.raw);
    EXPECT_EQ(link->import.raw->skip, 16);
    EXPECT_EQ(link->import.raw->order, ByteOrder::kBig);
    const auto opened = open_scan(*link);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(opened->sampler->dims(), (Dims{6, 5, 4}));
    EXPECT_EQ(opened->note, "");
  }
  EXPECT_FALSE(readable_scan(named("scan.raw"), "")) << "nobody says how it is read";
  EXPECT_EQ(skip_of_layout(raw_layout(16)), 16);
  EXPECT_EQ(skip_of_layout(raw_layout(0)), 0);
  EXPECT_FALSE(skip_of_layout("chunked"));
  import.raw->skip = 8;  // who says how it is read is believed
  EXPECT_EQ(scan_of(mesh, folder_ / "tablet.exa", import)->import.raw->skip, 8);
  EXPECT_FALSE(raw_volume_of(R"({"input": {"format": "hdf5"}})"));
  EXPECT_FALSE(raw_volume_of("not JSON"));
}

TEST(Slices, AMistakeInItsThreadIsANoteAndNoEndOfTheProgram) {
  const TriMesh nothing;
  SliceReader reader(nothing, []() -> Result<OpenedScan> { throw std::bad_alloc(); });
  reader.wait();
  EXPECT_FALSE(reader.has_scan());
  EXPECT_EQ(reader.note(), "the slices: there is not enough memory for it");
  reader.ask(0, SliceFrame());
  reader.wait();
}

}  // namespace
}  // namespace dubsar::app
