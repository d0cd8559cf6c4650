// The film editor with a mouse: what is pressed and dragged is said as commands.

#include "app/panels/film_page.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <set>

#include "app/panels/panel_kit.h"
#include "app/panels/window_panels.h"
#include "display/render/shading.h"

namespace dubsar::app {
namespace {

class FilmPage : public ::testing::Test {
 protected:
  static constexpr float kWidth = 1280.0f, kHeight = 720.0f;

  FilmPage() : commands_(CommandTable::standard({"relief"})), keys_(KeyTable::create(commands_).value()) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(kWidth, kHeight);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    state_.ui.panels = true;
    state_.ui.drawer = "film";
    for (int i = 0; i < 4; ++i) {
      state_.document.keyframes.push_back({});
      state_.document.keyframes.back().time_s = 2.0 * i;
    }
    state_.thumbnails = {11, 12, 13, 14};
    frame(0, 0, false);
    frame(0, 0, false);
  }
  ~FilmPage() override { ImGui::DestroyContext(); }

  void frame(float x, float y, bool down) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = 1.0f / 60.0f;
    io.MousePos = ImVec2(x, y);
    io.MouseDown[0] = down;
    ImGui::NewFrame();
    draw_panels(state_, keys_, kWidth, kHeight, said_);
    ImGui::Render();
  }
  void click(float x, float y) {
    for (const bool down : {false, true, true, false, false}) frame(x, y, down);
  }
  std::vector<std::string> said() { return std::exchange(said_, {}); }

  /// The rows of thumbnails, found by their textures in what was drawn: their middles.
  std::vector<ImVec2> pictures() const {
    std::vector<ImVec2> out;
    const ImDrawData& data = *ImGui::GetDrawData();
    for (const std::uint32_t texture : state_.thumbnails)
      for (int l = 0; l < data.CmdListsCount; ++l)
        for (const ImDrawCmd& command : data.CmdLists[l]->CmdBuffer)
          if (command.TextureId == reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture))) {
            const auto& list = *data.CmdLists[l];
            ImVec2 sum(0, 0);
            for (unsigned k = 0; k < command.ElemCount; ++k) {
              const ImVec2 at =
                  list.VtxBuffer[static_cast<int>(list.IdxBuffer[static_cast<int>(command.IdxOffset + k)])].pos;
              sum.x += at.x / static_cast<float>(command.ElemCount);
              sum.y += at.y / static_cast<float>(command.ElemCount);
            }
            out.push_back(sum);
          }
    return out;
  }

  CommandTable commands_;
  KeyTable keys_;
  PanelState state_;
  std::vector<std::string> said_;
};

TEST_F(FilmPage, ShowsAPictureForEachKeyframeBelowEachOther) {
  const auto at = pictures();
  ASSERT_EQ(at.size(), 4u);
  for (std::size_t i = 1; i < at.size(); ++i) {
    EXPECT_NEAR(at[i].y - at[i - 1].y, kFilmRow, 2.0f);
    EXPECT_FLOAT_EQ(at[i].x, at[0].x);
  }
  EXPECT_GT(at[0].x, kWidth - kTab - kDrawer - 4.0f);
}

TEST_F(FilmPage, APressGoesThereAndADragBringsItToAnotherPlace) {
  const auto at = pictures();
  ASSERT_EQ(at.size(), 4u);
  click(at[2].x, at[2].y);
  EXPECT_EQ(said(), std::vector<std::string>{"go_to_keyframe 3"});
  frame(at[0].x, at[0].y, false);
  for (int step = 0; step <= 20; ++step)
    frame(at[0].x, at[0].y + (at[2].y - at[0].y) * static_cast<float>(step) / 20.0f, true);
  frame(at[2].x, at[2].y, false);
  frame(at[2].x, at[2].y, false);
  EXPECT_EQ(said(), std::vector<std::string>{"move_keyframe 1 3"});
}

TEST_F(FilmPage, EveryButtonOfARowSaysItsCommand) {
  const auto at = pictures();
  ASSERT_EQ(at.size(), 4u);
  std::set<std::string> heard;
  for (float x = at[1].x + 58.0f; x < kWidth - kTab - 14.0f; x += 6.0f) {
    for (float y = at[1].y - 0.5f * kFilmPicture; y < at[1].y + 0.5f * kFilmPicture; y += 6.0f) {
      click(x, y);
      for (const std::string& command : said()) {
        EXPECT_TRUE(commands_.check(command)) << command;
        heard.insert(command);
      }
    }
  }
  for (const char* wanted : {"play 2", "replace_keyframe 2", "delete_keyframe 2"}) EXPECT_TRUE(heard.contains(wanted));
  EXPECT_EQ(heard.size(), 3u) << "and nothing else";
}

TEST_F(FilmPage, DraggingTheTimeChangesHowLongItTakes) {
  const auto at = pictures();
  ASSERT_EQ(at.size(), 4u);
  const float x = at[1].x + 80.0f, y = at[1].y - 3.0f;
  frame(x, y, false);
  for (int step = 0; step < 20; ++step) frame(x + 4.0f * static_cast<float>(step), y, true);
  frame(x + 80.0f, y, false);
  const auto commands = said();
  ASSERT_FALSE(commands.empty());
  for (const std::string& command : commands) {
    EXPECT_TRUE(command.starts_with("keyframe_seconds 2 ")) << command;
    EXPECT_TRUE(commands_.check(command)) << command;
    EXPECT_GT(std::stod(command.substr(19)), 2.0);
  }
}

TEST_F(FilmPage, ALongFilmIsScrolledAndDoesNotCoverTheStrip) {
  for (int i = 4; i < 30; ++i) {
    state_.document.keyframes.push_back({});
    state_.document.keyframes.back().time_s = 2.0 * i;
  }
  frame(0, 0, false);
  frame(0, 0, false);
  EXPECT_EQ(pictures().size(), 4u);
  const ImDrawData& data = *ImGui::GetDrawData();
  for (int l = 0; l < data.CmdListsCount; ++l)
    for (const ImDrawCmd& command : data.CmdLists[l]->CmdBuffer)
      if (command.ClipRect.x > kWidth - kTab - kDrawer - 8.0f && command.ClipRect.z < kWidth - kTab) {
        EXPECT_LE(command.ClipRect.w, kHeight - kStrip);
      }
}

}  // namespace
}  // namespace dubsar::app
