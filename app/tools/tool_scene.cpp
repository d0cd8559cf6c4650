#include "app/tools/tool_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "app/stage/pick_camera.h"

namespace dubsar::app {

std::optional<Picked> ToolScene::picked_at(const glm::dvec2& at) const {
  if (other_half(stage->shown(), stage->window_mm(), at)) return std::nullopt;
  const Shown now = shown(document(), window.view);
  return picker->pick(now.parts, PickCamera::of(*stage).ray(at), now.clips);
}

glm::dvec3 ToolScene::scan_place(const Picked& picked) const {
  const PartitionId id = mesh->partition_of(picked.triangle);
  const Shown now = shown(document(), window.view);
  return picked.at_mm - now.parts[std::min<std::size_t>(id, now.parts.size() - 1)].offset_mm;
}

Result<SurfacePin> ToolScene::pin(const glm::dvec3& at_mm) const {
  DUBSAR_ASSIGN(SurfacePin out, pin_on(*mesh, document().parts, at_mm));
  out.side = side_of(out.normal, seen_turn(document().home.rotation));
  return out;
}

Workplace::Reach ToolScene::reach(const glm::dvec3& direction, const glm::dquat& rotation) const {
  return reach_along(*mesh, glm::normalize(glm::transpose(seen_turn(rotation)) * direction));
}

}  // namespace dubsar::app
