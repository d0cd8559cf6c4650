#pragma once
// A scalar volume on a regular grid: x fastest, then y, then z; voxel centres at integer coordinates.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <new>
#include <span>
#include <string>

#include "core/base/result.h"

namespace dubsar {

struct Dims {
  std::int64_t x = 0, y = 0, z = 0;
  std::int64_t count() const noexcept { return x * y * z; }
  std::int64_t slice() const noexcept { return x * y; }
  friend bool operator==(const Dims&, const Dims&) = default;
};

/// Edge lengths of a voxel. `provenance` says where the figure comes from, e.g. "/entry/data/data@element_size_um";
/// it is empty when nobody said: then 1 voxel = 1 mm is used and every report says "voxel size unknown".
struct VoxelSize {
  glm::dvec3 mm{1.0, 1.0, 1.0};
  std::string provenance;
  bool known() const noexcept { return !provenance.empty(); }
};

/// Uninitialised, 64-byte aligned array. Memory is first touched by whoever writes it (page faults run in parallel).
template <class T>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::int64_t count)
      : data_(count > 0
                  ? static_cast<T*>(::operator new (static_cast<std::size_t>(count) * sizeof(T), std::align_val_t{64}))
                  : nullptr),
        count_(count) {
    static_assert(std::is_trivially_copyable_v<T>);
  }
  T* data() noexcept { return data_.get(); }
  const T* data() const noexcept { return data_.get(); }
  std::int64_t size() const noexcept { return count_; }
  T& operator[](std::int64_t i) noexcept { return data_.get()[i]; }
  const T& operator[](std::int64_t i) const noexcept { return data_.get()[i]; }
  std::span<T> span() noexcept { return {data(), static_cast<std::size_t>(count_)}; }
  std::span<const T> span() const noexcept { return {data(), static_cast<std::size_t>(count_)}; }

 private:
  struct Free {
    void operator()(T* p) const noexcept { ::operator delete (p, std::align_val_t{64}); }
  };
  std::unique_ptr<T, Free> data_;
  std::int64_t count_ = 0;
};

template <class T>
struct Volume {
  Dims dims;
  Buffer<T> voxels;

  Volume() = default;
  explicit Volume(Dims d) : dims(d), voxels(d.count()) {}
  T* row(std::int64_t y, std::int64_t z) noexcept { return voxels.data() + (z * dims.y + y) * dims.x; }
  const T* row(std::int64_t y, std::int64_t z) const noexcept { return voxels.data() + (z * dims.y + y) * dims.x; }
  T& at(std::int64_t x, std::int64_t y, std::int64_t z) noexcept { return row(y, z)[x]; }
  const T& at(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept { return row(y, z)[x]; }
};

/// How the processed grid sits in the input file's grid, and in millimetres:
/// input_vox = origin_vox + scale * grid, mm = voxel_mm * input_vox (per axis).
struct GridFrame {
  glm::dvec3 scale{1.0, 1.0, 1.0};
  glm::dvec3 origin_vox{0.0, 0.0, 0.0};
  VoxelSize input_voxel;

  glm::dvec3 input_vox_from_grid(const glm::dvec3& p) const { return origin_vox + scale * p; }
  glm::dvec3 mm_from_grid(const glm::dvec3& p) const { return input_voxel.mm * input_vox_from_grid(p); }
  /// Edge lengths of a processed voxel in mm.
  glm::dvec3 grid_voxel_mm() const { return input_voxel.mm * scale; }
};

}  // namespace dubsar
