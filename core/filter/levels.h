#pragma once
// Levels of air and clay beside the surface, where they are not the same everywhere: scatter and beam hardening raise
// one and lower the other, so that no single threshold lies half way.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/base/text/enum_names.h"
#include "core/volume/slab_source.h"

namespace dubsar {

/// How much higher the value half way between air and clay is than that of the whole scan: a smooth field.
class LevelShift {
 public:
  static constexpr std::int64_t kCell = 8;  ///< grid steps between its samples

  LevelShift() = default;
  explicit LevelShift(const Dims& dims);

  bool empty() const noexcept { return shift_.empty(); }
  const Dims& cells() const noexcept { return cells_; }
  float& at(std::int64_t cx, std::int64_t cy, std::int64_t cz) noexcept {
    return shift_[static_cast<std::size_t>((cz * cells_.y + cy) * cells_.x + cx)];
  }
  float at(std::int64_t cx, std::int64_t cy, std::int64_t cz) const noexcept {
    return shift_[static_cast<std::size_t>((cz * cells_.y + cy) * cells_.x + cx)];
  }
  /// Takes the field off a row of values; trilinear between the middles of cells, constant beyond the last.
  void subtract(std::int64_t y, std::int64_t z, std::span<float> row) const;

 private:
  Dims cells_;
  std::vector<float> shift_;
};

enum class Levels {
  kLocal,   ///< the surface is half way between air and clay beside it
  kGlobal,  ///< at one threshold everywhere, as the paper has it
};

inline constexpr EnumName<Levels> kLevels[] = {{Levels::kLocal, "local"}, {Levels::kGlobal, "global"}};
static_assert(names_all(kLevels, static_cast<std::size_t>(Levels::kGlobal) + 1));

struct LevelOptions {
  float threshold = 0.0f;         ///< of the whole scan
  float air = 0.0f, clay = 0.0f;  ///< of the whole scan: their difference is what shifts are judged by
  std::vector<float> constants;   ///< values that stand for nothing (core/refine) and do not count
};

struct LocalLevels {
  LevelShift shift;  ///< empty where one threshold does for all of the surface
  double least = 0.0,
         most = 0.0;  ///< of the shift along the surface, in parts of clay less air, a tenth on either side left out
};

/// For people, without a full stop.
std::string describe(const LocalLevels& levels);

/// Profiles across the surface along the axes of the grid: clay from 1 to 4 voxels behind it, air from 1 to 4 before
/// it; gaps of fewer than three voxels do not count, nor does what is thinner than four voxels. Their means in cells,
/// averaged by a Gauss of 12 voxels; half way between them is the level, and the surface is looked for at it again,
/// three times (local adaptive surface determination, but with averages of some hundred profiles instead of single
/// ones). Where a tenth of the surface does not differ by 4 % of the contrast the scan is left as it is. Reads the
/// source three times, or once, 20 slices at a time. The same for any number of threads. Errors of the source,
/// kCancelled.
Result<LocalLevels> measure_levels(SlabSource& source, const LevelOptions& options, Progress& progress);

/// A source less a field of its dims. Borrows both.
class LevelledSource final : public SlabSource {
 public:
  LevelledSource(SlabSource& source, const LevelShift& shift) : source_(&source), shift_(&shift) {}
  Dims dims() const noexcept override { return source_->dims(); }
  const GridFrame& frame() const noexcept override { return source_->frame(); }
  Result<void> read(std::int64_t z_begin, std::int64_t z_end, std::span<float> out) override;

 private:
  SlabSource* source_;
  const LevelShift* shift_;
};

}  // namespace dubsar
