#include "core/contact/cut/lattice_bricks.h"

#include <utility>

#include "core/base/system/parallel.h"

namespace dubsar {

LatticeBricks::LatticeBricks(const Dims& dims, std::vector<glm::ivec3> places)
    : places_(std::move(places)),
      brick_({(dims.x + kEdge - 1) / kEdge, (dims.y + kEdge - 1) / kEdge, (dims.z + kEdge - 1) / kEdge}, 0) {
  constexpr std::int64_t kGrain = 1 << 12;
  places_.insert(places_.begin(), glm::ivec3(-1));
  beside_.resize(places_.size());
  for (std::uint32_t b = 1; b < count(); ++b) brick_.at(places_[b].x, places_[b].y, places_[b].z) = b;
  beside_[0] = {};
  parallel_for(static_cast<std::int64_t>(count()) - 1, kGrain, [&](std::int64_t i) {
    const auto b = static_cast<std::uint32_t>(i + 1);
    for (std::uint32_t way = 0; way < kWays; ++way) {
      glm::ivec3 p = places_[b];
      p[static_cast<glm::length_t>(way / 2)] += way % 2 == 0 ? 1 : -1;
      beside_[b][way] = brick_.get(p.x, p.y, p.z);
    }
    beside_[b][kWays] = b;
  });
}

}  // namespace dubsar
