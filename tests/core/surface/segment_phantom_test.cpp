// The chain from scan to closed parts on phantoms, judged by their truth.

#include <gtest/gtest.h>

#include "core/phantom/phantom_source.h"
#include "core/surface/extract.h"
#include "core/surface/holes.h"
#include "core/surface/mesh_check.h"
#include "core/surface/segment.h"
#include "core/surface/smooth.h"
#include "core/volume/denoise.h"
#include "core/volume/estimate.h"
#include "core/volume/resample.h"
#include "tests/core/phantom/truth_compare.h"

namespace dubsar {
namespace {

SurfaceModel scan_and_segment(const std::shared_ptr<const phantom::Phantom>& truth) {
  SilentProgress progress;
  phantom::PhantomSource scan(truth);
  HalfResolutionSource half(scan);
  Volume<float> volume = read_all(half, progress).value();
  VolumeSource source(volume, half.frame());
  DenoiseOptions denoising;
  denoising.sigma = estimate(source, {}, progress).value().sigma;
  EXPECT_TRUE(denoise_in_place(volume, denoising, progress).has_value());
  ExtractOptions extraction;
  extraction.isovalue =
      static_cast<float>(automatic_threshold(estimate(source, {}, progress).value()).value());
  SurfaceModel model;
  model.frame = half.frame();
  model.samples = sample_surface(source, extraction, progress).value();
  model.mesh = build_quad_mesh(model.samples, progress).value();
  smooth(model.mesh, model.attributes.normals, {}, progress).value();
  EXPECT_TRUE(segment(model, {}, progress).value().nested);
  EXPECT_TRUE(fill_holes(model, {}, progress).value().watertight);
  return model;
}

phantom::TruthComparison judge(const phantom::Phantom& truth, const SurfaceModel& model) {
  MeshOptions options;
  options.fill_holes = false;  // a fill lies where no scan shows a surface
  TriMesh mesh = make_tri_mesh(model, options).value();
  for (glm::vec3& p : mesh.positions) p = glm::vec3(mesh.frame.input_vox_from_grid(glm::dvec3(p)));
  return phantom::compare(truth, {mesh.positions, mesh.triangles, mesh.partition, 2.0});
}

void expect_closed_parts(const SurfaceModel& model) {
  ASSERT_GE(model.partitions.size(), 3u);
  EXPECT_EQ(model.partitions[0].name, "tablet");
  EXPECT_EQ(model.partitions[1].name, "envelope outside");
  EXPECT_EQ(model.partitions[2].name, "envelope inside");
  const auto parts = measure_parts(model).value();
  EXPECT_EQ(parts[0].name, "tablet");
  EXPECT_EQ(parts[1].name, "envelope");
  for (const Partition& part : parts) EXPECT_TRUE(part.watertight) << part.name;
  EXPECT_GT(parts[0].volume_mm3, 0.0);
  EXPECT_GT(parts[1].volume_mm3, 0.0);
  const TriMesh all = make_tri_mesh(model).value();
  EXPECT_TRUE(check_mesh(all.positions, all.triangles).watertight());
}

/// The gap is about one voxel of the processed grid wide here, which costs the tablet some purity.
TEST(SegmentPhantom, SmallGluedPhantomIsSeparatedIntoClosedParts) {
  phantom::PhantomOptions options;
  options.dims = {320, 170, 296};
  options.seed = 3;
  const std::shared_ptr<const phantom::Phantom> truth = phantom::Phantom::create(options).value();
  EXPECT_GT(truth->glued_fraction(), 0.05);
  const SurfaceModel model = scan_and_segment(truth);
  expect_closed_parts(model);
  const auto score = judge(*truth, model);
  EXPECT_GE(score.owner[0].purity(), 0.96) << score.text();
  EXPECT_GE(score.owner[0].recall(), 0.99) << score.text();
  EXPECT_GE(score.owner[1].purity(), 0.99) << score.text();
  EXPECT_GE(score.owner[1].recall(), 0.985) << score.text();
}

class SegmentPhantomSlow : public testing::TestWithParam<unsigned> {};

TEST_P(SegmentPhantomSlow, PurityAndRecallAreAtLeast99PerCent) {
  phantom::PhantomOptions options;
  options.seed = GetParam();
  const std::shared_ptr<const phantom::Phantom> truth = phantom::Phantom::create(options).value();
  EXPECT_GT(truth->glued_fraction(), 0.05);
  const SurfaceModel model = scan_and_segment(truth);
  expect_closed_parts(model);
  const auto score = judge(*truth, model);
  for (const phantom::PartScore& owner : score.owner) {
    EXPECT_GE(owner.purity(), 0.99) << score.text();
    EXPECT_GE(owner.recall(), 0.99) << score.text();
  }
}

INSTANTIATE_TEST_SUITE_P(FiveSeeds, SegmentPhantomSlow, testing::Range(1u, 6u));

}  // namespace
}  // namespace dubsar
