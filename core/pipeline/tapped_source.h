#pragma once
// A slab source that passes slabs on and keeps the books: time spent above it, voxels read, progress, cancel.

#include <vector>

#include "core/base/progress.h"
#include "core/volume/slab_source.h"

namespace dubsar {

class TappedSource final : public SlabSource {
 public:
  /// Borrows both. Progress advances by voxels read for the first time, in rising z.
  TappedSource(SlabSource& source, Progress& progress) : source_(&source), progress_(&progress) {}
  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

  double wall_s() const noexcept { return wall_s_; }
  double cpu_s() const noexcept { return cpu_s_; }

 private:
  SlabSource* source_;
  Progress* progress_;
  double wall_s_ = 0.0, cpu_s_ = 0.0;
  std::int64_t slices_seen_ = 0;
};

/// Every `step`-th group of `group` slices of a source, as a shorter volume: for estimates that need no more than a
/// sample of a large scan. Borrows the source.
class SampledSource final : public SlabSource {
 public:
  /// Takes about `slices` slices in groups of `group`, spread evenly; all of them when there are no more. Groups do not
  /// lie across layers of the source's preferred height where that can be avoided: each layer may have to be decoded.
  SampledSource(SlabSource& source, std::int64_t slices, std::int64_t group);
  Dims dims() const noexcept override { return dims_; }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  SlabSource* source_;
  Dims dims_;
  std::int64_t group_;
  std::vector<std::int64_t> starts_;  ///< of each group
};

}  // namespace dubsar
