#include "core/rays/row_curve.h"

#include <algorithm>
#include <cmath>

namespace dubsar {
namespace {

using kernels::kLanes;

constexpr int kCurveSteps = 4096;
constexpr double kFrom = -0.25, kTo = 1.25;  ///< parts of the longest ray

}  // namespace

RowCurve::RowCurve(const RayCurve& curve, const ScatterField* field, std::int64_t directions, std::int64_t bins)
    : curve_(curve), field_(field), directions_(directions), bins_(bins) {
  const double step = (kTo - kFrom) * curve.longest / kCurveSteps;
  for (Table* table : {&plain_, &growth_}) {
    table->first = static_cast<float>(kFrom * curve.longest);
    table->per_length = static_cast<float>(1.0 / step);
  }
  for (int i = 0; i <= kCurveSteps + 1; ++i) {
    const double p = kFrom * curve.longest + i * step;
    plain_.values.push_back(static_cast<float>(curve.value(p) / curve.coefficients[0] - p));
    growth_.values.push_back(
        static_cast<float>(std::exp(curve.absorbed * std::min(p, curve.longest)) / curve.stray_unit));
  }
}

float RowCurve::Table::at(float p) const noexcept {
  const float place = std::clamp((p - first) * per_length, 0.0F, static_cast<float>(kCurveSteps));
  const auto cell = static_cast<std::size_t>(place);
  return values[cell] + (place - static_cast<float>(cell)) * (values[cell + 1] - values[cell]);
}

void RowCurve::bend(std::int64_t direction, std::span<const std::int64_t> planes, const float* p, float* out) const {
  const std::int64_t floats = bins_ * kLanes;
  if (field_ == nullptr) {
    for (std::int64_t i = 0; i < floats; ++i) out[i] = p[i] > 0.0F ? plain_.at(p[i]) : 0.0F;
    return;
  }
  thread_local std::vector<float> stray;
  stray.resize(static_cast<std::size_t>(floats));
  field_->row(direction, directions_, planes, bins_, stray.data());
  const double scale = curve_.longest / curve_.coefficients[0];
  const auto a = static_cast<float>(scale * curve_.stray[0]), b = static_cast<float>(scale * curve_.stray[1]),
             c = static_cast<float>(scale * curve_.stray[2]);
  for (std::int64_t i = 0; i < floats; ++i) {
    // Interpolation of a field without negative values may fall below 0, and no part of x is to grow beyond its fit.
    const float x = std::clamp(stray[static_cast<std::size_t>(i)] * growth_.at(p[i]), 0.0F, 1.25F);
    const float by_stray = x * (a + x * (b + x * x * c));
    out[i] = by_stray + (p[i] > 0.0F ? plain_.at(p[i]) : 0.0F);
  }
}

}  // namespace dubsar
