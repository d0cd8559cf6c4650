#pragma once
// Which of the samples of the patches is nearest to a grid point of the clay around them.

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/contact/band.h"

namespace dubsar {

/// The nearest sample of points. Fronts of rising distance find one, nearly the nearest, for every other point along
/// each axis: they leave out most of those that are closer together than that. Those of all points of a brick, and the
/// samples beside them, are then the ones among which the nearest of each point is. Borrows the samples.
class NearestSamples {
 public:
  /// `reach`: grid steps. kCancelled.
  static Result<NearestSamples> find(const std::vector<PatchPoint>& samples, const Dims& dims, float reach,
                                     Progress& progress);

  /// Bricks of the whole grid that may have points of the band, in order.
  std::vector<glm::ivec3> bricks() const;

  /// Appends the points of a brick that are inside and in reach of their nearest sample.
  void add_nodes(const glm::ivec3& brick, const BitVolume& inside, std::vector<ContactBand::Node>& nodes) const;

 private:
  static constexpr std::int64_t kEdge = BrickMap<std::uint32_t>::kEdge;
  static constexpr std::uint32_t kNone = ContactBand::kNone;
  /// Samples of which one is the nearest of each point of a brick.
  struct Nearby {
    std::vector<float> x, y, z;
    std::vector<std::uint32_t> sample;
  };

  NearestSamples(const std::vector<PatchPoint>& samples, const Dims& dims, float reach);
  void fill_cells();
  bool run_fronts(Progress& progress);
  Nearby nearby(const glm::ivec3& corner) const;
  void add(std::uint32_t s, Nearby& near) const;

  glm::ivec3 point_of(std::uint32_t s) const { return glm::ivec3(glm::round(samples_[s].position)); }
  bool in_grid(const glm::ivec3& p) const {
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < dims_.x && p.y < dims_.y && p.z < dims_.z;
  }

  const std::vector<PatchPoint>& samples_;
  Dims dims_;
  float reach_;
  BrickMap<std::uint32_t> known_;  ///< of every other point along each axis
  /// A cell is a grid point with the samples nearest to it, those at one place once. Samples beyond the grid have none.
  BrickMap<std::uint32_t> cell_at_;
  std::vector<std::uint32_t> first_;   ///< of each cell and behind the last, in `listed_`
  std::vector<std::uint32_t> listed_;  ///< samples, cell by cell
};

}  // namespace dubsar
