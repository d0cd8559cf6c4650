#include "core/filter/holder_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/system/log.h"

namespace dubsar {
namespace {

constexpr double kLeastCellVox = 4.0;
constexpr double kLeastRegion = 0.003;  ///< of the cells, by their flat middles
constexpr double kLeastHolder = 0.01;   ///< of the cells
constexpr double kLeastEven = 0.04;     ///< of the range: deviation of 27 cells in one region
/// Spread of one level: of the contrast, and in noise of a cell (a mean of 27 has a fifth of it).
constexpr double kMostUneven = 0.04, kMostNoise = 0.6;
/// Of the contrast, and in noise of a cell. Clay that hardening or rings divide has .9 of its level.
constexpr double kApartFromAir = 0.06, kApartFromClay = 0.15, kApartNoise = 2.0;
/// Of what hides nothing of the other, seen from the best of six sides.
constexpr double kLeastSeen = 0.6;
/// Of the holder's volume: what stands in it. A ball of glass beside clay makes no holder of the clay.
constexpr double kLeastObject = 0.05, kLeastObjectOfDense = 0.3;
constexpr double kDense = 0.45;  ///< of the contrast: from here on it may be in the surface
/// Noise of the scan after 2:1, from holder to clay: filters halve it once more, so that it is five of what they leave.
constexpr double kSureOfClay = 2.5;
constexpr double kNoiseOfHalf = 0.5;  ///< of the scan's: 2:1 takes 6 dB
constexpr std::int64_t kLeastCells = 6;

struct HolderLevels {
  double air = 0.0, holder = 0.0, clay = 0.0;
  double uneven = 0.0;  ///< what a region of one level may spread
};

/// Cells by level, noise taken out where they are in a region.
class CellLevels {
 public:
  CellLevels(const CellMeans& grid, const FlatRegions& flat) : grid_(&grid), level_(grid.values) {
    for (std::size_t i = 0; i < level_.size(); ++i)
      if (flat.of_cell[i] >= 0)
        level_[i] = static_cast<float>(flat.regions[static_cast<std::size_t>(flat.of_cell[i])].level);
  }
  double at(std::int64_t i) const { return static_cast<double>(level_[static_cast<std::size_t>(i)]); }

  struct Seen {
    double higher = 0.0, holder = 0.0;  ///< shares of their silhouettes, from the sides that show most of each
  };
  /// Of what is above `middle` and of the cells of `holder`, by lines along the axes from the border inwards: what is
  /// met first above `least`, and a cell or two behind it.
  Seen seen(double least, double middle, const std::vector<std::uint8_t>& holder) const {
    const Dims d = grid_->dims;
    const std::array<std::int64_t, 3> size{d.x, d.y, d.z}, step{1, d.x, d.slice()};
    Seen best;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      for (const bool back : {false, true}) {
        double highers = 0.0, holders = 0.0, higher_first = 0.0, holder_first = 0.0;
        for (std::int64_t i = 0; i < size[b] * size[c]; ++i) {
          const std::int64_t line = i % size[b] * step[b] + i / size[b] * step[c];
          std::int64_t met = -1;
          bool any_higher = false, any_holder = false, higher = false, is_holder = false;
          for (std::int64_t k = 0; k < size[a]; ++k) {
            const std::int64_t cell = line + (back ? size[a] - 1 - k : k) * step[a];
            if (met < 0 && at(cell) > least) met = k;
            const bool this_higher = at(cell) > middle, this_holder = holder[static_cast<std::size_t>(cell)] != 0;
            any_higher = any_higher || this_higher;
            any_holder = any_holder || this_holder;
            if (met >= 0 && k <= met + 1) higher = higher || this_higher;
            if (met >= 0 && k <= met + 2) is_holder = is_holder || this_holder;
          }
          highers += any_higher ? 1.0 : 0.0;
          holders += any_holder ? 1.0 : 0.0;
          higher_first += higher ? 1.0 : 0.0;
          holder_first += is_holder && !higher ? 1.0 : 0.0;
        }
        if (highers > 0.0) best.higher = std::max(best.higher, higher_first / highers);
        if (holders > 0.0) best.holder = std::max(best.holder, holder_first / holders);
      }
    }
    return best;
  }

 private:
  const CellMeans* grid_;
  std::vector<float> level_;
};

/// Whether cells lie at the border of the grid or at what is no measurement, or a cell or two from it.
bool reaches_border(const CellMeans& grid, const std::vector<std::uint8_t>& inside, std::optional<float> left_out,
                    double within) {
  const Dims d = grid.dims;
  const std::array<std::int64_t, 3> size{d.x, d.y, d.z}, step{1, d.x, d.slice()};
  for (std::int64_t i = 0; i < d.count(); ++i) {
    if (inside[static_cast<std::size_t>(i)] == 0) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t at = i / step[a] % size[a];
      if (at == 0 || at + 1 == size[a]) return true;
      for (const std::int64_t by : {-2, 2}) {
        if (!left_out || at + by < 0 || at + by >= size[a]) continue;
        const float value = grid.values[static_cast<std::size_t>(i + by * step[a])];
        if (static_cast<double>(std::abs(value - *left_out)) < within) return true;
      }
    }
  }
  return false;
}

std::vector<std::uint8_t> cells_of(const FlatRegions& flat, double level, double apart, double uneven) {
  std::vector<std::uint8_t> inside(flat.of_cell.size());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (flat.of_cell[i] < 0) continue;
    const FlatRegion& region = flat.regions[static_cast<std::size_t>(flat.of_cell[i])];
    inside[i] = std::abs(region.level - level) < apart && region.spread <= uneven ? 1 : 0;
  }
  return inside;
}

/// With cells beside them that are in no region and nearer to their level than to others.
void grow(const CellMeans& grid, const FlatRegions& flat, double least, double most,
          std::vector<std::uint8_t>& inside) {
  const Dims d = grid.dims;
  const std::array<std::int64_t, 3> size{d.x, d.y, d.z}, step{1, d.x, d.slice()};
  const std::vector<std::uint8_t> before = inside;
  for (std::int64_t i = 0; i < d.count(); ++i) {
    const auto here = static_cast<std::size_t>(i);
    const auto v = static_cast<double>(grid.values[here]);
    if (before[here] != 0 || flat.of_cell[here] >= 0 || v < least || v > most) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t at = i / step[a] % size[a];
      if ((at > 0 && before[static_cast<std::size_t>(i - step[a])] != 0) ||
          (at + 1 < size[a] && before[static_cast<std::size_t>(i + step[a])] != 0))
        inside[here] = 1;
    }
  }
}

double count_of(const std::vector<std::uint8_t>& inside) {
  return static_cast<double>(std::count(inside.begin(), inside.end(), std::uint8_t{1}));
}

struct Place {
  int axis = 0;
  bool high = false;
  double reach = 0.0;  ///< cells from that end of the grid
};

/// Where the cells of `inside` lie beside those above `middle`.
Place place_of(const CellMeans& grid, const std::vector<std::uint8_t>& inside, const CellLevels& levels, double middle,
               bool above) {
  const Dims d = grid.dims;
  const std::array<std::int64_t, 3> size{d.x, d.y, d.z}, step{1, d.x, d.slice()};
  std::array<double, 3> holder{}, object{};
  double holders = 0.0, objects = 0.0;
  for (std::int64_t i = 0; i < d.count(); ++i) {
    const bool is_holder = inside[static_cast<std::size_t>(i)] != 0;
    if (!is_holder && (levels.at(i) > middle) != above) continue;
    (is_holder ? holders : objects) += 1.0;
    for (std::size_t a = 0; a < 3; ++a) (is_holder ? holder : object)[a] += static_cast<double>(i / step[a] % size[a]);
  }
  Place place;
  double farthest = -1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double apart = holder[a] / std::max(1.0, holders) - object[a] / std::max(1.0, objects);
    if (std::abs(apart) <= farthest) continue;
    farthest = std::abs(apart);
    place.axis = static_cast<int>(a);
    place.high = apart > 0.0;
  }
  // But for a fiftieth of it, as crumbs and slopes are.
  const auto a = static_cast<std::size_t>(place.axis);
  std::vector<double> layers(static_cast<std::size_t>(size[a]));
  for (std::int64_t i = 0; i < d.count(); ++i) {
    const std::int64_t at = i / step[a] % size[a];
    if (inside[static_cast<std::size_t>(i)] != 0)
      layers[static_cast<std::size_t>(place.high ? size[a] - 1 - at : at)] += 1.0;
  }
  double left = 0.98 * holders;
  for (const double layer : layers) {
    if (left <= 0.0) break;
    left -= layer;
    place.reach += 1.0;
  }
  return place;
}

double quantile(std::vector<float> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

HolderFate fate_of(const Holder& holder, double noise) {
  if (holder.of_clay() < kDense) return HolderFate::kAir;
  if (holder.clay - holder.grey < kSureOfClay * noise) return HolderFate::kStays;
  return holder.at_border ? HolderFate::kTakenOff : HolderFate::kStaysInside;
}

struct Cells {
  const CellMeans& grid;
  const FlatRegions& flat;
  const CellLevels& levels;
};

/// The holder of one level between those of air and clay, or of clay where that of `level.holder` is the object's.
std::optional<FoundHolder> holder_of(const Cells& cells, const HolderLevels& level, const HolderOptions& options) {
  const double contrast = level.clay - level.air, middle = 0.5 * (level.holder + level.clay);
  const double least = 0.5 * (level.air + level.holder), apart = 0.5 * kApartFromAir * contrast;
  FoundHolder found{{}, {}, cells_of(cells.flat, level.holder, apart, level.uneven)};
  double objects = 0.0;
  for (std::int64_t i = 0; i < cells.grid.dims.count(); ++i) objects += cells.levels.at(i) > middle ? 1.0 : 0.0;
  const double of_clay = (level.holder - level.air) / contrast, ratio = objects / count_of(found.inside);
  const CellLevels::Seen seen = cells.levels.seen(least, middle, found.inside);
  log_debug("holder: {:.2f} of the range, seen {:.2f}, object {:.2f}, {:.2f} of its volume", of_clay, seen.holder,
            seen.higher, ratio);
  if (seen.holder < kLeastSeen || seen.higher < kLeastSeen ||
      ratio < (of_clay < kDense ? kLeastObject : kLeastObjectOfDense))
    return std::nullopt;
  const double within = 1e-3 * contrast;
  Holder& holder = found.holder;
  holder.at_border = reaches_border(cells.grid, found.inside, options.left_out, within);
  bool above = false;
  if (!holder.at_border) {
    std::vector<std::uint8_t> top = cells_of(cells.flat, level.clay, apart, level.uneven);
    above = reaches_border(cells.grid, top, options.left_out, within);
    if (above) found.inside = std::move(top), holder.at_border = true;
  }
  if (above)
    grow(cells.grid, cells.flat, middle, std::numeric_limits<double>::max(), found.inside);
  else
    grow(cells.grid, cells.flat, least, middle, found.inside);
  const Place place = place_of(cells.grid, found.inside, cells.levels, middle, !above);
  holder.air = level.air;
  holder.clay = above ? level.holder : level.clay;
  holder.grey = above ? level.clay : level.holder;
  holder.share = count_of(found.inside) / static_cast<double>(cells.grid.dims.count());
  holder.axis = place.axis;
  holder.at_high_end = place.high;
  holder.reach_vox = place.reach * static_cast<double>(cells.grid.cell) * options.voxels_a_step;
  holder.fate = fate_of(holder, cells.grid.source_noise * (options.voxels_a_step > 1.0 ? 1.0 : kNoiseOfHalf));
  return found;
}

/// In cells of one size.
std::optional<FoundHolder> holder_in(const CellMeans& grid, const HolderOptions& options) {
  if (std::min({grid.dims.x, grid.dims.y, grid.dims.z}) < kLeastCells) return std::nullopt;
  const double range = quantile(grid.values, 0.995) - quantile(grid.values, 0.005);
  if (!(range > 0.0)) return std::nullopt;
  const FlatRegions flat = find_flat_regions(grid, kLeastEven * range, kLeastRegion);
  const CellLevels levels(grid, flat);
  const auto count = static_cast<double>(grid.dims.count());
  const FlatRegion *air = nullptr, *clay = nullptr;
  for (const FlatRegion& region : flat.regions) {
    log_debug("holder: region of {:.2f} % at {:.4g} +- {:.2g}{}", 100.0 * static_cast<double>(region.cells) / count,
              region.level, region.spread, region.at_border ? ", at the border" : "");
    if (static_cast<double>(region.cells) >= kLeastHolder * count && (air == nullptr || region.level < air->level))
      air = &region;
    if (clay == nullptr || region.level > clay->level) clay = &region;
  }
  if (air == nullptr || air == clay) return std::nullopt;
  const double contrast = clay->level - air->level;
  const double least = air->level + std::max(kApartFromAir * contrast, kApartNoise * grid.noise);
  const double most = clay->level - std::max(kApartFromClay * contrast, kApartNoise * grid.noise);
  const double uneven = std::max(kMostUneven * contrast, kMostNoise * grid.noise);
  for (const FlatRegion& region : flat.regions) {
    if (static_cast<double>(region.cells) < kLeastHolder * count || region.spread > uneven || region.level < least ||
        region.level > most)
      continue;
    if (auto found = holder_of({grid, flat, levels}, {air->level, region.level, clay->level, uneven}, options))
      return found;
  }
  return std::nullopt;
}

}  // namespace

std::string describe(const Holder& holder, const VoxelSize& voxel) {
  const char axis = "xyz"[holder.axis];
  const double edge = voxel.mm[holder.axis];
  const std::string reach = voxel.known() ? fmt::format("{:.1f} mm", holder.reach_vox * edge)
                                          : fmt::format("{:.0f} voxels", holder.reach_vox);
  const char* fate = "";
  switch (holder.fate) {
    case HolderFate::kAir:
      fate = "counts as air";
      break;
    case HolderFate::kTakenOff:
      fate = "told from clay and taken off, counts as air";
      break;
    case HolderFate::kStays:
      fate = "too near to clay to be taken off, counts as a part of the object";
      break;
    case HolderFate::kStaysInside:
      fate = "does not reach the border of the scan and may belong to the object, as a part of which it counts";
      break;
  }
  return fmt::format(
      "a holder of {:.2f} of the clay's grey at the {} end of {}, as far as {} from there, {:.0f} % of the volume: {}",
      holder.of_clay(), holder.at_high_end ? "high" : "low", axis, reach, 100.0 * holder.share, fate);
}

Result<std::optional<FoundHolder>> find_holder(SlabSource& source, const HolderOptions& options, Progress& progress) {
  const auto least = static_cast<std::int64_t>(std::ceil(kLeastCellVox / options.voxels_a_step));
  DUBSAR_ASSIGN(CellMeans grid, read_cells(source, least, options.slices, progress));
  for (int size = 0; size < 2; ++size) {
    if (size > 0) grid = coarser(grid);
    if (auto found = holder_in(grid, options)) {
      found->grid = std::move(grid);
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace dubsar
