#pragma once
// Meshes for the tests of the file formats, and a folder to write them to.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// A torus around z, large radius 30, small radius 10, with analytic normals and curvatures and every attribute; two
/// parts that share no vertices: the second is a copy moved by 100 along x.
inline TriMesh sample_mesh(int around = 24, int across = 12) {
  TriMesh mesh;
  for (int part = 0; part < 2; ++part) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < around; ++i)
      for (int j = 0; j < across; ++j) {
        const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
        const glm::dvec3 ring(std::cos(u), std::sin(u), 0.0), up(0.0, 0.0, 1.0);
        const glm::dvec3 normal = ring * std::cos(v) + up * std::sin(v);
        mesh.positions.emplace_back(ring * 30.0 + normal * 10.0 + glm::dvec3(100.0 * part, 0.0, 0.0));
        mesh.normals.emplace_back(normal);
        const double k = std::cos(v) / (30.0 + 10.0 * std::cos(v));
        mesh.k_min.push_back(static_cast<float>(std::min(k, 0.1)));
        mesh.k_max.push_back(static_cast<float>(std::max(k, 0.1)));
        mesh.shape.push_back(static_cast<std::uint8_t>((i * across + j) % 127));
        mesh.ao.push_back(static_cast<std::uint8_t>((i + j) % 64));
        mesh.evidence.push_back(static_cast<std::uint8_t>((i + 3 * j) % 4));
        mesh.colors.push_back({static_cast<std::uint8_t>(i * 7), static_cast<std::uint8_t>(j * 20), 200});
      }
    for (int i = 0; i < around; ++i)
      for (int j = 0; j < across; ++j) {
        const auto id = [&](int a, int b) {
          return base + static_cast<std::uint32_t>((a % around) * across + b % across);
        };
        mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
        mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        mesh.triangle_partition.insert(mesh.triangle_partition.end(), 2, static_cast<PartitionId>(part * 3));
      }
  }
  mesh.frame.scale = {2.0, 2.0, 2.0};
  mesh.frame.origin_vox = {0.5, -3.0, 11.25};
  mesh.frame.input_voxel = {{0.038, 0.038, 0.038}, "/entry/data@pixel_size"};
  mesh.partitions = {{0, "tablet", "", 1234.5, 678.25, true}, {3, "envelope inside", "envelope", 0.1, 1e-3, false}};
  mesh.provenance = R"({"program":"dubsar","text":"a \"quoted\" \u00e4 line"})";
  return mesh;
}

class FileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              fmt::format("dubsar_{}_{}_{}", test->test_suite_name(), test->name(), ::getpid());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

}  // namespace dubsar
