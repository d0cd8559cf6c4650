#pragma once
// Labelled volumes for tests: labels drawn or given, crossings and face decisions drawn, and the checks of all labels.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "core/extract/labelled/labelled_mesh.h"
#include "core/extract/labelled/quad_edges.h"
#include "core/extract/triangulate.h"
#include "core/mesh/mesh_check.h"
#include "tests/core/extract/extract_help.h"

namespace dubsar {

/// 0 air, 1 tablet, 2 envelope.
struct Labels {
  Dims dims;
  std::vector<std::uint8_t> voxels;
  explicit Labels(Dims d) : dims(d), voxels(static_cast<std::size_t>(d.count())) {}
  std::uint8_t& at(std::int64_t x, std::int64_t y, std::int64_t z) {
    return voxels[static_cast<std::size_t>((z * dims.y + y) * dims.x + x)];
  }
  std::uint8_t at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return voxels[static_cast<std::size_t>((z * dims.y + y) * dims.x + x)];
  }
};

/// A labelled mesh, and which two labels each x-quad lies between.
struct BuiltMesh : LabelledMesh {
  std::vector<std::uint8_t> pairs;
  static constexpr std::uint8_t label_pair(PointLabel low, PointLabel high) noexcept {
    return static_cast<std::uint8_t>(static_cast<unsigned>(low) | static_cast<unsigned>(high) << 2);
  }
  BuiltMesh(LabelledMesh made, const SurfaceSamples& samples, const EdgeIndex& index, const PointLabels& labels)
      : LabelledMesh(std::move(made)),
        pairs(this->mesh.quads.size(), label_pair(PointLabel::kTablet, PointLabel::kEnvelope)) {
    each_quad_edge(samples.signs, index, [&](std::uint32_t q, const GridEdge& e) {
      const PointLabel from = labels.get(e.x, e.y, e.z),
                       to = labels.get(e.x + (e.axis == 0), e.y + (e.axis == 1), e.z + (e.axis == 2));
      pairs[q] = label_pair(std::min(from, to), std::max(from, to));
    });
  }
};

/// A labelled volume in the form that build_labelled_mesh() reads.
struct LabelledScene {
  std::unique_ptr<SurfaceSamples> samples = std::make_unique<SurfaceSamples>();
  std::unique_ptr<EnvelopeBits> envelope;
  std::unique_ptr<PointLabels> labels;
  std::unique_ptr<EdgeIndex> index;
  std::unique_ptr<ContactEdges> edges;
  std::vector<std::uint16_t> contact;

  explicit LabelledScene(const Labels& volume, int bits = 4) {
    samples->dims = volume.dims;
    samples->offset_bits = bits;
    samples->signs = BitVolume(volume.dims);
    each(volume.dims, [&](auto x, auto y, auto z) { samples->signs.set(x, y, z, volume.at(x, y, z) != 0); });
    envelope = std::make_unique<EnvelopeBits>(volume.dims);
    each(volume.dims, [&](auto x, auto y, auto z) { envelope->set(x, y, z, volume.at(x, y, z) == 2); });
    labels = std::make_unique<PointLabels>(samples->signs, *envelope);
    const SampleCounts counts = count_samples(samples->signs);
    samples->offsets.assign(static_cast<std::size_t>(counts.edges), static_cast<std::uint16_t>(1 << (bits - 1)));
    samples->joined.assign(static_cast<std::size_t>(counts.faces), 0);
    edges = std::make_unique<ContactEdges>(*labels);
    contact.assign(edges->all().size(), static_cast<std::uint16_t>(1 << (bits - 1)));
    auto made = EdgeIndex::create(*samples);
    EXPECT_TRUE(made.has_value());
    index = std::make_unique<EdgeIndex>(std::move(*made));
  }
  LabelledScene& draw(unsigned seed) {
    std::mt19937 random(seed);
    const unsigned most = (1u << samples->offset_bits) - 1;
    for (auto* offsets : {&samples->offsets, &contact})
      for (std::uint16_t& o : *offsets) o = static_cast<std::uint16_t>(random() & most);
    for (std::uint8_t& j : samples->joined) j = random() & 1u;
    return *this;
  }
  BuiltMesh build() const {
    SilentProgress progress;
    auto mesh = build_labelled_mesh(*samples, *index, *labels, *edges, contact, progress);
    EXPECT_TRUE(mesh.has_value()) << mesh.error().message;
    return BuiltMesh(std::move(*mesh), *samples, *index, *labels);
  }
  template <class Visit>
  static void each(const Dims& dims, const Visit& visit) {
    for (std::int64_t z = 0; z < dims.z; ++z)
      for (std::int64_t y = 0; y < dims.y; ++y)
        for (std::int64_t x = 0; x < dims.x; ++x) visit(x, y, z);
  }
};

/// Triangles of the surface of one label, out of it.
inline std::vector<Triangle> surface_of(const BuiltMesh& labelled, std::span<const Triangle> triangles,
                                        std::span<const std::uint32_t> first_triangle, PointLabel label) {
  std::vector<Triangle> surface;
  for (std::uint32_t q = 0; q < labelled.pairs.size(); ++q) {
    if (PointLabel(labelled.pairs[q] & 3u) != label && PointLabel(labelled.pairs[q] >> 2) != label) continue;
    for (std::uint32_t t = first_triangle[q]; t < first_triangle[q + 1]; ++t) {
      Triangle triangle = triangles[t];
      if (PointLabel(labelled.pairs[q] & 3u) == label) std::swap(triangle[1], triangle[2]);
      surface.push_back(triangle);
    }
  }
  return surface;
}

/// Every label's surface, that of the air, too, is closed, oriented and a 2-manifold; no two triangles are the same.
inline void expect_closed_manifolds(const BuiltMesh& labelled, std::span<const glm::vec3> positions,
                                    std::span<const Triangle> triangles,
                                    std::span<const std::uint32_t> first_triangle) {
  for (const PointLabel label : {PointLabel::kAir, PointLabel::kTablet, PointLabel::kEnvelope}) {
    const std::vector<Triangle> surface = surface_of(labelled, triangles, first_triangle, label);
    const MeshCheck check = check_mesh(positions, surface);
    EXPECT_EQ(check.boundary_edges, 0) << static_cast<int>(label);
    EXPECT_EQ(check.nonmanifold_edges, 0) << static_cast<int>(label);
    EXPECT_EQ(check.nonmanifold_vertices, 0) << static_cast<int>(label);
    EXPECT_EQ(check.inconsistent_edges, 0) << static_cast<int>(label);
    EXPECT_EQ(check.degenerate_triangles, 0) << static_cast<int>(label);
  }
  std::vector<Triangle> sorted(triangles.begin(), triangles.end());
  for (Triangle& t : sorted) std::sort(t.begin(), t.end());
  std::sort(sorted.begin(), sorted.end());
  EXPECT_TRUE(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) << "two equal triangles";
}

inline Labels random_labels(Dims dims, unsigned seed, std::array<unsigned, 3> weights = {1, 1, 1}) {
  std::mt19937 random(seed);
  Labels volume(dims);
  const unsigned all = weights[0] + weights[1] + weights[2];
  for (std::uint8_t& label : volume.voxels) {
    const unsigned drawn = static_cast<unsigned>(random() >> 8) % all;
    label = drawn < weights[0] ? 0 : drawn < weights[0] + weights[1] ? 1 : 2;
  }
  return volume;
}

/// A volume of drawn labels in which every labelling of a cell, of each `parts` the one with number `part`, stands
/// once, with drawn points around it.
inline Labels all_labellings(unsigned seed, int part = 0, int parts = 1) {
  constexpr std::int64_t kEvery = 4;
  std::int64_t blocks = 1;
  while (blocks * blocks * blocks * parts < LabelledCellTable::kLabellings) ++blocks;
  const std::int64_t n = blocks * kEvery + 1;
  Labels volume = random_labels({n, n, n}, seed);
  LabelledScene::each({blocks, blocks, blocks}, [&](auto x, auto y, auto z) {
    const auto labelling = static_cast<int>((z * blocks + y) * blocks + x) * parts + part;
    if (labelling >= LabelledCellTable::kLabellings) return;
    const CornerLabels labels = LabelledCellTable::labels_of(labelling);
    for (unsigned c = 0; c < 8; ++c)
      volume.at(kEvery * x + 1 + (c & 1u), kEvery * y + 1 + (c >> 1 & 1u), kEvery * z + 1 + (c >> 2)) = labels[c];
  });
  return volume;
}

/// The volume within a layer of air.
inline Labels in_air(const Labels& volume, const glm::ivec3& low = glm::ivec3(1),
                     const glm::ivec3& high = glm::ivec3(1)) {
  Labels wider(Dims{volume.dims.x + low.x + high.x, volume.dims.y + low.y + high.y, volume.dims.z + low.z + high.z});
  std::fill(wider.voxels.begin(), wider.voxels.end(), std::uint8_t{0});
  LabelledScene::each(volume.dims,
                      [&](auto x, auto y, auto z) { wider.at(x + low.x, y + low.y, z + low.z) = volume.at(x, y, z); });
  return wider;
}

/// Three smooth fields; the greatest gives the label.
inline Labels smooth_labels(Dims dims, unsigned seed, double wave = 9.0) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32; };
  struct Wave {
    double x, y, z, phase;
  };
  std::array<std::vector<Wave>, 3> waves;
  for (auto& field : waves)
    for (int i = 0; i < 12; ++i)
      field.push_back({(uniform() - 0.5) * 12.6 / wave, (uniform() - 0.5) * 12.6 / wave,
                       (uniform() - 0.5) * 12.6 / wave, uniform() * 6.3});
  Labels volume(dims);
  LabelledScene::each(dims, [&](auto x, auto y, auto z) {
    std::array<double, 3> value{};
    for (std::size_t k = 0; k < 3; ++k)
      for (const Wave& w : waves[k])
        value[k] += std::sin(w.x * static_cast<double>(x) + w.y * static_cast<double>(y) +
                             w.z * static_cast<double>(z) + w.phase);
    volume.at(x, y, z) = static_cast<std::uint8_t>(std::max_element(value.begin(), value.end()) - value.begin());
  });
  return volume;
}

/// A tablet in an envelope in air, both rough, and open where the envelope is thin.
inline Labels nested_labels(std::int64_t n, double rough, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32 - 0.5; };
  Labels volume(Dims{n, n, n});
  const double middle = 0.5 * static_cast<double>(n - 1);
  LabelledScene::each(volume.dims, [&](auto x, auto y, auto z) {
    const double dx = static_cast<double>(x) - middle,
                 dy = static_cast<double>(y) - middle - 0.05 * static_cast<double>(n),
                 dz = static_cast<double>(z) - middle;
    const double r = std::sqrt(dx * dx + dy * dy + dz * dz) + 2.0 * rough * uniform();
    const double outer =
        std::sqrt(dx * dx + (dy + 0.1 * static_cast<double>(n)) * (dy + 0.1 * static_cast<double>(n)) + dz * dz) +
        2.0 * rough * uniform();
    const bool border = x == 0 || y == 0 || z == 0 || x + 1 == n || y + 1 == n || z + 1 == n;
    volume.at(x, y, z) = border                                 ? 0
                         : r < 0.28 * static_cast<double>(n)    ? 1
                         : outer < 0.4 * static_cast<double>(n) ? 2
                                                                : 0;
  });
  return volume;
}

}  // namespace dubsar
