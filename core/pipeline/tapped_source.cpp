#include "core/pipeline/tapped_source.h"

#include <algorithm>

#include "core/base/system/clock.h"

namespace dubsar {

Result<void> TappedSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  if (progress_->cancelled()) return cancelled_error();
  const TimestampNs start = SteadyClock().now();
  const double start_cpu = process_cpu_seconds();
  DUBSAR_TRY(source_->read(z_begin, z_end, out));
  wall_s_ += 1e-9 * static_cast<double>(SteadyClock().now() - start);
  cpu_s_ += process_cpu_seconds() - start_cpu;
  if (z_end > slices_seen_) {
    progress_->advance((z_end - slices_seen_) * dims().slice());
    slices_seen_ = z_end;
  }
  return {};
}

SampledSource::SampledSource(SlabSource& source, std::int64_t slices, std::int64_t group)
    : source_(&source), dims_(source.dims()), group_(std::max<std::int64_t>(group, 1)) {
  const std::int64_t groups = std::max<std::int64_t>(1, slices / group_);
  if (dims_.z <= groups * group_) {
    group_ = dims_.z;
    starts_ = {0};
    return;
  }
  const std::int64_t spacing = dims_.z / groups, layer = std::max<std::int64_t>(source.preferred_height(), 1);
  for (std::int64_t i = 0; i < groups; ++i) {
    std::int64_t start = i * spacing;
    // A group that reaches into the next layer of chunks begins with it, where the layer is not that of the next group.
    const std::int64_t border = (start + layer - 1) / layer * layer;
    if (border < start + group_ && border + group_ <= std::min((i + 1) * spacing, dims_.z)) start = border;
    starts_.push_back(start);
  }
  dims_.z = groups * group_;
}

Result<void> SampledSource::read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) {
  for (std::int64_t z = z_begin; z < z_end;) {
    const std::int64_t in_group = z % group_;
    const std::int64_t count = std::min(z_end - z, group_ - in_group);
    const std::int64_t from = starts_[static_cast<std::size_t>(z / group_)] + in_group;
    DUBSAR_TRY(source_->read(from, from + count, out.subspan(static_cast<std::size_t>((z - z_begin) * dims_.slice()))));
    z += count;
  }
  return {};
}

}  // namespace dubsar
