#pragma once
// The drawers at the window's right side, in their order. A row and the words "panel.NAME" are all that a drawer needs
// besides the file in app/panels that draws it.

#include <array>
#include <cstdint>
#include <string_view>

namespace dubsar::app {

/// Name; key; how it stands. It is drawn by void draw_NAME(const PanelContext&).
#define DUBSAR_DRAWERS(X)      \
  X(parts, "p", kOfParts)      \
  X(light, "l", kBoxed)        \
  X(style, "t", kBoxed)        \
  X(measures, "m", kBoxed)     \
  X(notes, "shift+n", kBoxed)  \
  X(wedges, "shift+g", kBoxed) \
  X(cuts, "c", kBoxed)         \
  X(slices, "shift+s", kWide)  \
  X(film, "shift+k", kBoxed)   \
  X(export, "shift+e", kBoxed) \
  X(files, "shift+f", kBoxed)

enum class DrawerFrame : std::uint8_t {
  kBoxed,    ///< in a box as high as its contents
  kOfParts,  ///< the same, where the surface has several parts
  kWide,     ///< as wide as it likes: it makes its own box
};

struct DrawerRow {
  std::string_view name, key;
  DrawerFrame frame;
};

inline constexpr auto kDrawers = std::to_array<DrawerRow>({
#define DUBSAR_DRAWER_ROW(name, key, frame) {#name, key, DrawerFrame::frame},
    DUBSAR_DRAWERS(DUBSAR_DRAWER_ROW)
#undef DUBSAR_DRAWER_ROW
});

}  // namespace dubsar::app
