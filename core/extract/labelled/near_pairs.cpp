#include "core/extract/labelled/near_pairs.h"

#include <algorithm>
#include <glm/common.hpp>

#include "core/base/system/parallel_gather.h"

namespace dubsar {
namespace {

constexpr std::int64_t kPairsBrick = 4 * kExactSteps;
constexpr std::int64_t kPairsGrain = 1 << 14;

struct PlaceBox {
  ExactPlace low, high;
  PlaceBox(std::span<const ExactPlace> places, const Triangle& t)
      : low(glm::min(places[t[0]], glm::min(places[t[1]], places[t[2]]))),
        high(glm::max(places[t[0]], glm::max(places[t[1]], places[t[2]]))) {}
};

/// Bricks of the space of all places, one byte each.
class PlaceBricks {
 public:
  explicit PlaceBricks(std::span<const ExactPlace> places) {
    ExactPlace high = low_ = places[0];
    for (const ExactPlace& p : places) {
      low_ = glm::min(low_, p);
      high = glm::max(high, p);
    }
    size_ = (high - low_) / kPairsBrick + std::int64_t{1};
    met_.resize(static_cast<std::size_t>(size_.x * size_.y * size_.z));
  }
  void mark(const PlaceBox& box) {
    each(box, [&](std::size_t i) { met_[i] = 1; });
  }
  bool meets(const PlaceBox& box) const {
    bool found = false;
    each(box, [&](std::size_t i) { found = found || met_[i] != 0; });
    return found;
  }

 private:
  template <class Visit>
  void each(const PlaceBox& box, const Visit& visit) const {
    const ExactPlace from = (box.low - low_) / kPairsBrick, to = (box.high - low_) / kPairsBrick;
    for (std::int64_t z = from.z; z <= to.z; ++z)
      for (std::int64_t y = from.y; y <= to.y; ++y)
        for (std::int64_t x = from.x; x <= to.x; ++x) visit(static_cast<std::size_t>((z * size_.y + y) * size_.x + x));
  }

  ExactPlace low_{0}, size_{0};
  std::vector<std::uint8_t> met_;
};

}  // namespace

TrianglePairs touching_pairs_near(std::span<const ExactPlace> places, std::span<const Triangle> triangles,
                                  std::span<const std::uint8_t> wanted) {
  if (triangles.empty()) return {};
  PlaceBricks bricks(places);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (wanted[t] != 0) bricks.mark(PlaceBox(places, triangles[t]));
  using Ids = std::vector<std::uint32_t>;
  const Ids near = parallel_gather<std::uint32_t>(
      static_cast<std::int64_t>(triangles.size()), kPairsGrain, [&](std::int64_t begin, std::int64_t end, Ids& found) {
        for (auto t = static_cast<std::uint32_t>(begin); t < static_cast<std::uint64_t>(end); ++t)
          if (bricks.meets(PlaceBox(places, triangles[t]))) found.push_back(t);
      });
  std::vector<Triangle> some;
  std::vector<std::uint8_t> some_wanted;
  for (const std::uint32_t t : near) {
    some.push_back(triangles[t]);
    some_wanted.push_back(wanted[t]);
  }
  TrianglePairs pairs = touching_pairs(places, some, some_wanted);
  for (auto& pair : pairs) pair = {near[pair[0]], near[pair[1]]};  // rising still
  return pairs;
}

}  // namespace dubsar
