#include "core/rays/bent_rays.h"

#include <fmt/format.h>

#include <cmath>

namespace dubsar {

std::string rays_text(const RaysReport& report, const GridFrame& frame) {
  const std::string unbent =
      report.seen.bend > 0.0
          ? fmt::format("rays bend by {:.2f}, which explains {:.0f} % of what is uneven in clay and air: not corrected",
                        report.seen.bend, 100.0 * report.seen.share)
          : "rays: straight, no scatter or hardening that would count";
  if (!report.bent) return unbent;
  const BentRays& bent = *report.bent;
  const glm::dvec3 mm = frame.input_voxel.mm * frame.scale;
  const int axis = static_cast<int>(bent.axis);
  const double step = 0.5 * (mm[(axis + 1) % 3] + mm[(axis + 2) % 3]);
  const std::string length = frame.input_voxel.known() ? fmt::format("{:.0f} mm", bent.longest_vox * step)
                                                       : fmt::format("{:.0f} voxels", bent.longest_vox);
  std::string text = unbent;
  if (bent.curve.bends()) {
    text = fmt::format("rays through {} of clay arrive with {:.0f} % of their contrast (scatter, hardening)", length,
                       100.0 * bent.contrast);
    if (report.straightened) text += fmt::format("; straightened, turned about {}", "xyz"[axis]);
  }
  if (report.straightened && report.straightened->axis_shift.pixels != 0.0)
    text += fmt::format("; the axis of rotation was off by {:.2f} voxel, which is undone",
                        std::abs(report.straightened->axis_shift.pixels));
  if (!report.why_not.empty()) text += "; not straightened: " + report.why_not;
  if (bent.cut_by_border) text += "; the scan's border cuts the object, so that some lengths are wrong";
  return text;
}

}  // namespace dubsar
