#include "core/rays/curve_evidence.h"

#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

/// Products of two planes may be a little less than 0 by chance, squares are not: parts of the contrast, squared.
constexpr double kRidge = 1e-5;

/// The images at a pixel.
TermVector values_at(const std::vector<LaneImage>& images, std::int64_t x, std::int64_t y, std::size_t lane) {
  TermVector v{};
  for (std::size_t k = 0; k < RayCurve::kTerms; ++k) v[k] = images[k].at(x, y)[lane];
  return v;
}

}  // namespace

EvenEvidence gather(const std::vector<LaneImage>& images, const SureMaterials& sure, const PlaneStrides& at,
                    std::span<const std::int64_t> planes) {
  const auto material = [&](std::int64_t x, std::int64_t y, std::size_t lane) {
    return sure
        .of_voxel[static_cast<std::size_t>(planes[lane] * at.to_next + y * at.along_height + x * at.along_width)];
  };
  return parallel_reduce<EvenEvidence>(
      at.height, 8, {},
      [&](std::int64_t begin, std::int64_t end) {
        EvenEvidence part;
        for (std::int64_t y = begin; y < end; ++y)
          for (std::int64_t x = 0; x < at.width; ++x)
            for (std::size_t lane = 0; lane + 1 < planes.size(); lane += 2) {
              const Material here = material(x, y, lane);
              if (here == Material::kUnsure || here != material(x, y, lane + 1)) continue;
              (here == Material::kClay ? part.clay : part.air)
                  .add(values_at(images, x, y, lane), values_at(images, x, y, lane + 1));
            }
        return part;
      },
      [](EvenEvidence all, const EvenEvidence& part) {
        all.add(part);
        return all;
      });
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

}  // namespace dubsar
