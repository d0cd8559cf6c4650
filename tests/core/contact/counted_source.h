#pragma once
// A source that counts what is read of another.

#include <cstdint>
#include <span>

#include "core/volume/slab_source.h"

namespace dubsar {

/// Borrows the source.
class CountedSource final : public SlabSource {
 public:
  explicit CountedSource(SlabSource& source) : source_(source) {}
  Dims dims() const noexcept override { return source_.dims(); }
  const GridFrame& frame() const noexcept override { return source_.frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override {
    slices += z_end - z_begin;
    return source_.read(z_begin, z_end, out);
  }
  std::int64_t slices = 0;

 private:
  SlabSource& source_;
};

}  // namespace dubsar
