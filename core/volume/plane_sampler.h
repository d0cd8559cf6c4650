#pragma once
// Pictures of planes through a volume that stays in its file: only the bricks that a plane crosses are read, from
// coarse to exact, and only so many of them are kept.

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <list>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/base/result.h"
#include "core/volume/voxel_reader.h"

namespace dubsar {

/// Where the pixels of a picture lie among the voxels; voxel centres have whole coordinates.
struct PlaneGrid {
  glm::dvec3 first_vox{0.0};         ///< centre of the upper left pixel
  glm::dvec3 across_vox{1.0, 0, 0};  ///< to the next pixel of the row
  glm::dvec3 down_vox{0, 1.0, 0};    ///< to the next row
  int width = 0, height = 0;
  friend bool operator==(const PlaneGrid&, const PlaneGrid&) = default;
};

/// Row after row. NaN: outside the volume, or NaN in the scan; while it is read what was not read yet, too.
struct PlaneImage {
  int width = 0, height = 0;
  std::vector<float> values;
  double known = 0.0;  ///< share of the pixels inside the volume whose voxels were read
  bool exact() const noexcept { return known == 1.0; }
};

/// What is known of a picture while it is read.
class PlanePicture {
 public:
  /// `dims` of the volume.
  PlanePicture(const PlaneGrid& grid, const Dims& dims);
  double known() const noexcept;
  /// `whole`: what is not known has the value of the nearest pixel that is; else it is NaN.
  PlaneImage image(bool whole = false) const;

 private:
  friend class PlaneSampler;
  /// The voxel before a pixel, and how far it is behind that.
  struct Cell {
    std::array<std::int32_t, 3> before{};
    std::array<float, 3> behind{};
    bool inside = false;
  };
  PlaneGrid grid_;
  std::vector<Cell> cells_;
  std::vector<double> sums_, weights_;
  std::size_t inside_ = 0, done_ = 0;
};

struct PlaneSamplerOptions {
  std::uint64_t cache_bytes = std::uint64_t{256} << 20;  ///< of floats that are kept
  /// Most that is read for one picture; 0: a quarter of the volume, but 256 MiB at least. Where a plane crosses more,
  /// as in files that are stored in whole slices, the picture stays coarse: pixels have the nearest known value.
  std::uint64_t picture_bytes = 0;
};

/// One thread.
class PlaneSampler {
 public:
  /// kUnavailable for readers that go through the file from front to back only.
  static Result<std::unique_ptr<PlaneSampler>> create(std::unique_ptr<VoxelReader> reader,
                                                      const PlaneSamplerOptions& options = {});

  Dims dims() const noexcept { return reader_->dims(); }
  /// Voxels of a brick: what is read at once.
  Dims brick() const noexcept { return brick_; }
  /// Trilinear values at the pixels; those up to half a voxel outside have the value of the border. `look` sees the
  /// picture after each brick and may give it up by returning false; then the rest is NaN. Errors of the reader.
  Result<PlaneImage> sample(const PlaneGrid& grid, const std::function<bool(const PlanePicture&)>& look = {});
  /// Of voxels as stored, asked from the reader so far.
  std::uint64_t read_bytes() const noexcept { return read_bytes_; }
  std::uint64_t kept_bytes() const noexcept { return kept_bytes_; }

 private:
  struct Kept {
    std::vector<float> values;
    std::list<std::int64_t>::iterator age;
  };
  PlaneSampler(std::unique_ptr<VoxelReader> reader, const PlaneSamplerOptions& options);
  std::vector<std::pair<std::int64_t, std::uint32_t>> crossed(const PlanePicture& picture) const;
  VoxelBox box_of(std::int64_t brick) const noexcept;
  Result<const std::vector<float>*> values_of(std::int64_t brick);
  void add(PlanePicture& picture, std::uint32_t pixel, const VoxelBox& box, const std::vector<float>& values) const;

  std::unique_ptr<VoxelReader> reader_;
  PlaneSamplerOptions options_;
  Dims brick_, bricks_;
  std::unordered_map<std::int64_t, Kept> kept_;
  std::list<std::int64_t> ages_;  // the newest in front
  std::uint64_t kept_bytes_ = 0, read_bytes_ = 0;
  std::vector<std::byte> stored_;
};

}  // namespace dubsar
