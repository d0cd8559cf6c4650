#pragma once
// A pillow of clay: a rounded slab with convex sides, gentle undulation, finger marks, ruled lines and rolled bands.

#include <array>
#include <cstdint>
#include <vector>

#include "core/phantom/dual.h"
#include "core/phantom/random.h"
#include "core/phantom/seal.h"
#include "core/phantom/side.h"

namespace dubsar::phantom {

/// A sum of plane waves: slow variation over space. About 2 ns a wave.
class Waves {
 public:
  Waves() = default;
  /// `count` waves with lengths between `shortest` and `longest` in random directions; the sum has the standard
  /// deviation `deviation`.
  Waves(Random& random, int count, float shortest, float longest, float deviation);
  Dual evaluate(const Point& point) const;
  float largest() const noexcept { return amplitude_ * static_cast<float>(waves_.size()); }

 private:
  struct Wave {
    Float4 turns_per_voxel;
    float phase;
  };
  std::vector<Wave> waves_;
  float amplitude_ = 0.0f;
};

/// A band where a seal was rolled, on one side, along the reading direction.
struct SealBand {
  float bottom = 0.0f;  ///< lower border, voxels along `up`
  float phase_mm = 0.0f;
  float lost_above = 1e30f;  ///< where SealLoss::where exceeds it nothing is left of the impression
};

/// What became of sealings later: in patches they are worn down to their ground, or clay broke away from below them.
struct SealLoss {
  Waves where, kind, floor;  ///< of deviation 1; kind > 0: broken
  float depth = 0.0f;        ///< of what broke away, voxels below the ground; its floor is rough by a seventh of that
};

/// Horizontal ruled lines on one side at first + k * pitch, k = 0 .. count - 1, voxels along `up`.
struct Ruling {
  float first = 0.0f, pitch = 1.0f;
  int count = 0;
  float half_length = 0.0f;
};

/// All lengths in voxels. Fields are negative inside.
struct ClayBody {
  std::array<float, 3> half{};        ///< half extents at the middle of the sides
  std::array<float, kSides> bulge{};  ///< rise of each side's middle over its rim
  float edge_radius = 0.0f;
  Waves undulation;
  struct FingerMark {
    Float4 centre;
    float radius2, depth;
  };
  std::vector<FingerMark> finger_marks;
  std::array<std::vector<Ruling>, kSides> rulings;
  float ruling_depth = 0.0f, ruling_half_width = 1.0f;
  std::array<std::vector<SealBand>, kSides> bands;
  const SealRelief* seal = nullptr;
  float voxels_per_mm = 1.0f;
  float band_depth = 0.0f;
  SealLoss loss;

  /// The slab before anybody wrote on it: metric to first order after division by its gradient.
  Dual smooth(const Point& point) const { return evaluate(point, nullptr, 0.0f); }
  /// The slab, and in `decor` what ruling (+) and sealing (-) take from it: the surface is smooth + decor = 0. `decor`
  /// is left as it is farther than `range` from the slab's surface.
  Dual evaluate(const Point& point, Dual* decor, float range) const;

  /// The point of the smooth surface that is seen along the normal of `side` at (right, up).
  Float4 surface_point(Side side, float right, float up) const;
  /// Of what was ruled or sealed on `side`, the share that the edges' rounding leaves at a point near the surface.
  float decor_share(Side side, const Point& point) const;

 private:
  struct Faces {
    std::array<Dual, 3> distance;  ///< to the sphere cap of each axis
    std::array<Side, 3> side;
  };
  Dual pillow(const Point& point, Faces& faces) const;
  /// The axis whose side owns the point, and how much of it: ruling and sealing fade out where the edges round off, so
  /// that no two sides mix.
  Dual owned(const Dual& slab, const Faces& faces, std::size_t& axis) const;
  Dual decorate(const Point& point, const Dual& body, const Faces& faces) const;
};

}  // namespace dubsar::phantom
