#include "core/volume/plane_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace dubsar {
namespace {

constexpr Dims kFlatBrick{64, 64, 8};    // of files without chunks: runs of bytes, and few slices
constexpr std::int64_t kLeastEdge = 16;  // smaller chunks are read several at a time
constexpr std::int64_t kSmallChunk = 16 * 16 * 16;
constexpr std::uint64_t kLeastPictureBytes = std::uint64_t{256} << 20;
constexpr int kCoarsest = 8;  // every 8th brick along each axis comes first, then every 4th ...
constexpr double kWhole = 1.0 - 1e-9;

Dims brick_for(const Dims& chunk, const Dims& volume) {
  Dims out = chunk == Dims{1, 1, 1} ? kFlatBrick : chunk;
  if (out.count() < kSmallChunk)
    for (std::int64_t* edge : {&out.x, &out.y, &out.z}) *edge *= (kLeastEdge + *edge - 1) / *edge;
  return {std::min(out.x, volume.x), std::min(out.y, volume.y), std::min(out.z, volume.z)};
}

std::int64_t pieces(std::int64_t length, std::int64_t edge) { return (length + edge - 1) / edge; }

/// Pixels that are not known take the nearest one's value, by steps to neighbours.
void fill_unknown(std::vector<float>& values, std::vector<std::int32_t>& steps, int width, int height) {
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max() - 1;
  const auto from = [&](std::size_t at, std::size_t neighbour) {
    if (steps[neighbour] == kFar || steps[neighbour] + 1 >= steps[at] || steps[at] < 0 || steps[neighbour] < 0) return;
    steps[at] = steps[neighbour] + 1;
    values[at] = values[neighbour];
  };
  const auto row = static_cast<std::size_t>(width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
      if (x > 0) from(at, at - 1);
      if (y > 0) from(at, at - row);
    }
  for (int y = height - 1; y >= 0; --y)
    for (int x = width - 1; x >= 0; --x) {
      const std::size_t at = static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
      if (x + 1 < width) from(at, at + 1);
      if (y + 1 < height) from(at, at + row);
    }
}

}  // namespace

PlanePicture::PlanePicture(const PlaneGrid& grid, const Dims& dims) : grid_(grid) {
  const auto count = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  cells_.resize(count);
  sums_.assign(count, 0.0);
  weights_.assign(count, 0.0);
  const std::array<std::int64_t, 3> size{dims.x, dims.y, dims.z};
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i % static_cast<std::size_t>(grid.width));
    const auto y = static_cast<double>(i / static_cast<std::size_t>(grid.width));
    const glm::dvec3 place = grid.first_vox + x * grid.across_vox + y * grid.down_vox;
    Cell& cell = cells_[i];
    cell.inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const auto last = static_cast<double>(size[a] - 1);
      cell.inside = cell.inside && place[axis] >= -0.5 && place[axis] <= last + 0.5;
      const double clamped = std::clamp(place[axis], 0.0, last);
      const double before = std::min(std::floor(clamped), std::max(0.0, last - 1.0));
      cell.before[a] = static_cast<std::int32_t>(before);
      cell.behind[a] = static_cast<float>(clamped - before);
    }
    inside_ += cell.inside ? 1 : 0;
  }
}

double PlanePicture::known() const noexcept {
  return inside_ == 0 ? 1.0 : static_cast<double>(done_) / static_cast<double>(inside_);
}

PlaneImage PlanePicture::image(bool whole) const {
  PlaneImage out{grid_.width, grid_.height, {}, known()};
  out.values.assign(cells_.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<std::int32_t> steps(cells_.size(), std::numeric_limits<std::int32_t>::max() - 1);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!cells_[i].inside) steps[i] = -1;
    if (!cells_[i].inside || weights_[i] < kWhole) continue;
    out.values[i] = static_cast<float>(sums_[i]);
    steps[i] = 0;
  }
  if (whole && !out.exact()) fill_unknown(out.values, steps, out.width, out.height);
  return out;
}

Result<std::unique_ptr<PlaneSampler>> PlaneSampler::create(std::unique_ptr<VoxelReader> reader,
                                                           const PlaneSamplerOptions& options) {
  if (reader->sequential())
    return fail(ErrorKind::kUnavailable,
                "slices: this file can be read from front to back only, expected one without compression of the whole, "
                "such as HDF5");
  return std::unique_ptr<PlaneSampler>(new PlaneSampler(std::move(reader), options));
}

PlaneSampler::PlaneSampler(std::unique_ptr<VoxelReader> reader, const PlaneSamplerOptions& options)
    : reader_(std::move(reader)), options_(options) {
  const Dims volume = reader_->dims();
  brick_ = brick_for(reader_->chunk(), volume);
  bricks_ = {pieces(volume.x, brick_.x), pieces(volume.y, brick_.y), pieces(volume.z, brick_.z)};
  const auto stored = static_cast<std::uint64_t>(volume.count() * scalar_bytes(reader_->format().type));
  if (options_.picture_bytes == 0) options_.picture_bytes = std::max(kLeastPictureBytes, stored / 4);
}

VoxelBox PlaneSampler::box_of(std::int64_t brick) const noexcept {
  const Dims volume = reader_->dims();
  const auto range = [](std::int64_t at, std::int64_t edge, std::int64_t end) {
    return AxisRange{at * edge, std::min((at + 1) * edge, end), 1};
  };
  return {range(brick % bricks_.x, brick_.x, volume.x), range(brick / bricks_.x % bricks_.y, brick_.y, volume.y),
          range(brick / bricks_.x / bricks_.y, brick_.z, volume.z)};
}

/// Which bricks have voxels for which pixels: coarse ones first, each level in the order of the file.
std::vector<std::pair<std::int64_t, std::uint32_t>> PlaneSampler::crossed(const PlanePicture& picture) const {
  std::vector<std::pair<std::int64_t, std::uint32_t>> out;
  const std::array<std::int64_t, 3> edge{brick_.x, brick_.y, brick_.z};
  for (std::size_t i = 0; i < picture.cells_.size(); ++i) {
    const PlanePicture::Cell& cell = picture.cells_[i];
    if (!cell.inside) continue;
    std::array<std::int64_t, 3> first{}, last{};
    for (std::size_t a = 0; a < 3; ++a) {
      first[a] = cell.before[a] / edge[a];
      last[a] = (cell.before[a] + (cell.behind[a] > 0.0f ? 1 : 0)) / edge[a];
    }
    for (std::int64_t z = first[2]; z <= last[2]; ++z)
      for (std::int64_t y = first[1]; y <= last[1]; ++y)
        for (std::int64_t x = first[0]; x <= last[0]; ++x)
          out.emplace_back((z * bricks_.y + y) * bricks_.x + x, static_cast<std::uint32_t>(i));
  }
  if (out.empty()) return out;
  const auto place = [&](std::int64_t brick) {
    return std::array<std::int64_t, 3>{brick % bricks_.x, brick / bricks_.x % bricks_.y, brick / bricks_.x / bricks_.y};
  };
  // Levels are those of the two axes that the plane runs along most; along the third there is hardly more than one.
  const glm::dvec3 normal =
      glm::abs(glm::cross(picture.grid_.across_vox, picture.grid_.down_vox)) * glm::dvec3(brick_.x, brick_.y, brick_.z);
  const std::size_t across = normal.x >= normal.y && normal.x >= normal.z ? 0 : normal.y >= normal.z ? 1 : 2;
  std::array<std::int64_t, 3> least = place(out.front().first);
  for (const auto& [brick, pixel] : out)
    for (std::size_t a = 0; a < 3; ++a) least[a] = std::min(least[a], place(brick)[a]);
  const auto level = [&](std::int64_t brick) {
    const auto at = place(brick);
    std::int64_t together = 0;
    for (std::size_t a = 0; a < 3; ++a)
      if (a != across) together = std::gcd(together, at[a] - least[a]);
    together = std::gcd(together, std::int64_t{kCoarsest});  // 8, 4, 2 or 1
    return kCoarsest - together;
  };
  std::unordered_map<std::int64_t, std::int64_t> levels;
  for (const auto& [brick, pixel] : out) levels.try_emplace(brick, 0);
  for (auto& [brick, at] : levels) at = level(brick);
  std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) {
    if (a.first == b.first) return a.second < b.second;
    const std::int64_t la = levels.at(a.first), lb = levels.at(b.first);
    return la == lb ? a.first < b.first : la < lb;
  });
  return out;
}

Result<const std::vector<float>*> PlaneSampler::values_of(std::int64_t brick) {
  if (const auto at = kept_.find(brick); at != kept_.end()) {
    ages_.splice(ages_.begin(), ages_, at->second.age);
    return &at->second.values;
  }
  const VoxelBox box = box_of(brick);
  const NumberFormat& format = reader_->format();
  const auto count = static_cast<std::size_t>(box.dims().count());
  stored_.resize(count * static_cast<std::size_t>(scalar_bytes(format.type)));
  DUBSAR_TRY(reader_->read(box, stored_));
  read_bytes_ += stored_.size();
  ages_.push_front(brick);
  Kept& kept = kept_[brick] = {std::vector<float>(count), ages_.begin()};
  scalars_to_float(stored_.data(), format.type, format.order, format.map, kept.values);
  kept_bytes_ += count * sizeof(float);
  while (kept_bytes_ > options_.cache_bytes && ages_.size() > 1) {
    const auto oldest = kept_.find(ages_.back());
    kept_bytes_ -= oldest->second.values.size() * sizeof(float);
    kept_.erase(oldest);
    ages_.pop_back();
  }
  return &kept.values;
}

/// What the voxels of one brick give to a pixel.
void PlaneSampler::add(PlanePicture& picture, std::uint32_t pixel, const VoxelBox& box,
                       const std::vector<float>& values) const {
  const PlanePicture::Cell& cell = picture.cells_[pixel];
  const std::array<AxisRange, 3> range{box.x, box.y, box.z};
  const Dims size = box.dims();
  double& weight = picture.weights_[pixel];
  const bool before = weight >= kWhole;
  for (int corner = 0; corner < 8; ++corner) {
    double share = 1.0;
    std::array<std::int64_t, 3> at{};
    bool ours = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const bool second = (corner >> a & 1) != 0;
      share *= second ? double{cell.behind[a]} : 1.0 - double{cell.behind[a]};
      at[a] = cell.before[a] + (second ? 1 : 0);
      ours = ours && at[a] >= range[a].begin && at[a] < range[a].end;
      at[a] -= range[a].begin;
    }
    if (!ours || share == 0.0) continue;
    picture.sums_[pixel] += share * double{values[static_cast<std::size_t>((at[2] * size.y + at[1]) * size.x + at[0])]};
    weight += share;
  }
  picture.done_ += !before && weight >= kWhole ? 1 : 0;
}

Result<PlaneImage> PlaneSampler::sample(const PlaneGrid& grid, const std::function<bool(const PlanePicture&)>& look) {
  PlanePicture picture(grid, reader_->dims());
  const auto entries = crossed(picture);
  const std::uint64_t begun = read_bytes_;
  for (std::size_t i = 0; i < entries.size();) {
    const std::int64_t brick = entries[i].first;
    if (read_bytes_ - begun >= options_.picture_bytes && !kept_.contains(brick)) {
      while (i < entries.size() && entries[i].first == brick) ++i;
      continue;
    }
    DUBSAR_ASSIGN(const std::vector<float>* const values, values_of(brick));
    const VoxelBox box = box_of(brick);
    for (; i < entries.size() && entries[i].first == brick; ++i) add(picture, entries[i].second, box, *values);
    if (look && !look(picture)) return picture.image();
  }
  return picture.image(true);
}

}  // namespace dubsar
