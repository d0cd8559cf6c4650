#include "core/rays/sure_materials.h"

#include <algorithm>

#include "core/base/system/parallel.h"
#include "core/filter/estimate.h"

namespace dubsar {
namespace {

/// Marks also what lies within `reach` voxels of a mark along one axis.
void spread(std::vector<std::uint8_t>& marks, std::int64_t lines_outer, std::int64_t n, std::int64_t stride,
            std::int64_t reach) {
  // Lines of n voxels that are `stride` apart; `stride` lines lie side by side.
  parallel_for(lines_outer, 1, [&](std::int64_t outer) {
    std::vector<std::int64_t> last(static_cast<std::size_t>(stride));
    std::uint8_t* const block = marks.data() + outer * n * stride;
    std::vector<std::uint8_t> near(static_cast<std::size_t>(n * stride));
    for (const bool forward : {true, false}) {
      std::fill(last.begin(), last.end(), -(reach + 1));
      for (std::int64_t step = 0; step < n; ++step) {
        const std::int64_t i = forward ? step : n - 1 - step;
        for (std::int64_t k = 0; k < stride; ++k) {
          if (block[i * stride + k] != 0) last[static_cast<std::size_t>(k)] = step;
          if (step - last[static_cast<std::size_t>(k)] <= reach) near[static_cast<std::size_t>(i * stride + k)] = 1;
        }
      }
    }
    std::copy(near.begin(), near.end(), block);
  });
}

/// Marks all voxels within `reach` of one that is on the side `clay` of the threshold.
std::vector<std::uint8_t> near_side(const Volume<float>& volume, float threshold, bool clay, std::int64_t reach) {
  const Dims d = volume.dims;
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(d.count()));
  parallel_for(d.count(), 1 << 18, [&](std::int64_t i) {
    const bool above = volume.voxels[i] >= threshold;
    marks[static_cast<std::size_t>(i)] = above == clay ? 1 : 0;
  });
  spread(marks, d.y * d.z, d.x, 1, reach);
  spread(marks, d.z, d.y, d.x, reach);
  spread(marks, 1, d.z, d.slice(), reach);
  return marks;
}

double median_of(const Volume<float>& volume, const std::vector<Material>& materials, Material wanted) {
  std::vector<float> values;
  for (std::size_t i = 0; i < materials.size(); ++i)
    if (materials[i] == wanted) values.push_back(volume.voxels[static_cast<std::int64_t>(i)]);
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Result<SureMaterials> find_sure_materials(const Volume<float>& volume, std::int64_t margin) {
  ValueCounts counts;
  counts.add(volume.voxels.span());
  DUBSAR_ASSIGN(const double threshold,
                automatic_threshold(estimate(make_histogram(counts), 0.0, {.method = ThresholdMethod::kOtsu})));
  const auto value = static_cast<float>(threshold);
  const std::vector<std::uint8_t> near_clay = near_side(volume, value, true, margin);
  const std::vector<std::uint8_t> near_air = near_side(volume, value, false, margin);
  SureMaterials sure;
  sure.of_voxel.resize(near_clay.size());
  for (std::size_t i = 0; i < near_clay.size(); ++i) {
    if (near_clay[i] == 0) sure.of_voxel[i] = Material::kAir, ++sure.air;
    if (near_air[i] == 0) sure.of_voxel[i] = Material::kClay, ++sure.clay;
  }
  sure.levels = {median_of(volume, sure.of_voxel, Material::kAir), median_of(volume, sure.of_voxel, Material::kClay)};
  return sure;
}

}  // namespace dubsar
