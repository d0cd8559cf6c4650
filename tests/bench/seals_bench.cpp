// Impressions of one seal on phantoms' envelopes, half of each lost: the average beside the best single one.

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>
#include <string_view>

#include "core/exa/exa_file.h"
#include "core/phantom/seal.h"
#include "core/phantom/write_phantom.h"
#include "core/pipeline/pipeline.h"
#include "core/seals/seal_average.h"
#include "core/seals/seal_band.h"

namespace dubsar {
namespace {

constexpr std::string_view kSealsHelp =
    "seals_bench [--size XxYxZ] [--seed N] [--seeds COUNT] [--lost SHARE] [--keep DIR] [--pgm FILE]\n"
    "  --lost  of each sealing (.5); the obverse's two and the reverse's one are taken\n"
    "  --keep  surfaces are kept in this folder, and taken from there the next time\n"
    "  --pgm   each single one, the average and the truth as one gray picture\n";

struct SealsArguments {
  Dims dims{256, 160, 240};
  std::uint64_t seed = 1;
  int seeds = 1;
  double lost = 0.5;
  std::string keep, pgm;
};

[[noreturn]] void seals_usage() {
  fmt::print(stderr, "{}", kSealsHelp);
  std::exit(64);
}

SealsArguments parse_seals(int argc, char** argv) {
  SealsArguments a;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view word = argv[i];
    const char* value = argv[i + 1];
    if (word == "--seed") {
      a.seed = std::strtoull(value, nullptr, 10);
    } else if (word == "--seeds") {
      a.seeds = std::atoi(value);
    } else if (word == "--lost") {
      a.lost = std::atof(value);
    } else if (word == "--keep") {
      a.keep = value;
    } else if (word == "--pgm") {
      a.pgm = value;
    } else if (word == "--size") {
      long x = 0, y = 0, z = 0;
      if (std::sscanf(value, "%ldx%ldx%ld", &x, &y, &z) != 3) seals_usage();
      a.dims = {x, y, z};
    } else {
      seals_usage();
    }
  }
  if (argc % 2 == 0) seals_usage();
  return a;
}

template <class T>
T seals_value(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "seals_bench: {}\n", result.error().message);
  std::exit(1);
}

SurfaceModel sealed_surface(const phantom::PhantomOptions& options, const std::string& keep, Progress& progress) {
  namespace fs = std::filesystem;
  const fs::path kept = fs::path(keep) / fmt::format("seals{}_{}x{}x{}_{:g}.exa", options.seed, options.dims.x,
                                                     options.dims.y, options.dims.z, options.writing.seals_lost);
  if (!keep.empty() && fs::exists(kept)) return seals_value(read_exa(kept, progress));
  const fs::path scan = fs::temp_directory_path() / fmt::format("dubsar_seals_{}.h5", ::getpid());
  seals_value(phantom::write_phantom(scan, std::nullopt, options, progress));
  PipelineOptions pipeline;
  pipeline.import.path = scan;
  pipeline.occlusion.reset();
  auto result = run_pipeline(pipeline, progress);
  fs::remove(scan);
  SurfaceModel model = std::move(seals_value(std::move(result)).model);
  if (!keep.empty()) seals_value(write_exa(kept, model, progress));
  return model;
}

/// The seal's own raster, .25 mm.
constexpr double kTruthMm = 0.25;
constexpr int kTruthColumns = static_cast<int>(phantom::SealRelief::kTurnMm / kTruthMm),
              kTruthRows = static_cast<int>(phantom::SealRelief::kHeightMm / kTruthMm);
struct SealGrid {
  std::vector<double> sum = std::vector<double>(kTruthColumns * kTruthRows), count = sum, truth = sum, shown = sum;
  std::array<std::vector<double>, 3> shown_by{sum, sum, sum};
  static std::size_t at(const phantom::SealPlace& p) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(p.y_mm / kTruthMm), 0, kTruthRows - 1)) *
               kTruthColumns +
           static_cast<std::size_t>(std::clamp(static_cast<int>(p.x_mm / kTruthMm), 0, kTruthColumns - 1));
  }
};

struct JudgedSeal {
  double rms = 0.0, rms_shown = 0.0, covered = 0.0;  ///< over the whole seal; where `any` shows it; share of that
  double seen = 0.0, rms_seen = 0.0;                 ///< share that is drawn, error there
  double best_gain = 0.0;                            ///< factor that would fit best
  double turn_mm = 0.0;
  std::vector<float> picture;
};

/// A relief in the frame of a band, against the seal that was rolled. What it does not show counts as its mean.
JudgedSeal judge_seal(const phantom::Phantom& truth, std::size_t sealing, const UnrolledBand& band,
                      const SealImpression& relief, const glm::dvec2& least, double turn_mm, const SealGrid& any) {
  const double voxel = truth.options().voxel_mm;
  SealGrid grid;
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x) {
      const std::size_t at = relief.index(x, y);
      if (relief.shown[at] < 0.3f) continue;
      glm::dvec2 p = least + relief.step_mm * glm::dvec2(x, y);
      auto surface = band.surface_mm(p);
      std::optional<phantom::SealPlace> place;
      for (const double back : {0.0, turn_mm, -turn_mm}) {
        surface = band.surface_mm(p + glm::dvec2(back, 0.0));
        if (surface) place = truth.seal_place(sealing, *surface / voxel);
        if (place) break;
      }
      if (!place) continue;
      grid.sum[SealGrid::at(*place)] += static_cast<double>(relief.mm[at]);
      grid.count[SealGrid::at(*place)] += 1.0;
    }
  double mean = 0.0, cells = 0.0, off = 0.0, seen = 0.0, et = 0.0, ee = 0.0;
  for (std::size_t k = 0; k < grid.sum.size(); ++k) {
    if (any.count[k] == 0.0) continue;
    mean += any.truth[k];
    cells += 1.0;
    if (grid.count[k] > 0.0) {
      off += any.truth[k] - grid.sum[k] / grid.count[k];
      seen += 1.0;
    }
  }
  mean /= cells;
  off /= std::max(seen, 1.0);
  JudgedSeal out;
  double squares = 0.0, squares_shown = 0.0, shown = 0.0, covered = 0.0;
  out.picture.assign(grid.sum.size(), 0.0f);
  for (std::size_t k = 0; k < grid.sum.size(); ++k) {
    if (any.count[k] == 0.0) continue;
    const double estimate = grid.count[k] > 0.0 ? grid.sum[k] / grid.count[k] + off : mean;
    const double error = estimate - any.truth[k];
    out.picture[k] = static_cast<float>(estimate);
    squares += error * error;
    if (grid.count[k] > 0.0) {
      out.rms_seen += error * error;
      out.seen += 1.0;
      et += (estimate - mean) * (any.truth[k] - mean);
      ee += (estimate - mean) * (estimate - mean);
    }
    if (any.shown[k] > 0.0) {
      shown += 1.0;
      squares_shown += error * error;
      if (grid.count[k] > 0.0) covered += 1.0;
    }
  }
  out.rms_seen = std::sqrt(out.rms_seen / std::max(out.seen, 1.0));
  out.seen /= cells;
  out.best_gain = ee > 0 ? et / ee : 0.0;
  out.rms = std::sqrt(squares / cells);
  out.rms_shown = std::sqrt(squares_shown / std::max(shown, 1.0));
  out.covered = covered / std::max(shown, 1.0);
  return out;
}

/// Error over the whole seal of who knows exactly what is shown, and takes the mean for what is not.
double least_error(const SealGrid& any, const std::vector<double>& shown) {
  double mean = 0.0, cells = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < any.count.size(); ++k)
    if (any.count[k] > 0.0) mean += any.truth[k], cells += 1.0;
  mean /= cells;
  for (std::size_t k = 0; k < any.count.size(); ++k)
    if (any.count[k] > 0.0 && shown[k] == 0.0) squares += (any.truth[k] - mean) * (any.truth[k] - mean);
  return std::sqrt(squares / cells);
}

void write_pgm(const std::string& path, const std::vector<std::vector<float>>& pictures) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return;
  fmt::print(file, "P5\n{} {}\n255\n", kTruthColumns, kTruthRows * static_cast<int>(pictures.size()));
  for (const auto& picture : pictures)
    for (int y = kTruthRows - 1; y >= 0; --y)
      for (int x = 0; x < kTruthColumns; ++x)
        std::fputc(
            std::clamp(static_cast<int>(100 + 250 * picture[static_cast<std::size_t>(y * kTruthColumns + x)]), 0, 255),
            file);
  std::fclose(file);
}

int run_seals(int argc, char** argv) {
  const SealsArguments a = parse_seals(argc, argv);
  SilentProgress progress;
  double least = 1e9, sum = 0.0;
  for (int k = 0; k < a.seeds; ++k) {
    phantom::PhantomOptions options;
    options.dims = a.dims;
    options.seed = a.seed + static_cast<std::uint64_t>(k);
    options.writing.seals_lost = a.lost;
    const auto truth = seals_value(phantom::Phantom::create(options));
    const SurfaceModel model = sealed_surface(options, a.keep, progress);
    const TriMesh mesh =
        seals_value(make_tri_mesh(model, {.partition = model.partitions.find(PartitionKind::kEnvelopeOutside)->id}));
    const double voxel = truth->options().voxel_mm;
    std::vector<UnrolledBand> bands;
    std::vector<SealImpression> impressions;
    SealGrid any;
    const auto sealings = truth->sealings();
    for (std::size_t s = 0; s < 3; ++s) {
      bands.push_back(seals_value(unroll(mesh, {sealings[s].from * voxel, sealings[s].to * voxel, 17.0})));
      impressions.push_back(level_impression(bands.back().relief));
      const HeightMap& map = bands.back().relief;
      double measured = 0, lost = 0;
      for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
          if (const auto surface = bands.back().surface_mm(map.step_mm * glm::dvec2(x, y)))
            if (const auto place = truth->seal_place(s, *surface / voxel)) {
              const std::size_t at = SealGrid::at(*place);
              any.count[at] += 1.0;
              any.truth[at] += place->height_mm;
              measured += 1.0;
              if (place->shown && !std::isnan(map.at(x, y))) {
                any.shown[at] += 1.0;
                any.shown_by[s][at] += 1.0;
              } else
                lost += 1.0;
            }
      fmt::print(
          "  band {}: {:.1f} x {:.1f} mm, step {:.3f}, length off by {:.2f} % (95 %), {:.2f} % at most, angles {:.2f} "
          "degrees; lost {:.2f}\n",
          s, map.width * map.step_mm, map.height * map.step_mm, map.step_mm, 100 * bands.back().distortion.length_95,
          100 * bands.back().distortion.length_most, bands.back().distortion.angle_95_deg, lost / measured);
    }
    for (std::size_t c = 0; c < any.count.size(); ++c)
      if (any.count[c] > 0) any.truth[c] /= any.count[c];
    std::size_t flattest = 0;
    for (std::size_t s = 1; s < bands.size(); ++s)
      if (bands[s].distortion.length_95 < bands[flattest].distortion.length_95) flattest = s;
    const SealAverage average = average_seal(impressions, {.first = flattest});
    std::vector<JudgedSeal> single;
    std::vector<std::vector<float>> pictures;
    double best = 1e9, best_alone = 1e9, covered = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
      const JudgedSeal alone = judge_seal(*truth, s, bands[s], impressions[s], glm::dvec2(0.0), 0.0, any);
      const SealAverage folded = average_seal({impressions[s]}, {.turn_mm = 38.0});
      const JudgedSeal own = judge_seal(*truth, s, bands[s], folded.relief, folded.least_mm, 38.0, any);
      fmt::print("  alone {:.4f} (drawn {:.3f} with {:.4f}), gain {:.2f}\n", own.rms, own.seen, own.rms_seen,
                 own.best_gain);
      best = std::min(best, own.rms);
      best_alone = std::min(best_alone, alone.rms);
      covered = std::max(covered, own.covered);
      pictures.push_back(own.picture);
    }
    const std::size_t first = average.placing.first;
    const JudgedSeal all =
        judge_seal(*truth, first, bands[first], average.relief, average.least_mm, average.placing.turn_mm, any);
    pictures.push_back(all.picture);
    std::vector<float> true_picture(any.truth.begin(), any.truth.end());
    pictures.push_back(true_picture);
    if (!a.pgm.empty()) write_pgm(a.pgm, pictures);
    double deviation = 0.0, mean = 0.0, shown = 0.0;
    for (std::size_t c = 0; c < any.truth.size(); ++c) mean += any.truth[c] / static_cast<double>(any.truth.size());
    for (std::size_t c = 0; c < any.truth.size(); ++c) {
      deviation += (any.truth[c] - mean) * (any.truth[c] - mean) / static_cast<double>(any.truth.size());
      shown += (any.shown[c] > 0.0 ? 1.0 : 0.0) / static_cast<double>(any.truth.size());
    }
    const double times = best / all.rms;
    double possible = 1e9;
    for (const auto& shown_by : any.shown_by) possible = std::min(possible, least_error(any, shown_by));
    possible /= least_error(any, any.shown);
    least = std::min(least, times);
    sum += times;
    fmt::print(
        "seed {}: relief {:.3f} mm RMS; error of the best single one {:.4f} (not folded {:.4f}), of the average {:.4f} "
        "({:.4f} where "
        "shown): {:.2f} times as good, {:.2f} if all that is shown were known exactly; any shows {:.3f} of the seal, "
        "drawn of that {:.4f} (best single {:.3f}); turn "
        "{:.2f} mm "
        "(log of likelihoods {:.1f}), likeness",
        options.seed, std::sqrt(deviation), best, best_alone, all.rms, all.rms_shown, times, possible, shown,
        all.covered, covered, average.placing.turn_mm, average.placing.turn_sure);
    for (const double like : average.placing.likeness) fmt::print(" {:.1f}", like);
    fmt::print("; drawn {:.3f} with {:.4f}, gain {:.2f}\n", all.seen, all.rms_seen, all.best_gain);
    std::fflush(stdout);
  }
  fmt::print("least {:.2f}, mean {:.2f} times as good\n", least, sum / a.seeds);
  return 0;
}

}  // namespace
}  // namespace dubsar

int main(int argc, char** argv) { return dubsar::run_seals(argc, argv); }
