#pragma once
// The clay around the patches between tablet and envelope: all grid points inside the object within some steps of a
// patch, each with its height over it.

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/contact/brick_map.h"
#include "core/parts/surface_model.h"

namespace dubsar {

inline glm::ivec3 unit_step(int axis) { return {axis == 0, axis == 1, axis == 2}; }

/// The six points one step from `p`.
template <class Visit>
void each_beside(const glm::ivec3& p, const Visit& visit) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int sense : {-1, 1}) visit(p + sense * unit_step(axis));
}

/// Which side of the contact a point of clay is on.
enum class ClaySide : std::uint8_t { kTablet, kEnvelope };

/// A place on a patch: the smooth guess at where the two clays touch.
struct PatchPoint {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0.0f};  ///< unit, out of the tablet
  bool at_rim = false;     ///< nearer to where it begins at the surface than to its next vertex
};

/// Is its `partition` the tablet's and its reverse the envelope's, or the other way round?
bool is_contact_patch(const SurfaceModel& model, const FillPatch& patch);

/// Points of such patches, at most `spacing` grid steps apart in a triangle, thinned() to it.
std::vector<PatchPoint> sample_patches(const SurfaceModel& model, float spacing);

/// Of those in each cube of that side the one nearest to its middle; cubes are counted from the middle of all.
std::vector<PatchPoint> thinned(const std::vector<PatchPoint>& samples, float side);

/// Middle of the box around all samples. Statistics over pieces of the contact count the pieces from here: they are the
/// same wherever the object lies on the grid, and mirrored where it is.
glm::vec3 middle_of(const std::vector<PatchPoint>& samples);

/// Cubes around the middle of all samples, each of them in one.
struct SampleCubes {
  float side;  ///< grid steps
  glm::vec3 middle{0.0f};
  glm::ivec3 middle_cube{0};

  SampleCubes(const std::vector<PatchPoint>& samples, float edge);
  Dims dims() const { return {2 * middle_cube.x + 1, 2 * middle_cube.y + 1, 2 * middle_cube.z + 1}; }
  /// From the middle of all, in cubes.
  glm::vec3 place(const PatchPoint& sample) const { return (sample.position - middle) / side; }
  glm::ivec3 cube(const PatchPoint& sample) const { return middle_cube + glm::ivec3(glm::round(place(sample))); }
};

struct ContactBand {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Node {
    std::int32_t x = 0, y = 0, z = 0;
    std::uint32_t sample = 0;  ///< the nearest
    float height = 0.0f;       ///< over the patch, positive towards the envelope
    float distance = 0.0f;     ///< from the sample
  };
  std::vector<PatchPoint> samples;
  std::vector<Node> nodes;                           ///< brick by brick
  BrickMap<std::uint32_t> node_at;                   ///< kNone: not in the band
  float tablet_reach = 0.0f, envelope_reach = 0.0f;  ///< from the nearest sample, under the patch and over it

  float reach_at(float height) const noexcept { return height < 0.0f ? tablet_reach : envelope_reach; }
  std::uint32_t at(const glm::ivec3& p) const noexcept { return node_at.get(p.x, p.y, p.z); }
  glm::ivec3 point(std::uint32_t node) const noexcept { return {nodes[node].x, nodes[node].y, nodes[node].z}; }
  const glm::vec3& normal(std::uint32_t node) const noexcept { return samples[nodes[node].sample].normal; }

  /// About 0.3 us a point of the band; points one step from the border of the grid are left out. kCancelled.
  static Result<ContactBand> make(const BitVolume& inside, std::vector<PatchPoint> samples, float reach,
                                  Progress& progress);
  /// Drops what lies over the patches and farther from them than that.
  void trim_envelope(float reach);
};

}  // namespace dubsar
