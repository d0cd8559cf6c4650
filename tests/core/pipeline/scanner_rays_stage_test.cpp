// Scans of a simulated scanner, read by the whole chain: what straightening and an axis set right give the surface.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <glm/vec3.hpp>

#include "core/mesh/evidence.h"
#include "core/mesh/tri_mesh.h"
#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"

namespace dubsar {
namespace {
namespace fs = std::filesystem;

struct ReadTablet {
  double rms = 0.0;  ///< from the true surface, of vertices nearer than 3 voxels, voxels
  RaysReport rays;
};

ReadTablet read_tablet(const char* scanner, Artefacts artefacts) {
  const fs::path path = fs::temp_directory_path() / fmt::format("dubsar_rays_stage_{}.h5", ::getpid());
  SilentProgress progress;
  phantom::PhantomOptions wanted;
  wanted.dims = {160, 100, 150};
  wanted.seed = 20611;
  wanted.scanner = phantom::parse_scanner(scanner).value();
  EXPECT_TRUE(phantom::write_phantom(path, std::nullopt, wanted, progress));
  PipelineOptions options;
  options.import.path = path;
  options.detail = Detail::kScan;
  options.contact.reset();
  options.occlusion.reset();
  options.artefacts = artefacts;
  const Result<PipelineResult> result = run_pipeline(options, progress);
  fs::remove(path);
  ReadTablet read;
  EXPECT_TRUE(result) << result.error().message;
  if (!result) return read;
  if (result->report.scan.rays) read.rays = *result->report.scan.rays;
  const auto tablet = make_tri_mesh(result->model, {.body = "tablet"});
  EXPECT_TRUE(tablet);
  if (!tablet) return read;
  const auto truth = phantom::Phantom::create(wanted).value();
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < tablet->positions.size(); ++i) {
    if (!tablet->evidence.empty() && tablet->evidence[i] == evidence_byte(Evidence::kInferred)) continue;
    const glm::dvec3 p(tablet->frame.input_vox_from_grid(tablet->positions[i]));
    const double off = truth->tablet_distance(p);
    if (std::abs(off) > 3.0 || truth->gap_width(p) < 1.5) continue;
    squares += off * off;
    count += 1.0;
  }
  read.rms = std::sqrt(squares / std::max(1.0, count));
  return read;
}

TEST(ScannerRays, ScatterIsTakenOutOfAScanByStrongScatter) {
  const ReadTablet off = read_tablet("strong,axis=0,turn=half,cone=0", Artefacts::kOff);
  const ReadTablet on = read_tablet("strong,axis=0,turn=half,cone=0", Artefacts::kAuto);
  ASSERT_TRUE(on.rays.straightened);
  EXPECT_TRUE(on.rays.bent->stray);
  EXPECT_LT(on.rays.bent->contrast, 0.75);
  EXPECT_LT(on.rms, 0.75 * off.rms) << off.rms;
}

TEST(ScannerRays, AnAxisThatIsOffAloneIsSetRight) {
  const ReadTablet off = read_tablet("ideal,axis=1,turn=half,cone=0", Artefacts::kOff);
  const ReadTablet on = read_tablet("ideal,axis=1,turn=half,cone=0", Artefacts::kAuto);
  ASSERT_TRUE(on.rays.straightened);
  EXPECT_FALSE(on.rays.bent->curve.bends());
  EXPECT_NEAR(std::abs(on.rays.straightened->axis_shift.pixels), 1.0, 0.1);
  EXPECT_LT(on.rms, 0.3 * off.rms) << off.rms;
}

TEST(ScannerRays, ACleanScanIsLeftAsItIs) {
  const ReadTablet clean = read_tablet("ideal,turn=half,cone=0", Artefacts::kAuto);
  EXPECT_FALSE(clean.rays.bent);
  EXPECT_FALSE(clean.rays.straightened);
  EXPECT_GT(clean.rays.seen.bend, 0.9);
  EXPECT_LT(clean.rays.seen.bend, 1.1);
}

}  // namespace
}  // namespace dubsar
