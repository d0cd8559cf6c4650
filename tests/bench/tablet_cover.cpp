#include "tests/bench/tablet_cover.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/base/system/parallel.h"
#include "core/mesh/evidence.h"

namespace dubsar {
namespace {

constexpr double kSlit = 1.5, kNear = 1.0, kOff = 3.0;

/// Points by the voxel that they are in.
class Places {
 public:
  Places(const Dims& dims, std::span<const glm::vec3> points)
      : dims_(dims), first_(static_cast<std::size_t>(dims.count() + 1)) {
    for (const glm::vec3& p : points) ++first_[cell(p) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    points_.resize(points.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const glm::vec3& p : points) points_[next[cell(p)]++] = p;
  }
  bool within(const glm::dvec3& p, double distance) const {
    const auto reach = static_cast<std::int64_t>(std::ceil(distance));
    const glm::dvec3 c(std::round(p.x), std::round(p.y), std::round(p.z));
    for (std::int64_t z = -reach; z <= reach; ++z)
      for (std::int64_t y = -reach; y <= reach; ++y)
        for (std::int64_t x = -reach; x <= reach; ++x) {
          const std::size_t at = cell(glm::vec3(c + glm::dvec3(x, y, z)));
          for (std::uint32_t i = first_[at]; i < first_[at + 1]; ++i)
            if (glm::length(glm::dvec3(points_[i]) - p) <= distance) return true;
        }
    return false;
  }

 private:
  std::size_t cell(const glm::vec3& p) const {
    const auto along = [](float v, std::int64_t n) {
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::lround(v)), 0, n - 1);
    };
    return static_cast<std::size_t>((along(p.z, dims_.z) * dims_.y + along(p.y, dims_.y)) * dims_.x +
                                    along(p.x, dims_.x));
  }
  Dims dims_;
  std::vector<std::uint32_t> first_;
  std::vector<glm::vec3> points_;
};

struct Counts {
  double all = 0.0;
  TabletCover cover;
};

}  // namespace

TabletCover cover_tablet(const phantom::Phantom& truth, const TriMesh& tablet, std::span<const glm::vec3> of_tablet,
                         std::span<const glm::vec3> of_envelope) {
  const Dims d = truth.options().dims;
  std::vector<glm::vec3> seen, patch;
  for (std::size_t v = 0; v < of_tablet.size(); ++v)
    (tablet.evidence.empty() || tablet.evidence[v] <= evidence_byte(Evidence::kPocket) ? seen : patch)
        .push_back(of_tablet[v]);
  const Places measured(d, seen), contact(d, patch), envelope(d, of_envelope);
  Counts counts = parallel_reduce<Counts>(
      d.y * d.z, 8, {},
      [&](std::int64_t begin, std::int64_t end) {
        Counts part;
        for (std::int64_t row = begin; row < end; ++row)
          for (std::int64_t x = 0; x < d.x; ++x) {
            const glm::dvec3 voxel(static_cast<double>(x), static_cast<double>(row % d.y),
                                   static_cast<double>(row / d.y));
            const auto fields = [&](const glm::dvec3& at) {
              return truth.fields(static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z), 2.0f)
                  .tablet;
            };
            const phantom::Dual f = fields(voxel);
            const double slope = std::sqrt(static_cast<double>(phantom::dot(f.g, f.g)));
            if (std::abs(static_cast<double>(f.v)) > 0.5 * std::max(slope, 0.2)) continue;
            if (truth.gap_width(voxel) < kSlit) continue;
            // The foot of the voxel on the surface, by the field's differences along the grid.
            const auto difference = [&](const glm::dvec3& way) {
              return static_cast<double>(fields(voxel + way).v) - static_cast<double>(fields(voxel - way).v);
            };
            const glm::dvec3 g{difference({0.5, 0, 0}), difference({0, 0.5, 0}), difference({0, 0, 0.5})};
            const glm::dvec3 p = voxel - g * (static_cast<double>(f.v) / std::max(glm::dot(g, g), 0.04));
            part.all += 1.0;
            if (measured.within(p, kNear))
              part.cover.measured += 1.0;
            else if (contact.within(p, kNear))
              part.cover.patch += 1.0;
            else if (envelope.within(p, kNear))
              part.cover.envelope += 1.0;
            else if (measured.within(p, kOff) || contact.within(p, kOff) || envelope.within(p, kOff))
              part.cover.off += 1.0;
            else
              part.cover.nothing += 1.0;
          }
        return part;
      },
      [](Counts a, const Counts& b) {
        a.all += b.all;
        a.cover.measured += b.cover.measured;
        a.cover.patch += b.cover.patch;
        a.cover.envelope += b.cover.envelope;
        a.cover.off += b.cover.off;
        a.cover.nothing += b.cover.nothing;
        return a;
      });
  for (double* share :
       {&counts.cover.measured, &counts.cover.patch, &counts.cover.envelope, &counts.cover.off, &counts.cover.nothing})
    *share /= std::max(1.0, counts.all);
  return counts.cover;
}

}  // namespace dubsar
