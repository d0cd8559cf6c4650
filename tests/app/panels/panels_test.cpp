// Panels without a window: the letters they can write, and figures of the scale bar.

#include <gtest/gtest.h>
#include <imgui.h>

#include <cmath>

#include "app/panels/overlay.h"
#include "app/panels/panel_font.h"
#include "app/panels/window_panels.h"

namespace dubsar::app {
namespace {

TEST(PanelFont, HasTheLettersOfEuropeanLanguagesAndOfTransliterations) {
  ImFontAtlas atlas;
  ASSERT_GT(panel_font().size(), 100'000u);
  ImFont* const font = add_panel_font(atlas, 15.0f, panel_letters());
  ASSERT_TRUE(atlas.Build());
  for (const int code : {0x0161 /* s caron */, 0x1e63 /* s dot */, 0x1e6d /* t dot */, 0x1e2b /* h breve */,
                         0x02be /* aleph */, 0x02bf /* ayin */, 0x2082 /* subscript 2 */, 0x2093 /* subscript x */,
                         0x011d /* g circumflex */, 0x1e2a, 0x0160, 0x0101, 0x00e9, 0x00df, 0x0142, 0x0159, 0x00b0})
    EXPECT_NE(font->FindGlyphNoFallback(static_cast<ImWchar>(code)), nullptr) << std::hex << code;
}

TEST(ScaleBar, IsTheLongestRoundLengthThatFits) {
  for (double mm_per_px = 1e-5; mm_per_px < 1e3; mm_per_px *= 1.37) {
    const double bar = scale_bar_mm(mm_per_px, 150.0), most = 150.0 * mm_per_px;
    EXPECT_LE(bar, most * (1 + 1e-9));
    EXPECT_GE(bar, most / 2.5 * (1 - 1e-9));
    const double mantissa = bar / std::pow(10.0, std::floor(std::log10(bar * (1 + 1e-12))));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-9 || std::abs(mantissa - 2) < 1e-9 || std::abs(mantissa - 5) < 1e-9)
        << mantissa;
  }
}

TEST(Overlay, LettersAreAsLargeAsTheMonitorOrSomebodyWantsThem) {
  const glm::dvec2 window(600.0, 337.5);
  EXPECT_EQ(Overlay::layout(2160, window), glm::dvec2(1600, 900)) << "4K: 2.4 pixels for one";
  EXPECT_EQ(Overlay::layout(2160, window, 2.0), glm::dvec2(1920, 1080));
  EXPECT_EQ(Overlay::layout(2160, window, 3.0), glm::dvec2(1280, 720));
  EXPECT_EQ(Overlay::layout(1080, window, 1.0), glm::dvec2(1920, 1080));
  EXPECT_EQ(Overlay::layout(1080, window, 4.0).y, 400) << "panels need some room";
}

}  // namespace
}  // namespace dubsar::app
