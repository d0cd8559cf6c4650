// A field of text without a window: keys in, text out.

#include <gtest/gtest.h>
#include <imgui.h>

#include <string>

#include "app/panels/panel_kit.h"
#include "core/edition/typed_letters.h"

namespace dubsar::app {
namespace {

class TypeIn : public ::testing::Test {
 protected:
  TypeIn() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(400, 200);
    io.IniFilename = nullptr;
    for (const ImGuiKey key : {ImGuiKey_Home, ImGuiKey_End}) io.KeyMap[key] = key;  // a number of its own for each
    io.Fonts->AddFontDefault();
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    frame(now_.size());
    frame();
    frame();
  }
  ~TypeIn() override { ImGui::DestroyContext(); }
  void frame(std::optional<std::size_t> goes_on = std::nullopt) {
    ImGui::GetIO().DeltaTime = 0.02f;
    ImGui::NewFrame();
    ImGui::Begin("desk");
    std::string typed;
    if (type_in("##text", now_, typed, 300.0f, goes_on, letters_)) now_ = typed;
    ImGui::End();
    ImGui::EndFrame();
  }
  void type(const std::string& keys) {
    for (const char key : keys) {
      ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(key));
      frame();
    }
  }
  void press(ImGuiKey key) {
    ImGui::GetIO().KeysDown[key] = true;
    frame();
    ImGui::GetIO().KeysDown[key] = false;
    frame();
  }
  std::string now_;
  std::string (*letters_)(std::string_view) = typed_letters;
};

TEST_F(TypeIn, LettersBecomeThoseOfPrintWithEachKeyAndTheCaretStaysBehindThem) {
  type("szu-mi qi2");
  EXPECT_EQ(now_, "\u0161u-mi qi\u2082");
  press(ImGuiKey_Home);
  type("a-s,");
  EXPECT_EQ(now_, "a-\u1e63\u0161u-mi qi\u2082");
  type("i ");
  EXPECT_EQ(now_, "a-\u1e63i \u0161u-mi qi\u2082") << "what is typed next stands where the caret was";
  press(ImGuiKey_End);
  type("-bi4");
  EXPECT_EQ(now_, "a-\u1e63i \u0161u-mi qi\u2082-bi\u2084");
}

TEST_F(TypeIn, WithoutThemTextIsAsItIsTyped) {
  letters_ = nullptr;
  type("sz, 2");
  EXPECT_EQ(now_, "sz, 2");
}

}  // namespace
}  // namespace dubsar::app
