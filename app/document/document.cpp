#include "app/document/document.h"

#include <algorithm>

namespace dubsar::app {
namespace {

ViewState view_from(const CameraPose& camera, const LightPlace& light) {
  return {camera.rotation, camera.zoom, camera.pan, light.azimuth_deg, light.elevation_deg, camera.nearer};
}

}  // namespace

ViewState view_of(const Document& document) { return view_from(document.now, document.light); }
ViewState home_of(const Document& document) { return view_from(document.home, document.home_light); }

void set_view(Document& document, const ViewState& view) {
  document.now = {view.rotation, view.zoom, view.pan, view.nearer};
  document.light = {view.light_azimuth_deg, view.light_elevation_deg};
}

bool can_unpack(const Document& document) {
  return document.parts.size() > 1 && std::any_of(document.parts.begin(), document.parts.end(),
                                                  [](const Part& part) { return part.name == "envelope"; });
}

std::uint8_t visible_partitions(const Document& document) {
  if (document.parts.empty()) return 0xff;
  std::uint8_t out = 0;
  for (const Part& part : document.parts)
    if (part.visible) out = static_cast<std::uint8_t>(out | part.partitions);
  for (const Part& part : document.parts)
    if (!part.visible) out = static_cast<std::uint8_t>(out & ~part.pores);
  return out;
}

}  // namespace dubsar::app
