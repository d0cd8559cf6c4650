#include "core/filter/flat_regions.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/numbers/disjoint_sets.h"
#include "core/base/system/parallel.h"

namespace dubsar {
namespace {

constexpr std::int64_t kWidest = 96;
/// Of the deviation of 27 cells, by noise alone: 1.7 is five of its own deviations up.
constexpr double kFlat = 1.7;
/// Means of 27 cells beside each other share 18; what is left differs by sqrt(18)/27 of the noise. Five of it.
constexpr double kAlike = 5.0 * 0.157;
/// Of the least spread: what means beside each other may differ by without noise.
constexpr double kLeastAlike = 0.3;

struct Window {
  float mean = 0.0f;
  bool flat = false;
};

/// Of the 27 cells around each cell that has all of them.
std::vector<Window> windows_of(const CellMeans& grid, double most_spread) {
  const Dims d = grid.dims;
  std::vector<Window> windows(grid.values.size());
  parallel_for(std::max<std::int64_t>(0, d.z - 2), 1, [&](std::int64_t k) {
    const std::int64_t z = k + 1;
    for (std::int64_t y = 1; y + 1 < d.y; ++y)
      for (std::int64_t x = 1; x + 1 < d.x; ++x) {
        double sum = 0.0, squares = 0.0;
        const auto here = static_cast<std::size_t>(grid.index(x, y, z));
        const double origin = static_cast<double>(grid.values[here]);
        for (std::int64_t c = -1; c <= 1; ++c)
          for (std::int64_t b = -1; b <= 1; ++b)
            for (std::int64_t a = -1; a <= 1; ++a) {
              const double v =
                  static_cast<double>(grid.values[static_cast<std::size_t>(grid.index(x + a, y + b, z + c))]) - origin;
              sum += v;
              squares += v * v;
            }
        const double mean = sum / 27.0;
        windows[here] = {static_cast<float>(origin + mean), squares / 27.0 - mean * mean <= most_spread * most_spread};
      }
  });
  return windows;
}

double median_of(std::vector<float>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

/// Of values, from the sizes of differences of two of them.
double deviation_of(std::vector<float>& apart) { return 1.4826 * median_of(apart) / std::sqrt(2.0); }

/// Equal neighbours (padding, a masked background) say nothing of it.
double noise_of(const CellMeans& grid) {
  std::vector<float> steps;
  const Dims d = grid.dims;
  const std::array<std::int64_t, 3> size{d.x, d.y, d.z}, step{1, d.x, d.slice()};
  for (std::int64_t i = 0; i < d.count(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      if (i / step[a] % size[a] + 1 >= size[a]) continue;
      const float apart =
          std::abs(grid.values[static_cast<std::size_t>(i + step[a])] - grid.values[static_cast<std::size_t>(i)]);
      if (apart > 0.0f) steps.push_back(apart);
    }
  return deviation_of(steps);
}

}  // namespace

Result<CellMeans> read_cells(SlabSource& source, std::int64_t least_cell, std::int64_t slices, Progress& progress) {
  const Dims size = source.dims();
  CellMeans grid;
  grid.cell = std::max(least_cell, (std::max({size.x, size.y, size.z}) + kWidest - 1) / kWidest);
  const std::int64_t cell = grid.cell;
  grid.dims = {size.x / cell, size.y / cell, size.z / cell};
  grid.origin = {size.x % cell / 2, size.y % cell / 2, size.z % cell / 2};
  const Dims d = grid.dims;
  if (d.count() == 0) return grid;
  grid.values.resize(static_cast<std::size_t>(d.count()));
  slices = std::min(cell, slices);
  std::vector<float> steps;
  const auto scale = 1.0f / static_cast<float>(cell * cell * slices);
  Buffer<float> slice(size.slice());
  for (std::int64_t z = 0; z < d.z; ++z)
    for (std::int64_t k = 0; k < slices; ++k) {
      if (progress.cancelled()) return cancelled_error();
      const std::int64_t at = grid.origin[2] + z * cell + (2 * k + 1) * cell / (2 * slices);
      DUBSAR_TRY(source.read(at, at + 1, slice.span()));
      parallel_for(d.y, 8, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < d.x; ++x) {
          float sum = 0.0f;
          for (std::int64_t j = 0; j < cell; ++j)
            for (std::int64_t i = 0; i < cell; ++i)
              sum += slice[(grid.origin[1] + y * cell + j) * size.x + grid.origin[0] + x * cell + i];
          grid.values[static_cast<std::size_t>(grid.index(x, y, z))] += sum * scale;
        }
      });
      for (std::int64_t y = 0; y < d.y; ++y)
        for (std::int64_t x = 0; x + 2 < size.x; x += std::max<std::int64_t>(cell, 3)) {
          const std::int64_t from = (grid.origin[1] + y * cell) * size.x + x;
          if (const float apart = std::abs(slice[from + 2] - slice[from]); apart > 0.0f) steps.push_back(apart);
        }
    }
  grid.noise = noise_of(grid);
  grid.source_noise = deviation_of(steps);
  return grid;
}

CellMeans coarser(const CellMeans& grid) {
  CellMeans wide;
  wide.cell = 2 * grid.cell;
  wide.dims = {grid.dims.x / 2, grid.dims.y / 2, grid.dims.z / 2};
  wide.origin = {grid.origin[0] + grid.dims.x % 2 * grid.cell / 2, grid.origin[1] + grid.dims.y % 2 * grid.cell / 2,
                 grid.origin[2] + grid.dims.z % 2 * grid.cell / 2};
  wide.source_noise = grid.source_noise;
  wide.values.resize(static_cast<std::size_t>(wide.dims.count()));
  for (std::int64_t z = 0; z < wide.dims.z; ++z)
    for (std::int64_t y = 0; y < wide.dims.y; ++y)
      for (std::int64_t x = 0; x < wide.dims.x; ++x) {
        float sum = 0.0f;
        for (int k = 0; k < 8; ++k)
          sum += grid.values[static_cast<std::size_t>(
              grid.index(2 * x + (k & 1), 2 * y + (k >> 1 & 1), 2 * z + (k >> 2)))];
        wide.values[static_cast<std::size_t>(wide.index(x, y, z))] = 0.125f * sum;
      }
  wide.noise = noise_of(wide);
  return wide;
}

FlatRegions find_flat_regions(const CellMeans& grid, double least_spread, double least_share) {
  const Dims d = grid.dims;
  const std::vector<Window> windows = windows_of(grid, std::max(kFlat * grid.noise, least_spread));
  const double alike = std::max(kAlike * grid.noise, kLeastAlike * least_spread);
  DisjointSets sets(windows.size());
  const std::array<std::int64_t, 3> size{d.x, d.y, d.z}, step{1, d.x, d.slice()};
  for (std::int64_t i = 0; i < d.count(); ++i) {
    const Window& here = windows[static_cast<std::size_t>(i)];
    if (!here.flat) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      if (i / step[a] % size[a] + 1 >= size[a]) continue;
      const Window& next = windows[static_cast<std::size_t>(i + step[a])];
      if (next.flat && static_cast<double>(std::abs(next.mean - here.mean)) <= alike)
        sets.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + step[a]));
    }
  }
  struct Sums {
    double count = 0.0, sum = 0.0, squares = 0.0;
  };
  std::map<std::uint32_t, Sums> sums;
  for (std::uint32_t i = 0; i < windows.size(); ++i) {
    if (!windows[i].flat) continue;
    const auto v = static_cast<double>(windows[i].mean);
    Sums& of = sums[sets.root(i)];
    of.count += 1.0;
    of.sum += v;
    of.squares += v * v;
  }
  FlatRegions found;
  found.of_cell.assign(windows.size(), -1);
  std::vector<std::pair<std::uint32_t, Sums>> large;
  for (const auto& [root, of] : sums)
    if (of.count >= least_share * static_cast<double>(windows.size())) large.emplace_back(root, of);
  std::stable_sort(large.begin(), large.end(),
                   [](const auto& a, const auto& b) { return a.second.count > b.second.count; });
  std::map<std::uint32_t, std::int32_t> number;
  for (const auto& [root, of] : large) {
    number[root] = static_cast<std::int32_t>(found.regions.size());
    const double mean = of.sum / of.count;
    found.regions.push_back({mean, std::sqrt(std::max(0.0, of.squares / of.count - mean * mean)), 0, false});
  }
  for (std::int64_t z = 1; z + 1 < d.z; ++z)
    for (std::int64_t y = 1; y + 1 < d.y; ++y)
      for (std::int64_t x = 1; x + 1 < d.x; ++x) {
        const auto here = static_cast<std::size_t>(grid.index(x, y, z));
        if (!windows[here].flat) continue;
        const auto region = number.find(sets.root(static_cast<std::uint32_t>(here)));
        if (region == number.end()) continue;
        for (std::int64_t c = -1; c <= 1; ++c)
          for (std::int64_t b = -1; b <= 1; ++b)
            for (std::int64_t a = -1; a <= 1; ++a)
              found.of_cell[static_cast<std::size_t>(grid.index(x + a, y + b, z + c))] = region->second;
      }
  for (std::int64_t i = 0; i < d.count(); ++i) {
    if (found.of_cell[static_cast<std::size_t>(i)] < 0) continue;
    FlatRegion& of = found.regions[static_cast<std::size_t>(found.of_cell[static_cast<std::size_t>(i)])];
    ++of.cells;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t at = i / step[a] % size[a];
      of.at_border = of.at_border || at == 0 || at + 1 == size[a];
    }
  }
  return found;
}

}  // namespace dubsar
