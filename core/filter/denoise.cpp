#include "core/filter/denoise.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/filter/bilateral_kernels.h"
#include "core/filter/gauss_kernels.h"
#include "core/filter/sharpen.h"
#include "core/filter/slice_ring.h"

namespace dubsar {
namespace {

constexpr std::int64_t kBatchBytes = 4 << 20;  // output slices made at a time: the chain stays in the caches
constexpr std::int64_t kTile = 256;            // voxels in x: the window's rows of a tile stay in the first-level cache
constexpr std::int64_t kTileRows = 32;

std::int64_t slices_at_a_time(Dims dims) {
  return std::clamp<std::int64_t>(kBatchBytes / (dims.slice() * static_cast<std::int64_t>(sizeof(float))), 1, 16);
}

/// Factor on guide values that leaves a range weight of the difference alone.
float guide_scale(const DenoiseOptions& options) {
  if (!needs_sigma(options.method)) return 1.0F;
  const double width = options.sigma * (options.range == RangeWeight::kTukey ? kTukeyScale : std::numbers::sqrt2);
  return static_cast<float>(std::min(1.0 / width, static_cast<double>(std::numeric_limits<float>::max())));
}

std::int64_t guide_radius(const DenoiseOptions& options) {
  return options.method == DenoiseMethod::kJointBilateral ? 1 : 0;
}

/// One iteration of one filter; of the points of each row that are wanted.
class FilterSource final : public SlabSource {
 public:
  /// `sharpen`, with Gauss: the source plus so much of its difference from it; nothing new beyond `level` (NaN: none).
  FilterSource(SlabSource& source, const DenoiseOptions& options, const Wanted& wanted = {}, float sharpen = 0.0F,
               float level = std::numeric_limits<float>::quiet_NaN())
      : source_(&source),
        options_(options),
        wanted_(wanted),
        sharpen_(sharpen),
        level_(level),
        radius_(options.window / 2),
        guide_radius_(guide_radius(options)),
        scale_(guide_scale(options)),
        batch_(slices_at_a_time(source.dims())),
        image_(source.dims(), batch_ + 2 * (radius_ + guide_radius_), SliceRing::Rows::kPadded),
        guide_(needs_sigma(options.method) ? SliceRing(source.dims(), batch_ + 2 * radius_, SliceRing::Rows::kPadded)
                                           : SliceRing({1, 1, 1}, 1, SliceRing::Rows::kPadded)) {}

  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }

  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    DUBSAR_CHECK(z_begin >= 0 && z_begin <= z_end && z_end <= dims().z);
    DUBSAR_CHECK(static_cast<std::int64_t>(out.size()) >= (z_end - z_begin) * dims().slice());
    for (std::int64_t z = z_begin; z < z_end; z += batch_) {
      const std::int64_t end = std::min(z_end, z + batch_);
      if (!wanted_.any(z, end)) continue;
      const std::int64_t halo = radius_ + guide_radius_;
      DUBSAR_TRY(image_.load(*source_, {z - halo, end + halo}, wanted_.wider(halo)));
      if (needs_sigma(options_.method)) make_guide({z - radius_, end + radius_});
      float* to = out.data() + (z - z_begin) * dims().slice();
      if (options_.method == DenoiseMethod::kGauss) {
        gauss({z, end}, to);
      } else {
        window_filter({z, end}, to);
      }
    }
    return {};
  }

 private:
  void make_guide(SliceRange wanted) {
    const SliceRange part = guide_.missing(wanted);
    if (part.empty()) return;
    const Dims d = dims();
    const Wanted seen = wanted_.wider(radius_);
    parallel_chunks((part.end - part.begin) * d.y, 16, [&](std::int64_t begin, std::int64_t end) {
      Buffer<float> padded(d.x + 2);
      float* line = padded.data() + 1;
      std::vector<Span> spans;
      for (std::int64_t i = begin; i < end; ++i) {
        const std::int64_t y = i % d.y, z = part.begin + i / d.y;
        seen.spans(d.x, y, z, spans);
        if (spans.empty()) continue;
        float* to = guide_.row(y, z);
        std::array<const float*, 9> rows{};
        for (int k = 0; k < 9; ++k) rows[static_cast<std::size_t>(k)] = image_.row(y + k % 3 - 1, z + k / 3 - 1);
        for (const Span& span : spans) {
          if (guide_radius_ == 0) {
            for (std::int64_t x = span.begin; x < span.end; ++x) to[x] = rows[4][x] * scale_;
            continue;
          }
          const std::array<const float*, 9> from = moved(rows, span.begin - 1);  // rows are padded
          kernels::gauss3_yz(from.data(), span.end - span.begin + 2, line - 1);
          kernels::gauss3_x(line, span.end - span.begin, scale_, to + span.begin);
        }
        guide_.pad_row(to);
      }
    });
    guide_.hold(part);
  }

  template <std::size_t kCount>
  static std::array<const float*, kCount> moved(std::array<const float*, kCount> rows, std::int64_t by) {
    for (const float*& row : rows)
      if (row != nullptr) row += by;
    return rows;
  }

  /// Row pointers of the window around row y of slice z, `rows[side * dz + dy]`.
  void gather(SliceRing& ring, std::int64_t y, std::int64_t z, const float** rows) const {
    for (std::int64_t dz = -radius_; dz <= radius_; ++dz) {
      const SliceRing::Slice slice = ring.slice(z + dz);
      for (std::int64_t dy = -radius_; dy <= radius_; ++dy) *rows++ = slice.row(y + dy);
    }
  }

  /// Bilateral filters and median: every output row sees the rows of a window.
  void window_filter(SliceRange slices, float* out) {
    const Dims d = dims();
    const std::int64_t tile_x = wanted_.mask != nullptr ? d.x : kTile;  // spans are found once a row
    const std::int64_t tiles_x = (d.x + tile_x - 1) / tile_x, tiles_y = (d.y + kTileRows - 1) / kTileRows;
    parallel_for((slices.end - slices.begin) * tiles_x * tiles_y, 1, [&](std::int64_t tile) {
      const std::int64_t x0 = tile % tiles_x * tile_x, y0 = tile / tiles_x % tiles_y * kTileRows;
      const std::int64_t x1 = std::min(x0 + tile_x, d.x), y1 = std::min(y0 + kTileRows, d.y);
      const std::int64_t z = slices.begin + tile / tiles_x / tiles_y;
      std::array<const float*, 49> image{}, guide{};
      const kernels::Window window{image.data(), guide.data(), static_cast<int>(radius_)};
      std::vector<Span> spans;
      for (std::int64_t y = y0; y < y1; ++y) {
        wanted_.spans(d.x, y, z, spans);
        if (spans.empty()) continue;
        gather(image_, y, z, image.data());
        if (needs_sigma(options_.method)) gather(guide_, y, z, guide.data());
        float* to = out + (z - slices.begin) * d.slice() + y * d.x;
        for (const Span& span : spans) filter_row(window, std::max(span.begin, x0), std::min(span.end, x1), to);
      }
    });
  }

  void filter_row(const kernels::Window& window, std::int64_t begin, std::int64_t end, float* to) const {
    if (begin >= end) return;
    if (options_.method == DenoiseMethod::kMedian) {
      kernels::median(window, begin, end, to);
    } else if (options_.range == RangeWeight::kTukey) {
      kernels::bilateral_tukey(window, begin, end, to);
    } else {
      kernels::bilateral_gauss(window, begin, end, to);
    }
  }

  void gauss(SliceRange slices, float* out) {
    const Dims d = dims();
    const int side = options_.window;
    const std::vector<float> taps = binomial(side);
    std::vector<float> plane;
    for (float z : taps)
      for (float y : taps) plane.push_back(z * y);
    parallel_chunks((slices.end - slices.begin) * d.y, 16, [&](std::int64_t begin, std::int64_t end) {
      Buffer<float> padded(d.x + 2 * radius_);
      float* line = padded.data() + radius_;
      std::array<const float*, 49> rows{};
      std::vector<Span> spans;
      for (std::int64_t i = begin; i < end; ++i) {
        const std::int64_t y = i % d.y, z = slices.begin + i / d.y;
        wanted_.spans(d.x, y, z, spans);
        if (spans.empty()) continue;
        gather(image_, y, z, rows.data());
        for (const Span& span : spans) {
          const std::array<const float*, 49> from = moved(rows, span.begin - radius_);  // rows are padded
          const std::int64_t count = span.end - span.begin;
          float* to = out + i * d.x + span.begin;
          if (side == 3) {
            kernels::gauss3_yz(from.data(), count + 2, line - 1);
            kernels::gauss3_x(line, count, 1.0F, to);
          } else {
            kernels::weighted_rows(from.data(), plane.data(), side * side, count + 2 * radius_, line - radius_);
            kernels::weighted_taps(line, taps.data(), side, count, to);
          }
          if (sharpen_ == 0.0F) continue;
          const float* own = image_.row(y, z) + span.begin;
          for (std::int64_t x = 0; x < count; ++x) to[x] = own[x] + sharpen_ * (own[x] - to[x]);
          if (!std::isnan(level_)) stay_beside(y, z, span, to);
        }
      }
    });
  }

  /// Takes back what went to the other side of the level where nothing beside it was there before.
  void stay_beside(std::int64_t y, std::int64_t z, const Span& span, float* to) {
    const float* own = image_.row(y, z);
    for (std::int64_t x = span.begin; x < span.end; ++x) {
      const bool inside = own[x] >= level_;
      float& value = to[x - span.begin];
      if ((value >= level_) == inside) continue;
      bool beside = false;
      for (std::int64_t k = 0; k < 9 && !beside; ++k) {
        const float* row = image_.row(y + k % 3 - 1, z + k / 3 - 1) + x;  // rows are padded
        beside = (row[-1] >= level_) != inside || (row[0] >= level_) != inside || (row[1] >= level_) != inside;
      }
      if (!beside) value = own[x];
    }
  }

  /// Row of Pascal's triangle with `side` entries, sum 1.
  static std::vector<float> binomial(int side) {
    std::vector<float> row{1.0F};
    while (static_cast<int>(row.size()) < side) {
      row.push_back(0.0F);
      for (std::size_t k = row.size() - 1; k > 0; --k) row[k] = 0.5F * (row[k] + row[k - 1]);
      row[0] *= 0.5F;
    }
    return row;
  }

  SlabSource* source_;
  DenoiseOptions options_;
  Wanted wanted_;
  float sharpen_, level_;
  std::int64_t radius_, guide_radius_;
  float scale_;
  std::int64_t batch_;
  SliceRing image_, guide_;
};

/// Owns the iterations; the last one is the result.
class FilterChain final : public SlabSource {
 public:
  FilterChain(SlabSource& source, const DenoiseOptions& options, const Wanted& wanted) : last_(&source) {
    const std::int64_t each = options.window / 2 + guide_radius(options);
    for (int k = 0; k < options.iterations; ++k) {
      filters_.push_back(
          std::make_unique<FilterSource>(*last_, options, wanted.wider(each * (options.iterations - 1 - k))));
      last_ = filters_.back().get();
    }
  }
  Dims dims() const noexcept override { return last_->dims(); }
  const GridFrame& frame() const noexcept override { return last_->frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    return last_->read(z_begin, z_end, out);
  }

 private:
  std::vector<std::unique_ptr<FilterSource>> filters_;
  SlabSource* last_;
};

}  // namespace

Result<void> check(const DenoiseOptions& options) {
  if (options.window != 3 && options.window != 5 && options.window != 7)
    return fail(ErrorKind::kUsage, "denoise: window of {} voxels, expected 3, 5 or 7", options.window);
  if (options.iterations < 0 || options.iterations > 100)
    return fail(ErrorKind::kUsage, "denoise: {} iterations, expected 0 to 100", options.iterations);
  if (needs_sigma(options.method) && options.iterations > 0 && !(options.sigma > 0.0 && std::isfinite(options.sigma)))
    return fail(ErrorKind::kUsage,
                "denoise: sigma is {}, a bilateral filter needs the noise's standard deviation (> 0)", options.sigma);
  return {};
}

Result<std::unique_ptr<SlabSource>> make_denoised(SlabSource& source, const DenoiseOptions& options,
                                                  const Wanted& wanted) {
  DUBSAR_TRY(check(options));
  return std::make_unique<FilterChain>(source, options, wanted);
}

std::int64_t reach_of(const DenoiseOptions& options) noexcept {
  return options.iterations * (options.window / 2 + guide_radius(options));
}

std::unique_ptr<SlabSource> make_sharpened(SlabSource& source, float amount, const Wanted& wanted) {
  DenoiseOptions gauss;
  gauss.method = DenoiseMethod::kGauss;
  return std::make_unique<FilterSource>(source, gauss, wanted, amount);
}

std::unique_ptr<SlabSource> make_widely_sharpened(SlabSource& source, float amount, float level, const Wanted& wanted) {
  DenoiseOptions gauss;
  gauss.method = DenoiseMethod::kGauss;
  gauss.window = 7;
  return std::make_unique<FilterSource>(source, gauss, wanted, amount, level);
}

Result<void> denoise_in_place(GridStore& grid, const DenoiseOptions& options, Progress& progress,
                              ParallelCounts* counts) {
  DUBSAR_TRY(check(options));
  const Dims dims = grid.dims();
  if (dims.count() == 0) return {};
  const std::int64_t batch = slices_at_a_time(dims);
  for (int k = 0; k < options.iterations; ++k) {
    FilterSource filter(grid, options);
    // The filter has taken the slices around a batch into its ring before the batch is written, and never asks for a
    // slice twice while it is read in rising order.
    for (std::int64_t z = 0; z < dims.z; z += batch) {
      if (progress.cancelled()) return cancelled_error();
      const std::int64_t end = std::min(dims.z, z + batch);
      const std::span<float> page = grid.page(z, end);
      DUBSAR_TRY(filter.read(z, end, page));
      if (counts != nullptr && k + 1 == options.iterations) counts->add(z, page);
      DUBSAR_TRY(grid.store(z, end));
      progress.advance((end - z) * dims.slice());
    }
  }
  return {};
}

Result<void> denoise_in_place(Volume<float>& volume, const DenoiseOptions& options, Progress& progress) {
  GridStore grid(std::move(volume));
  const Result<void> done = denoise_in_place(grid, options, progress);
  volume = grid.take_volume();
  return done;
}

}  // namespace dubsar
