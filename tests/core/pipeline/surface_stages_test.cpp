#include "core/pipeline/surface_stages.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/parts/grid_scene.h"

namespace dubsar {
namespace {

/// A body in a shell that fills most of the cavity, but is cut into plates that hang together on one side.
SurfaceModel furrowed_body() {
  scene::Nested nested;
  nested.gap = 2.0f;
  return scene::extract_model(nested.dims, [nested](const glm::vec3& p) {
    const float furrow = std::abs(p.x - 5.0f * std::round(p.x / 5.0f)) - 0.9f;
    const float base = p.y - nested.centre.y;
    const float body = std::min(nested.tablet(p), std::max(furrow, base));
    return std::max(std::min(nested.shell(p), -nested.hollow(p)), body);
  });
}

TEST(Separate, ABodyFullOfFurrowsIsNoTablet) {
  StageClock clock;
  SilentProgress progress;
  SurfaceModel alone = furrowed_body();
  ASSERT_TRUE(segment(alone, {}, progress).value().nested) << "the scene does not ask the question";
  const SeparatedModel made = separate(furrowed_body(), {}, true, {clock, progress}).value();
  EXPECT_FALSE(made.segment.nested);
  EXPECT_TRUE(made.segment.enclosure_refused);
  EXPECT_EQ(made.model.partitions.find(PartitionKind::kTablet), nullptr);
  EXPECT_EQ(made.model.partitions.find(PartitionKind::kEnvelopeInside), nullptr);
  ASSERT_NE(made.model.partitions.find(PartitionKind::kObject), nullptr);
  for (const Partition& part : made.model.partitions) {
    EXPECT_TRUE(part.watertight) << part.name;
  }
}

TEST(Separate, ASmoothBodyThatFillsItsCavityIsATablet) {
  StageClock clock;
  SilentProgress progress;
  scene::Nested nested;
  nested.glue = [](const glm::vec3& p) { return p.y < 20.0f && std::hypot(p.x - 47.0f, p.z - 47.0f) < 9.0f; };
  const SeparatedModel made = separate(scene::extract_model(nested.dims, nested), {}, true, {clock, progress}).value();
  EXPECT_TRUE(made.segment.nested);
  EXPECT_FALSE(made.segment.enclosure_refused);
  EXPECT_NE(made.model.partitions.find(PartitionKind::kTablet), nullptr);
}

}  // namespace
}  // namespace dubsar
