#include "core/exa/exa_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>

#include "core/base/atomic_file.h"
#include "core/base/bytes.h"
#include "core/base/input_file.h"
#include "core/base/parallel.h"
#include "core/exa/attributes.h"
#include "core/exa/chunks.h"
#include "core/exa/settle.h"
#include "core/extract/extract.h"
#include "core/relief/smooth.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

enum class Kind { kNoise, kBlob, kEmpty, kFull };

/// A model with every field filled: a field of blobs or noise, positions and attributes moved about at random.
SurfaceModel sample_model(const Dims& dims, Kind kind, unsigned seed, bool closed = true, int bits = 4) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  Volume<float> volume(dims);
  for (std::int64_t i = 0; i < dims.count(); ++i) {
    const auto x = static_cast<float>(i % dims.x), y = static_cast<float>(i / dims.x % dims.y),
               z = static_cast<float>(i / dims.slice());
    const float blob = std::sin(0.4f * x) + std::sin(0.31f * y + 1.0f) + std::sin(0.23f * z) - 0.3f;
    volume.voxels[i] = kind == Kind::kNoise  ? uniform(random)
                       : kind == Kind::kBlob ? blob
                       : kind == Kind::kFull ? 1.0f
                                             : -1.0f;
  }
  VolumeSource source(volume);
  SilentProgress progress;
  SurfaceModel model;
  model.samples = sample_surface(source, {.isovalue = 0.125f, .offset_bits = bits, .closed = closed}, progress).value();
  model.mesh = build_quad_mesh(model.samples, progress).value();
  for (glm::vec3& p : model.mesh.positions) p += 0.3f * glm::vec3(uniform(random), uniform(random), uniform(random));
  const auto vertices = model.mesh.positions.size();
  for (std::size_t v = 0; v < vertices; ++v) {
    glm::vec3 n(uniform(random), uniform(random), uniform(random));
    if (v % 5 == 0) n.z = 0.0f;  // the seam of the octahedron
    if (v % 7 == 0) n = glm::vec3(0.0f, 0.0f, -1.0f);
    model.attributes.normals.push_back(n / std::max(std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z), 1e-3f));
    model.attributes.k_min.push_back(uniform(random) - 1.0f);
    model.attributes.k_max.push_back(uniform(random) * 30.0f);
    model.attributes.shape.push_back(static_cast<std::uint8_t>(random() % 127));
    model.attributes.ao.push_back(static_cast<std::uint8_t>(random() % 64));
  }
  for (std::size_t q = 0; q < model.mesh.quads.size(); ++q)
    model.quad_partition.push_back(static_cast<std::uint8_t>(q / 100 % 8));
  model.partitions = {{0, "tablet", "", 12.5, 1.0 / 3.0, true},
                      {1, "envelope \"inside\"", "envelope", 1e-9, -2e5, false}};
  for (PartitionId id = 2; id < PartitionTable::kMost; ++id)
    EXPECT_TRUE(model.partitions.insert({id, fmt::format("fragment {}", id), "", 0.1 * id, 0.0, false}));
  if (vertices > 3) {
    model.patches.resize(2);
    model.patches[0] = {0, 7, {{0.5f, 1.25f, -3.0f}}, {{0, 1, static_cast<std::uint32_t>(vertices)}, {1, 2, 3}}};
    model.patches[1].partition = 3;
  }
  model.frame.scale = {2.0, 2.0, 2.0};
  model.frame.origin_vox = {0.5, 0.1, -1.0 / 3.0};
  model.frame.input_voxel = {{0.038, 0.0381, 0.04}, "/entry/data@pixel_size"};
  model.provenance = "{\"text\":\"\xc3\xa4 \\n\"}";
  return model;
}

bool same_bytes(const auto& a, const auto& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

void expect_equal(const SurfaceModel& a, const SurfaceModel& b) {
  EXPECT_TRUE(a.samples == b.samples);
  EXPECT_TRUE(same_bytes(a.mesh.positions, b.mesh.positions));
  EXPECT_EQ(a.mesh.quads, b.mesh.quads);
  EXPECT_EQ(a.mesh.doubled, b.mesh.doubled);
  EXPECT_EQ(a.mesh.first_incident, b.mesh.first_incident);
  EXPECT_EQ(a.mesh.incident, b.mesh.incident);
  EXPECT_EQ(a.mesh.doubled_bits, b.mesh.doubled_bits);
  EXPECT_TRUE(same_bytes(a.attributes.normals, b.attributes.normals));
  EXPECT_TRUE(same_bytes(a.attributes.k_min, b.attributes.k_min));
  EXPECT_TRUE(same_bytes(a.attributes.k_max, b.attributes.k_max));
  EXPECT_EQ(a.attributes.shape, b.attributes.shape);
  EXPECT_EQ(a.attributes.ao, b.attributes.ao);
  EXPECT_EQ(a.quad_partition, b.quad_partition);
  ASSERT_EQ(a.partitions.size(), b.partitions.size());
  for (std::size_t i = 0; i < a.partitions.size(); ++i) {
    EXPECT_EQ(a.partitions[i].id, b.partitions[i].id);
    EXPECT_EQ(a.partitions[i].name, b.partitions[i].name);
    EXPECT_EQ(a.partitions[i].body, b.partitions[i].body);
    EXPECT_EQ(a.partitions[i].area_mm2, b.partitions[i].area_mm2);
    EXPECT_EQ(a.partitions[i].volume_mm3, b.partitions[i].volume_mm3);
    EXPECT_EQ(a.partitions[i].watertight, b.partitions[i].watertight);
  }
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t i = 0; i < a.patches.size(); ++i) {
    EXPECT_EQ(a.patches[i].partition, b.patches[i].partition);
    EXPECT_EQ(a.patches[i].reverse_partition, b.patches[i].reverse_partition);
    EXPECT_TRUE(same_bytes(a.patches[i].extra_positions, b.patches[i].extra_positions));
    EXPECT_EQ(a.patches[i].triangles, b.patches[i].triangles);
  }
  EXPECT_EQ(a.frame.scale, b.frame.scale);
  EXPECT_EQ(a.frame.origin_vox, b.frame.origin_vox);
  EXPECT_EQ(a.frame.input_voxel.mm, b.frame.input_voxel.mm);
  EXPECT_EQ(a.frame.input_voxel.provenance, b.frame.input_voxel.provenance);
  EXPECT_EQ(a.provenance, b.provenance);
}

std::string file_of(const std::vector<ExaBlock>& blocks, std::uint16_t major = kExaMajor,
                    std::uint16_t minor = kExaMinor) {
  std::string bytes = exa_head(blocks, major, minor);
  for (const ExaBlock& block : blocks) bytes += block.bytes;
  return bytes + std::string(kExaEnd);
}

std::vector<ExaBlock> encoded(const SurfaceModel& model) {
  SilentProgress progress;
  auto blocks = encode_exa(model, progress);
  EXPECT_TRUE(blocks) << blocks.error().message;
  return blocks ? *blocks : std::vector<ExaBlock>();
}

class ExaFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() /
        fmt::format("dubsar_exa_{}_{}", ::testing::UnitTest::GetInstance()->current_test_info()->name(), ::getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
  SilentProgress progress_;
};

TEST_F(ExaFile, ModelReadBackEqualsTheModelWritten) {
  const Dims shapes[] = {{1, 1, 1}, {30, 1, 17}, {33, 20, 41}, {65, 3, 2}};
  unsigned seed = 0;
  for (const Dims& dims : shapes)
    for (const Kind kind : {Kind::kNoise, Kind::kBlob, Kind::kEmpty, Kind::kFull})
      for (const bool closed : {true, false})
        for (const bool quantised : {true, false}) {
          ++seed;
          SurfaceModel model = sample_model(dims, kind, seed, closed, 1 + static_cast<int>(seed % 16));
          if (quantised) {
            ASSERT_TRUE(settle_for_exa(model, {}, progress_));
          }
          const auto stats = write_exa(folder_ / "a.exa", model, progress_);
          ASSERT_TRUE(stats) << stats.error().message;
          const auto read = read_exa(folder_ / "a.exa", progress_);
          ASSERT_TRUE(read) << read.error().message << " " << dims.x << "x" << dims.y << "x" << dims.z;
          expect_equal(model, *read);
          EXPECT_EQ(file_of(encoded(*read)), *read_file_bytes(folder_ / "a.exa")) << "encode, decode, encode";
        }
}

TEST_F(ExaFile, MinimalModelWithoutAttributesIsStored) {
  SurfaceModel model = sample_model({20, 20, 20}, Kind::kBlob, 3);
  model.mesh = build_quad_mesh(model.samples, progress_).value();
  model.attributes = {};
  model.quad_partition.clear();
  model.partitions.clear();
  model.patches.clear();
  model.provenance.clear();
  const auto stats = write_exa(folder_ / "a.exa", model, progress_);
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->blocks.size(), 8u) << "container, header, four of signs, face decisions, offsets";
  expect_equal(model, read_exa(folder_ / "a.exa", progress_).value());
}

TEST_F(ExaFile, SettlingKeepsTheSurfaceWithinTheBoundAndTwiceIsOnce) {
  // A sphere, smoothed by moving its vertices onto the exact one.
  const Dims dims{60, 56, 52};
  const glm::dvec3 centre(29.3, 27.1, 25.9);
  const double radius = 20.25;
  Volume<float> volume(dims);
  for (std::int64_t z = 0; z < dims.z; ++z)
    for (std::int64_t y = 0; y < dims.y; ++y)
      for (std::int64_t x = 0; x < dims.x; ++x)
        volume.at(x, y, z) = static_cast<float>(radius - glm::length(glm::dvec3(x, y, z) - centre));
  VolumeSource source(volume);
  for (const bool closed : {true, false}) {
    SurfaceModel model;
    model.samples = sample_surface(source, {.isovalue = 0.0f, .offset_bits = 4, .closed = closed}, progress_).value();
    model.mesh = build_quad_mesh(model.samples, progress_).value();
    for (glm::vec3& p : model.mesh.positions) {
      const glm::dvec3 from = glm::dvec3(p) - centre;
      p = glm::vec3(centre + from * (radius / glm::length(from)));
    }
    model.attributes.normals = vertex_normals(model.mesh, face_normals(model.mesh));
    SurfaceModel once = model;
    const auto stats = settle_for_exa(once, {.max_error = 1.0f / 16.0f}, progress_);
    ASSERT_TRUE(stats) << stats.error().message;
    std::vector<double> errors;
    for (const glm::vec3& p : once.mesh.positions)
      errors.push_back(std::abs(glm::length(glm::dvec3(p) - centre) - radius));
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors.back(), 1.0 / 16.0);
    EXPECT_LT(errors[errors.size() * 95 / 100], 1.0 / 32.0);
    EXPECT_LE(stats->max_error_vox, 1.0 / 16.0);
    EXPECT_LT(stats->normal_error_deg, 2.0);
    EXPECT_EQ(model.mesh.quads, once.mesh.quads);
    SurfaceModel twice = once;
    ASSERT_TRUE(settle_for_exa(twice, {}, progress_));
    expect_equal(once, twice);
    const auto blocks = encoded(once);
    for (const ExaBlock& block : blocks) EXPECT_TRUE(block.type != "POSN" && block.type != "NORM") << block.type;
  }
  SurfaceModel model = sample_model({20, 20, 20}, Kind::kBlob, 1);
  EXPECT_EQ(settle_for_exa(model, {.max_error = 0.0f}, progress_).error().kind, ErrorKind::kUsage);
}

TEST_F(ExaFile, ThreadsDoNotChangeTheBytes) {
  SurfaceModel model = sample_model({70, 60, 50}, Kind::kNoise, 4);
  ASSERT_TRUE(settle_for_exa(model, {}, progress_));
  set_thread_count(1);
  const std::string one = file_of(encoded(model));
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    EXPECT_TRUE(file_of(encoded(model)) == one) << threads;
    SilentProgress progress;
    expect_equal(model, decode_exa(one, progress).value());
  }
  set_thread_count(0);
}

TEST_F(ExaFile, InfoAndStatsDescribeTheFile) {
  SurfaceModel model = sample_model({33, 20, 41}, Kind::kBlob, 5);
  ASSERT_TRUE(settle_for_exa(model, {}, progress_));
  const auto stats = write_exa(folder_ / "a.exa", model, progress_);
  ASSERT_TRUE(stats);
  EXPECT_EQ(stats->bytes, static_cast<std::int64_t>(fs::file_size(folder_ / "a.exa")));
  std::int64_t sum = 0;
  for (const ExaBlockStats& block : stats->blocks) {
    sum += block.bytes;
    EXPECT_DOUBLE_EQ(block.bits_per_vertex,
                     8.0 * static_cast<double>(block.bytes) / static_cast<double>(stats->vertices));
  }
  EXPECT_EQ(sum, stats->bytes);
  const auto info = read_exa_info(folder_ / "a.exa");
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->header.dims, model.samples.dims);
  EXPECT_EQ(info->header.isovalue, 0.125f);
  EXPECT_EQ(info->header.vertices, model.mesh.vertex_count());
  EXPECT_EQ(info->header.quads, model.mesh.quad_count());
  EXPECT_EQ(info->partitions[1].name, "envelope \"inside\"");
  EXPECT_EQ(info->provenance, model.provenance);
  EXPECT_EQ(info->stats.blocks.size(), stats->blocks.size());
}

TEST_F(ExaFile, EveryTruncationBitFlipAndExtraByteIsRefused) {
  SurfaceModel model = sample_model({12, 9, 10}, Kind::kBlob, 6);
  ASSERT_TRUE(settle_for_exa(model, {}, progress_));
  const std::string whole = file_of(encoded(model));
  ASSERT_TRUE(decode_exa(whole, progress_));
  const auto refused = [&](const std::string& bytes) {
    const auto read = decode_exa(bytes, progress_);
    return !read && read.error().kind == ErrorKind::kBadData && read.error().message.size() > 20;
  };
  for (std::size_t length = 0; length < whole.size(); ++length) ASSERT_TRUE(refused(whole.substr(0, length))) << length;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string flipped = whole;
    flipped[at] ^= static_cast<char>(1u << at % 8);
    if (at == 10 || at == 11) continue;  // the minor version is covered by the checksum below
    ASSERT_TRUE(refused(flipped)) << at;
  }
  std::string minor = whole;
  minor[10] ^= 1;
  EXPECT_TRUE(refused(minor));
  EXPECT_TRUE(refused(whole + '\0'));
  EXPECT_TRUE(refused("x" + whole));
}

TEST_F(ExaFile, LaterVersionsAreRefusedOrSkippedAsTheirNumberSays) {
  SurfaceModel model = sample_model({12, 9, 10}, Kind::kBlob, 6);
  std::vector<ExaBlock> blocks = encoded(model);
  EXPECT_THAT(decode_exa(file_of(blocks, 3), progress_).error().message,
              HasSubstr("format version 3 found, expected 2; it needs a later dubsar"));
  EXPECT_THAT(decode_exa(file_of(blocks, 1), progress_).error().message, HasSubstr("process the scan again"));
  blocks.push_back({"NEW1", 99, 0, 1, join_chunks(std::vector<std::string>{"whatever"})});
  const auto later = decode_exa(file_of(blocks, kExaMajor, 7), progress_);
  ASSERT_TRUE(later) << later.error().message;
  expect_equal(model, *later);
  blocks.back().flags = kExaRequired;
  EXPECT_THAT(decode_exa(file_of(blocks), progress_).error().message, HasSubstr("\"NEW1\" is needed and not known"));
  blocks.pop_back();
  blocks.push_back(blocks[2]);
  EXPECT_THAT(decode_exa(file_of(blocks), progress_).error().message, HasSubstr("two blocks"));
  blocks.pop_back();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    std::vector<ExaBlock> other = blocks;
    other[b].codec = 77;
    const auto read = decode_exa(file_of(other), progress_);
    if (!read)
      EXPECT_THAT(read.error().message, HasSubstr("codec 77"));
    else
      EXPECT_EQ(blocks[b].type, "none of the blocks may ignore its codec");
    if (!(blocks[b].flags & kExaRequired) || blocks[b].type == "POSN" || blocks[b].type == "ESCP") continue;
    other = blocks;
    other.erase(other.begin() + static_cast<std::ptrdiff_t>(b));
    EXPECT_THAT(decode_exa(file_of(other), progress_).error().message, HasSubstr("is missing"));
  }
}

/// The chunks of a block, for damage behind sums that are repaired.
std::vector<std::string> chunks_of(const ExaBlock& block) {
  const auto chunks = split_chunks(block.bytes, block.chunks, "test");
  return {chunks->begin(), chunks->end()};
}

TEST_F(ExaFile, DamageBehindRepairedSumsNeverCrashes) {
  for (const bool settled : {false, true}) {
    SurfaceModel model = sample_model({14, 9, 10}, Kind::kNoise, 6);
    if (settled) {
      ASSERT_TRUE(settle_for_exa(model, {}, progress_));
    }
    const std::vector<ExaBlock> blocks = encoded(model);
    std::mt19937 random(1);
    int accepted = 0;
    for (int round = 0; round < 500; ++round) {
      std::vector<ExaBlock> damaged = blocks;
      ExaBlock& block = damaged[random() % damaged.size()];
      std::vector<std::string> chunks = chunks_of(block);
      std::string& bytes = chunks[random() % chunks.size()];
      if (bytes.empty()) continue;
      if (round % 3 == 0)
        bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
      else if (round % 3 == 1)
        bytes.resize(random() % bytes.size());
      else
        bytes.insert(random() % bytes.size(), std::string(1 + random() % 9, static_cast<char>(random())));
      if (round % 50 == 0) chunks.pop_back();
      block.chunks = static_cast<std::uint32_t>(chunks.size());
      block.bytes = join_chunks(chunks);
      const auto read = decode_exa(file_of(damaged), progress_);
      if (!read) {
        ASSERT_TRUE(read.error().kind == ErrorKind::kBadData || read.error().kind == ErrorKind::kTryAgain)
            << read.error().message;
        continue;
      }
      ++accepted;  // a flipped attribute or text: a valid file all the same
      ASSERT_EQ(read->mesh.quads, model.mesh.quads);
      ASSERT_TRUE(same_bytes(read->mesh.positions, model.mesh.positions));
      if (const auto mesh = make_tri_mesh(*read); !mesh) {
        ASSERT_EQ(mesh.error().kind, ErrorKind::kBadData) << "a flipped partition id";
      }
    }
    EXPECT_LT(accepted, 350);
  }
}

TEST_F(ExaFile, HeadersThatLieAreRefusedWithASentence) {
  const SurfaceModel model = sample_model({12, 9, 10}, Kind::kBlob, 6);
  const std::vector<ExaBlock> blocks = encoded(model);
  const auto says = [&](const std::string& from, const std::string& to) {
    std::vector<ExaBlock> lying = blocks;
    const std::size_t at = lying[0].bytes.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::string text = chunks_of(lying[0])[0];
    text.replace(text.find(from), from.size(), to);
    lying[0].bytes = join_chunks(std::vector<std::string>{text});
    const auto read = decode_exa(file_of(lying), progress_);
    return read ? std::string("accepted") : read.error().message;
  };
  EXPECT_THAT(says("[12,9,10]", "[65535,65535,16]"), HasSubstr("grid points in a file of"));
  EXPECT_THAT(says("[12,9,10]", "[65535,65535,65535]"), HasSubstr("2^36"));
  EXPECT_THAT(says("[12,9,10]", "[0,9,10]"), HasSubstr("dimension 0"));
  EXPECT_THAT(says("[12,9,10]", "[12,9]"), HasSubstr("\"dims\""));
  EXPECT_THAT(says("[12,9,10]", "[12,9,1e999]"), HasSubstr("broken"));
  EXPECT_THAT(says("\"offset_bits\":4", "\"offset_bits\":5"), HasSubstr("not the one that was written"));
  EXPECT_THAT(says("\"offset_bits\":4", "\"offset_bits\":17"), HasSubstr("17 offset bits"));
  EXPECT_THAT(says("\"closed\":true", "\"closed\":false"), HasSubstr("the header says"));
  EXPECT_THAT(says("\"closed\":true", "\"closed\":1"), HasSubstr("\"closed\""));
  EXPECT_THAT(says("\"vertices\":", "\"vertices\":1"), HasSubstr("the header says"));
  EXPECT_THAT(says("{", std::string(100, '[')), HasSubstr("nested"));
}

TEST_F(ExaFile, CancelLeavesTheOldFile) {
  ASSERT_TRUE(write_file_atomically(folder_ / "a.exa", "old"));
  SilentProgress progress;
  progress.cancel();
  const auto written = write_exa(folder_ / "a.exa", sample_model({30, 30, 30}, Kind::kBlob, 2), progress);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kCancelled);
  EXPECT_EQ(*read_file_bytes(folder_ / "a.exa"), "old");
  EXPECT_EQ(read_exa(folder_ / "a.exa", progress_).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(read_exa_info(folder_ / "a.exa").error().kind, ErrorKind::kBadData);
  EXPECT_EQ(read_exa(folder_ / "none.exa", progress_).error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(read_exa(folder_, progress_).error().kind, ErrorKind::kBadData);
  EXPECT_EQ(write_exa(folder_ / "no" / "a.exa", sample_model({9, 9, 9}, Kind::kBlob, 2), progress_).error().kind,
            ErrorKind::kCannotCreate);
}

TEST_F(ExaFile, ModelsThatContradictThemselvesAreNotWritten) {
  SurfaceModel model = sample_model({20, 20, 20}, Kind::kBlob, 2);
  const auto kind_of = [&](const SurfaceModel& broken) {
    const auto written = write_exa(folder_ / "a.exa", broken, progress_);
    EXPECT_FALSE(fs::exists(folder_ / "a.exa"));
    return written ? ErrorKind::kUsage : written.error().kind;
  };
  SurfaceModel broken = model;
  broken.attributes.ao.pop_back();
  EXPECT_EQ(kind_of(broken), ErrorKind::kInternal);
  broken = model;
  broken.attributes.shape[3] = 127;
  EXPECT_EQ(kind_of(broken), ErrorKind::kInternal);
  broken = model;
  std::swap(broken.mesh.quads[0], broken.mesh.quads[1]);
  EXPECT_EQ(kind_of(broken), ErrorKind::kInternal);
  broken = model;
  broken.mesh.positions[5].x = NAN;
  EXPECT_EQ(kind_of(broken), ErrorKind::kBadData);
  broken = model;
  broken.samples.offsets[0] = 16;
  EXPECT_EQ(kind_of(broken), ErrorKind::kBadData);
}

}  // namespace
}  // namespace dubsar
