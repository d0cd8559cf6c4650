// What a gallery writes is read from where visitors stand.

#include "app/panels/gallery_page.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/kiosk/words.h"
#include "app/panels/panel_font.h"
#include "display/render/images/utf8.h"

namespace dubsar::app {
namespace {

constexpr float kFontPx = 26.0f;

/// A frame of Dear ImGui without a picture.
class GalleryPage : public ::testing::Test {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(1920, 1080);
    io.DeltaTime = 1.0f / 60.0f;
    add_panel_font(*io.Fonts, kFontPx, panel_letters_of_all());
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    ImGui::NewFrame();
  }
  void TearDown() override {
    ImGui::EndFrame();
    ImGui::DestroyContext();
  }
};

TEST_F(GalleryPage, TheSizeOfCapitalsIsThatOfTheFont) {
  const ImFontGlyph* const h = ImGui::GetFont()->FindGlyph('H');
  EXPECT_NEAR(panel_capital(), (h->Y1 - h->Y0) / kFontPx, 1.2 / kFontPx);  // drawn in whole pixels
}

struct PanelSize {
  const char* name;
  double width_mm, height_mm;
  int height_px;
};

TEST_F(GalleryPage, EverySentenceIsReadFromAMetreAndAHalfOnEveryPanelAndLeavesTheObjectItsPlace) {
  constexpr double kDistanceM = 1.5, kLeast = 16.0;  // minutes of arc of a capital: ISO 9241-303
  const Words words;
  for (const PanelSize& panel : {PanelSize{"24 inches", 531, 299, 1080},
                                 {"15.6 inches, 4K", 344, 194, 2160},
                                 {"55 inches", 1210, 680, 2160},
                                 {"portrait of 32 inches", 398, 708, 1920},
                                 {"Looking Glass 16", 345, 194, 819}}) {
    const double px_per_mm = panel.height_px / panel.height_mm, width = panel.width_mm * px_per_mm;
    const double size = letters_size(letter_height_mm(kDistanceM), panel.height_px, px_per_mm);
    for (const std::string& language : words.languages())
      for (std::size_t line = 0; line < kLineCount; ++line) {
        const std::string& text = words.say(static_cast<Line>(line), language);
        const SetWords set = set_words(text, size, width);
        const double capital_mm = set.size * panel_capital() / px_per_mm;
        const double arc = 60.0 * 180.0 / std::numbers::pi * capital_mm / (1e3 * kDistanceM);
        EXPECT_GE(arc, kLeast) << panel.name << ": " << text;
        EXPECT_LE(set.wide, 0.9 * width) << panel.name << ": " << text;
        EXPECT_LE(set.tall, 0.36 * panel.height_px) << panel.name << ": " << text;
      }
  }
}

TEST_F(GalleryPage, ArabicAndHebrewSentencesHaveAllTheirLettersAndLinesThatFit) {
  for (const std::string text :
       {"مد يدك وأدر اللوح الطيني بنفسك لترى جميع جوانبه الستة واحدا بعد الآخر (٦)",
        "دست خود را دراز کنید و لوح گلی را بچرخانید پیش از آنکه باز شود", "הושיטו יד וסובבו את לוח החומר"}) {
    const SetWords set = set_words(text, 60.0, 1200.0, true);
    ASSERT_FALSE(set.lines.empty());
    EXPECT_LE(set.wide, 0.9 * 1200.0);
    EXPECT_NEAR(set.tall, set.size * static_cast<double>(set.lines.size()), 1e-6);
    std::size_t letters = 0;
    for (const std::string& line : set.lines)
      for (const unsigned code : code_points(line)) {
        EXPECT_NE(ImGui::GetFont()->FindGlyphNoFallback(static_cast<ImWchar>(code)), nullptr) << std::hex << code;
        letters += code != ' ';
      }
    EXPECT_GT(letters, 20U);
  }
  EXPECT_GT(set_words("مد يدك وأدر اللوح الطيني بنفسك لترى جميع جوانبه الستة واحدا بعد الآخر", 60.0, 900.0, true)
                .lines.size(),
            1U);
}

}  // namespace
}  // namespace dubsar::app
