#pragma once
// Models with every field filled, and the bytes of their files.

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>

#include "core/exa/chunks.h"
#include "core/exa/exa_file.h"
#include "core/extract/extract.h"

namespace dubsar {

enum class Kind { kNoise, kBlob, kEmpty, kFull };

/// A model with every field filled: a field of blobs or noise, positions and attributes moved about at random.
inline SurfaceModel sample_model(const Dims& dims, Kind kind, unsigned seed, bool closed = true, int bits = 4) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  Volume<float> volume(dims);
  for (std::int64_t i = 0; i < dims.count(); ++i) {
    const std::int64_t slice = i / dims.slice();
    const auto x = static_cast<float>(i % dims.x), y = static_cast<float>(i / dims.x % dims.y),
               z = static_cast<float>(slice);
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
    model.attributes.evidence.push_back(static_cast<std::uint8_t>(model.attributes.ao.size() * 7 / 5 % 4));
  }
  for (std::size_t q = 0; q < model.mesh.quads.size(); ++q)
    model.quad_partition.push_back(static_cast<std::uint8_t>(q / 100 % 8));
  model.partitions = {{0, "tablet", "", 12.5, 1.0 / 3.0, true},
                      {1, "envelope \"inside\"", "envelope", 1e-9, -2e5, false}};
  for (PartitionId id = 2; id < PartitionTable::kMost; ++id)
    EXPECT_TRUE(model.partitions.insert({id, fmt::format("fragment {}", id), "", 0.1 * id, 0.0, false}));
  model.frame.scale = {2.0, 2.0, 2.0};
  model.frame.origin_vox = {0.5, 0.1, -1.0 / 3.0};
  model.frame.input_voxel = {{0.038, 0.0381, 0.04}, "/entry/data@pixel_size"};
  model.provenance = "{\"text\":\"\xc3\xa4 \\n\"}";
  return model;
}

inline bool same_bytes(const auto& a, const auto& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

inline void expect_equal(const SurfaceModel& a, const SurfaceModel& b) {
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
  EXPECT_EQ(a.attributes.evidence, b.attributes.evidence);
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
    EXPECT_EQ(a.patches[i].evidence, b.patches[i].evidence);
  }
  EXPECT_EQ(a.frame.scale, b.frame.scale);
  EXPECT_EQ(a.frame.origin_vox, b.frame.origin_vox);
  EXPECT_EQ(a.frame.input_voxel.mm, b.frame.input_voxel.mm);
  EXPECT_EQ(a.frame.input_voxel.provenance, b.frame.input_voxel.provenance);
  EXPECT_EQ(a.provenance, b.provenance);
}

inline std::string file_of(const std::vector<ExaBlock>& blocks, std::uint16_t major, std::uint16_t minor = kExaMinor) {
  std::string bytes = exa_head(blocks, major, minor);
  for (const ExaBlock& block : blocks) bytes += block.bytes;
  return bytes + std::string(kExaEnd);
}

inline std::string file_of(const std::vector<ExaBlock>& blocks) { return file_of(blocks, exa_major_of(blocks)); }

inline std::vector<ExaBlock> encoded(const SurfaceModel& model) {
  SilentProgress progress;
  auto blocks = encode_exa(model, progress);
  EXPECT_TRUE(blocks) << blocks.error().message;
  return blocks ? *blocks : std::vector<ExaBlock>();
}

class ExaFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() /
        fmt::format("dubsar_exa_{}_{}", ::testing::UnitTest::GetInstance()->current_test_info()->name(), ::getpid());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
  SilentProgress progress_;
};

/// The chunks of a block, for damage behind sums that are repaired.
inline std::vector<std::string> chunks_of(const ExaBlock& block) {
  const auto chunks = split_chunks(block.bytes, block.chunks, "test");
  return {chunks->begin(), chunks->end()};
}

/// Changes, cuts or lengthens a chunk of one of the blocks, and takes one away every 50th round; the sums are right
/// afterwards. False when what was drawn is empty.
inline bool damage_a_chunk(std::vector<ExaBlock>& blocks, int round, std::mt19937& random) {
  ExaBlock& block = blocks[random() % blocks.size()];
  std::vector<std::string> chunks = chunks_of(block);
  if (chunks.empty()) return false;  // no face is ambiguous
  std::string& bytes = chunks[random() % chunks.size()];
  if (bytes.empty()) return false;
  if (round % 3 == 0)
    bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
  else if (round % 3 == 1)
    bytes.resize(random() % bytes.size());
  else
    bytes.insert(random() % bytes.size(), std::string(1 + random() % 9, static_cast<char>(random())));
  if (round % 50 == 0) chunks.pop_back();
  block.chunks = static_cast<std::uint32_t>(chunks.size());
  block.bytes = join_chunks(chunks);
  return true;
}

}  // namespace dubsar
