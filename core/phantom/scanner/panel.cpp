#include "core/phantom/scanner/panel.h"

#include <algorithm>
#include <cmath>

#include "core/base/system/parallel.h"
#include "core/phantom/scanner/photon_noise.h"

namespace dubsar::phantom {
namespace {

/// Half a Gauss from its middle, the whole of it summing to 1.
std::vector<float> half_gauss(double sigma) {
  std::vector<double> w;
  double sum = 0.0;
  for (int k = 0; k <= static_cast<int>(std::ceil(3.5 * sigma)); ++k) {
    w.push_back(sigma > 0.0 ? std::exp(-0.5 * k * k / (sigma * sigma)) : 1.0);
    sum += (k == 0 ? 1.0 : 2.0) * w.back();
  }
  std::vector<float> out;
  for (const double value : w) out.push_back(static_cast<float>(value / sum));
  return out;
}

/// Blurs `n` numbers that are `step` apart; beyond the ends: as the last one, or dark.
void blur_line(float* line, std::int64_t n, std::int64_t step, const std::vector<float>& w, bool dark,
               std::vector<float>& copy) {
  copy.resize(static_cast<std::size_t>(n));
  for (std::int64_t i = 0; i < n; ++i) copy[static_cast<std::size_t>(i)] = line[i * step];
  const auto at = [&](std::int64_t i) {
    if (dark && (i < 0 || i >= n)) return 0.0f;
    return copy[static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, n - 1))];
  };
  for (std::int64_t i = 0; i < n; ++i) {
    float sum = w[0] * at(i);
    for (std::size_t k = 1; k < w.size(); ++k) {
      const auto off = static_cast<std::int64_t>(k);
      sum += w[k] * (at(i - off) + at(i + off));
    }
    line[i * step] = sum;
  }
}

constexpr float kLeastLight = 1e-7f;  ///< a pixel that reads nothing is taken as this

}  // namespace

StrayField::StrayField(std::int64_t columns, std::int64_t rows, double sigma_px)
    : columns_(columns),
      rows_(rows),
      cell_(std::max<std::int64_t>(1, std::llround(sigma_px / 4.0))),
      cells_u_((columns + cell_ - 1) / cell_),
      cells_v_((rows + cell_ - 1) / cell_),
      weights_(half_gauss(sigma_px / static_cast<double>(cell_))) {}

std::vector<float> StrayField::spread(const float* view, std::int64_t stride) const {
  std::vector<float> cells(static_cast<std::size_t>(cells_u_ * cells_v_), 0.0f), line;
  for (std::int64_t column = 0; column < columns_; ++column)
    for (std::int64_t row = 0; row < rows_; ++row)
      cells[static_cast<std::size_t>(column / cell_ * cells_v_ + row / cell_)] += view[column * stride + row];
  for (std::int64_t u = 0; u < cells_u_; ++u)
    for (std::int64_t v = 0; v < cells_v_; ++v) {  // the last cells are narrower
      const std::int64_t wide = std::min(cell_, columns_ - u * cell_), high = std::min(cell_, rows_ - v * cell_);
      cells[static_cast<std::size_t>(u * cells_v_ + v)] /= static_cast<float>(wide * high);
    }
  for (std::int64_t u = 0; u < cells_u_; ++u) blur_line(cells.data() + u * cells_v_, cells_v_, 1, weights_, true, line);
  for (std::int64_t v = 0; v < cells_v_; ++v) blur_line(cells.data() + v, cells_u_, cells_v_, weights_, true, line);
  return cells;
}

float StrayField::at(const std::vector<float>& field, std::int64_t column, std::int64_t row) const noexcept {
  const auto place = [&](std::int64_t pixel, std::int64_t cells) {
    const double at = (static_cast<double>(pixel) + 0.5) / static_cast<double>(cell_) - 0.5;
    return static_cast<float>(std::clamp(at, 0.0, static_cast<double>(cells - 1)));
  };
  const float u = place(column, cells_u_), v = place(row, cells_v_);
  const auto iu = static_cast<std::int64_t>(u), iv = static_cast<std::int64_t>(v);
  const float tu = u - static_cast<float>(iu), tv = v - static_cast<float>(iv);
  const auto value = [&](std::int64_t a, std::int64_t b) {
    return field[static_cast<std::size_t>(std::min(a, cells_u_ - 1) * cells_v_ + std::min(b, cells_v_ - 1))];
  };
  const float low = value(iu, iv) + tv * (value(iu, iv + 1) - value(iu, iv));
  const float high = value(iu + 1, iv) + tv * (value(iu + 1, iv + 1) - value(iu + 1, iv));
  return low + tu * (high - low);
}

Panel::Panel(const BeamOptions& beam, const PanelOptions& options, const ScanGeometry& geometry, std::uint64_t seed)
    : beam_(beam), options_(options), geometry_(geometry), seed_(hash64(seed ^ 0x70616e656c)) {
  make_gains();
}

void Panel::make_gains() {
  offsets_ = Columns(1, geometry_.columns, geometry_.rows);
  offsets_.clear();
  constexpr std::int64_t kRun = 40;
  const double common = std::sqrt(0.6) * options_.rings, single = std::sqrt(0.4) * options_.rings;
  const double worst = std::max(10.0 * options_.rings, 0.01);
  for (std::int64_t column = 0; column < geometry_.columns; ++column) {
    Random random(seed_ ^ 0x6761696e, static_cast<std::uint64_t>(column));
    double run = 0.0, fault = 0.0;
    std::int64_t run_end = 0, fault_end = 0;
    for (std::int64_t row = 0; row < geometry_.rows; ++row) {
      if (row >= run_end) {
        run = PixelDraw(random.next()).normal;
        run_end = row + kRun / 2 + random.index(kRun);
      }
      if (row >= fault_end) fault = 0.0;
      // A fault of 20 rows in the mean begins at a twentieth of the share of bad pixels.
      if (random.uniform() < options_.bad / (0.5 * kRun)) {
        fault = worst * PixelDraw(random.next()).normal;
        fault_end = row + 1 + random.index(kRun);
      }
      const double gain = common * run + single * PixelDraw(random.next()).normal + fault;
      offsets_.at(0, column)[row] = static_cast<float>(-std::log1p(std::max(gain, -0.9)));
    }
  }
}

void Panel::blur(float* view, std::int64_t stride, std::vector<float>& copy) const {
  if (options_.blur_vox <= 0.0) return;
  const std::vector<float> w = half_gauss(options_.blur_vox);
  for (std::int64_t column = 0; column < geometry_.columns; ++column)
    blur_line(view + column * stride, geometry_.rows, 1, w, false, copy);
  // Across columns, a whole column at a time.
  const std::vector<float> before(view, view + geometry_.columns * stride);
  for (std::int64_t column = 0; column < geometry_.columns; ++column) {
    float* to = view + column * stride;
    for (std::int64_t row = 0; row < geometry_.rows; ++row) to[row] *= w[0];
    for (std::size_t k = 1; k < w.size(); ++k) {
      const auto off = static_cast<std::int64_t>(k);
      const float* a = before.data() + std::max<std::int64_t>(column - off, 0) * stride;
      const float* b = before.data() + std::min(column + off, geometry_.columns - 1) * stride;
      for (std::int64_t row = 0; row < geometry_.rows; ++row) to[row] += w[k] * (a[row] + b[row]);
    }
  }
}

void Panel::read(std::int64_t view, std::int64_t stride, const std::vector<float>& excess, float* light) const {
  const std::uint64_t view_key = hash64(seed_ + static_cast<std::uint64_t>(view));
  for (std::int64_t column = 0; column < geometry_.columns; ++column)
    for (std::int64_t row = 0; row < geometry_.rows; ++row) {
      const std::int64_t i = column * stride + row;
      if (options_.photons > 0.0) {
        const std::uint64_t key =
            view_key ^ (static_cast<std::uint64_t>(column) << 32 | static_cast<std::uint64_t>(row));
        // Counts worth `excess` photons each have the variance of the photons' energies.
        const auto worth = static_cast<double>(excess[static_cast<std::size_t>(i)]);
        double photons = worth * poisson(options_.photons * static_cast<double>(light[i]) / worth, PixelDraw(key));
        if (options_.electronic > 0.0) photons += options_.electronic * PixelDraw(~key).normal;
        light[i] = static_cast<float>(photons / options_.photons);
      }
      light[i] = -std::log(std::max(light[i], kLeastLight)) + offsets_.at(0, column)[row];
    }
}

Result<LongestRay> Panel::expose(Columns& views, Progress& progress) const {
  const std::int64_t stride = views.stride, n = geometry_.columns * stride;
  const double px_per_mm = 1.0 / (kMagnification * geometry_.voxel_mm);
  const StrayField scatter(geometry_.columns, geometry_.rows, options_.spread_mm * px_per_mm);
  constexpr double kGlareMm = 10.0;  // on the panel
  const StrayField glare(geometry_.columns, geometry_.rows, kGlareMm * px_per_mm);
  struct Place {
    float mm = 0.0f;
    std::int64_t view = 0, column = 0, row = 0;
  };
  const Place longest = parallel_reduce<Place>(
      views.planes, 1, {},
      [&](std::int64_t view, std::int64_t) {
        const float* from = views.at(view, 0);
        const std::int64_t i = std::max_element(from, from + n) - from;
        return Place{from[i], view, i / stride, i % stride};
      },
      [](const Place& x, const Place& y) { return y.mm > x.mm ? y : x; });
  const BeamTable table(beam_, static_cast<double>(longest.mm));
  std::vector<std::vector<float>> scattered(static_cast<std::size_t>(views.planes));
  float scale = 0.0f;
  if (options_.scatter > 0.0) {
    parallel_for(views.planes, 1, [&](std::int64_t view) {
      std::vector<float> source(static_cast<std::size_t>(n), 0.0f);
      const float* from = views.at(view, 0);
      for (std::int64_t i = 0; i < n; ++i) {
        const float light = table.transmission(from[i]);
        source[static_cast<std::size_t>(i)] = light < 1.0f ? -light * std::log(light) : 0.0f;
      }
      scattered[static_cast<std::size_t>(view)] = scatter.spread(source.data(), stride);
    });
    double sum = 0.0;
    for (const auto& field : scattered)
      sum += static_cast<double>(scatter.at(field, geometry_.columns / 2, geometry_.rows / 2));
    if (sum > 0.0) scale = static_cast<float>(options_.scatter * static_cast<double>(views.planes) / sum);
  }
  const auto stray = static_cast<float>(options_.glare);
  progress.begin("expose", views.planes, "view");
  parallel_for(views.planes, 1, [&](std::int64_t view) {
    if (progress.cancelled()) return;
    thread_local std::vector<float> excess, copy;
    excess.resize(static_cast<std::size_t>(n));
    float* light = views.at(view, 0);
    for (std::int64_t i = 0; i < n; ++i) {
      excess[static_cast<std::size_t>(i)] = table.excess(light[i]);
      light[i] = table.transmission(light[i]);
    }
    blur(light, stride, copy);
    std::vector<float> lost;  // of the open light
    if (stray > 0.0f) {
      std::vector<float> dark(static_cast<std::size_t>(n));
      for (std::int64_t i = 0; i < n; ++i) dark[static_cast<std::size_t>(i)] = 1.0f - light[i];
      lost = glare.spread(dark.data(), stride);
    }
    for (std::int64_t column = 0; column < geometry_.columns; ++column)
      for (std::int64_t row = 0; row < geometry_.rows; ++row) {
        float& value = light[column * stride + row];
        if (stray > 0.0f) value += stray * (1.0f - glare.at(lost, column, row) - value);
        if (scale > 0.0f) value += scale * scatter.at(scattered[static_cast<std::size_t>(view)], column, row);
      }
    read(view, stride, excess, light);
    for (std::int64_t column = 0; column < geometry_.columns; ++column)
      std::fill(light + column * stride + geometry_.rows, light + (column + 1) * stride, 0.0f);
    progress.advance(1);
  });
  progress.end();
  if (progress.cancelled()) return cancelled_error();
  LongestRay ray;
  ray.clay_mm = static_cast<double>(longest.mm);
  if (scale > 0.0f)
    ray.scatter = static_cast<double>(
        scale * scatter.at(scattered[static_cast<std::size_t>(longest.view)], longest.column, longest.row));
  return ray;
}

}  // namespace dubsar::phantom
