#pragma once
// Which of the samples of the patches is nearest to a grid point of the clay around them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/contact/band.h"

namespace dubsar {

/// The nearest sample of points: found by fronts of rising distance for every other point along each axis, between
/// those by looking at what they know, and then among the samples around that one: fronts leave out most of those that
/// are closer together than the points from which they run. Borrows the samples.
class NearestSamples {
 public:
  /// `reach`: grid steps. kCancelled.
  static Result<NearestSamples> find(const std::vector<PatchPoint>& samples, const Dims& dims, float reach,
                                     Progress& progress);

  /// Bricks of the whole grid that may have points of the band, in order.
  std::vector<glm::ivec3> bricks() const;

  /// visit(node) for the points of a brick that are inside and in reach of their nearest sample.
  template <class Visit>
  void each_point(const glm::ivec3& brick, const BitVolume& inside, const Visit& visit) const {
    const glm::ivec3 from = glm::max(brick * static_cast<int>(kEdge), 1),
                     to = glm::min((brick + 1) * static_cast<int>(kEdge), glm::ivec3(dims_.x, dims_.y, dims_.z) - 1);
    for (std::int32_t z = from.z; z < to.z; ++z)
      for (std::int32_t y = from.y; y < to.y; ++y) {
        std::uint32_t beside = ContactBand::kNone;  // that of the point before
        for (std::int32_t x = from.x; x < to.x; ++x) {
          if (!inside.get(x, y, z)) continue;
          const std::uint32_t s = nearest_of({x, y, z}, beside);
          if (s == ContactBand::kNone) continue;
          beside = s;
          const glm::vec3 off = glm::vec3(x, y, z) - samples_[s].position;
          const float distance = glm::length(off);
          if (distance > reach_) continue;
          visit({x, y, z, s, glm::dot(off, samples_[s].normal), distance});
        }
      }
  }

 private:
  static constexpr std::int64_t kEdge = BrickMap<std::uint32_t>::kEdge;
  static constexpr std::uint32_t kNone = ContactBand::kNone;
  struct Place {
    glm::vec3 position;
    std::uint32_t sample;
  };
  struct Cell {
    glm::ivec3 point;
    std::uint32_t first_place, places;
    std::uint32_t first_beside, beside;
  };

  NearestSamples(const std::vector<PatchPoint>& samples, const Dims& dims, float reach);
  void fill_cells();
  void find_cells_beside(const BrickMap<std::uint32_t>& cell_at);

  glm::ivec3 point_of(std::uint32_t s) const { return glm::ivec3(glm::round(samples_[s].position)); }
  bool in_grid(const glm::ivec3& p) const {
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < dims_.x && p.y < dims_.y && p.z < dims_.z;
  }
  bool run_fronts(Progress& progress);
  std::uint32_t nearest_of(const glm::ivec3& p, std::uint32_t guess) const;
  void look_around(const glm::ivec3& p, std::uint32_t& nearest, float& least) const;

  const std::vector<PatchPoint>& samples_;
  Dims dims_;
  float reach_;
  BrickMap<std::uint32_t> known_;  ///< of every other point along each axis
  /// A cell is a grid point with the samples nearest to it, those at one place once. Samples beyond the grid have none.
  std::vector<std::uint32_t> cell_of_;  ///< of each sample
  std::vector<Cell> cells_;
  std::vector<Place> places_;          ///< cell by cell, the last sample first
  std::vector<std::uint32_t> beside_;  ///< cells that touch each cell, itself first, cell by cell
};

}  // namespace dubsar
