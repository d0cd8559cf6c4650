#include "core/volume/formats/front_reader.h"

#include <algorithm>
#include <utility>

namespace dubsar {
namespace {

class FrontReader final : public VoxelReader {
 public:
  FrontReader(std::unique_ptr<VoxelReader> whole, const Dims& dims) : whole_(std::move(whole)), dims_(dims) {}

  const NumberFormat& format() const noexcept override { return whole_->format(); }
  Dims dims() const noexcept override { return dims_; }
  Dims chunk() const noexcept override { return whole_->chunk(); }
  AxisRange layer_of(std::int64_t z) const noexcept override {
    AxisRange layer = whole_->layer_of(z);
    layer.end = std::min(layer.end, dims_.z);
    return layer;
  }
  bool sequential() const noexcept override { return whole_->sequential(); }
  Result<void> read(const VoxelBox& box, std::span<std::byte> out) override { return whole_->read(box, out); }

 private:
  std::unique_ptr<VoxelReader> whole_;
  Dims dims_;
};

}  // namespace

std::unique_ptr<VoxelReader> make_front_reader(std::unique_ptr<VoxelReader> whole, const Dims& dims) {
  const Dims all = whole->dims();
  DUBSAR_CHECK(dims.x <= all.x && dims.y <= all.y && dims.z <= all.z);
  if (dims == all) return whole;
  return std::make_unique<FrontReader>(std::move(whole), dims);
}

}  // namespace dubsar
