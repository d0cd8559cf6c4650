#include "core/filter/sharpen.h"

#include "core/base/parallel.h"
#include "core/filter/denoise.h"

namespace dubsar {
namespace {

DenoiseOptions gauss_once() {
  DenoiseOptions options;
  options.method = DenoiseMethod::kGauss;
  options.iterations = 1;
  return options;
}

}  // namespace

SharpenedSource::SharpenedSource(SlabSource& source, float amount) : source_(&source), amount_(amount) {
  auto smooth = make_denoised(source, gauss_once());
  DUBSAR_CHECK(smooth.has_value());
  smooth_ = *std::move(smooth);
}

Result<void> SharpenedSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  const std::int64_t count = (z_end - z_begin) * dims().slice();
  if (original_.size() < count) original_ = Buffer<float>(count);
  DUBSAR_TRY(smooth_->read(z_begin, z_end, out));
  DUBSAR_TRY(source_->read(z_begin, z_end, original_.span().first(static_cast<std::size_t>(count))));
  const float* const original = original_.data();
  float* const result = out.data();
  parallel_chunks(count, 1 << 18, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) result[i] = original[i] + amount_ * (original[i] - result[i]);
  });
  return {};
}

}  // namespace dubsar
