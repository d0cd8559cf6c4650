#pragma once
// Was the scan made of straight rays? Projected again and backprojected in powers, it says so itself (method `rays`).

#include <array>
#include <memory>
#include <optional>

#include "core/base/progress.h"
#include "core/rays/lane_planes.h"
#include "core/rays/ray_curve.h"
#include "core/rays/scatter_field.h"

namespace dubsar {

/// What is left of clay and air that should be even, in parts of the contrast.
struct Evenness {
  double clay = 0.0, air = 0.0;                                    ///< standard deviations without noise
  double sum() const noexcept { return clay * clay + air * air; }  ///< of variances
};

/// What a curve that was fitted in some planes does in others, whose noise it has not seen: each half of the planes is
/// made even by the curve of the other half.
struct Elsewhere {
  double left = 1.0;   ///< share of the variance of clay and air that is left there; may be less than 0 by noise
  double gain = 0.0;   ///< variance that is taken away there, in parts of the contrast, squared
  double error = 0.0;  ///< standard error of `gain`, by planes that are left out ([Efron 1982], the jackknife); 0:
                       ///< there are too few planes to tell
  /// Whether anything is taken away but by chance. Three errors: noise of 12 and 14 dB came to 2.0 (52 small scans in
  /// 226 places), the surest curve of scanners from mild to strong to 6.2 and more (26 scans).
  bool sure() const noexcept { return error > 0.0 && gain > 3.0 * error; }
};

/// The curve that makes a scan even if it was turned about `axis`.
struct CurveTrial {
  TurnAxis axis = TurnAxis::kZ;
  RayCurve curve;
  std::shared_ptr<const ScatterField> stray = {};  ///< where the curve has a part by scatter
  Evenness before, after;
  Elsewhere elsewhere;
  /// 1: rays are straight; the largest loss of contrast is its inverse.
  double bend() const noexcept { return 1.0 / curve.contrast(); }
  /// Share of the variance of clay and air that is left.
  double left() const noexcept { return after.sum() / before.sum(); }
  /// Bent by more than a tenth, clay and air together become more even by a fifth of their variance, also in planes
  /// that the curve was not fitted in and there by more than its error, and air alone does not become less even.
  bool significant() const noexcept;
};

struct CurveSearch {
  GreyLevels levels;                ///< of the volume
  std::optional<CurveTrial> found;  ///< the best that is significant; its lengths in voxels of the volume
  std::vector<CurveTrial> trials;   ///< of each axis that was tried
  bool cut_by_border = false;       ///< clay lies at the border beside the axis: rays miss some of it
  std::int64_t crossings = 0;       ///< of voxels and rays, that the search took: what its time goes by
};

/// Tries the three axes, or the one that is wanted `only`, on some planes each. Linear least squares with coefficients
/// >= 0 of the images R^-1 p^k against 1 in clay and 0 in air, each with the same weight ([Kachelriess 2006]). For
/// volumes of some hundred voxels a side; cost: about 7 projections of 32 planes an axis. `margin`: distance of what
/// counts as clay and as air from the other, in voxels. Where that leaves much, scatter is taken for a field over the
/// detector (ScatterField), whose spread and absorption are searched for about the axis that leaves least, or as they
/// are `known`, in voxels of the volume. Nothing is found where there is too little of either, or no more than noise
/// makes uneven. Errors: kCancelled.
Result<CurveSearch> search_curve(const Volume<float>& volume, std::int64_t margin, std::optional<TurnAxis> only,
                                 const std::shared_ptr<const ScatterField>& known, Progress& progress);

}  // namespace dubsar
