#include "core/contact/dips.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>

#include "core/base/numbers/median.h"
#include "core/base/system/parallel_gather.h"
#include "core/contact/kernels/dip_rows.h"
#include "core/contact/kernels/row_sums.h"

namespace dubsar {
namespace {

constexpr std::int64_t kEdge = BrickMap<float>::kEdge;
/// Steps to the disks in the clay on both sides. At two the dip of a film is still there, at three it is over; but one
/// disk alone has as much noise as the middle, and one that is far meets the other wall of a wedge. The first must be
/// in clay, the others count where they are.
constexpr std::array<float, kDipArms> kArms{3.0f, 2.0f, 4.0f};
constexpr float kDisk = 3.2f, kDiskDeviation = 1.8f;
constexpr float kLeastDipCosine = 0.45f;  ///< flanks of wedges stand up to 60 degrees from the contact
/// Of the strongest dip, noise that is taken for at least: as of a scan of 8 bits.
constexpr float kLeastNoise = 1.0f / 256.0f;

/// A brick and what lies around it, as an array.
template <class T, int kHalo>
struct Block {
  static constexpr int kSide = static_cast<int>(kEdge) + 2 * kHalo;
  std::array<T, static_cast<std::size_t>(kSide) * kSide * kSide + kRowLength> value{};

  static constexpr std::ptrdiff_t away(const glm::ivec3& step) {
    return (static_cast<std::ptrdiff_t>(step.z) * kSide + step.y) * kSide + step.x;
  }
  static constexpr std::size_t place(int x, int y, int z) { return static_cast<std::size_t>(away({x, y, z})); }
  /// Values of a map around the brick whose first point `corner` is.
  void fill(const glm::ivec3& corner, const BrickMap<T>& map) {
    constexpr int kBrick = static_cast<int>(kEdge);
    constexpr int kFirst = -((kHalo + kBrick - 1) / kBrick), kLast = kSide - kHalo;
    value.fill(T{});
    for (int z = kFirst * kBrick; z < kLast; z += kBrick)
      for (int y = kFirst * kBrick; y < kLast; y += kBrick)
        for (int x = kFirst * kBrick; x < kLast; x += kBrick) {
          const glm::ivec3 at = (corner + glm::ivec3(x, y, z)) / kBrick;
          if (corner.x + x < 0 || corner.y + y < 0 || corner.z + z < 0) continue;
          if (const T* const brick = map.brick(at.x, at.y, at.z)) put_brick({x, y, z}, brick);
        }
  }

 private:
  void put_brick(const glm::ivec3& first, const T* brick) {
    constexpr int kBrick = static_cast<int>(kEdge);
    const glm::ivec3 low = glm::max(first, -kHalo), high = glm::min(first + kBrick, kSide - kHalo);
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        std::copy_n(brick + ((z - first.z) * kBrick + y - first.y) * kBrick + low.x - first.x, high.x - low.x,
                    value.begin() + place(low.x + kHalo, y + kHalo, z + kHalo));
  }
};

constexpr int kArmHalo = 4, kDiskHalo = 3;  ///< of directions(): no arm and no disk reaches farther along an axis
using Around = Block<float, kArmHalo + kDiskHalo>;
using Means = Block<float, kArmHalo>;
using Clay = Block<std::int32_t, kArmHalo>;  // 1: clay, 0: air

struct Direction {
  DipDirection dip;
  std::vector<RowTap> disk;
  std::vector<glm::ivec3> ends;  ///< of the arms on both sides, and the middle
};

/// Half of the ways to points up to two steps away along each axis: some 25 degrees from one to the next, so that a
/// disk of any wall is less than a step and a half off where it ends.
std::vector<Direction> directions() {
  constexpr int kFar = 2, kWide = 2 * kFar + 1;
  std::vector<Direction> all;
  for (int k = 0; k < kWide * kWide * kWide / 2; ++k) {
    const glm::ivec3 step(k % kWide - kFar, k / kWide % kWide - kFar, k / (kWide * kWide) - kFar);
    if (step.x % 2 == 0 && step.y % 2 == 0 && step.z % 2 == 0) continue;  // twice another
    Direction d;
    const glm::vec3 unit = glm::normalize(glm::vec3(step));
    d.dip = {{unit.x, unit.y, unit.z}, kLeastDipCosine, {}};
    d.ends.emplace_back(0);
    for (std::size_t i = 0; i < kArms.size(); ++i) {
      const glm::ivec3 end(glm::round(kArms[i] * unit));
      d.dip.arms[i] = static_cast<std::int32_t>(Means::away(end));
      d.ends.push_back(end);
      d.ends.push_back(-end);
    }
    float sum = 0.0f;
    for (int z = -3; z <= 3; ++z)
      for (int y = -3; y <= 3; ++y)
        for (int x = -3; x <= 3; ++x) {
          const glm::vec3 q(x, y, z);
          if (glm::length(q) > kDisk || std::abs(glm::dot(q, unit)) > 0.45f) continue;
          d.disk.push_back({static_cast<std::int32_t>(Around::away({x, y, z})),
                            std::exp(-0.5f * glm::dot(q, q) / (kDiskDeviation * kDiskDeviation))});
          sum += d.disk.back().weight;
        }
    for (RowTap& tap : d.disk) tap.weight /= sum;
    all.push_back(std::move(d));
  }
  return all;
}

/// 1 where the points around a brick are clay, 0 where they are air or beyond the grid.
void fill_clay(const BitVolume& inside, const glm::ivec3& corner, Clay& clay) {
  const Dims d = inside.dims();
  clay.value.fill(0);
  const glm::ivec3 first = corner - kArmHalo, low = glm::max(first, 0),
                   high = glm::min(first + Clay::kSide, glm::ivec3(d.x, d.y, d.z));
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y) {
      const std::uint64_t* const words = inside.row(y, z);
      std::int32_t* const row = clay.value.data() + Clay::place(0, y - first.y, z - first.z);
      for (int x = low.x; x < high.x; ++x) row[x - first.x] = static_cast<std::int32_t>(words[x >> 6] >> (x & 63) & 1u);
    }
}

static_assert(Means::kSide == kRowLength && kEdge == kDipRow);

/// The dips of the nodes of a brick, row by row.
class BrickDips {
 public:
  BrickDips(const ContactBand& band, const BitVolume& inside, const BandDensity& density,
            const std::vector<Direction>& directions)
      : band_(band), inside_(inside), density_(density), directions_(directions) {}

  void find(std::uint32_t first, std::uint32_t last, Dips& dips) {
    const glm::ivec3 corner = band_.point(first) / static_cast<int>(kEdge) * static_cast<int>(kEdge);
    around_.fill(corner, density_.raw());
    fill_clay(inside_, corner, clay_);
    rows_.clear();
    std::int32_t last_row = -1;
    for (std::uint32_t node = first; node < last; ++node) {
      const glm::ivec3 at = band_.point(node) - corner;
      if (const std::int32_t row = at.z * static_cast<int>(kEdge) + at.y; row != last_row) {
        rows_.emplace_back().place =
            static_cast<std::int32_t>(Means::place(kArmHalo, at.y + kArmHalo, at.z + kArmHalo));
        last_row = row;
      }
      const glm::vec3& normal = band_.normal(node);
      const auto x = static_cast<std::size_t>(at.x);
      DipRow& row = rows_.back();
      for (glm::length_t axis = 0; axis < 3; ++axis) row.normal[static_cast<std::size_t>(axis)][x] = normal[axis];
      row.strength[x] = kNoDip;
      row.density[x] = density_.get(corner.x + at.x, corner.y + at.y, corner.z + at.z);
    }
    for (const Direction& d : directions_) find_along(d);
    std::size_t row = 0;
    for (std::uint32_t node = first; node < last; ++node) {
      const glm::ivec3 at = band_.point(node) - corner + kArmHalo;
      if (rows_[row].place != static_cast<std::int32_t>(Means::place(kArmHalo, at.y, at.z))) ++row;
      dips.strength[node] = rows_[row].strength[static_cast<std::size_t>(at.x - kArmHalo)];
      dips.density[node] = rows_[row].density[static_cast<std::size_t>(at.x - kArmHalo)];
    }
  }

 private:
  void find_along(const Direction& d) {
    across_.resize(rows_.size());
    const std::size_t count = rows_across(rows_, d.dip, clay_.value.data(), across_.data());
    if (count == 0) return;
    // An arm of a row ends in one row: no arm is longer than the halo.
    std::array<std::uint32_t, Means::kSide> along{}, asked{};  // bit y of z: rows
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t row = rows_[across_[i]].place / Means::kSide;
      along[static_cast<std::size_t>(row / Means::kSide)] |= 1u << row % Means::kSide;
    }
    for (const glm::ivec3& end : d.ends)
      for (int z = kArmHalo; z < kArmHalo + static_cast<int>(kEdge); ++z) {
        const std::uint32_t rows = along[static_cast<std::size_t>(z)];
        const int there = z + end.z;
        asked[static_cast<std::size_t>(there)] |= end.y < 0 ? rows >> -end.y : rows << end.y;
      }
    summed_.clear();
    for (int z = 0; z < Means::kSide; ++z)
      for (std::uint32_t rows = asked[static_cast<std::size_t>(z)]; rows != 0; rows &= rows - 1) {
        const int y = std::countr_zero(rows);
        summed_.push_back({static_cast<std::int32_t>(Around::place(kDiskHalo, y + kDiskHalo, z + kDiskHalo)),
                           static_cast<std::int32_t>(Means::place(0, y, z))});
      }
    sum_rows(around_.value.data(), d.disk, summed_, means_.value.data());
    raise_dips(rows_, std::span(across_).first(count), d.dip, clay_.value.data(), means_.value.data());
  }

  const ContactBand& band_;
  const BitVolume& inside_;
  const BandDensity& density_;
  const std::vector<Direction>& directions_;
  std::vector<DipRow> rows_;           ///< that have nodes
  std::vector<std::uint32_t> across_;  ///< those of them for some of whose nodes a direction is one across
  std::vector<SummedRow> summed_;
  Around around_;
  Clay clay_;
  Means means_;
};

/// Nodes [first of a brick, first of the next): they stand brick by brick.
std::vector<std::uint32_t> brick_starts(const ContactBand& band) {
  std::vector<std::uint32_t> starts;
  glm::ivec3 last(-1);
  for (std::uint32_t n = 0; n < band.nodes.size(); ++n) {
    const glm::ivec3 brick = band.point(n) / static_cast<int>(kEdge);
    if (brick != last) starts.push_back(n);
    last = brick;
  }
  starts.push_back(static_cast<std::uint32_t>(band.nodes.size()));
  return starts;
}

using BrickPlace = std::array<std::int64_t, 3>;

/// The bricks of a band and `around` more on all sides, layer by layer.
std::vector<BrickPlace> bricks_around(const ContactBand& band, std::int64_t around) {
  const Dims bricks = band.node_at.bricks();
  std::vector<bool> wanted(static_cast<std::size_t>(bricks.count()), false);
  const auto place = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::size_t>((z * bricks.y + y) * bricks.x + x);
  };
  std::vector<BrickPlace> places;
  const auto each_brick = [&](const auto& visit) {
    for (std::int64_t z = 0; z < bricks.z; ++z)
      for (std::int64_t y = 0; y < bricks.y; ++y)
        for (std::int64_t x = 0; x < bricks.x; ++x) visit(x, y, z);
  };
  each_brick([&](std::int64_t bx, std::int64_t by, std::int64_t bz) {
    if (!band.node_at.has_brick(bx, by, bz)) return;
    for (std::int64_t z = std::max<std::int64_t>(bz - around, 0); z <= std::min(bz + around, bricks.z - 1); ++z)
      for (std::int64_t y = std::max<std::int64_t>(by - around, 0); y <= std::min(by + around, bricks.y - 1); ++y)
        for (std::int64_t x = std::max<std::int64_t>(bx - around, 0); x <= std::min(bx + around, bricks.x - 1); ++x)
          wanted[place(x, y, z)] = true;
  });
  each_brick([&](std::int64_t x, std::int64_t y, std::int64_t z) {
    if (wanted[place(x, y, z)]) places.push_back({x, y, z});
  });
  return places;
}

}  // namespace

Result<BandDensity> BandDensity::read(const ContactBand& band, SlabSource& source, Progress& progress, int around) {
  BandDensity density;
  DUBSAR_TRY(density.follow(band, source, progress, {around, around}));
  density.low_pass(band, around);
  return density;
}

Result<void> BandDensity::follow(const ContactBand& band, SlabSource& source, Progress& progress, Room room) {
  const Dims d = source.dims();
  DUBSAR_CHECK(d == band.node_at.dims());
  if (raw_.dims() != d) raw_ = BrickMap<float>(d, 0.0f);
  const auto is_there = [&](const BrickPlace& b) { return raw_.has_brick(b[0], b[1], b[2]); };
  std::vector<bool> is_read(static_cast<std::size_t>(raw_.bricks().z), false);  // layers of bricks
  for (const BrickPlace& b : bricks_around(band, room.least))
    if (!is_there(b)) is_read[static_cast<std::size_t>(b[2])] = true;
  if (std::ranges::count(is_read, true) == 0) return {};
  std::vector<BrickPlace> places = bricks_around(band, room.most);
  std::erase_if(places, [&](const BrickPlace& b) { return !is_read[static_cast<std::size_t>(b[2])] || is_there(b); });
  raw_.reserve(raw_.made() + places.size());
  std::vector<float> slab;
  progress.begin("contact density", static_cast<std::int64_t>(places.size()), "brick");
  for (std::size_t first = 0, end = 0; first < places.size(); first = end) {
    if (progress.cancelled()) return cancelled_error();
    const std::int64_t layer = places[first][2], z0 = layer * kEdge, z1 = std::min(z0 + kEdge, d.z);
    slab.resize(static_cast<std::size_t>((z1 - z0) * d.slice()));
    DUBSAR_TRY(source.read(z0, z1, slab));
    for (; end < places.size() && places[end][2] == layer; ++end)  // all are there before threads write
      raw_.add_brick(places[end][0], places[end][1], layer);
    parallel_for(static_cast<std::int64_t>(end - first), 16, [&](std::int64_t i) {
      const auto [bx, by, bz] = places[first + static_cast<std::size_t>(i)];
      float* const brick = raw_.brick(bx, by, bz);
      const std::int64_t x = bx * kEdge, y = by * kEdge, rows = std::min(kEdge, d.y - y),
                         length = std::min(kEdge, d.x - x);
      for (std::int64_t z = z0; z < z1; ++z)
        for (std::int64_t row = 0; row < rows; ++row)
          std::copy_n(slab.data() + (z - z0) * d.slice() + (y + row) * d.x + x, length,
                      brick + ((z - z0) * kEdge + row) * kEdge);
    });
    progress.advance(static_cast<std::int64_t>(end - first));
  }
  progress.end();
  return {};
}

void BandDensity::low_pass(const ContactBand& band, int around) {
  const Dims d = raw_.dims();
  const std::vector<BrickPlace> places = bricks_around(band, around);
  smooth_ = BrickMap<float>(d, 0.0f);
  smooth_.reserve(places.size());
  for (const auto& [bx, by, bz] : places) smooth_.add_brick(bx, by, bz);
  parallel_for(static_cast<std::int64_t>(places.size()), 8, [&](std::int64_t i) {
    const auto [bx, by, bz] = places[static_cast<std::size_t>(i)];
    using Raw = Block<float, 1>;
    Raw block;
    block.fill({bx * kEdge, by * kEdge, bz * kEdge}, raw_);
    // In place: what stands before a value was filtered already, and is not needed any more.
    for (const std::size_t step : {Raw::place(1, 0, 0), Raw::place(0, 1, 0), Raw::place(0, 0, 1)})
      for (std::size_t k = 0; k + 2 * step < block.value.size(); ++k)
        block.value[k] = 0.25f * (block.value[k] + block.value[k + 2 * step]) + 0.5f * block.value[k + step];
    float* const brick = smooth_.brick(bx, by, bz);
    const auto points = [](std::int64_t b, std::int64_t end) {
      return static_cast<int>(std::min(kEdge, end - b * kEdge));
    };
    for (int z = 0; z < points(bz, d.z); ++z)
      for (int y = 0; y < points(by, d.y); ++y)
        std::copy_n(block.value.begin() + Raw::place(0, y, z), points(bx, d.x), brick + (z * kEdge + y) * kEdge);
  });
}

Result<Dips> find_dips(const ContactBand& band, const BitVolume& inside, const BandDensity& density, Progress& progress,
                       float least_deviation) {
  const std::vector<Direction> all_directions = directions();
  Dips dips;
  dips.strength.assign(band.nodes.size(), kNoDip);
  dips.density.assign(band.nodes.size(), 0.0f);
  const std::vector<std::uint32_t> starts = brick_starts(band);
  parallel_chunks(static_cast<std::int64_t>(starts.size()) - 1, 8, [&](std::int64_t begin, std::int64_t end) {
    if (progress.cancelled()) return;
    const auto of_brick = std::make_unique<BrickDips>(band, inside, density, all_directions);
    for (auto brick = static_cast<std::size_t>(begin); brick < static_cast<std::size_t>(end); ++brick)
      of_brick->find(starts[brick], starts[brick + 1], dips);
  });
  if (progress.cancelled()) return cancelled_error();
  // What clay shows far from the contact, in a robust measure: pores and grains are few.
  const auto count = static_cast<std::int64_t>(band.nodes.size());
  constexpr std::int64_t kTogether = 1 << 16;
  std::vector<float> quiet =
      parallel_gather<float>(count, kTogether, [&](std::int64_t begin, std::int64_t end, std::vector<float>& found) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
          if (band.nodes[i].distance > 0.8f * band.reach_at(band.nodes[i].height) && dips.strength[i] > kNoDip)
            found.push_back(dips.strength[i]);
      });
  const float level = median(quiet);
  const float most = parallel_reduce(
      count, kTogether, 0.0f,
      [&](std::int64_t begin, std::int64_t end) {
        float most_here = 0.0f;
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
          if (const float v = dips.strength[i]; v > kNoDip) most_here = std::max(most_here, std::abs(v - level));
        return most_here;
      },
      [](float a, float b) { return std::max(a, b); });
  for (float& v : quiet) v = std::abs(v - level);
  dips.deviation = std::max({1.4826f * median(std::move(quiet)), kLeastNoise * most, least_deviation, 1e-30f});
  parallel_for(count, kTogether, [&](std::int64_t i) {
    float& v = dips.strength[static_cast<std::size_t>(i)];
    v = v > kNoDip ? (v - level) / dips.deviation : 0.0f;
  });
  return dips;
}

}  // namespace dubsar
