#include "app/panels/overlay.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "app/panels/help_columns.h"
#include "app/panels/panel_font.h"
#include "app/stage/right_to_left.h"
#include "display/render/context/gl_objects.h"
#include "display/render/view_array.h"

namespace dubsar::app {
namespace {

constexpr float kPanelFontPx = 15.0f;         // of panels on monitors of 96 dpi
constexpr double kLargeScale = 1.2;           // from here on panels are drawn with the large font
constexpr double kLeastHeight = 540.0;        // of the layout; smaller views show it smaller
constexpr double kLeastScaledHeight = 400.0;  // what panels need where somebody wants them larger
constexpr double kMostHeight = 900.0;         // larger ones larger
constexpr float kMargin = 12.0f;
constexpr float kLeastScaled = 1.0f;  // letters of the help, where somebody said how large
constexpr float kCaptionRoom = 64.0f;
constexpr float kLegendLeft = 8.0f, kLegendBeside = 96.0f;  // below the tools; beside them where they reach so far down
constexpr float kToolsEnd = 270.0f, kLegendTall = 80.0f;
constexpr float kBallAside = 372.0f;  // beside the drawers

/// Keys that edit text, by their places in Dear ImGui's table, which are ours to choose.
constexpr std::array<std::pair<std::string_view, ImGuiKey_>, 18> kEditKeys{{{"left", ImGuiKey_LeftArrow},
                                                                            {"right", ImGuiKey_RightArrow},
                                                                            {"up", ImGuiKey_UpArrow},
                                                                            {"down", ImGuiKey_DownArrow},
                                                                            {"page_up", ImGuiKey_PageUp},
                                                                            {"page_down", ImGuiKey_PageDown},
                                                                            {"home", ImGuiKey_Home},
                                                                            {"end", ImGuiKey_End},
                                                                            {"insert", ImGuiKey_Insert},
                                                                            {"delete", ImGuiKey_Delete},
                                                                            {"backspace", ImGuiKey_Backspace},
                                                                            {"enter", ImGuiKey_Enter},
                                                                            {"escape", ImGuiKey_Escape},
                                                                            {"a", ImGuiKey_A},
                                                                            {"c", ImGuiKey_C},
                                                                            {"v", ImGuiKey_V},
                                                                            {"x", ImGuiKey_X},
                                                                            {"z", ImGuiKey_Z}}};

void add_fonts(const std::uint16_t* letters) {
  for (const float size_px : {kLargeFontPx, kPanelFontPx}) add_panel_font(*ImGui::GetIO().Fonts, size_px, letters);
  add_title_font(*ImGui::GetIO().Fonts, kLargeFontPx);
}

constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav;

void draw_notice(const std::string& notice, double opacity, float width, float height) {
  const float scale = std::min(1.4f, (width - 4 * kMargin) / (static_cast<float>(notice.size() + 2) * kGlyphPx));
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, static_cast<float>(std::clamp(opacity, 0.0, 1.0)));
  ImGui::SetNextWindowPos(ImVec2(0.5f * width, height - kMargin), ImGuiCond_Always, ImVec2(0.5f, 1.0f));
  ImGui::SetNextWindowBgAlpha(0.7f);
  ImGui::Begin("notice", nullptr, kPlain | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::SetWindowFontScale(std::max(scale, 0.7f) * kLinePx / kLargeFontPx);
  ImGui::PushTextWrapPos(width - 4 * kMargin);
  ImGui::TextUnformatted(notice.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace

/// Dear ImGui works on one state at a time: that of an overlay while it is called, then the one before.
class Overlay::Turn {
 public:
  explicit Turn(ImGuiContext* state) : before_(ImGui::GetCurrentContext()) { ImGui::SetCurrentContext(state); }
  ~Turn() { ImGui::SetCurrentContext(before_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  ImGuiContext* before_;
};

Result<std::unique_ptr<Overlay>> Overlay::create(const KeyTable& keys) {
  const Turn turn(nullptr);
  ImGuiContext* const state = ImGui::CreateContext();
  ImGui::SetCurrentContext(state);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.DeltaTime = 1.0f / 60.0f;
  io.KeyRepeatDelay = 1e9f;  // the window's keyboard repeats
  for (const auto& [name, key] : kEditKeys) io.KeyMap[key] = key;
  add_fonts(panel_letters());
  ImGui::StyleColorsDark();
  ImGui::GetStyle().WindowBorderSize = 0.0f;
  ImGui::GetStyle().WindowRounding = 4.0f;
  if (!ImGui_ImplOpenGL3_Init("#version 430")) {
    ImGui::DestroyContext(state);
    return fail(ErrorKind::kUnavailable, "overlay: Dear ImGui found no OpenGL library that it can use");
  }
  ImGui_ImplOpenGL3_NewFrame();  // makes the picture of the letters
  return std::unique_ptr<Overlay>(new Overlay(keys, state));
}

Overlay::~Overlay() {
  const Turn turn(state_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(state_);
}

glm::dvec2 Overlay::layout(int view_height, const glm::dvec2& window_mm, double scale) {
  const double height = scale > 0 ? std::max(view_height / scale, kLeastScaledHeight)
                                  : std::clamp(static_cast<double>(view_height), kLeastHeight, kMostHeight);
  return {height * window_mm.x / window_mm.y, height};
}

/// With letters as large as those of panels on this monitor.
void Overlay::draw_in_panel_letters(const std::function<void()>& draw) const {
  ImFont* const font = ImGui::GetIO().Fonts->Fonts[scale_.y >= kLargeScale ? 0 : 1];
  const float before = std::exchange(font->Scale, kPanelFontPx / font->FontSize);
  ImGui::PushFont(font);
  draw();
  ImGui::PopFont();
  font->Scale = before;
}

void Overlay::draw_all(float width, float height) {
  const bool around = text_.panels && text_.panels->ui.panels;
  const auto legend = [&] {
    const bool captions = !text_.legend->figures.empty();  // names stand below two surfaces
    const float bottom = height - (around ? 120.0f : captions ? kCaptionRoom : 24.0f);
    draw_legend(*text_.legend, around && bottom - kLegendTall < kToolsEnd ? kLegendBeside : kLegendLeft, bottom);
  };
  if (text_.help.empty()) {
    draw_in_panel_letters([&] {
      if (text_.box) draw_box(*text_.box, width, height);
      if (text_.panels) draw_panels(*text_.panels, keys_, width, height, commands_);
      if (text_.legend && around) legend();
    });
    if (text_.legend && !around) legend();
  }
  if (text_.light && text_.help.empty())
    draw_light_ball(*text_.light, width - (around ? kBallAside : 16.0f), height - (around ? 72.0f : 16.0f));
  if (text_.help.empty()) help_ = {};
  if (!text_.help.empty()) draw_help(text_.help, width, height, wanted_scale_ > 0 ? kLeastScaled : 0.0f, help_);
  if (text_.gallery) draw_gallery(*text_.gallery, width, height, px_per_mm_);
  if (!text_.notice.empty()) draw_notice(text_.notice, text_.notice_opacity, width, height - (text_.panels ? 56 : 0));
}

/// Only museums that need them wait for them, .1 s once.
void Overlay::take_letters() {
  if (all_letters_ || !text_.gallery) return;
  if (!has_right_to_left(text_.gallery->line) && !has_right_to_left(text_.gallery->title)) return;
  all_letters_ = true;
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui::GetIO().Fonts->Clear();
  add_fonts(panel_letters_of_all());
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Overlay::frame(const glm::dvec2& layout, const glm::dvec2& scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(layout.x), static_cast<float>(layout.y));
  io.DisplayFramebufferScale = ImVec2(static_cast<float>(scale.x), static_cast<float>(scale.y));
  scale_ = scale;
  ImGui::NewFrame();
  draw_all(io.DisplaySize.x, io.DisplaySize.y);
  ImGui::Render();
}

namespace {
/// What a key types; empty: nothing.
std::string typed_by(const InputEvent& event) {
  if ((event.modifiers & (kControl | kAlt)) != 0) return {};
  if (event.key == "space") return " ";
  const bool named = event.key.size() > 1 && static_cast<unsigned char>(event.key[0]) < 0x80;
  if (named) return {};
  const bool upper = (event.modifiers & kShift) != 0 && event.key[0] >= 'a' && event.key[0] <= 'z';
  return upper ? std::string(1, static_cast<char>(event.key[0] - 'a' + 'A')) : event.key;
}
}  // namespace

bool Overlay::take_key(const InputEvent& event, const glm::dvec2& layout) {
  ImGuiIO& io = ImGui::GetIO();
  const UiState& ui = text_.panels->ui;
  const bool palette = ui.palette || ui.choosing.open;  // what lists things takes the keys
  const bool placed = std::exchange(notes_answered_, ui.pointing.notes) != ui.pointing.notes;
  if (palette ? !io.WantTextInput : placed)
    for (int pass = 0; pass < 3; ++pass) frame(layout, scale_);  // the field that waits for its text takes the keys
  if (!palette && !io.WantTextInput) return false;
  if (!palette && event.key == "escape") {  // Dear ImGui would take back what was typed
    InputEvent enter = event;
    enter.key = "enter";
    return take_key(enter, layout);
  }
  const bool control = (event.modifiers & kControl) != 0;
  if (!palette && control && std::string_view("acvxz").find(event.key) == std::string_view::npos) return false;
  if (palette && (event.key == "escape" || (control && (event.key == "k" || event.key == "o"))))
    return false;  // they close it
  const auto at =
      std::find_if(kEditKeys.begin(), kEditKeys.end(), [&](const auto& row) { return row.first == event.key; });
  io.KeyCtrl = control;
  io.KeyShift = (event.modifiers & kShift) != 0;
  if (event.down) {
    const std::string typed = typed_by(event);
    if (!typed.empty()) io.AddInputCharactersUTF8(typed.c_str());
    if (at != kEditKeys.end() && io.KeysDown[at->second]) {  // held: it goes down again
      io.KeysDown[at->second] = false;
      frame(layout, scale_);
    }
  }
  if (at != kEditKeys.end()) io.KeysDown[at->second] = event.down;
  frame(layout, scale_);
  return true;
}

/// Help that does not fit on the page is moved by the wheel and the keys that move pages.
bool Overlay::scroll_help(const InputEvent& event) {
  if (help_.most <= 0.0f) return false;
  constexpr float kLines = 3.0f * kLinePx;
  if (event.kind == EventKind::kWheel) {
    help_.by(-kLines * static_cast<float>(event.motion.y));
    return true;
  }
  if (event.kind != EventKind::kKey) return false;
  const std::array<std::pair<std::string_view, float>, 6> ways{{{"page_down", help_.page},
                                                                {"page_up", -help_.page},
                                                                {"down", kLines},
                                                                {"up", -kLines},
                                                                {"home", -help_.most},
                                                                {"end", help_.most}}};
  const auto way = std::find_if(ways.begin(), ways.end(), [&](const auto& row) { return row.first == event.key; });
  if (way == ways.end()) return false;
  if (event.down) help_.by(way->second);
  return true;
}

bool Overlay::take(const InputEvent& event, const glm::dvec2& layout) {
  const Turn turn(state_);
  if (!text_.help.empty()) return scroll_help(event);
  if (!text_.panels) return false;
  if (event.kind == EventKind::kKey) return take_key(event, layout);
  if (event.kind == EventKind::kPinch) return false;  // fingers have the object between them
  const bool dropped = event.kind == EventKind::kButton && !event.down && !event.at;  // without a click
  if (!event.at && !dropped) return false;
  ImGuiIO& io = ImGui::GetIO();
  io.KeyCtrl = (event.modifiers & kControl) != 0;
  io.KeyShift = (event.modifiers & kShift) != 0;
  const auto button = static_cast<std::size_t>(event.button);
  const bool releases_ours = event.kind == EventKind::kButton && !event.down && held_[button];
  constexpr float kNowhere = -std::numeric_limits<float>::max();
  io.MousePos = dropped ? ImVec2(kNowhere, kNowhere)
                        : ImVec2(static_cast<float>(0.5 * layout.x + event.at->x * layout.y),
                                 static_cast<float>((0.5 - event.at->y) * layout.y));
  frame(layout, scale_);  // what is under the pointer now
  const bool ours = io.WantCaptureMouse && !object_held_;
  if (event.kind == EventKind::kButton && event.down) {
    held_[button] = ours;
    object_held_ = object_held_ || !ours;
  }
  if (event.kind == EventKind::kButton && !event.down && !releases_ours) object_held_ = false;
  if (!ours && !releases_ours) return false;
  if (event.kind == EventKind::kWheel) io.MouseWheel = static_cast<float>(event.motion.y);
  if (event.kind == EventKind::kButton) {
    held_[button] = event.down;
    constexpr std::array<int, 3> kTheirs{0, 2, 1};
    io.MouseDown[kTheirs[button]] = event.down;
  }
  frame(layout, scale_);
  return true;
}

std::vector<std::string> Overlay::take_commands() { return std::exchange(commands_, {}); }

Result<void> Overlay::paint(ViewArray& layers, const glm::dvec2& window_mm) {
  if (text_.empty()) return {};
  const Turn turn(state_);
  const glm::dvec2 size = layout(layers.height(), window_mm, wanted_scale_);
  px_per_mm_ = static_cast<float>(size.y / window_mm.y);
  take_letters();
  ImGui_ImplOpenGL3_NewFrame();
  for (int pass = 0; pass < 2; ++pass)  // sizes that follow from text are known in the second
    frame(size, {layers.width() / size.x, layers.height() / size.y});
  const GlFramebuffer target = make_framebuffer();
  for (int layer = 0; layer < layers.layers(); ++layer) {
    glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT0, layers.coded(), 0, layer);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return check_gl("drawing the overlay");
}

}  // namespace dubsar::app
