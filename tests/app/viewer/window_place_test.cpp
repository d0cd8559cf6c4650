#include "app/viewer/presenter/window_place.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace dubsar::app {
namespace {

std::vector<std::string> names(const std::vector<SinkSpec>& specs) {
  std::vector<std::string> out;
  for (const SinkSpec& spec : specs) out.push_back(spec.text());
  return out;
}

bool has(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

WindowKind on(int width, int height, double refresh_hz = 60.0, bool stereo = false) {
  WindowKind out;
  out.screen.width_px = width;
  out.screen.height_px = height;
  out.refresh_hz = refresh_hz;
  out.stereo = stereo;
  return out;
}

TEST(WindowPlace, DisplaysToGoThroughAreThoseWhoseTraitsFitTheWindow) {
  const SinkCatalog catalog;
  const auto plain = names(displays_for_window({"anaglyph"}, catalog, on(1920, 1200)));
  EXPECT_EQ(plain, (std::vector<std::string>{"anaglyph", "mono", "side_by_side", "top_bottom", "interlaced"}));
  EXPECT_TRUE(has(names(displays_for_window({"mono"}, catalog, on(1920, 1080, 120.0))), "shutter"));
  EXPECT_FALSE(has(names(displays_for_window({"mono"}, catalog, on(1920, 1080, 60.0))), "shutter"));
  EXPECT_TRUE(has(names(displays_for_window({"mono"}, catalog, on(1920, 1080, 60.0, true))), "quad_buffer"));
  int panels = 0;
  for (const PanelProfile& panel : catalog.panels().profiles) {
    if (!panel.sheet && !panel.optics) continue;
    ++panels;
    const auto there = names(displays_for_window({"mono"}, catalog, on(panel.width_px, panel.height_px)));
    EXPECT_TRUE(has(there, "lenticular:" + panel.name)) << panel.name;
    const auto elsewhere = names(displays_for_window({"mono"}, catalog, on(panel.width_px + 1, panel.height_px)));
    EXPECT_FALSE(has(elsewhere, "lenticular:" + panel.name)) << panel.name;
  }
  EXPECT_GE(panels, 3);
}

}  // namespace
}  // namespace dubsar::app
