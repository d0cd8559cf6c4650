#include "core/contact/kernels/nearest_places.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/kernels/nearest_places.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace dubsar {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Of four rows of a brick at a time: what lies along x is the same for them.
void nearest_places(const PlacesByAxis& places, const glm::vec3& corner,
                    std::array<std::int32_t, kNearestEdge * kNearestEdge * kNearestEdge>& nearest) {
  const hn::CappedTag<float, kNearestEdge> floats;
  const hn::Rebind<std::int32_t, decltype(floats)> ints;
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(floats));
  const auto count = static_cast<std::int32_t>(places.x.size());
  using Floats = hn::Vec<decltype(floats)>;
  using Ints = hn::Vec<decltype(ints)>;
  for (std::int32_t z = 0; z < kNearestEdge; ++z)
    for (std::int32_t y = 0; y < kNearestEdge; y += 4)
      for (std::int32_t x = 0; x < kNearestEdge; x += lanes) {
        const auto along = [&](float from, std::int32_t step) { return from + static_cast<float>(step); };
        const Floats px = hn::Iota(floats, along(corner.x, x)), pz = hn::Set(floats, along(corner.z, z)),
                     y0 = hn::Set(floats, along(corner.y, y)), y1 = hn::Set(floats, along(corner.y, y + 1)),
                     y2 = hn::Set(floats, along(corner.y, y + 2)), y3 = hn::Set(floats, along(corner.y, y + 3));
        Floats least0 = hn::Set(floats, 1e30f), least1 = least0, least2 = least0, least3 = least0;
        Ints which0 = hn::Zero(ints), which1 = which0, which2 = which0, which3 = which0;
        for (std::int32_t k = 0; k < count; ++k) {
          const auto i = static_cast<std::size_t>(k);
          const Floats dx = hn::Sub(px, hn::Set(floats, places.x[i])), dz = hn::Sub(pz, hn::Set(floats, places.z[i])),
                       py = hn::Set(floats, places.y[i]), aside = hn::Add(hn::Mul(dx, dx), hn::Mul(dz, dz));
          const Ints own = hn::Set(ints, k);
          const auto offer = [&](Floats row, Floats& least, Ints& which) HWY_ATTR {
            const Floats dy = hn::Sub(row, py), square = hn::Add(aside, hn::Mul(dy, dy));
            which = hn::IfThenElse(hn::RebindMask(ints, hn::Lt(square, least)), own, which);
            least = hn::Min(square, least);
          };
          offer(y0, least0, which0);
          offer(y1, least1, which1);
          offer(y2, least2, which2);
          offer(y3, least3, which3);
        }
        std::int32_t* const to = nearest.data() + (z * kNearestEdge + y) * kNearestEdge + x;
        hn::StoreU(which0, ints, to);
        hn::StoreU(which1, ints, to + kNearestEdge);
        hn::StoreU(which2, ints, to + 2 * kNearestEdge);
        hn::StoreU(which3, ints, to + 3 * kNearestEdge);
      }
}

}  // namespace HWY_NAMESPACE
}  // namespace dubsar
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dubsar {
namespace {
HWY_EXPORT(nearest_places);
}  // namespace

void nearest_places(const PlacesByAxis& places, const glm::vec3& corner,
                    std::array<std::int32_t, kNearestEdge * kNearestEdge * kNearestEdge>& nearest) {
  HWY_DYNAMIC_DISPATCH(nearest_places)(places, corner, nearest);
}

}  // namespace dubsar
#endif
