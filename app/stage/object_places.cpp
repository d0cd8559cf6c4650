#include "app/stage/object_places.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec4.hpp>

namespace dubsar::app {

std::vector<ScreenRect> object_places(const Stage& stage, const Document& document, const PartLooks& looks) {
  std::vector<glm::dvec3> offsets;
  for (const Part& part : document.parts)
    for (std::size_t p = 0; p < looks.size(); ++p) {
      if ((part.partitions >> p & 1) == 0 || !looks[p].visible || looks[p].opacity <= 0) continue;
      if (std::find(offsets.begin(), offsets.end(), looks[p].offset_mm) == offsets.end())
        offsets.push_back(looks[p].offset_mm);
    }
  if (document.parts.empty()) offsets.emplace_back(0.0);
  const glm::dmat4 screen = stage.screen_from_model();
  std::vector<ScreenRect> out;
  for (const glm::dvec3& offset : offsets) {
    const auto place = [&](int corner) {
      return glm::dvec2(screen * glm::dvec4(stage.box_mm().corner(corner) + offset, 1.0));
    };
    ScreenRect rect{place(0), place(0)};
    for (int corner = 1; corner < 8; ++corner) {
      rect.min_mm = glm::min(rect.min_mm, place(corner));
      rect.max_mm = glm::max(rect.max_mm, place(corner));
    }
    out.push_back(rect);
  }
  return out;
}

}  // namespace dubsar::app
