#include "core/rays/curve_evidence.h"

#include <array>
#include <optional>

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

/// Products of two planes may be a little less than 0 by chance, squares are not: parts of the contrast, squared.
constexpr double kRidge = 1e-5;

/// Pairs of planes are left out in so many blocks of neighbours, which may share noise, for the error of a gain; every
/// other two blocks are one half, so that both halves have rays of the same lengths in a body that tapers.
constexpr std::size_t kBlocks = 8;

/// The images at a pixel.
TermVector values_at(const std::vector<LaneImage>& images, std::int64_t x, std::int64_t y, std::size_t lane) {
  TermVector v{};
  for (std::size_t k = 0; k < RayCurve::kTerms; ++k) v[k] = images[k].at(x, y)[lane];
  return v;
}

/// Of clay and air together, in parts of the contrast, squared.
double variance_of(const EvenEvidence& evidence, const TermVector& c) {
  const double contrast = evidence.clay.mean(c) - evidence.air.mean(c);
  return (evidence.clay.variance(c) + evidence.air.variance(c)) / (contrast * contrast);
}

struct Gain {
  double before = 0.0, after = 0.0;  ///< sums over both halves
};

/// Each half by the curve of the other; without one block, or with all of them.
Gain gain_elsewhere(std::span<const EvenEvidence, kBlocks> blocks, std::optional<std::size_t> without) {
  std::array<EvenEvidence, 2> halves;
  for (std::size_t block = 0; block < kBlocks; ++block)
    if (block != without) halves[block / 2 % 2].add(blocks[block]);
  Gain gain;
  for (const std::size_t half : {std::size_t{0}, std::size_t{1}}) {
    gain.before += variance_of(halves[half], {1.0});
    gain.after += variance_of(halves[half], fit(halves[1 - half]));
  }
  return gain;
}

}  // namespace

std::vector<EvenEvidence> gather(const std::vector<LaneImage>& images, const SureMaterials& sure,
                                 const PlaneStrides& at, std::span<const std::int64_t> planes) {
  const auto material = [&](std::int64_t x, std::int64_t y, std::size_t lane) {
    return sure
        .of_voxel[static_cast<std::size_t>(planes[lane] * at.to_next + y * at.along_height + x * at.along_width)];
  };
  const std::size_t pairs = planes.size() / 2;
  using Pairs = std::vector<EvenEvidence>;
  return parallel_reduce<Pairs>(
      at.height, 8, Pairs(pairs),
      [&](std::int64_t begin, std::int64_t end) {
        Pairs part(pairs);
        for (std::int64_t y = begin; y < end; ++y)
          for (std::int64_t x = 0; x < at.width; ++x)
            for (std::size_t pair = 0; pair < pairs; ++pair) {
              const std::size_t lane = 2 * pair;
              const Material here = material(x, y, lane);
              if (here == Material::kUnsure || here != material(x, y, lane + 1)) continue;
              (here == Material::kClay ? part[pair].clay : part[pair].air)
                  .add(values_at(images, x, y, lane), values_at(images, x, y, lane + 1));
            }
        return part;
      },
      [](Pairs all, const Pairs& part) {
        for (std::size_t pair = 0; pair < all.size(); ++pair) all[pair].add(part[pair]);
        return all;
      });
}

EvenEvidence sum_of(std::span<const EvenEvidence> pairs) {
  EvenEvidence all;
  for (const EvenEvidence& pair : pairs) all.add(pair);
  return all;
}

Evenness evenness(const EvenEvidence& evidence, const TermVector& c) {
  const double contrast = evidence.clay.mean(c) - evidence.air.mean(c);
  return {evidence.clay.deviation(c) / contrast, evidence.air.deviation(c) / contrast};
}

TermVector fit(const EvenEvidence& evidence) {
  TermMatrix gram{};
  TermVector right{};
  for (std::size_t i = 0; i < RayCurve::kTerms; ++i) {
    right[i] = evidence.clay.sums[i] / evidence.clay.count;
    for (std::size_t j = 0; j < RayCurve::kTerms; ++j)
      gram[i][j] = evidence.clay.product(i, j) + evidence.air.product(i, j);
    gram[i][i] += kRidge;
  }
  return nonnegative_fit(gram, right);
}

Elsewhere look_elsewhere(std::span<const EvenEvidence> pairs) {
  if (pairs.size() < kBlocks) return {};
  std::array<EvenEvidence, kBlocks> blocks;
  for (std::size_t k = 0; k < pairs.size(); ++k) blocks[k * kBlocks / pairs.size()].add(pairs[k]);
  const Gain all = gain_elsewhere(blocks, {});
  Elsewhere found{all.after / all.before, 0.5 * (all.before - all.after)};
  double sum = 0.0, squares = 0.0;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const Gain some = gain_elsewhere(blocks, block);
    const double gain = 0.5 * (some.before - some.after);
    sum += gain;
    squares += gain * gain;
  }
  constexpr auto kCount = static_cast<double>(kBlocks);
  found.error = std::sqrt(std::max(0.0, (kCount - 1.0) / kCount * (squares - sum * sum / kCount)));
  return found;
}

}  // namespace dubsar
