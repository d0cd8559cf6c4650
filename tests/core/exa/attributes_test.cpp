#include "core/exa/values/attributes.h"

#include <cmath>

#include "core/exa/values/exact.h"
#include "tests/core/exa/chunk_views.h"
#include "tests/core/exa/exa_test_models.h"

namespace dubsar {
namespace {

/// Light as rays give it: smooth over the surface, and noise of some levels.
std::vector<std::uint8_t> noisy_light(const QuadMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.4);
  std::vector<std::uint8_t> light;
  for (const glm::vec3& p : mesh.positions)
    light.push_back(static_cast<std::uint8_t>(
        std::clamp(std::round(45.0 + 20.0 * std::sin(0.1 * double{p.x}) + noise(random)), 0.0, 63.0)));
  return light;
}

TEST(ExaAttributes, LabelsOfAllKindsComeBack) {
  SilentProgress progress;
  const SurfaceModel model = sample_model({40, 30, 50}, Kind::kBlob, 11);
  std::mt19937 random(4);
  for (const ExaLabel label : {ExaLabel::kShape, ExaLabel::kLight, ExaLabel::kPartition, ExaLabel::kEnum}) {
    const auto items =
        static_cast<std::size_t>(label == ExaLabel::kPartition ? model.mesh.quad_count() : model.mesh.vertex_count());
    for (const bool noise : {false, true}) {
      std::vector<std::uint8_t> values(items);
      for (std::size_t i = 0; i < items; ++i)
        values[i] =
            static_cast<std::uint8_t>((noise ? random() : i / 97) % static_cast<unsigned>(highest_label(label) + 1));
      const auto chunks = encode_labels(label, model.mesh, values, progress);
      const auto back = decode_labels(label, model.mesh, views_of(chunks), progress);
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(*back, values);
    }
  }
}

TEST(ExaAttributes, EvidenceInRegionsTakesNextToNothing) {
  SilentProgress progress;
  const SurfaceModel model = sample_model({60, 60, 60}, Kind::kBlob, 12);
  std::vector<std::uint8_t> evidence;
  for (const glm::vec3& p : model.mesh.positions)
    evidence.push_back(static_cast<std::uint8_t>(static_cast<int>(p.x / 15.0f) % 2 + 2 * (p.z > 40.0f ? 1 : 0)));
  const auto chunks = encode_labels(ExaLabel::kEnum, model.mesh, evidence, progress);
  EXPECT_LT(8.0 * static_cast<double>(bytes_of(chunks)), 0.3 * static_cast<double>(evidence.size()));
  EXPECT_EQ(decode_labels(ExaLabel::kEnum, model.mesh, views_of(chunks), progress).value(), evidence);
}

TEST(ExaAttributes, SettledLightMovesByOneLevelAtMostAndTakesAlmostHalfTheBits) {
  SilentProgress progress;
  SurfaceModel model = sample_model({70, 60, 50}, Kind::kBlob, 13);
  model.mesh = build_quad_mesh(model.samples, progress).value();
  const std::vector<std::uint8_t> before = noisy_light(model.mesh, 5);
  std::vector<std::uint8_t> light = before;
  settle_light(model.mesh, light, progress);
  for (std::size_t v = 0; v < light.size(); ++v)
    ASSERT_LE(std::abs(int{light[v]} - int{before[v]}), kLightStep / 2) << v;
  const auto chunks = encode_labels(ExaLabel::kLight, model.mesh, light, progress);
  const auto exact = encode_labels(ExaLabel::kLight, model.mesh, before, progress);
  EXPECT_LT(bytes_of(chunks), bytes_of(exact) * 6 / 10);
  EXPECT_EQ(decode_labels(ExaLabel::kLight, model.mesh, views_of(chunks), progress).value(), light);
  EXPECT_EQ(decode_labels(ExaLabel::kLight, model.mesh, views_of(exact), progress).value(), before);
  std::vector<std::uint8_t> twice = light;
  settle_light(model.mesh, twice, progress);
  EXPECT_EQ(twice, light);
}

TEST(ExaAttributes, WrongChunksAreRefused) {
  SilentProgress progress;
  const SurfaceModel model = sample_model({20, 20, 20}, Kind::kBlob, 14);
  EXPECT_EQ(decode_labels(ExaLabel::kLight, model.mesh, {}, progress).error().kind, ErrorKind::kBadData);
  for (const std::string_view chunk : {std::string_view(), std::string_view("\x02zz"), std::string_view("\x7f")}) {
    const std::vector<std::string_view> chunks{chunk};
    EXPECT_EQ(decode_labels(ExaLabel::kLight, model.mesh, chunks, progress).error().kind, ErrorKind::kBadData);
  }
}

TEST(ExactNumbers, OnesThatAreNoneAreRefusedWhenTheyAreReadAndWhenTheyAreWritten) {
  SilentProgress progress;
  for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
    std::vector<float> values(99, 0.25f), back(99);
    ASSERT_TRUE(decode_floats(views_of(encode_floats(values, 3, progress)), 3, "normals", back, progress));
    EXPECT_EQ(back, values);
    values[57] = bad;
    const auto read = decode_floats(views_of(encode_floats(values, 3, progress)), 3, "normals", back, progress);
    ASSERT_FALSE(read) << bad;
    EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(read.error().message, "exa: a number of normals is not finite");

    const SurfaceModel sound = sample_model({9, 8, 7}, Kind::kBlob, 3);
    for (const int which : {0, 1, 2}) {
      SurfaceModel model = sound;
      (which == 0   ? model.attributes.normals.at(5).y
       : which == 1 ? model.attributes.k_min.at(5)
                    : model.attributes.k_max.at(5)) = bad;
      const auto written = encode_exa(model, progress);
      ASSERT_FALSE(written) << which;
      EXPECT_NE(written.error().message.find("not finite"), std::string::npos) << written.error().message;
    }
  }
}

}  // namespace
}  // namespace dubsar
