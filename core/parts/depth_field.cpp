#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/base/system/parallel.h"
#include "core/parts/air_space.h"

namespace dubsar {
namespace {

constexpr float kFar = 1e20f;

/// Squared distances along one line, lower envelope of parabolas (Felzenszwalb and Huttenlocher 2012), in
/// place.
class LineTransform {
 public:
  explicit LineTransform(std::int64_t longest)
      : value_(static_cast<std::size_t>(longest)), place_(value_.size()), border_(value_.size() + 1) {}

  void operator()(float* line, std::int64_t count, std::int64_t stride) {
    std::int64_t top = -1;
    for (std::int64_t i = 0; i < count; ++i) {
      const float f = line[i * stride];
      value_[static_cast<std::size_t>(i)] = f;
      if (f >= kFar) continue;
      double meet = -1e30;
      while (top >= 0) {
        const auto p = static_cast<double>(place_[static_cast<std::size_t>(top)]);
        const double g = value_[static_cast<std::size_t>(place_[static_cast<std::size_t>(top)])];
        const auto x = static_cast<double>(i);
        meet = ((f + x * x) - (g + p * p)) / (2.0 * (x - p));
        if (meet > border_[static_cast<std::size_t>(top)]) break;
        --top;
        meet = -1e30;
      }
      ++top;
      place_[static_cast<std::size_t>(top)] = i;
      border_[static_cast<std::size_t>(top)] = meet;
    }
    if (top < 0) return;
    std::int64_t k = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      while (k < top && border_[static_cast<std::size_t>(k + 1)] < static_cast<double>(i)) ++k;
      const std::int64_t p = place_[static_cast<std::size_t>(k)];
      const auto d = static_cast<float>(i - p);
      line[i * stride] = d * d + value_[static_cast<std::size_t>(p)];
    }
  }

 private:
  std::vector<float> value_;
  std::vector<std::int64_t> place_;
  std::vector<double> border_;
};

/// The same for a line of 0 and kFar along x: to the nearest 0 on either side.
void squares_to_nearest(float* line, std::int64_t count) {
  std::int64_t zero = -1;
  for (std::int64_t i = 0; i < count; ++i) {
    if (line[i] == 0.0f)
      zero = i;
    else if (zero >= 0)
      line[i] = static_cast<float>(i - zero) * static_cast<float>(i - zero);
  }
  zero = -1;
  for (std::int64_t i = count - 1; i >= 0; --i) {
    if (line[i] == 0.0f)
      zero = i;
    else if (zero >= 0)
      line[i] = std::min(line[i], static_cast<float>(zero - i) * static_cast<float>(zero - i));
  }
}

/// Squared distances to the points that are 0, of a field of 0 and kFar, all threads.
void squares_to_nearest(const Dims& d, float* data) {
  parallel_for(d.z, 1, [&](std::int64_t z) {
    LineTransform transform(d.y);
    float* const slice = data + z * d.slice();
    for (std::int64_t y = 0; y < d.y; ++y) squares_to_nearest(slice + y * d.x, d.x);
    for (std::int64_t x = 0; x < d.x; ++x) transform(slice + x, d.y, d.x);
  });
  parallel_for(d.y, 1, [&](std::int64_t y) {
    LineTransform transform(d.z);
    for (std::int64_t x = 0; x < d.x; ++x) transform(data + y * d.x + x, d.z, d.slice());
  });
}

constexpr std::int64_t kBlur = 2;

/// Each value is the mean of the five that are `step` apart in `from`, which has room for the first and the last.
void mean_of_five(const float* from, std::int64_t step, std::int64_t count, float* to) {
  for (std::int64_t i = 0; i < count; ++i) {
    float sum = 0.0f;
    for (std::int64_t k = 0; k <= 2 * kBlur; ++k) sum += from[i + k * step];
    to[i] = sum / static_cast<float>(2 * kBlur + 1);
  }
}

/// The rows of a plane, `pitch` apart, become means along the other axis, ends clamped.
void blur_across(float* rows, std::int64_t pitch, std::int64_t length, std::int64_t count, std::vector<float>& copy) {
  copy.resize(static_cast<std::size_t>((count + 2 * kBlur) * length));
  for (std::int64_t i = 0; i < count + 2 * kBlur; ++i)
    std::copy_n(rows + std::clamp<std::int64_t>(i - kBlur, 0, count - 1) * pitch, length, copy.data() + i * length);
  for (std::int64_t i = 0; i < count; ++i) mean_of_five(copy.data() + i * length, length, length, rows + i * pitch);
}

/// Means of five along each axis in turn, ends clamped; twice gives a near-Gaussian. All threads.
void box_blur(const Dims& d, float* data) {
  parallel_for(d.z, 1, [&](std::int64_t z) {
    std::vector<float> copy(static_cast<std::size_t>(d.x + 2 * kBlur));
    float* const slice = data + z * d.slice();
    for (std::int64_t y = 0; y < d.y; ++y) {
      float* const row = slice + y * d.x;
      std::copy_n(row, d.x, copy.data() + kBlur);
      std::fill_n(copy.data(), kBlur, row[0]);
      std::fill_n(copy.data() + kBlur + d.x, kBlur, row[d.x - 1]);
      mean_of_five(copy.data(), 1, d.x, row);
    }
    blur_across(slice, d.x, d.x, d.y, copy);
  });
  parallel_for(d.y, 1, [&](std::int64_t y) {
    std::vector<float> copy;
    blur_across(data + y * d.x, d.slice(), d.x, d.z, copy);
  });
}

}  // namespace

Result<DepthField> DepthField::make(const BitVolume& inside, int seal_radius, Progress& progress) {
  constexpr std::int64_t kMostPoints = 24'000'000;  // 96 MB; the field is smooth, so steps of 2 or 3 lose nothing
  const Dims fine = inside.dims();
  std::int64_t step = 1;
  // One layer of exterior around the grid.
  const auto coarse = [&](std::int64_t n) { return (n + step - 1) / step + 2; };
  while (coarse(fine.x) * coarse(fine.y) * coarse(fine.z) > kMostPoints) ++step;

  DepthField field;
  field.step_ = static_cast<float>(step);
  field.dims_ = {coarse(fine.x), coarse(fine.y), coarse(fine.z)};
  BitVolume exterior;
  {
    const int margin = seal_radius + 2;
    const BitVolume blocked = dilate(pad(inside, margin), seal_radius);
    if (progress.cancelled()) return cancelled_error();
    exterior = crop(flood_from_border(blocked), margin);
  }
  if (progress.cancelled()) return cancelled_error();
  const Dims d = field.dims_;
  field.depth_.resize(static_cast<std::size_t>(d.count()));
  parallel_for(d.z, 1, [&](std::int64_t z) {
    for (std::int64_t y = 0; y < d.y; ++y)
      for (std::int64_t x = 0; x < d.x; ++x) {
        const std::int64_t fx = (x - 1) * step, fy = (y - 1) * step, fz = (z - 1) * step;
        const bool outside =
            std::min({fx, fy, fz}) < 0 || fx >= fine.x || fy >= fine.y || fz >= fine.z || exterior.get(fx, fy, fz);
        field.depth_[static_cast<std::size_t>(z * d.slice() + y * d.x + x)] = outside ? 0.0f : kFar;
      }
  });
  squares_to_nearest(d, field.depth_.data());
  if (progress.cancelled()) return cancelled_error();
  parallel_for(d.count(), 1 << 16, [&](std::int64_t i) {
    float& v = field.depth_[static_cast<std::size_t>(i)];
    v = v >= kFar ? 0.0f : std::sqrt(v) * static_cast<float>(step);
  });
  for (int pass = 0; pass < 2; ++pass) box_blur(d, field.depth_.data());
  return field;
}

float DepthField::depth(const glm::vec3& p) const noexcept {
  const auto axis = [&](float v, std::int64_t n, std::int64_t& i, float& t) {
    const float s = std::clamp(v / step_ + 1.0f, 0.0f, static_cast<float>(n - 1));
    i = std::min(static_cast<std::int64_t>(s), n - 2);
    t = s - static_cast<float>(i);
  };
  std::int64_t x = 0, y = 0, z = 0;
  float tx = 0, ty = 0, tz = 0;
  axis(p.x, dims_.x, x, tx);
  axis(p.y, dims_.y, y, ty);
  axis(p.z, dims_.z, z, tz);
  const float* base = depth_.data() + z * dims_.slice() + y * dims_.x + x;
  const auto row = [&](std::int64_t dy, std::int64_t dz) {
    const float* r = base + dz * dims_.slice() + dy * dims_.x;
    return r[0] + tx * (r[1] - r[0]);
  };
  const float front = row(0, 0) + ty * (row(1, 0) - row(0, 0)), back = row(0, 1) + ty * (row(1, 1) - row(0, 1));
  return front + tz * (back - front);
}

glm::vec3 DepthField::inwards(const glm::vec3& p) const noexcept {
  const float h = std::max(step_, 1.5f);
  const auto slope = [&](const glm::vec3& e) { return depth(p + h * e) - depth(p - h * e); };
  const glm::vec3 g(slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1}));
  const float length = glm::length(g);
  return length > 1e-4f * h ? g / length : glm::vec3(0.0f);
}

}  // namespace dubsar
