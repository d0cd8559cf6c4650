#pragma once
// Triangles that rays can be shot at: the only user of Embree.

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/tri_mesh.h"

namespace dubsar {

/// 16 rays at a time; fastest when they have neighbouring origins and similar directions.
struct RayPacket {
  static constexpr int kRays = 16;
  alignas(64) std::array<float, kRays> origin_x{}, origin_y{}, origin_z{};
  alignas(64) std::array<float, kRays> direction_x{}, direction_y{}, direction_z{};  ///< unit
  alignas(64) std::array<float, kRays> distance{};  ///< in: the longest; out: of the nearest hit, if any
  std::array<bool, kRays> active{};
  std::array<bool, kRays> hit{};          ///< out
  std::array<bool, kRays> from_behind{};  ///< out: the hit triangle was met from its back
};

/// Holds the vertices once; scenes made from it share them. Not movable while scenes exist.
class RayDevice {
 public:
  /// `threads` build the trees. kUnavailable when Embree does not start, kTryAgain without memory.
  static Result<std::unique_ptr<RayDevice>> create(std::span<const glm::vec3> positions, int threads);
  ~RayDevice();
  RayDevice(const RayDevice&) = delete;
  RayDevice& operator=(const RayDevice&) = delete;

  struct Impl;
  Impl& impl() noexcept { return *impl_; }

 private:
  explicit RayDevice(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

class RayScene {
 public:
  /// Builds the tree; looks at progress.cancelled(). The device must outlive the scene.
  static Result<std::unique_ptr<RayScene>> build(RayDevice& device, std::span<const Triangle> triangles,
                                                 Progress& progress);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Nearest hits, watertight at shared edges. Any thread.
  void intersect(RayPacket& packet) const noexcept;

 private:
  struct Impl;
  explicit RayScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace dubsar
