#pragma once
// Crossings of the active edges such that the vertices between them lie on a given surface.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/exa/offsets/offset_choice.h"
#include "core/parts/surface_model.h"

namespace dubsar {

class OffsetFit : public OffsetPrices {
 public:
  /// `model`: the samples and the wanted surface, with its vertex normals; `base`: where the samples alone put the
  /// vertices. `bound`: the largest distance of a vertex from the surface. All must outlive it.
  OffsetFit(const SurfaceModel& model, std::span<const glm::vec3> base, std::span<const glm::vec3> normals,
            double bound);

  /// Moves the crossings until the vertices lie on the surface, as far as the edges reach.
  void improve();
  /// Rounds the crossings to samples.offsets. Those that cost fewer bits are preferred, while vertices stay in bounds.
  Result<void> store(SurfaceSamples& samples, Progress& progress);

  std::pair<int, int> range(std::uint32_t number) const override;
  void prices(std::uint32_t number, int first, int last, double* to) const override;
  void take(std::uint32_t number, int offset) override;

 private:
  template <class Visit>
  void each_corner(std::uint32_t e, const Visit& visit) const;
  glm::vec3 place(std::uint32_t v) const;
  void find_residuals();
  float crossing(int offset) const { return (static_cast<float>(offset) + 0.5f) / static_cast<float>(steps_); }
  int nearest(float t) const;

  const QuadMesh& mesh_;
  std::span<const glm::vec3> base_, normals_;
  double bound_;
  std::vector<std::uint8_t> axis_;         ///< of the edges with an x-quad, in the order of those
  std::vector<std::uint32_t> offset_;      ///< their places in samples.offsets
  std::vector<std::uint32_t> edge_of_;     ///< by place in samples.offsets; kNoEdge: without an x-quad
  std::vector<float> before_, t_, moved_;  ///< crossings of the edges before and now, and how far they moved
  std::vector<float> residual_;            ///< of vertices, along the normal
  int steps_ = 1;
};

}  // namespace dubsar
