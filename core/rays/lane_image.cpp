#include "core/rays/lane_image.h"

#include <algorithm>

#include "core/base/system/parallel.h"

namespace dubsar {

using kernels::kLanes;

LaneImage::LaneImage(std::int64_t width, std::int64_t height)
    : width_(width), height_(height), groups_((width + 2) * (height + 2) * kLanes) {
  clear();
}

void LaneImage::clear() {
  parallel_chunks(groups_.size(), 1 << 20, [&](std::int64_t begin, std::int64_t end) {
    std::fill(groups_.data() + begin, groups_.data() + end, 0.0F);
  });
}

}  // namespace dubsar
