#pragma once
// What was found of rays that are not straight, for reports and in words.

#include <optional>
#include <string>

#include "core/rays/curve_search.h"
#include "core/rays/straighten.h"

namespace dubsar {

/// Rays that arrive weaker than straight ones: scatter and hardening. Where only the axis of rotation was off, the
/// curve is straight.
struct BentRays {
  TurnAxis axis = TurnAxis::kZ;                    ///< of the scan, about which the scanner turned
  RayCurve curve;                                  ///< lengths in voxels of the scan
  std::shared_ptr<const ScatterField> stray = {};  ///< in voxels of the scan, where scatter varies over the detector
  GreyLevels levels;
  Evenness before, after;
  double longest_vox = 0.0;  ///< straight length of the longest ray in clay, voxels of the scan
  double contrast = 1.0;     ///< with which details on it arrive
  bool cut_by_border = false;
  double crossing_s = 0.0;  ///< seconds of one core for a crossing of voxel and ray (straighten.h), about
};

/// The bend that would even clay and air most.
struct SeenBend {
  double bend = 0.0;   ///< CurveTrial::bend(); 0: none was looked for
  double share = 0.0;  ///< of the variance of clay and air that it would take away; 0: nothing but by chance
};

struct RaysReport {
  std::optional<BentRays> bent;              ///< nothing: none that is significant
  std::optional<Straightened> straightened;  ///< nothing: rays are as they were; shifts in voxels of the scan
  std::string why_not;                       ///< one sentence, where rays are bent and stay so
  SeenBend seen;                             ///< where none is significant
};

/// "rays through 45 mm of clay arrive with 26 % of their contrast (scatter, hardening); straightened"
/// `frame`: of the scan.
std::string rays_text(const RaysReport& report, const GridFrame& frame);

/// What to do at the scanner next time, in one sentence.
inline constexpr const char* kAdviceForBentRays =
    "next time: a harder beam (more kV, 1 to 2 mm of copper), the longest edge upright, a beam that ends at the "
    "object, "
    "more air between object and detector";

}  // namespace dubsar
